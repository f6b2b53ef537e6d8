"""Pictures of grooves against Mitsuba 3's of their true geometry, with all inter-reflection.

Tolerances: 0.5 % of the mean, most of which is what Mitsuba's GGX, its masking and its shadowing independent, sends
less from rough facet to rough facet (0.3 to 0.4 % at this roughness of 0.3); the RMS of pixels at most twice Mitsuba's
noise. The triangles traced by ourselves, with the same facets: 0.3 %, all of it noise (0.01 % with 16 times the
samples). One kernel for grooves, one for triangles.
"""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.scene import Curves

from . import groove_geometry as sheets
from . import scenes

GLOSSY = replace(sheets.ROUGH, roughness=0.2)
MIRROR = replace(sheets.ROUGH, roughness=0.0)
EFFECTS = dict.fromkeys(("lights.dome", "lights.distant", "grooves.crossings", "grooves.interreflection"), True)


@pytest.mark.parametrize(
    ("crossing", "surface"),
    [(False, sheets.ROUGH), (True, sheets.ROUGH), (True, sheets.LAMBERT)],
    ids=["parallel-rough", "crossing-rough", "crossing-diffuse"],
)
def test_true_geometry_looks_the_same(tmp_path, crossing, surface):
    file, _ = sheets.true_mesh(crossing, tmp_path)
    film = sheets.ours(crossing, surface, 1.0, 0.5, 8, 8192 if crossing else 2048, EFFECTS)
    assert film.stats["invalid_samples"] == 0
    made = film["color"].astype(float)
    true, variance = sheets.theirs(file, surface, 1.0, 0.5, 8, 4096)
    assert made.mean() == pytest.approx(true.mean(), rel=5e-3)
    assert np.sqrt(((made - true) ** 2).mean()) < 2.0 * np.sqrt(variance.mean())


@pytest.mark.parametrize("crossing", [False, True], ids=["parallel", "crossing"])
@pytest.mark.parametrize("surface", [sheets.ROUGH, sheets.LAMBERT, MIRROR], ids=["glossy", "diffuse", "mirror"])
def test_light_between_facets_is_that_between_triangles(crossing, surface):
    """A sun and a sky each, eight facets and sixteen surfaces: 0.3 %, twice the noise of 64 pixels of 8,192 samples (of
    the sun 0.15 % where facets are rough, less elsewhere); a sun is not seen in a mirror."""
    for sun, sky in ((1.0, 0.0), (0.0, 0.5)) if surface is not MIRROR else ((0.0, 0.5),):
        made = sheets.ours(crossing, surface, sun, sky, 8, 4096, EFFECTS)["color"].mean(dtype=float)
        true = sheets.twin(crossing, surface, sun, sky, 8, 8192)["color"].mean(dtype=float)
        assert made == pytest.approx(true, rel=3e-3)


@pytest.mark.parametrize("crossing", [False, True], ids=["parallel", "crossing"])
def test_a_stretched_mapping_stretches_grooves(crossing):
    """A mapping whose u and v are 53 degrees apart: the triangles, sheared like that and no less deep."""
    shear = np.array([[1.0, 0.6], [0.0, 0.8]])
    for sun, sky in ((1.0, 0.0), (0.0, 0.5)):
        world = sheets.world(crossing, GLOSSY, sun, sky)
        (mesh,) = world.meshes
        points = np.concatenate([mesh.points[:, :2] @ shear.T, mesh.points[:, 2:]], 1)
        world = replace(world, meshes=(replace(mesh, points=points),))
        made = sw.render(world, sw.make_plan(world, sheets.settings(8, 4096, EFFECTS)))["color"].mean(dtype=float)
        true = sheets.twin(crossing, GLOSSY, sun, sky, 8, 8192, shear)["color"].mean(dtype=float)
        assert made == pytest.approx(true, rel=4e-3)


def picture(world, spp=16):
    """Finite, or a failed assertion."""
    film = sw.render(world, sw.make_plan(world, sheets.settings(16, spp, EFFECTS)))
    assert film.stats["invalid_samples"] == 0 and np.isfinite(film["color"]).all()
    return film["color"].astype(float)


@pytest.mark.parametrize("layout", ["concentric", "spiral", "random", "worley"])
def test_every_layout_is_laid_out(layout):
    """A diffuse sheet in the open: grooves change what a bare one shows, and lose light at most."""
    fields = {"distribution": layout, "length": 1000.0, "coverage": 0.4, "seed": 3}
    world = sheets.world(True, sheets.LAMBERT, 1.0, 0.5, **fields)
    world = replace(world, meshes=(scenes.plane(2e-3),))
    (layer,) = world.materials[0].layers
    bare = picture(replace(world, materials=(replace(world.materials[0], layers=(replace(layer, depth=1e-3),)),)))
    made = picture(world)
    assert made.std() > 0.02 * bare.mean() and 0.7 < made.mean() / bare.mean() < 1.05


def test_explicit_curves_in_uv_and_in_space_are_one():
    """The same zigzag, its points given in uv and on the surface: rounding of float32 apart, the same picture."""
    way = np.array([[0.2, 0.1], [0.8, 0.5], [0.4, 0.6], [0.7, 0.95]])
    images = []
    for space in ("uv", "object"):
        points = np.zeros((4, 3))
        points[:, :2] = way if space == "uv" else (way - 0.5) * 2e-3
        curves = Curves("/c", points, np.array([4]), np.full(4, 90.0), np.full(4, 40.0), space)
        world = sheets.world(True, sheets.LAMBERT, 1.0, 0.5, distribution="curves", curves=(0,))
        images.append(picture(replace(world, meshes=(scenes.plane(2e-3),), curves=(curves,)), 256))
    assert np.abs(images[0] - images[1]).max() < 0.02 * images[0].mean() and images[0].std() > 0.005


@pytest.mark.parametrize("case", ["tiny", "grazing", "seam", "edge"])
def test_hard_cases_are_finite(case):
    """A footprint smaller than a facet, a view along the grooves a degree above the ground, a seam of the mapping under
    the camera, and the rim of the uv square."""
    world = sheets.world(True, sheets.ROUGH, 1.0, 0.5)
    cam = world.camera
    if case == "tiny":
        cam = replace(cam, horizontal_aperture=1e-9, vertical_aperture=1e-9)
    if case == "grazing":
        tilt = np.radians(89.0)
        omega = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
        cam = replace(cam, transform=sheets.looking(omega, 1.0))
    if case == "edge":
        world = replace(world, meshes=(scenes.plane(5e-4),))
    if case == "seam":
        world = replace(
            world, meshes=(scenes.sphere(radius=1e-3),), instances=(scenes.place(linear=np.eye(3)[[0, 2, 1]]),)
        )
    made = picture(replace(world, camera=cam), 64)
    assert made.mean() > 0.0
