"""A mixture of two rough surfaces by a map: what a MaterialX look of scratches is."""

from pathlib import Path
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from .base import Base
from .tables import TINY, Values


class Blend:
    """The base, and over a share of it a surface that stands for the scratches."""

    def __init__(self, data: dict[str, np.ndarray], folder: Path) -> None:
        with np.load(folder / str(data["second"])) as held:
            over = {name: held[name] for name in held.files}
        self.parts = [Base(data, data["window"]), Base(over, data["window"])]
        self.coverage = Values(data["coverage"], data["window"])

    def eval_pdf(self, si: Any, wo: Any, active: Any) -> tuple[Any, Any]:
        """(f cos, density) of all that is no mirror."""
        active = mi.Bool(active) & (si.wi.z > 0) & (wo.z > 0)
        cover = self.coverage.at(si.uv, active)[0]
        one = mi.Float(1)
        under, over = (part.terms(si.uv, si.wi, wo, one, one, active) for part in self.parts)
        value = (1 - cover) * under[0] + cover * over[0]
        return value & active, dr.select(active, (1 - cover) * under[1] + cover * over[1], 0)

    def sample(self, si: Any, sample1: Any, sample2: Any, active: Any) -> tuple[Any, Any]:
        """(BSDFSample3f, f cos / pdf)."""
        active = mi.Bool(active) & (si.wi.z > 0)
        cover = self.coverage.at(si.uv, active)[0]
        above, one, none = sample1 < cover, mi.Float(1), mi.Float(0)
        own = dr.select(above, cover, 1 - cover)
        u = dr.select(above, sample1 / dr.maximum(cover, TINY), (sample1 - cover) / dr.maximum(1 - cover, TINY))
        u = dr.clip(u, 0, 0.9999999)
        made = [part.sample(si.uv, si.wi, u, sample2, one, one, none, active) for part in self.parts]
        wo, delta, p, weight = (dr.select(above, b, a) for a, b in zip(*made, strict=True))
        active = active & (wo.z > 0)
        value, density = self.eval_pdf(si, wo, active & ~delta)
        bs = mi.BSDFSample3f()
        bs.wo, bs.eta = wo, mi.Float(1)
        bs.pdf = dr.select(active, dr.select(delta, own * p, density), 0)
        flags = mi.BSDFFlags
        bs.sampled_type = dr.select(delta, mi.UInt32(+flags.DeltaReflection), mi.UInt32(+flags.GlossyReflection))
        bs.sampled_component = dr.select(delta, mi.UInt32(2), mi.UInt32(0))
        weight = dr.select(delta, weight, value / dr.maximum(density, TINY))
        return bs, weight & (active & (bs.pdf > 0))
