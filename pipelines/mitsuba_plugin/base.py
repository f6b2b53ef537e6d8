"""The surface between the scratches: Lambert under GGX under a coat, as scratchwarp has it (``base_device``)."""

import math
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np

from .tables import TINY, Values


class Base:
    """Lambert under GGX under a coat, as scratchwarp has it (``reflectance.base_device``)."""

    def __init__(self, data: dict[str, np.ndarray], window: np.ndarray) -> None:
        for name in ("fresnel", "ior", "specular", "clearcoat", "clearcoat_alpha", "clearcoat_f0"):
            setattr(self, name, float(data[name]))
        self.turn = Values(data["turn"], window)
        self.eta, self.k = (mi.Color3f(*map(float, data[name])) for name in ("eta", "k"))
        self.maps = {n: Values(data[n], window) for n in ("diffuse", "f0", "f90", "alpha")}
        self.smooth = bool(data["alpha"].max() < 1e-3)
        self.coat_smooth = self.clearcoat_alpha < 1e-3

    def color(self, name: str, uv: Any, active: Any) -> Any:
        """A colour of the maps."""
        return mi.Color3f(*self.maps[name].at(uv, active))

    def brightness(self, uv: Any, active: Any) -> Any:
        """Mean diffuse albedo."""
        return dr.mean(self.color("diffuse", uv, active))

    def way(self, uv: Any, active: Any) -> tuple[Any, Any]:
        """(cos, sin) of the angle that the frame of the anisotropy is turned by."""
        c, s = self.turn.at(uv, active)
        angle = 0.5 * dr.atan2(s, c)
        return dr.cos(angle), dr.sin(angle)

    def facet(self, f0: Any, f90: Any, cos: Any) -> Any:
        """Reflectance of a facet."""
        cos = dr.clip(cos, 0, 1)
        if self.fresnel == 1:
            result = _conductor(cos, self.eta, self.k)
        elif self.fresnel == 2:
            result = mi.Color3f(_dielectric(cos, self.ior))
        else:
            result = f0 + (f90 - f0) * (1 - cos) ** 5
        return self.specular * result

    def prepared(self, uv: Any, view: Any, w_diffuse: Any, w_specular: Any, active: Any) -> dict[str, Any]:
        """What depends on the view alone."""
        f0, f90 = self.color("f0", uv, active), self.color("f90", uv, active)
        ax, ay = (dr.maximum(a, 1e-4) for a in self.maps["alpha"].at(uv, active))
        diffuse, c = self.color("diffuse", uv, active), dr.clip(view.z, 0, 1)
        coat_shape = _shape(mi.Float(0 if self.coat_smooth else self.clearcoat_alpha), False)
        coat = self._coat(coat_shape, c)
        left, albedo = mi.Color3f(1), diffuse
        shape, specular = _shape(mi.Float(0), False), mi.Float(0)
        if self.specular > 0 and self.fresnel == 1:
            left = albedo = mi.Color3f(0)
            specular = dr.mean(self.facet(f0, f90, c))
        elif self.specular > 0:
            if self.fresnel == 2:
                r2 = 1.0 if self.ior < 1 else ((self.ior - 1) / (self.ior + 1)) ** 2
                f0, f90 = mi.Color3f(r2), mi.Color3f(1)
            shape = _shape(mi.Float(0) if self.smooth else dr.minimum(ax, ay), self.fresnel == 2)
            left = 1 - self.specular * (f0 + _bound(shape, c) * (f90 - f0))
            mean = 1 - self.specular * (f0 + _bound_mean(shape) * (f90 - f0))
            albedo = diffuse * left / dr.maximum(mean, 1e-4)
            specular = 1 - dr.mean(left) + (0 if self.smooth else 0.01 * self.specular * dr.mean(f90))
        parts = [
            w_diffuse * (1 - coat) * dr.mean(diffuse * left), w_specular * (1 - coat) * specular, w_specular * coat
        ]  # fmt: skip
        total = dr.maximum(parts[0] + parts[1] + parts[2], TINY)
        p = [part / total for part in parts]
        return {
            "f0": f0, "f90": f90, "ax": ax, "ay": ay, "albedo": albedo, "shape": shape, "coat": coat,
            "coat_shape": coat_shape, "p": p,
        }  # fmt: skip

    def _coat(self, shape: Any, cos: Any) -> Any:
        return self.clearcoat * (self.clearcoat_f0 + _bound(shape, cos) * (1 - self.clearcoat_f0))

    def terms(self, uv: Any, view: Any, light: Any, w_diffuse: Any, w_specular: Any, active: Any) -> tuple[Any, Any]:
        """(f cos, density) of the lobes that are no mirrors."""
        q = self.prepared(uv, view, w_diffuse, w_specular, active)
        c, s = self.way(uv, active)
        wo, wi = _turned(view, c, s), _turned(light, c, s)
        h = dr.normalize(wo + wi)
        ci, value, density, below = dr.clip(light.z, 0, 1), mi.Color3f(0), mi.Float(0), mi.Float(1)
        if self.clearcoat > 0:
            below = 1 - dr.maximum(q["coat"], self._coat(q["coat_shape"], ci))
            if not self.coat_smooth:
                a = mi.Float(max(self.clearcoat_alpha, 1e-4))
                f = self.clearcoat_f0 + (1 - self.clearcoat_f0) * (1 - dr.clip(dr.dot(wo, h), 0, 1)) ** 5
                value += mi.Color3f(w_specular * self.clearcoat * f * _ggx(wo, wi, h, a, a) * ci)
                density += q["p"][2] * _ggx_pdf(wo, h, a, a)
        if self.specular > 0 and not self.smooth:
            lobe = w_specular * below * _ggx(wo, wi, h, q["ax"], q["ay"]) * ci
            value += lobe * self.facet(q["f0"], q["f90"], dr.dot(wo, h))
            density += q["p"][1] * _ggx_pdf(wo, h, q["ax"], q["ay"])
        albedo = q["albedo"]
        if self.specular > 0:
            albedo = albedo * (1 - self.specular * (q["f0"] + _bound(q["shape"], ci) * (q["f90"] - q["f0"])))
        value += w_diffuse * below * ci / math.pi * albedo
        return value, density + q["p"][0] * ci / math.pi

    def sample(
        self, uv: Any, view: Any, u: Any, sample2: Any, w_diffuse: Any, w_specular: Any, p_matte: Any, active: Any
    ) -> tuple[Any, Any, Any, Any]:
        """(direction, whether by a mirror, and then its probability and weight)."""
        q = self.prepared(uv, view, w_diffuse, w_specular, active)
        p_diffuse = p_matte + (1 - p_matte) * q["p"][0]
        p_specular = (1 - p_matte) * q["p"][1]
        cos, sin = self.way(uv, active)
        wo = _turned(view, cos, sin)
        mirror = mi.Vector3f(-view.x, -view.y, view.z)
        lambert = mi.warp.square_to_cosine_hemisphere(sample2)
        a = mi.Float(max(self.clearcoat_alpha, 1e-4))
        below, c = 1 - q["coat"], dr.clip(view.z, 0, 1)
        shiny = mirror if self.smooth else _turned(_ggx_sample(wo, q["ax"], q["ay"], sample2), cos, -sin)
        coat = mirror if self.coat_smooth else _turned(_ggx_sample(wo, a, a, sample2), cos, -sin)
        is_diffuse, is_specular = u < p_diffuse, u < p_diffuse + p_specular
        w = dr.select(is_diffuse, lambert, dr.select(is_specular, shiny, coat))
        in_mirror = active & ~is_diffuse & dr.select(is_specular, mi.Bool(self.smooth), mi.Bool(self.coat_smooth))
        p = dr.maximum(dr.select(is_specular, p_specular, (1 - p_matte) * q["p"][2]), TINY)
        reflected = dr.select(
            is_specular,
            w_specular * below * self.facet(q["f0"], q["f90"], c),
            mi.Color3f(w_specular * q["coat"]),
        )
        return w, in_mirror, p, reflected / p


def _turned(w: Any, c: Any, s: Any) -> Any:
    """A direction in a frame turned by the angle of cos ``c`` and sin ``s``."""
    return mi.Vector3f(c * w.x + s * w.y, c * w.y - s * w.x, w.z)


def _shape(alpha: Any, dielectric: bool) -> tuple[Any, Any, Any]:
    c = 1 / (1 + 14 * alpha * alpha / (alpha + 0.035))
    p = 2.5 + 2.5 * dr.exp(-10 * alpha)
    d = dr.minimum(alpha / 3000, 1e-4)
    return (c, p - 1, d + 0.006) if dielectric else (c, p, d)


def _bound(shape: tuple[Any, Any, Any], cos: Any) -> Any:
    return dr.minimum(shape[0] * dr.power(1 - dr.clip(cos, 0, 1), shape[1]) + shape[2], 1)


def _bound_mean(shape: tuple[Any, Any, Any]) -> Any:
    return 2 * shape[0] / ((shape[1] + 1) * (shape[1] + 2)) + shape[2]


def _stretched(w: Any, ax: Any, ay: Any) -> Any:
    return dr.sqrt(w.z * w.z + dr.square(ax * w.x) + dr.square(ay * w.y))


def _ggx_d(h: Any, ax: Any, ay: Any) -> Any:
    e = dr.square(h.x / ax) + dr.square(h.y / ay) + h.z * h.z
    return dr.select(h.z > 0, 1 / (math.pi * ax * ay * dr.maximum(e * e, 1e-30)), 0)


def _ggx(wo: Any, wi: Any, h: Any, ax: Any, ay: Any) -> Any:
    so, si = _stretched(wo, ax, ay), _stretched(wi, ax, ay)
    return 0.5 * _ggx_d(h, ax, ay) / dr.maximum(so * wi.z + si * wo.z, 1e-30)


def _ggx_pdf(wo: Any, h: Any, ax: Any, ay: Any) -> Any:
    return 0.5 * _ggx_d(h, ax, ay) / dr.maximum(dr.maximum(wo.z, 0) + _stretched(wo, ax, ay), 1e-30)


def _ggx_sample(wo: Any, ax: Any, ay: Any, u: Any) -> Any:
    v = dr.normalize(mi.Vector3f(ax * wo.x, ay * wo.y, dr.maximum(wo.z, 0)))
    phi = 2 * math.pi * u.x
    z = (1 - u.y) * (1 + v.z) - v.z
    r = dr.sqrt(dr.maximum((1 - z) * (1 + z), 0))
    h = dr.normalize(
        mi.Vector3f(ax * (r * dr.cos(phi) + v.x), ay * (r * dr.sin(phi) + v.y), dr.maximum(z + v.z, 1e-12))
    )
    return dr.normalize(2 * dr.dot(wo, h) * h - wo)


def _conductor(cos: Any, eta: Any, k: Any) -> Any:
    c2 = cos * cos
    s2 = 1 - c2
    t = eta * eta - k * k - s2
    a2b2 = dr.sqrt(t * t + 4 * eta * eta * k * k)
    a = dr.sqrt(dr.maximum(0.5 * (a2b2 + t), 0))
    rs = (a2b2 - 2 * a * cos + c2) / (a2b2 + 2 * a * cos + c2)
    rp = rs * (c2 * a2b2 - 2 * a * cos * s2 + s2 * s2) / (c2 * a2b2 + 2 * a * cos * s2 + s2 * s2)
    return 0.5 * (rs + rp)


def _dielectric(cos: Any, ior: float) -> Any:
    g2 = ior * ior - 1 + cos * cos
    g = dr.sqrt(dr.maximum(g2, 0))
    a = dr.square((g - cos) / dr.maximum(g + cos, TINY))
    b = dr.square((cos * (g + cos) - 1) / dr.maximum(cos * (g - cos) + 1, TINY))
    return dr.select(g2 > 0, 0.5 * a * (1 + b), 1)
