"""Light along the whole mirror cone of a scratch at once, in closed form (Raymond 2016 section 5 samples it).

A scratch reflects L = int rho(phi) cos(phi) L_i(phi) dphi. Over the arcs in which the cone meets a light of one
radiance that is the light's radiance times running sums of the table: nothing is sampled. Where something may stand
between, one direction is drawn within the arcs in proportion to the luminance of rho cos(phi), and what it brings
counts for all: luminance of value over density is the same for every direction, so noise comes from shadow edges, and
from colours of rho that differ along the cone. Images and shaped lights are looked up in ``LightSet.taps`` strata of
equal share of the sums, each tap at random in its stratum, and the shadow ray follows one tap in proportion to its
luminance. All of that is without bias but for one thing: an image around everything is averaged over the distance
between taps, those of all of a pixel's samples together, so that the blur goes to nothing as samples are added.

Both rows of the table next to the view count, in the proportion of linear interpolation.
"""

from typing import Any

import warp as wp

from ..lights.arcs_device import MOST_ARCS, Arcs, above_facet
from ..lights.light_device import Light
from ..reflectance.cone_sums_device import ConeRows, cone_integral, cone_rows, place, value_in
from ..reflectance.profile_table_device import TableArrays, cone_direction, phi_bin
from ..scene.settings import MOST_CONE_TAPS
from .geometry_device import Geometry
from .key import KernelKey
from .lobe_device import Lobe, largest, luminance
from .material_device import MaterialArrays
from .world_device import LightSet

wp.set_module_options({"enable_backward": False})

MOST_PIECES = 2 * MOST_ARCS
vec_pieces: Any = wp.types.vector(length=MOST_PIECES, dtype=wp.float32)
vec_taps: Any = wp.types.vector(length=MOST_CONE_TAPS, dtype=wp.float32)


@wp.struct
class Pieces:
    """Integrals over every arc by the lower row, then by the upper one: their sum, and the luminance of each."""

    total: wp.vec4
    each: vec_pieces


@wp.struct
class ConePoint:
    """A direction on the cone, with the row that it was drawn from and that row's share."""

    phi: float
    row: int
    share: float


@wp.struct
class Tap:
    """Direction towards a light, its distance [m], and what the stratum around it reflects."""

    toward: wp.vec3
    distance: float
    color: wp.vec3


@wp.func
def pieces_of(tables: TableArrays, rows: ConeRows, arcs: Arcs) -> Pieces:
    """What all arcs reflect of a light of radiance 1."""
    r = Pieces()
    for k in range(arcs.count):
        low = (1.0 - rows.part) * cone_integral(tables, rows, rows.low, arcs.lo[k], arcs.hi[k])
        high = rows.part * cone_integral(tables, rows, rows.high, arcs.lo[k], arcs.hi[k])
        r.each[k] = low[3]
        r.each[arcs.count + k] = high[3]
        r.total += low + high
    return r


@wp.func
def locate(tables: TableArrays, rows: ConeRows, arcs: Arcs, pieces: Pieces, wanted: float) -> ConePoint:
    """The direction before which ``wanted`` of the luminance of all pieces lies."""
    left = float(wanted)
    k = int(0)
    last = 2 * arcs.count - 1
    while k < last and left >= pieces.each[k]:
        left = left - pieces.each[k]
        k = k + 1
    r = ConePoint()
    arc = k
    r.row = rows.low
    r.share = 1.0 - rows.part
    if k >= arcs.count:
        arc = k - arcs.count
        r.row = rows.high
        r.share = rows.part
    r.phi = place(tables, rows, r.row, arcs.lo[arc], arcs.hi[arc], left / wp.max(r.share, 1.0e-20))
    return r


def make_cone_lights(key: KernelKey, models: Any, arrives: Any) -> list[Any]:
    """For each kind of light the device function of its light along a cone; None for one that is sampled there."""
    return [_make(key, model, arrives) if key.closed_form and model.arcs is not None else None for model in models]


def _make(key: KernelKey, model: Any, arrives: Any) -> Any:
    arcs_of, lit = model.arcs, model.lit

    @wp.func
    def tap_at(
        tables: TableArrays,
        rows: ConeRows,
        arcs: Arcs,
        pieces: Pieces,
        lights: LightSet,
        light: Light,
        p: wp.vec3,
        lobe: Lobe,
        wanted: float,
        step: float,
    ) -> Tap:
        """The tap before which ``wanted`` of the luminance of all pieces lies, ``step`` from its neighbours."""
        r = Tap()
        f = lobe.frame
        at = locate(tables, rows, arcs, pieces, wanted)
        rho = value_in(tables, rows, at.row, phi_bin(tables, at.phi))
        r.toward = cone_direction(f.x, f.y, f.n, lobe.sin_theta, at.phi)
        along = lights.tap_width * step * wp.sqrt(wp.max(1.0 - lobe.sin_theta * lobe.sin_theta, 0.0))
        width = along / wp.max(rho[3] * wp.cos(at.phi) * at.share, 1.0e-6 * step)
        hit = lit(lights.arrays, light, p, r.toward, width)
        rho = rho * (step / wp.max(rho[3], 1.0e-20))
        r.color = wp.cw_mul(wp.vec3(rho[0], rho[1], rho[2]), hit.radiance)
        r.distance = hit.distance
        return r

    @wp.func
    def from_cone(
        g: Geometry,
        arrays: MaterialArrays,
        tables: TableArrays,
        lights: LightSet,
        light: Light,
        p: wp.vec3,
        ng: wp.vec3,
        lobe: Lobe,
        u: wp.vec2,
    ) -> wp.vec4:
        """What the scratch reflects of one light, and in w the rays it took."""
        value = wp.vec3(0.0, 0.0, 0.0)
        rays = float(0.0)
        f = lobe.frame
        ends = above_facet(ng, f.x, f.y, f.n, lobe.sin_theta)
        arcs = arcs_of(light, p, f.x, f.y, f.n, lobe.sin_theta, ends[0], ends[1])
        pieces = Pieces()
        rows = ConeRows()
        if arcs.count > 0:
            phi_o = wp.atan2(lobe.wo[1], wp.max(lobe.wo[2], 0.0))
            rows = cone_rows(tables, lobe.table, phi_o, lobe.sin_theta)
            pieces = pieces_of(tables, rows, arcs)
        whole = pieces.total[3]
        if whole > 0.0:
            w = wp.vec3(0.0, 0.0, 1.0)
            far = float(0.0)
            even = int(1)
            if wp.static(key.cone_taps):
                if light.shaped == 1 or light.texture >= 0:
                    even = 0
                    bright = vec_taps()
                    weight = float(0.0)
                    step = whole / float(lights.taps)
                    for k in range(lights.taps):
                        tap = tap_at(tables, rows, arcs, pieces, lights, light, p, lobe, (float(k) + u[1]) * step, step)
                        value += tap.color
                        bright[k] = luminance(tap.color)
                        weight += bright[k]
                    if wp.static(key.shadows):
                        if light.shadow != 0 and weight > 0.0:
                            # one of them again, in proportion to luminance and in order, which keeps strata of u strata
                            left = u[0] * weight
                            k = int(0)
                            while k < lights.taps - 1 and left >= bright[k]:
                                left = left - bright[k]
                                k = k + 1
                            tap = tap_at(
                                tables, rows, arcs, pieces, lights, light, p, lobe, (float(k) + u[1]) * step, step
                            )
                            value = tap.color * (weight / wp.max(bright[k], 1.0e-30))
                            w = tap.toward
                            far = tap.distance
            if even == 1:
                value = wp.cw_mul(wp.vec3(pieces.total[0], pieces.total[1], pieces.total[2]), light.radiance)
                if wp.static(key.shadows):
                    if light.shadow != 0 and largest(value) > 0.0:
                        at = locate(tables, rows, arcs, pieces, u[0] * whole)
                        rho = value_in(tables, rows, at.row, phi_bin(tables, at.phi))
                        rho = rho * (whole / wp.max(rho[3], 1.0e-20))
                        value = wp.cw_mul(wp.vec3(rho[0], rho[1], rho[2]), light.radiance)
                        w = cone_direction(f.x, f.y, f.n, lobe.sin_theta, at.phi)
                        far = lit(lights.arrays, light, p, w, 0.0).distance
            if wp.static(key.light_multipliers):
                value = value * light.specular
            if wp.static(key.shadows):
                if largest(value) > 0.0:
                    value = wp.cw_mul(value, arrives(g, arrays, light, p, w, far))
                    rays = float(light.shadow)
        return wp.vec4(value[0], value[1], value[2], rays)

    return from_cone
