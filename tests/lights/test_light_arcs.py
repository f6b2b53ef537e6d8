"""Arcs of lights on scratch cones against rays along the cone: nothing is missing and nothing too much."""

from functools import cache

import numpy as np
import pytest
import warp as wp

from scratchwarp import lights
from scratchwarp.lights.arcs_device import Arcs, above_facet
from scratchwarp.lights.light_device import Light
from scratchwarp.lights.quartic_device import quartic_roots, vec_quartic
from scratchwarp.scene import CylinderLight, DiskLight, DistantLight, RectLight, SphereLight

wp.set_module_options({"enable_backward": False})
COUNT, GRID = 600, 4001
WIDE = np.array((0.0, 0.1, -0.4)) / np.hypot(0.1, 0.4)
LIGHTS = {
    "sphere": SphereLight(path="/l", radiance=(1, 1, 1), center=(0.2, 0, 1.2), radius=0.6),
    "distant": DistantLight(path="/l", radiance=(1, 1, 1), direction=(0.2, 0, -1), angle=3.5),
    "rect": RectLight(path="/l", radiance=(1, 1, 1), center=(0.2, 0, 1.2), ex=(2, 0, 0), ey=(0, 0.4, 0.1), normal=WIDE),
    "disk": DiskLight(path="/l", radiance=(1, 1, 1), center=(0.2, 0, 1.2), ex=(2, 0, 0), ey=(0, 0.4, 0.1), normal=WIDE),
    "far disk": DiskLight(
        path="/l", radiance=(1, 1, 1), center=(3, 0, 8), ex=(0.3, 0, 0), ey=(0, 0.2, 0), normal=(0, 0, -1)
    ),
    "cylinder": CylinderLight(path="/l", radiance=(1, 1, 1), center=(0.2, 0.1, 0.9), axis=(0.7, 0.1, 0.2), radius=0.3),
    "end on": CylinderLight(path="/l", radiance=(1, 1, 1), center=(0.1, 0.1, 1.5), axis=(0.1, 0, 1.0), radius=0.3),
}


@cache
def kernel(model):
    arcs_of = model.arcs

    @wp.kernel(module="unique", module_options={"enable_backward": False})
    def arcs(
        light: wp.array(dtype=Light),
        x: wp.array(dtype=wp.vec3),
        u: wp.array(dtype=wp.vec3),
        n: wp.array(dtype=wp.vec3),
        ng: wp.array(dtype=wp.vec3),
        sin_theta: wp.array(dtype=float),
        out: wp.array(dtype=Arcs),
    ):
        i = wp.tid()
        v = wp.cross(n[i], u[i])
        ends = above_facet(ng[i], u[i], v, n[i], sin_theta[i])
        out[i] = arcs_of(light[0], x[i], u[i], v, n[i], sin_theta[i], ends[0], ends[1])

    return arcs


def unit(a):
    return a / np.linalg.norm(a, axis=-1, keepdims=True)


@pytest.mark.parametrize("name", LIGHTS)
def test_arcs_are_what_rays_meet(name):
    """Random points, cones and facets tilted against them; a grid of 4001 rays differs at ends alone."""
    light, rng = LIGHTS[name], np.random.default_rng(0)
    n = unit(rng.normal(size=(COUNT, 3)) + (0, 0, 1.5))
    u = unit(np.cross(n, rng.normal(size=(COUNT, 3))))
    ng = unit(n + 0.3 * rng.normal(size=(COUNT, 3)))
    x = 0.3 * rng.normal(size=(COUNT, 3)) * (1, 1, 0.5)
    sin_theta = rng.uniform(-0.99, 0.99, COUNT)
    if name == "far disk":
        toward = unit(np.array(light.center) - x + 0.2 * rng.normal(size=(COUNT, 3)))
        sin_theta = np.clip((toward * u).sum(1), -0.999, 0.999)
    packed = lights.pack_lights([light])
    out = wp.zeros(COUNT, dtype=Arcs, device="cpu")
    arrays = [wp.array(a.astype(np.float32), dtype=wp.vec3, device="cpu") for a in (x, u, n, ng)]
    sines = wp.array(sin_theta.astype(np.float32), dtype=float, device="cpu")
    wp.launch(
        kernel(packed.models[0]),
        COUNT,
        inputs=[packed.lights[packed.kinds[0]], *arrays, sines],
        outputs=[out],
        device="cpu",
    )
    found = out.numpy()
    phi = np.pi * ((np.arange(GRID) + 0.5) / GRID - 0.5)
    cosine = np.sqrt(1 - sin_theta**2)[:, None, None]
    across = np.sin(phi)[:, None] * np.cross(n, u)[:, None] + np.cos(phi)[:, None] * n[:, None]
    w = sin_theta[:, None, None] * u[:, None] + cosine * across
    met = (lights.hit(packed, x[:, None], w)["distance"] >= 0) & ((w * ng[:, None]).sum(-1) > 0)
    inside = np.zeros_like(met)
    for k in range(found["lo"].shape[1]):
        here = (phi > found["lo"][:, k, None]) & (phi < found["hi"][:, k, None])
        inside |= here & (k < found["count"])[:, None]
    assert met.any(1).sum() > 60
    if name in ("rect", "cylinder", "end on"):
        assert (found["count"] > 1).any()
    # a ray at an end, or a tangent cone, may go either way
    assert (met != inside).sum(1).max() <= 4
    assert (met != inside).mean() < 1e-5


@wp.kernel
def solve(q: wp.array(dtype=vec_quartic), out: wp.array(dtype=vec_quartic)):
    i = wp.tid()
    out[i] = quartic_roots(q[i], wp.float64(-1.0), wp.float64(1.0))


def test_roots_of_quartics():
    """Against numpy's eigenvalues; roots close together, double degrees that vanish."""
    rng = np.random.default_rng(1)
    roots = rng.uniform(-1.6, 1.6, (200, 4))
    roots[50:100, 1] = roots[50:100, 0] + 1e-4
    polynomials = np.array([np.poly(r)[::-1] for r in roots])
    polynomials[150:, 4] = 0.0  # a cubic
    polynomials[180:, 3] = 0.0  # a parabola
    out = wp.zeros(200, dtype=vec_quartic, device="cpu")
    wp.launch(solve, 200, inputs=[wp.array(polynomials, dtype=vec_quartic, device="cpu"), out], device="cpu")
    for q, found in zip(polynomials, out.numpy(), strict=True):
        wanted = np.roots(np.trim_zeros(q, "b")[::-1])
        wanted = np.sort(wanted[np.abs(wanted.imag) < 1e-7].real)
        wanted = wanted[np.abs(wanted) < 1]
        np.testing.assert_allclose(found[found < 8], wanted, atol=1e-7)
