"""The scratch that Python describes, and its rows for the device."""

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from scratchwarp.profiles import Profile

from .inputs import common_shape, numbers
from .outline import facets, proportion


@dataclass(frozen=True, eq=False)
class Scratch:
    """One scratch near the shading point; every field but ``profile`` may be an array, and they broadcast.

    ``width``, ``depth`` [um] >= 0; ``azimuth`` [rad] turns the direction u along it in the tangent plane; ``offset``
    [um]: distance s_b from the shading point across, along v; ``coherence_radius`` [um] > 0: sigma of the Gaussian that
    weighs the field. ``ends``: the positions [um] along u, from the shading point, of its two ends, as a pair in either
    order or an array ``[..., 2]``; either may be infinite; None: both are.

    ``profile``: its cross-section as ``profiles.Profile``, stretched to ``width`` and, from z = 0 to its lowest point,
    to ``depth``; x runs along v, centred. ``depth`` None keeps the profile's own proportions. None: a rectangle.

    ``depth_spread`` [um]: standard deviation of the depth along the scratch; ``roughness`` [um]: that of the height of
    its floor, whose scattered part 1 - e^{-(k g roughness)^2} is not in the lobe. Both of rectangles alone.

    Raises ValueError naming the field and its value.
    """

    width: Any = 3.0
    depth: Any = 1.2
    azimuth: Any = 0.0
    offset: Any = 0.0
    coherence_radius: Any = 60.0
    ends: Any = None
    profile: Profile | None = None
    depth_spread: Any = 0.0
    roughness: Any = 0.0

    def __post_init__(self) -> None:
        if not (self.profile is None or isinstance(self.profile, Profile)):
            raise ValueError(f"profile must be a profiles.Profile or None, got {self.profile!r}")
        if self.depth is None:
            if self.profile is None:
                raise ValueError("depth must be a number unless there is a profile, got None")
            object.__setattr__(self, "depth", proportion(self.profile) * numbers("width", self.width, least=0.0))
        bounds: dict[str, dict[str, float]] = {
            "width": {"least": 0.0},
            "depth": {"least": 0.0},
            "azimuth": {},
            "offset": {},
            "coherence_radius": {"above": 0.0},
            "depth_spread": {"least": 0.0},
            "roughness": {"least": 0.0},
        }
        for name, bound in bounds.items():
            object.__setattr__(self, name, numbers(name, getattr(self, name), **bound))
        if self.ends is not None:
            object.__setattr__(self, "ends", _ends(self.ends))
        if self.profile is not None:
            for name in ("depth_spread", "roughness"):
                if np.any(getattr(self, name) > 0.0):
                    raise ValueError(f"{name} must be 0 where there is a profile, got {getattr(self, name)}")
        _ = self.shape

    @property
    def shape(self) -> tuple[int, ...]:
        """What the fields broadcast to."""
        shapes = {
            field.name: np.shape(getattr(self, field.name))
            for field in fields(self)
            if field.name not in ("ends", "profile")
        }
        if self.ends is not None:
            shapes["ends"] = self.ends.shape[:-1]
        return common_shape(**shapes)

    @property
    def facets(self) -> np.ndarray:
        """Rows of its outline, ``[n, 4]``; none for a rectangle. One of a flat profile has no width."""
        if self.profile is None:
            return np.zeros((0, 4))
        rows = facets(self.profile)
        return rows if len(rows) else np.zeros((1, 4))

    def to_rows(self, shape: tuple[int, ...], first: int = 0) -> np.ndarray:
        """Structured array for the device, one row for each value of ``shape``; its outline begins at row ``first``."""
        rows = np.zeros(shape, row_dtype())
        turned = numbers("azimuth", self.azimuth)
        rows["cosine"], rows["sine"] = np.cos(turned), np.sin(turned)
        rows["width"], rows["depth"], rows["offset"] = self.width, self.depth, self.offset
        rows["sigma"] = self.coherence_radius
        rows["depth_spread"], rows["roughness"] = self.depth_spread, self.roughness
        rows["start"] = -np.inf if self.ends is None else self.ends[..., 0]
        rows["end"] = np.inf if self.ends is None else self.ends[..., 1]
        rows["first"], rows["count"] = first, len(self.facets)
        return rows.reshape(-1)


def row_dtype() -> Any:
    """Fields of a row of ``Scratch.to_rows``."""
    from .scratch_device import WaveScratch

    struct: Any = WaveScratch
    return struct.numpy_dtype()


def _ends(value: Any) -> np.ndarray:
    if isinstance(value, tuple | list):
        if len(value) != 2:
            raise ValueError(f"ends must be two positions, got {len(value)}: {value!r}")
        pair = np.stack(np.broadcast_arrays(*(np.asarray(end, np.float64) for end in value)), axis=-1)
    else:
        pair = np.asarray(value, np.float64)
        if pair.ndim < 1 or pair.shape[-1] != 2:
            raise ValueError(f"ends must be a pair or have shape [..., 2], got {list(pair.shape)}")
    if np.any(np.isnan(pair)):
        raise ValueError(f"ends must be positions, got {value}")
    return np.sort(pair, axis=-1)
