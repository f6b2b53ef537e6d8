"""The base reflectance from Python: records that check themselves, and NumPy entry points to the device functions.

``BaseSurface`` holds the lobes directly, ``preview_base`` makes one from UsdPreviewSurface inputs. ``evaluate_base``,
``base_density`` and ``sample_base`` are vectorised over leading dimensions. The model is described in ``base_device``.
"""

from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np
import warp as wp

from . import base_arrays_device as device
from .base_device import Base
from .vectors import directions, to_device, uniforms

FRESNELS = ("schlick", "conductor", "dielectric")


def _range(name: str, value: Any, low: float, high: float, shapes: tuple[tuple[int, ...], ...]) -> np.ndarray:
    a = np.asarray(value, np.float64)
    if a.shape not in shapes or not np.all(np.isfinite(a)) or np.any(a < low) or np.any(a > high):
        kind = "one number" if shapes == ((),) else "a number or three"
        raise ValueError(f"{name} must be {kind} in [{low:g}, {high:g}], got {value}")
    return a


@dataclass(frozen=True)
class BaseSurface:
    """Lambert under GGX under a coat; colours linear Rec.709, a number or three; alphas the GGX widths, below 1e-3 a
    mirror.

    ``fresnel``: "schlick" (``f0`` to ``f90``), "conductor" (``eta``, ``k``; leaves nothing to the diffuse lobe) or
    "dielectric" (``ior``). ``alpha_y`` None means ``alpha_x``. ``specular`` 0 leaves Lambert alone. Raises ValueError
    naming the field.
    """

    diffuse: Any = 0.0
    f0: Any = 0.04
    f90: Any = 1.0
    eta: Any = 1.0
    k: Any = 0.0
    fresnel: str = "schlick"
    ior: float = 1.5
    alpha_x: float = 0.25
    alpha_y: float | None = None
    specular: float = 1.0
    clearcoat: float = 0.0
    clearcoat_alpha: float = 1e-4
    clearcoat_f0: float = 0.04

    def __post_init__(self) -> None:
        if self.fresnel not in FRESNELS:
            raise ValueError(f"fresnel must be one of {FRESNELS}, got {self.fresnel!r}")
        if self.alpha_y is None:
            object.__setattr__(self, "alpha_y", self.alpha_x)
        for name in ("diffuse", "f0", "f90", "eta", "k"):
            high = 1.0 if name in ("diffuse", "f0", "f90") else np.inf
            a = _range(name, getattr(self, name), 0.0, high, ((), (3,)))
            object.__setattr__(self, name, tuple(float(v) for v in np.broadcast_to(a, 3)))
        for name in ("ior", "alpha_x", "alpha_y", "specular", "clearcoat", "clearcoat_alpha", "clearcoat_f0"):
            high = np.inf if name == "ior" else 1.0
            object.__setattr__(self, name, float(_range(name, getattr(self, name), 0.0, high, ((),))))
        if any(low > high for low, high in zip(self.f0, self.f90, strict=True)):
            raise ValueError(f"f0 must not exceed f90 = {self.f90}, got {self.f0}")

    def to_device(self) -> Any:
        """The device struct ``base_device.Base``."""
        b = Base()
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name == "fresnel":
                value = FRESNELS.index(value)
            setattr(b, field.name, wp.vec3(*value) if isinstance(value, tuple) else value)
        return b


class BaseSamples(NamedTuple):
    """Directions, f_r cos(theta_i) / pdf (both [..., 3]), pdf ([1/sr]; a probability where delta), delta ([...])."""

    omega_i: np.ndarray
    weight: np.ndarray
    pdf: np.ndarray
    delta: np.ndarray


def preview_base(
    diffuse: Any = 0.18,
    metallic: float = 0.0,
    specular_workflow: bool = False,
    specular_color: Any = 0.0,
    roughness: float = 0.5,
    ior: float = 1.5,
    clearcoat: float = 0.0,
    clearcoat_roughness: float = 0.01,
) -> BaseSurface:
    """The lobes of a UsdPreviewSurface with these inputs; defaults are those of its specification."""
    named = {"diffuse": diffuse, "specular_color": specular_color}
    colours = [_range(name, value, 0.0, 1.0, ((), (3,))) for name, value in named.items()]
    numbers = {"metallic": metallic, "roughness": roughness, "clearcoat": clearcoat}
    numbers["clearcoat_roughness"] = clearcoat_roughness
    for name, value in numbers.items():
        _range(name, value, 0.0, 1.0, ((),))
    _range("ior", ior, 0.0, np.inf, ((),))
    diffuse3, specular3 = (wp.vec3(*np.broadcast_to(c, 3)) for c in colours)
    out = wp.zeros(1, dtype=Base, device="cpu")
    wp.launch(
        device.preview,
        1,
        inputs=[diffuse3, metallic, int(specular_workflow), specular3, roughness, ior, clearcoat, clearcoat_roughness],
        outputs=[out],
        device="cpu",
    )
    row = out.numpy()[0]
    values = {field.name: row[field.name] for field in fields(BaseSurface)}
    values["fresnel"] = FRESNELS[int(values["fresnel"])]
    for name in ("f0", "f90", "diffuse"):
        values[name] = np.clip(values[name], 0.0, 1.0)
    values["f0"] = np.minimum(values["f0"], values["f90"])
    return BaseSurface(**values)


def _evaluate(surface: BaseSurface, omega_i: Any, omega_o: Any, weights: tuple[float, float]) -> list[np.ndarray]:
    shape, arrays = to_device([directions("omega_i", omega_i), directions("omega_o", omega_o)], [wp.vec3, wp.vec3])
    count = len(arrays[0])
    value, pdf = wp.zeros(count, dtype=wp.vec3, device="cpu"), wp.zeros(count, dtype=float, device="cpu")
    base: Any = wp.array([surface.to_device()], dtype=Base, device="cpu")
    wp.launch(device.evaluate, count, inputs=[base, *arrays, *weights], outputs=[value, pdf], device="cpu")
    return [value.numpy().reshape(*shape, 3), pdf.numpy().reshape(shape)]


def evaluate_base(
    surface: BaseSurface, omega_i: Any, omega_o: Any, w_diffuse: float = 1.0, w_specular: float = 1.0
) -> np.ndarray:
    """f_r cos(theta_i) [1/sr] of all lobes that are not mirrors, float32 ``[..., 3]``; 0 below the horizon.

    Directions broadcast, unit in the frame n = +z with x along ``alpha_x``. ``w_diffuse`` and ``w_specular`` scale the
    diffuse lobe and the specular ones. Raises ValueError on directions that are not unit within 1e-3.
    """
    return _evaluate(surface, omega_i, omega_o, (w_diffuse, w_specular))[0]


def base_density(
    surface: BaseSurface, omega_i: Any, omega_o: Any, w_diffuse: float = 1.0, w_specular: float = 1.0
) -> np.ndarray:
    """Density [1/sr] with which ``sample_base`` finds ``omega_i`` by a lobe that is not a mirror, float32 ``[...]``."""
    return _evaluate(surface, omega_i, omega_o, (w_diffuse, w_specular))[1]


def sample_base(
    surface: BaseSurface, omega_o: Any, u: Any, w_diffuse: float = 1.0, w_specular: float = 1.0
) -> BaseSamples:
    """Sample directions in proportion to the lobes; ``u [..., 3]`` in [0, 1), the last number chooses the lobe.

    ``omega_o`` and ``u`` broadcast. The mean of ``weight`` times the incident radiance is the reflected radiance.
    """
    shape, arrays = to_device([directions("omega_o", omega_o), uniforms("u", u, 3)], [wp.vec3, wp.vec3])
    count = len(arrays[0])
    wi, weight = (wp.zeros(count, dtype=wp.vec3, device="cpu") for _ in range(2))
    pdf, delta = wp.zeros(count, dtype=float, device="cpu"), wp.zeros(count, dtype=int, device="cpu")
    base: Any = wp.array([surface.to_device()], dtype=Base, device="cpu")
    outputs = [wi, weight, pdf, delta]
    wp.launch(device.sample, count, inputs=[base, *arrays, w_diffuse, w_specular], outputs=outputs, device="cpu")
    tail = ((3,), (3,), (), ())
    result = [o.numpy().reshape(*shape, *t) for o, t in zip(outputs, tail, strict=True)]
    return BaseSamples(result[0], result[1], result[2], result[3].astype(bool))
