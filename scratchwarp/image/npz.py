"""Layers to and from NumPy archives."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..scene import check_archive
from ..whole import whole
from .layers import check


def write(layers: Mapping[str, np.ndarray], path: Path, metadata: Mapping[str, Any]) -> None:
    """Write each layer under its own name, as it is, and the metadata as JSON text under ``metadata``.

    ValueError naming the layer and place of a NaN, OSError when the file cannot be written.
    """
    for name, values in layers.items():
        check(name, np.asarray(values))
    arrays: dict[str, Any] = dict(layers)
    text = json.dumps({key: np.asarray(value).tolist() for key, value in metadata.items()})
    with whole(path) as draft, draft.open("wb") as file:
        np.savez_compressed(file, metadata=np.array(text), **arrays)


def read(path: Path) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Layers and metadata that ``write`` wrote; OSError or ValueError when the file is missing or something else, or
    claims more than it holds or than there is memory."""
    check_archive(path)
    with np.load(path, allow_pickle=False) as archive:
        layers = {name: archive[name] for name in archive.files if name != "metadata"}
        metadata = json.loads(str(archive["metadata"])) if "metadata" in archive.files else {}
    return layers, metadata
