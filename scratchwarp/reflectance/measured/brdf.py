"""A measured BRDF in memory, whatever file it came from."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import warp as wp
from numpy.typing import ArrayLike

from ..stencils.angles import PHIS, SIZE, grid_directions
from ..vectors import directions, to_device
from .grid_device import GridBrdf, grid_eval
from .measured_kernels import evaluation_kernel
from .merl_device import MerlBrdf, merl_eval
from .rgl_device import RglBrdf, rgl_eval

FORMATS = ("utia", "merl", "rgl")


@dataclass(frozen=True, eq=False)
class Brdf:
    """A measurement. ``format`` "utia", "merl" or "rgl"; ``tables`` what its file holds, by name; ``path`` the file.

    ``np.asarray(brdf)`` is float64 [288, 288, 3] (illumination 48 it + ip, view 48 it + ip, rgb; theta = 15 it, phi =
    7.5 ip degrees): the very values of a UTIA file, resampled from the others.
    """

    format: str
    tables: dict[str, np.ndarray]
    path: str = ""

    def __post_init__(self) -> None:
        if self.format not in FORMATS:
            raise ValueError(f"brdf: format must be one of {', '.join(FORMATS)}, got {self.format!r}")

    @classmethod
    def from_values(cls, values: ArrayLike) -> "Brdf":
        """A BRDF of values [288, 288, 3] on the UTIA grid, finite [1/sr]."""
        return cls("utia", {"values": grid_values("values", values)})

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        values = self.values
        return np.array(values, dtype) if copy or (dtype is not None and values.dtype != dtype) else values

    @cached_property
    def values(self) -> np.ndarray:
        """Float64 [288, 288, 3] on the UTIA grid, read-only."""
        if self.format == "utia":
            return self.tables["values"]
        w = grid_directions()
        values = self.evaluate(w[:, None], w[None]).astype(np.float64)
        values.setflags(write=False)
        return values

    def evaluate(self, omega_i: ArrayLike, omega_o: ArrayLike, reciprocal: bool = False) -> np.ndarray:
        """f_r [1/sr], float32 ``[..., 3]``, for unit directions ``[..., 3]`` that broadcast; 0 below the horizon.

        Interpolated linearly without seams and not negative; held towards grazing where nothing was measured.
        ``reciprocal``: the mean of both ways of the light. Raises ValueError on directions that are not unit.
        """
        arrays = [directions("omega_i", omega_i), directions("omega_o", omega_o)]
        lead, inputs = to_device(arrays, [wp.vec3, wp.vec3])
        kind, struct, function = self._device
        out = wp.zeros(len(inputs[0]), dtype=wp.vec3, device="cpu")
        kernel = evaluation_kernel(kind, function)
        wp.launch(kernel, len(out), inputs=[struct, *inputs, int(reciprocal)], outputs=[out], device="cpu")
        return out.numpy().reshape(*lead, 3)

    def device_record(self) -> Any:
        """The struct that the device reads: ``GridBrdf``, ``MerlBrdf`` or ``RglBrdf``, on the CPU."""
        return self._device[1]

    @cached_property
    def _device(self) -> tuple[Any, Any, Any]:
        return _PACKERS[self.format](self.tables)


def grid_values(name: str, values: Any) -> np.ndarray:
    """``values`` as read-only float64 [288, 288, 3], finite."""
    array = np.array(values, np.float64)
    if array.shape != (SIZE, SIZE, 3):
        raise ValueError(f"{name} must have shape [288, 288, 3], got {list(array.shape)}")
    if not np.all(np.isfinite(array)):
        raise ValueError(f"{name} must be finite, got {array[~np.isfinite(array)][0]}")
    array.setflags(write=False)
    return array


def _grid(tables: dict[str, np.ndarray]) -> tuple[Any, Any, Any]:
    table = np.maximum(tables["values"], 0.0)
    table[:PHIS] = table[:PHIS].mean(axis=0)
    table[:, :PHIS] = table[:, :PHIS].mean(axis=1, keepdims=True)
    brdf = GridBrdf()
    brdf.values = wp.array(table.astype(np.float32), dtype=wp.vec3, device="cpu")
    return GridBrdf, brdf, grid_eval


def _merl(tables: dict[str, np.ndarray]) -> tuple[Any, Any, Any]:
    brdf = MerlBrdf()
    table = np.moveaxis(np.maximum(tables["values"], 0.0), 0, -1)
    brdf.values = wp.array(np.ascontiguousarray(table, np.float32), dtype=wp.vec3, device="cpu")
    return MerlBrdf, brdf, merl_eval


def _rgl(tables: dict[str, np.ndarray]) -> tuple[Any, Any, Any]:
    brdf = RglBrdf()
    phi, theta = tables["phi_i"], tables["theta_i"]
    vndf = np.asarray(tables["vndf"], np.float64).reshape(-1, *tables["vndf"].shape[2:])
    along = np.cumsum(0.5 * (vndf[..., :-1] + vndf[..., 1:]), axis=-1)
    conditional = np.concatenate([np.zeros_like(along[..., :1]), along], axis=-1)
    rows = conditional[..., -1]
    down = np.cumsum(0.5 * (rows[:, :-1] + rows[:, 1:]), axis=-1)
    marginal = np.concatenate([np.zeros_like(down[:, :1]), down], axis=-1)
    total = np.maximum(marginal[:, -1], 1e-300)
    for name, table in (("vndf", vndf), ("conditional", conditional)):
        setattr(brdf, name, wp.array((table / total[:, None, None]).astype(np.float32), device="cpu"))
    brdf.marginal = wp.array((marginal / total[:, None]).astype(np.float32), device="cpu")
    for name, table in (("phi", phi), ("theta", theta), ("ndf", tables["ndf"]), ("sigma", tables["sigma"])):
        setattr(brdf, name, wp.array(np.ascontiguousarray(table, np.float32), device="cpu"))
    rgb = np.moveaxis(tables["rgb"].reshape(-1, *tables["rgb"].shape[2:]), 1, -1)
    brdf.rgb = wp.array(np.ascontiguousarray(rgb, np.float32), dtype=wp.vec3, device="cpu")
    brdf.isotropic = int(len(phi) <= 2)
    brdf.turn = 1 if brdf.isotropic else int(np.rint(2.0 * np.pi / (phi[-1] - phi[0])))
    return RglBrdf, brdf, rgl_eval


_PACKERS = {"utia": _grid, "merl": _merl, "rgl": _rgl}
