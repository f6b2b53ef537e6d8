"""The BSDF and its registration."""

import math
from pathlib import Path
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from .base import Base
from .blend import Blend
from .tables import HALF_PI, TINY, Tables, Values

PLUGIN = "scratchwarp"


def register(folder: str | Path) -> None:
    """Make the plugin known to the variant that is set; paths in scenes are relative to ``folder``.

    ImportError unless the variant is an rgb one of LLVM or CUDA.
    """
    variant = mi.variant() or ""
    if not variant.startswith(("llvm", "cuda")) or "rgb" not in variant:
        raise ImportError(f"variant {variant!r} does not do; call mitsuba.set_variant('llvm_ad_rgb') first")

    class ScratchBSDF(mi.BSDF):
        """The plugin; what it does is in ``Model``."""

        def __init__(self, props: Any) -> None:
            mi.BSDF.__init__(self, props)
            self.model = loaded(Path(folder) / str(props["data"]))
            front, flags = mi.BSDFFlags.FrontSide, mi.BSDFFlags
            kinds = [flags.GlossyReflection, flags.DiffuseReflection, flags.DeltaReflection]
            self.m_components = [kind | front for kind in kinds]
            self.m_flags = kinds[0] | kinds[1] | kinds[2] | front

        def sample(self, ctx: Any, si: Any, sample1: Any, sample2: Any, active: Any = True) -> Any:
            """A direction, and f cos / pdf."""
            return self.model.sample(si, sample1, sample2, active)

        def eval(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
            """f cos of all that is no delta."""
            return self.model.eval_pdf(si, wo, active)[0]

        def pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
            """Density of ``sample`` there, of all that is no delta."""
            return self.model.eval_pdf(si, wo, active)[1]

        def eval_pdf(self, ctx: Any, si: Any, wo: Any, active: Any = True) -> Any:
            """Both."""
            return self.model.eval_pdf(si, wo, active)

        def to_string(self) -> str:
            """What it is."""
            return f"ScratchBSDF[{self.model}]"

    mi.register_bsdf(PLUGIN, ScratchBSDF)


def loaded(file: Path) -> Any:
    """The model in an archive: of simulated tables, or the nearest rough surface."""
    with np.load(file) as held:
        data = {name: held[name] for name in held.files}
    return Blend(data, file.parent) if "second" in data else Model(data, file.parent)


class Model:
    """One material: its base, its sets of scratches and their tables."""

    def __init__(self, data: dict[str, np.ndarray], folder: Path) -> None:
        self.tables = Tables(folder / str(data["tables"])) if len(data["table"]) else None
        window = data["window"]
        self.base = Base(data, window)
        self.table = [int(x) for x in data["table"]]
        self.weights = [float(x) for x in data["weight"]]
        self.keeps = [bool(x) for x in data["keeps"]]
        self.albedo = [mi.Color3f(*map(float, x)) for x in data["albedo"]]
        self.scale = [float(x) for x in np.abs(data["scale"])]
        self.blur = float(data["blur"])
        self.share = Values(data["share"], window)
        two = data["two"]
        self.two = Values(two.reshape(-1) if two.ndim == 2 else two.reshape(*two.shape[:2], -1), window)

    def gather(self, si: Any, active: Any) -> Any:
        """(base weights of diffuse and specular, shares, directions) at a point."""
        shares = self.share.at(si.uv, active) if self.table else []
        bare, kept = mi.Float(1), mi.Float(0)
        for share, keeps in zip(shares, self.keeps, strict=True):
            bare -= share
            kept += share if keeps else 0
        bare = dr.maximum(bare, 0)
        twos = self.two.at(si.uv, active) if self.table else []
        du, dv = si.dp_du, si.dp_dv
        handed = dr.mulsign(mi.Float(1), dr.dot(dr.cross(du, dv), si.n))
        flat = dr.normalize(du)
        across = dr.cross(si.n, flat)
        ways = []
        for c, s in zip(twos[::2], twos[1::2], strict=True):
            angle = 0.5 * dr.atan2(s, c)
            x, y = dr.cos(angle) / self.scale[0], dr.sin(angle) * handed / self.scale[1]
            mapped = du * x + dv * y
            along, aside = dr.dot(mapped, flat), dr.dot(mapped, across)
            length = dr.maximum(dr.sqrt(along * along + aside * aside), TINY)
            ways.append((along / length, aside / length))
        return bare, bare + kept, shares, ways

    def choice(self, bare: Any, diffuse: Any, shares: list[Any], view: Any, uv: Any, active: Any) -> tuple[Any, Any]:
        """(probability of the base and Lambert scratches, weight of every set that has a table)."""
        smooth = bare + diffuse * self.base.brightness(uv, active)
        cones = [mi.Float(0) for _ in shares]
        for k, share in enumerate(shares):
            if self.table[k] < 0:
                smooth += share * dr.mean(self.albedo[k])
            else:
                cones[k] = share * self.weights[k]
        total = smooth + sum(cones, mi.Float(0))
        return smooth / dr.maximum(total, TINY), cones

    def eval_pdf(self, si: Any, wo: Any, active: Any) -> tuple[Any, Any]:
        """(f cos, density) of all that is no delta."""
        view, light = si.wi, wo
        active = mi.Bool(active) & (view.z > 0) & (light.z > 0)
        bare, diffuse, shares, ways = self.gather(si, active)
        p_smooth, cones = self.choice(bare, diffuse, shares, view, si.uv, active)
        value, density = self.base.terms(si.uv, view, light, diffuse, bare, active)
        matte, p_matte = self._matte(shares, diffuse, bare, si.uv, active)
        value += matte * light.z / math.pi
        density = p_smooth * ((1 - p_matte) * density + p_matte * light.z / math.pi)
        if self.blur > 0:
            total = dr.maximum(sum(cones, mi.Float(0)), TINY)
            for k, way in enumerate(ways):
                if self.table[k] >= 0:
                    f, p = self._cone(k, way, view, light, active)
                    value += shares[k] * f * light.z
                    density += (1 - p_smooth) * cones[k] / total * p
        return value & active, dr.select(active, density, 0)

    def _matte(self, shares: list[Any], diffuse: Any, bare: Any, uv: Any, active: Any) -> tuple[Any, Any]:
        """(albedo of Lambert scratches times their share, their probability among what is smooth)."""
        matte = mi.Color3f(0)
        for k, share in enumerate(shares):
            if self.table[k] < 0:
                matte += share * self.albedo[k]
        own = dr.mean(matte)
        return matte, own / dr.maximum(own + bare + diffuse * self.base.brightness(uv, active), TINY)

    def _angles(self, way: Any, w: Any) -> tuple[Any, Any]:
        """(sin theta, phi) of a direction in the frame of a scratch."""
        u = w.x * way[0] + w.y * way[1]
        v = w.y * way[0] - w.x * way[1]
        return dr.clip(u, -1, 1), dr.atan2(v, dr.maximum(w.z, 0))

    def _cone(self, k: int, way: Any, view: Any, light: Any, active: Any) -> tuple[Any, Any]:
        """(f, density) of a set of blurred scratches."""
        (sin_o, phi_o), (sin_i, phi_i) = self._angles(way, view), self._angles(way, light)
        cos_o, cos_i = (dr.sqrt(dr.maximum(1 - s * s, 1e-8)) for s in (sin_o, sin_i))
        off = dr.asin(sin_o) + dr.asin(sin_i)
        normal = dr.exp(-0.5 * dr.square(off / self.blur)) / (self.blur * math.sqrt(2 * math.pi))
        at = self.tables.row(phi_o)
        low, column = dr.floor(at), self.tables.column(phi_i)
        f, p = mi.Color3f(0), mi.Float(0)
        for step in (0, 1):
            part = at - low if step else 1 - (at - low)
            row = dr.clip(mi.Int32(low) + step, 0, self.tables.bins - 1)
            table = mi.Int32(self.table[k])
            f += part * self.tables.value(table, row, column, sin_o, active)
            p += part * self.tables.pdf(table, row, phi_i, active)
        return f * normal / (cos_i * cos_o), p * normal / cos_i

    def sample(self, si: Any, sample1: Any, sample2: Any, active: Any) -> tuple[Any, Any]:
        """(BSDFSample3f, f cos / pdf)."""
        view = si.wi
        active = mi.Bool(active) & (view.z > 0)
        bare, diffuse, shares, ways = self.gather(si, active)
        p_smooth, cones = self.choice(bare, diffuse, shares, view, si.uv, active)
        smooth = sample1 < p_smooth
        u = dr.select(smooth, sample1 / dr.maximum(p_smooth, TINY), (sample1 - p_smooth) / (1 - p_smooth + TINY))
        u = dr.clip(u, 0, 0.9999999)
        _, p_matte = self._matte(shares, diffuse, bare, si.uv, active)
        wo, delta, p_delta, w_delta = self.base.sample(si.uv, view, u, sample2, diffuse, bare, p_matte, active & smooth)
        bs = mi.BSDFSample3f()
        bs.eta = mi.Float(1)
        bs.wo = wo
        kind = dr.select(delta, mi.UInt32(+mi.BSDFFlags.DeltaReflection), mi.UInt32(+mi.BSDFFlags.GlossyReflection))
        pdf, weight = p_smooth * p_delta, w_delta / dr.maximum(p_smooth, TINY)
        if self.tables is not None:
            picked = active & ~smooth
            index, part, table, way = self._pick(u, cones, shares, ways)
            sin_o, phi_o = self._angles(way, view)
            at = self.tables.row(phi_o)
            low = dr.floor(at)
            # which of the two rows: the rest of the random number that picked the set
            row = dr.clip(mi.Int32(low) + dr.select(index < at - low, 1, 0), 0, self.tables.bins - 1)
            phi, density, column = self.tables.sample(table, row, sample2.x, picked)
            rho = self.tables.value(table, row, column, sin_o, picked)
            theta = -dr.asin(sin_o)
            if self.blur > 0:
                other = dr.sqrt(2.0) * dr.erfinv(dr.clip(2 * sample2.y - 1, -0.999999, 0.999999))
                theta = dr.clip(theta + self.blur * other, -HALF_PI, HALF_PI)
            cone = mi.Vector3f(
                dr.sin(theta) * way[0] - dr.cos(theta) * dr.sin(phi) * way[1],
                dr.sin(theta) * way[1] + dr.cos(theta) * dr.sin(phi) * way[0],
                dr.cos(theta) * dr.cos(phi),
            )
            bs.wo = dr.select(picked, cone, bs.wo)
            pdf = dr.select(picked, (1 - p_smooth) * part[0] * density, pdf)
            if self.blur <= 0:
                share = part[1] / dr.maximum((1 - p_smooth) * part[0], TINY)
                weight = dr.select(picked, share * rho * dr.cos(phi) / dr.maximum(density, TINY), weight)
                delta = delta | picked
                kind = dr.select(picked, mi.UInt32(+mi.BSDFFlags.DeltaReflection), kind)
        active = active & (bs.wo.z > 0)
        value, density = self.eval_pdf(si, bs.wo, active & ~delta)
        bs.pdf = dr.select(delta, pdf, density)
        bs.sampled_type = kind
        bs.sampled_component = dr.select(delta, mi.UInt32(2), mi.UInt32(0))
        weight = dr.select(delta, weight, value / dr.maximum(density, TINY))
        active = active & (bs.pdf > 0)
        bs.pdf = dr.select(active, bs.pdf, 0)
        return bs, weight & active

    def _pick(self, u: Any, cones: list[Any], shares: list[Any], ways: list[Any]) -> Any:
        """(random number left over, (probability, share), table, direction) of a set drawn in proportion."""
        total = dr.maximum(sum(cones, mi.Float(0)), TINY)
        left, found = u * total, mi.Bool(False)
        rest, part, share, table = mi.Float(0), mi.Float(1), mi.Float(0), mi.Int32(0)
        cos, sin = mi.Float(1), mi.Float(0)
        for k, own in enumerate(cones):
            if self.table[k] < 0:
                continue
            here = ~found & (left < own)
            rest = dr.select(here, left / dr.maximum(own, TINY), rest)
            part, share = dr.select(here, own / total, part), dr.select(here, shares[k], share)
            table = dr.select(here, mi.Int32(self.table[k]), table)
            cos, sin = dr.select(here, ways[k][0], cos), dr.select(here, ways[k][1], sin)
            left, found = left - own, found | here
        return rest, (part, share), table, (cos, sin)
