"""Radiance over arrays of lights, views, scratches and wavelengths."""

import warp as wp

from .few_device import make_few
from .polygon_device import PolygonView, cut_polygon, polygon_breaks, polygon_marks, short_polygon, view_polygon
from .quadrature_device import Rules
from .radiance_device import make_radiance
from .real_device import real, vec3
from .scratch_device import WaveScratch
from .slice_device import LobeTables, make_lobe
from .sphere_device import SphereView, cut_sphere, short_sphere, sphere_breaks, sphere_marks, view_sphere

wp.set_module_options({"enable_backward": False})

_few_of_sphere = make_few(SphereView, sphere_marks, cut_sphere, short_sphere)
_few_of_polygon = make_few(PolygonView, polygon_marks, cut_polygon, short_polygon)
_sphere_radiance = make_radiance(SphereView, sphere_breaks, cut_sphere, _few_of_sphere)
_polygon_radiance = make_radiance(PolygonView, polygon_breaks, cut_polygon, _few_of_polygon)


@wp.struct
class Queries:
    """One row for each value asked for; ``table``: first row and number of nodes of its table, 0 where none."""

    omega_o: wp.array(dtype=vec3)
    scratch: wp.array(dtype=WaveScratch)
    wavelength: wp.array(dtype=real)
    table: wp.array2d(dtype=int)
    kind: int
    method: int
    slices: int


@wp.kernel
def sphere_kernel(
    q: Queries,
    tables: LobeTables,
    rules: Rules,
    center: wp.array(dtype=vec3),
    radius: wp.array(dtype=real),
    out: wp.array(dtype=real),
):
    """Under a sphere each."""
    i = wp.tid()
    s = q.scratch[i]
    lobe = make_lobe(s, q.omega_o[i], q.wavelength[i], q.kind, q.table[i, 0], q.table[i, 1])
    out[i] = _sphere_radiance(view_sphere(center[i], radius[i], s), lobe, tables, rules, q.method, q.slices)


@wp.kernel
def polygon_kernel(
    q: Queries,
    tables: LobeTables,
    rules: Rules,
    vertices: wp.array(dtype=vec3),
    corners: int,
    out: wp.array(dtype=real),
):
    """Under a polygon of so many ``corners`` each."""
    i = wp.tid()
    lobe = make_lobe(q.scratch[i], q.omega_o[i], q.wavelength[i], q.kind, q.table[i, 0], q.table[i, 1])
    light = view_polygon(vertices, i * corners, corners)
    out[i] = _polygon_radiance(light, lobe, tables, rules, q.method, q.slices)
