"""Pictures over the uv square, and profile tables, in Dr.Jit arrays."""

import math
from pathlib import Path
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

HALF_PI = 0.5 * math.pi
TINY = 1e-20


class Values:
    """Channels that are constant, or a picture over the window of the uv square."""

    def __init__(self, values: np.ndarray, window: np.ndarray) -> None:
        self.window, self.constant, self.picture = [float(x) for x in window], None, None
        if values.ndim <= 1:
            self.constant = [float(x) for x in np.atleast_1d(values)]
        else:
            whole = self.window == [0.0, 0.0, 1.0, 1.0]
            wrap = dr.WrapMode.Repeat if whole else dr.WrapMode.Clamp
            texels = np.ascontiguousarray(values if values.ndim == 3 else values[..., None], np.float32)
            self.picture = mi.Texture2f(mi.TensorXf(texels), wrap_mode=wrap)

    def at(self, uv: Any, active: Any) -> list[Any]:
        """The channels at ``uv``."""
        if self.constant is not None:
            return [mi.Float(x) for x in self.constant]
        u0, v0, u1, v1 = self.window
        place = mi.Point2f((uv.x - u0) / (u1 - u0), (v1 - uv.y) / (v1 - v0))
        return list(self.picture.eval(place, active))


class Tables:
    """Profile tables, M bins of phi each, as scratchwarp's renderer packs them."""

    def __init__(self, file: Path) -> None:
        with np.load(file) as held:
            self.bins = int(held["mirror"].shape[1])
            self.rows = int(held["slices"].shape[1])
            self.mirror = mi.Float(held["mirror"].ravel())
            self.cdf = mi.Float(held["cdf"].ravel())
            self.slices = mi.Float(held["slices"].ravel())
            self.first = mi.Int32(held["first"].astype(np.int32))
            self.steps = mi.Int32(held["steps"].astype(np.int32))
            self.shift = mi.Float(held["shift"])
            self.powers = bool(((held["first"] >= 0) & (held["steps"] == 0)).any())

    def slice(self, row: Any, index: Any, column: Any, active: Any) -> Any:
        """One of the slices: rgb."""
        at = (row * self.rows + index) * self.bins + column
        return dr.gather(mi.Color3f, self.slices, mi.UInt32(dr.maximum(at, 0)), active)

    def value(self, table: Any, row: Any, column: Any, sin_theta: Any, active: Any) -> Any:
        """rho_s [1/rad]."""
        first = dr.gather(mi.Int32, self.first, mi.UInt32(table), active)
        steps = dr.gather(mi.Int32, self.steps, mi.UInt32(table), active)
        shift = dr.gather(mi.Float, self.shift, mi.UInt32(table), active)
        cell = (table * self.bins + row) * self.bins + column
        value = mi.Color3f(dr.gather(mi.Float, self.mirror, mi.UInt32(cell), active))
        mu = dr.sqrt(dr.maximum(1 - dr.square(sin_theta), 0))
        parabolas = active & (first >= 0) & (steps > 0)
        at = mu * (1 + shift) / dr.maximum(mu + shift, TINY) * mi.Float(steps)
        middle = dr.clip(mi.Int32(at + 0.5), 1, dr.maximum(steps - 1, 1))
        d = at - mi.Float(middle)
        found = 0.5 * d * (d - 1) * self.slice(row, first + middle - 1, column, parabolas)
        found += (1 - d * d) * self.slice(row, first + middle, column, parabolas)
        found += 0.5 * d * (d + 1) * self.slice(row, first + middle + 1, column, parabolas)
        value = dr.select(parabolas, dr.maximum(found, 0), value)
        if self.powers:
            power = active & (first >= 0) & (steps == 0)
            r = dr.asin(dr.clip(dr.abs(sin_theta), 0, 1)) * (2 / math.pi)
            normal = self.slice(row, first + 1, column, power)
            mirror, gamma = self.slice(row, first, column, power), self.slice(row, first + 2, column, power)
            value = dr.select(power, normal + dr.power(mi.Color3f(r), gamma) * (mirror - normal), value)
        return value

    def weight(self, column: Any) -> Any:
        """Integral of the cosine over a bin."""
        width = math.pi / self.bins
        return 2 * math.sin(0.5 * width) * dr.cos((mi.Float(column) + 0.5) * width - HALF_PI)

    def edge(self, table: Any, row: Any, column: Any, active: Any) -> Any:
        """The distribution over phi_i at the left edge of a bin."""
        at = (table * self.bins + row) * (self.bins + 1) + column
        return dr.gather(mi.Float, self.cdf, mi.UInt32(at), active)

    def column(self, phi: Any) -> Any:
        """The bin that holds ``phi``."""
        return dr.clip(mi.Int32(dr.floor((phi / math.pi + 0.5) * self.bins)), 0, self.bins - 1)

    def row(self, phi: Any) -> Any:
        """The place of ``phi`` among the rows, 0 in the middle of the first."""
        return (phi / math.pi + 0.5) * self.bins - 0.5

    def pdf(self, table: Any, row: Any, phi: Any, active: Any) -> Any:
        """Density of ``sample`` [1/rad]."""
        i = self.column(phi)
        share = self.edge(table, row, i + 1, active) - self.edge(table, row, i, active)
        return share * dr.maximum(dr.cos(phi), 0) / self.weight(i)

    def sample(self, table: Any, row: Any, u: Any, active: Any) -> tuple[Any, Any, Any]:
        """(phi_i, its density [1/rad], its bin)."""
        found = dr.binary_search(0, self.bins, lambda i: self.edge(table, row, mi.Int32(i), active) <= u)
        low = dr.clip(mi.Int32(found) - 1, 0, self.bins - 1)
        c0 = self.edge(table, row, low, active)
        share = self.edge(table, row, low + 1, active) - c0
        t = dr.clip((u - c0) / dr.maximum(share, TINY), 0, 1)
        width = math.pi / self.bins
        left = mi.Float(low) * width - HALF_PI
        s0, s1 = dr.sin(left), dr.sin(left + width)
        phi = dr.clip(dr.asin(dr.clip(s0 + t * (s1 - s0), -1, 1)), left, left + width)
        return phi, share * dr.maximum(dr.cos(phi), 1e-7) / self.weight(low), low
