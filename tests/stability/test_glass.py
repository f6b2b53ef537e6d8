"""Grooved glass by two roads: an index of 1 is not there, a slab is known in closed form, light goes both ways alike
(radiance over the square of the index), and a scene of any size looks the same.

The kernels are those of ``render.test_groove_glass``.
"""

from dataclasses import replace

import numpy as np
import pytest
import warp as wp
from scipy.stats import qmc

import scratchwarp as sw
from scratchwarp.scene import DomeLight, Texture

from ..render import groove_geometry as sheets
from ..render import scenes
from ..render.test_groove_glass import EFFECTS, GLASS, ROWS, THICK, UP, WITHIN, directions, dome, radiance, slab
from . import probe_glass as probes

PERIOD = 200e-6


def look(
    ior=1.5, view=UP, thick=THICK, size=1.0, aside=0.0, window=4 * PERIOD, sky=None, spp=64, pixels=4, depth=50.0,
    bounces=8,
):  # fmt: skip
    """A film of a sheet, or a slab of ``thick`` periods, all lengths times ``size``, moved ``aside`` [m]."""
    fields = {"width": 100.0 * size, "pitch": 200.0 * size, "depth": depth * size}
    world = sheets.world(True, replace(GLASS, ior=ior), 0.0, 0.0, **fields)
    light, texture = sky or dome()
    camera = replace(
        world.camera, transform=sheets.looking(view, size), horizontal_aperture=window * size,
        vertical_aperture=window * size,
    )  # fmt: skip
    mesh = slab(0.02 * size, thick * PERIOD * size)
    world = replace(
        world, meshes=(mesh,), lights=(light,), textures=(texture,), camera=camera,
        instances=(scenes.place(at=(aside, 0.0, 0.0)),),
    )  # fmt: skip
    asked = {"width": pixels, "height": pixels, "spp": spp, "filter": "box", "integrator": "path", "max_depth": 32}
    asked["knobs"] = {"grooves.bounces": bounces}
    film = sw.render(world, sw.make_plan(world, sw.Settings(**asked, effects=EFFECTS)))
    assert film.stats["invalid_samples"] == 0
    assert np.isfinite(film["color"]).all() and film["color"].min() >= 0.0
    return film


@pytest.mark.parametrize("view", [UP, WITHIN], ids=["slab", "from within"])
@pytest.mark.parametrize("above_one", [0.0, 1e-6])
def test_an_index_of_one_is_not_there(view, above_one):
    """The sky behind, pixel by pixel."""
    thick = THICK if view is UP else 0.0
    seen = look(1.0 + above_one, view, thick)
    sky = look(1.0, view, thick, aside=9.0)
    assert (seen["alpha"] == 1.0).all() and (sky["alpha"] == 0.0).all()
    np.testing.assert_allclose(seen["color"], sky["color"], rtol=1e-4 if above_one == 0.0 else 1e-3)


@pytest.mark.parametrize(("cosine", "depth"), [(0.05, 50.0), (1e-2, 1e-4), (1e-3, 1e-4), (1e-4, 1e-4), (1e-6, 1e-6)])
def test_nor_is_it_at_grazing_angles(cosine, depth):
    """Where 1 - sin^2 / ior^2 in float32 is 0, nothing would pass. Deep grooves are met by dozens at such angles."""
    view = np.array([np.sqrt(1.0 - cosine**2), 0.0, cosine])
    asked = {"ior": 1.0, "view": view, "thick": 0.0, "window": 1e-9, "depth": depth, "bounces": 64}
    seen, sky = look(**asked), look(**asked, aside=9.0)
    assert (seen["alpha"] == 1.0).all() and (sky["alpha"] == 0.0).all()
    np.testing.assert_allclose(seen["color"], sky["color"], rtol=1e-4)


@pytest.mark.parametrize("cos_i", [0.8, 0.3])
def test_a_slab_reflects_and_passes_what_the_sum_of_its_echoes_says(cos_i):
    """2 F / (1 + F) of the mirrored sky, the rest of the sky straight behind; noise of the choice 0.1 %."""
    view = np.array([np.sqrt(1.0 - cos_i**2), 0.0, cos_i])
    made = look(1.5, view, thick=0.3, spp=4096, depth=1e-4)["color"].astype(float).mean((0, 1))
    cos_t = np.sqrt(1.0 - (1.0 - cos_i**2) / 2.25)
    across, along = (cos_i - 1.5 * cos_t) / (cos_i + 1.5 * cos_t), (1.5 * cos_i - cos_t) / (1.5 * cos_i + cos_t)
    f = 0.5 * (across**2 + along**2)
    back = 2.0 * f / (1.0 + f)
    expected = back * radiance(view * (-1.0, -1.0, 1.0)) + (1.0 - back) * radiance(-view)
    np.testing.assert_allclose(made, expected, rtol=4e-3)


@pytest.mark.parametrize("alpha", [0.0, 0.3])
def test_a_facet_lets_through_as_much_either_way(alpha):
    """Between any two sheaves of directions n^2 cos d(omega) times what passes is the same; noise 2 % a pair."""
    n = 1 << 18
    u = wp.array(qmc.Sobol(4, seed=3).random(n).astype(np.float32), dtype=wp.vec4, device="cpu")
    passed = []
    for within in (0, 1):
        out = wp.zeros(n, dtype=wp.vec3, device="cpu")
        wp.launch(probes.through, n, inputs=[u, alpha, 1.5, within, out], device="cpu")
        before, behind, share = out.numpy().astype(float).T
        assert np.isfinite(out.numpy()).all() and share.min() >= 0.0 and share.max() <= 1.0 + 1e-5
        # sheaves of like cos^2: of like measure cos d(omega)
        passed.append(np.histogram2d(before**2, behind**2, 4, [[0.0, 1.0]] * 2, weights=share)[0] / n)
    into, out_of = passed
    assert into.sum() > 0.8
    np.testing.assert_allclose(into, 2.25 * out_of.T, rtol=0.05, atol=2e-3)
    assert into.sum() == pytest.approx(2.25 * out_of.sum(), rel=2e-3)


def half_sky(sign):
    """1 above (or below) the plane z = 0."""
    w = directions(np.pi * (np.arange(ROWS) + 0.5) / ROWS)
    pixels = np.repeat((sign * w[..., 2:] > 0.0).astype(float), 4, -1)
    return DomeLight(path="/sky", radiance=np.ones(3), texture=0), Texture("sky", pixels)


def test_a_grooved_surface_lets_through_as_much_either_way():
    """From a sky above to the glass, n^2 times from a sky in the glass to the air: 32 directions by Lambert's law, of
    which a mean of what varies by a third is good to 1 %."""
    u, v = qmc.Sobol(2, seed=5).random(32).T
    r, phi = np.sqrt(u), 2.0 * np.pi * v
    ways = np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1.0 - u)], -1)

    def passed(side):
        behind = half_sky(-side)
        mirrored = ways * (1.0, 1.0, side)
        return np.mean([look(1.5, w, 0.0, sky=behind, pixels=1, spp=1024)["color"].mean() for w in mirrored])

    into, out_of = passed(1.0), passed(-1.0)
    assert 0.5 < into < 1.0
    assert into == pytest.approx(2.25 * out_of, rel=0.02)


def test_scenes_of_any_size_look_the_same():
    """Scaled by powers of two with all they hold; now and then a path goes another way by rounding."""
    one = look(1.5, spp=256)["color"].astype(float)
    for power in (-20, 20):
        other = look(1.5, size=2.0**power, spp=256)["color"].astype(float)
        assert other.mean() == pytest.approx(one.mean(), rel=2e-3)
        assert np.isclose(other, one, rtol=1e-2).all(-1).mean() > 0.9
