"""Grooves one by one: exact at any distance (Bosch, Pueyo, Merillou, Ghazanfarpour 2008); names load on first use.

``masking`` (``masking_device``): what is seen and lit and shadowing in a cross-section.
"""

from ...lazy import lazily

_PUBLIC = {
    "visibility": "masking",
}

__all__ = sorted(_PUBLIC)

__getattr__, __dir__ = lazily(__name__, _PUBLIC)
