"""Glass that is grooved: refraction, total reflection and all bounces against Mitsuba 3's of the true geometry.

Mitsuba scales radiance by the square of the index where it goes in or out, so where a path ends in the glass the sky is
scaled against that. A slab of it is open at its rim, a hundred periods wide; what it loses there it loses of the even
channel, too, by which its others are divided. Measured: 0.03 to 0.1 %, and 0.3 % of the slab's sun.
"""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.kernels.assemble import kernel_key
from scratchwarp.scene import DomeLight, Mesh, PreviewSurface, Texture

from . import groove_geometry as sheets
from . import scenes
from .mitsuba_reference import T, film, matrix, mi, shoot

EFFECTS = dict.fromkeys(("lights.dome", "grooves.crossings", "grooves.interreflection", "indirect", "shadows"), True)
ROWS = 128
THICK = 3.0  # periods
UP, WITHIN = np.array([0.6, 0.0, 0.8]), np.array([0.4, 0.0, -np.sqrt(0.84)])
GLASS = PreviewSurface(diffuse_color=(0.8, 0.8, 0.8), roughness=0.0, ior=1.5, opacity=0.0)


def directions(polar):
    """Unit vectors of a latitude-longitude image's texels, +Y up and +Z in the middle."""
    longitude = np.pi * (1 - (2 * np.arange(2 * ROWS) + 1) / (2 * ROWS))
    p, q = np.meshgrid(polar, longitude, indexing="ij")
    return np.stack([np.sin(p) * np.sin(q), np.cos(p), np.sin(p) * np.cos(q)], -1)


def radiance(w):
    """A sun, a gradient, a constant."""
    sun = np.exp(6.0 * (w @ np.array([0.48, 0.36, 0.8]) - 1.0))
    return np.stack([sun + 0.1, 0.6 + w @ np.array([0.3, -0.2, 0.1]), np.ones(w.shape[:-1])], -1)


def dome():
    """(our sky, its texture)."""
    pixels = radiance(directions(np.pi * (np.arange(ROWS) + 0.5) / ROWS))
    return DomeLight(path="/sky", radiance=np.ones(3), texture=0), Texture("sky", np.dstack([pixels, pixels[..., 2]]))


def sky(above=1.0, below=1.0):
    """Mitsuba's, scaled above and below the plane z = 0."""
    w = directions(np.pi * np.arange(ROWS) / (ROWS - 1))
    pixels = radiance(w) * np.where(w[..., 2:] > 0.0, above, below)
    return {"type": "envmap", "bitmap": mi.Bitmap(pixels.astype(np.float32))}


def slab(size, thick):
    """Two squares, back to back; with ``thick`` 0 the upper one alone."""
    top = scenes.plane(size)
    if thick == 0.0:
        return top
    low = top.points - (0.0, 0.0, thick)
    triangles = np.concatenate([top.triangles, top.triangles[:, ::-1] + 4])
    st = np.concatenate([top.uvs["st"], top.uvs["st"][:, ::-1]])
    return Mesh("/slab", np.concatenate([top.points, low]), triangles, uvs={"st": st})


def ours(
    view, lights, pixels=4, spp=1024, mesh=None, textures=(), crossing=True, surface=GLASS, integrator="path", **fields
):
    """Our film of a sheet of glass."""
    world = sheets.world(crossing, surface, 0.0, 0.0, **fields)
    camera = replace(world.camera, transform=sheets.looking(view, 1.0))
    world = replace(world, meshes=(mesh or scenes.plane(0.02),), lights=lights, textures=textures, camera=camera)
    asked = {"width": pixels, "height": pixels, "spp": spp, "filter": "box", "integrator": integrator}
    asked["max_depth"] = 32
    made = sw.render(world, sw.make_plan(world, sw.Settings(**asked, effects=EFFECTS)))
    assert made.stats["invalid_samples"] == 0 and (made["alpha"] == 1.0).all()
    return made["color"].astype(float)


def theirs(view, env, folder, thick=0.0, pixels=4, spp=4096, alpha=0.0):
    """Mitsuba's image of the true sheet, or of two of them back to back."""
    points, faces = sheets.triangles(True)
    parts = {"env": env}
    for name, own in (("top", points), ("low", points * (1.0, -1.0, -1.0) - (0.0, 0.0, thick * sheets.PERIOD))):
        if name == "top" or thick > 0.0:
            mesh = mi.Mesh(name, len(own), len(faces))
            params = mi.traverse(mesh)
            params["vertex_positions"] = own.astype(np.float32).ravel()
            params["faces"] = faces.astype(np.uint32).ravel()
            params.update()
            mesh.write_ply(str(folder / f"{name}.ply"))
            parts[name] = {"type": "ply", "filename": str(folder / f"{name}.ply"), "face_normals": True}
            parts[name]["bsdf"] = {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}
            if alpha > 0.0:
                parts[name]["bsdf"] |= {"type": "roughdielectric", "alpha": alpha, "distribution": "ggx"}
    turned = sheets.looking(view, 30 * sheets.PERIOD) @ np.diag([-1.0, 1, -1, 1])
    place = matrix(turned) @ T().scale([2 * sheets.PERIOD, 2 * sheets.PERIOD, 1])
    camera = {"type": "orthographic", "to_world": place, "near_clip": sheets.PERIOD, "film": film(pixels, pixels)}
    return shoot(parts, camera, spp, {"type": "path", "max_depth": 64, "rr_depth": 1000})[0]


@pytest.mark.parametrize("case", ["into", "out of", "slab"])
def test_true_geometry_refracts_the_same(tmp_path, monkeypatch, case):
    """From the air, from within the glass (total reflection between crossing facets), and through a slab whose other
    side is grooved as well, where it matters on which facet a path arrives."""
    monkeypatch.setattr(sheets, "COUNT", 100 if case == "slab" else 60)
    thick = THICK if case == "slab" else 0.0
    view, scales = {"into": (UP, (1, 2.25)), "out of": (WITHIN, (1 / 2.25, 1)), "slab": (UP, (1, 1))}[case]
    light, texture = dome()
    made = ours(view, (light,), mesh=slab(0.02, thick * 200e-6), textures=(texture,)).mean((0, 1))
    true = theirs(view, sky(*scales), tmp_path, thick).mean((0, 1))
    assert abs(true[2] - 1.0) < 0.01
    # noise: 16,384 samples of a sun that varies by about itself are good to 0.3 % of its pixels' mean (two sigma: 0.6)
    np.testing.assert_allclose(made, true / true[2], rtol=5e-3)


@pytest.mark.parametrize("view", [UP, WITHIN], ids=["into", "out of"])
def test_rough_glass_is_that_of_true_geometry(tmp_path, monkeypatch, view):
    """Facets of alpha 0.2, all bounces: 0.1 to 0.5 %, of the sun as of the other channels; Mitsuba's masking and
    shadowing are independent, and both lose the same to what meets two micro-facets."""
    monkeypatch.setattr(sheets, "COUNT", 60)
    light, texture = dome()
    surface = replace(GLASS, roughness=np.sqrt(0.2))
    made = ours(view, (light,), spp=4096, textures=(texture,), surface=surface).mean((0, 1))
    scales = (1, 2.25) if view is UP else (1 / 2.25, 1)
    true = theirs(view, sky(*scales), tmp_path, alpha=0.2).mean((0, 1))
    np.testing.assert_allclose(made, true, rtol=1.2e-2)


@pytest.mark.parametrize("integrator", ["path", "direct"])
def test_nothing_is_lost_or_gained(integrator):
    """A white sky behind smooth glass: a slab grooved on both sides, a sphere, any footprint; 1 within the noise of
    paths that end at random, 0.1 %, but for the few that end after 8 facets or 32 surfaces. Reflections within a body
    are followed without indirect light, too."""
    for mesh in (slab(0.02, 6e-4), scenes.sphere(radius=1e-3)):
        seen = ours(UP, (scenes.dome(),), spp=4096, mesh=mesh, integrator=integrator).mean()
        assert seen == pytest.approx(1.0, abs=4e-3)


def test_white_pigment_on_glass_loses_nothing():
    """Half of the light goes through, the rest meets white pigment, from outside and from within. What is missing, 1.5
    %, the diffuse lobe leaves to a reflectance at grazing angles that is an upper bound."""
    surface = replace(GLASS, opacity=0.5, diffuse_color=(1.0, 1.0, 1.0))
    seen = ours(UP, (scenes.dome(),), mesh=slab(0.02, 6e-4), surface=surface).mean()
    assert 0.98 < seen < 1.004


def test_grooves_of_no_depth_are_smooth_glass():
    """Fresnel's share of the mirrored sky, the rest of the sky where Snell has it: 1e-3, for the sky is a texture."""
    light, texture = dome()
    made = ours(UP, (light,), spp=4096, textures=(texture,), depth=1e-4).mean((0, 1))
    cos_i, cos_t = 0.8, np.sqrt(1.0 - 0.16)
    across, along = (cos_i - 1.5 * cos_t) / (cos_i + 1.5 * cos_t), (1.5 * cos_i - cos_t) / (1.5 * cos_i + cos_t)
    f = 0.5 * (across**2 + along**2)
    expected = f * radiance(np.array([-0.6, 0.0, 0.8])) + (1 - f) * radiance(np.array([-0.4, 0.0, -cos_t]))
    np.testing.assert_allclose(made, expected, rtol=1e-3)


@pytest.mark.parametrize(
    ("surface", "refracts"),
    [
        (GLASS, True),
        (replace(GLASS, opacity=1.0), False),
        (replace(GLASS, opacity_mode="presence"), False),
        (replace(GLASS, metallic=1.0), False),
    ],
)
def test_what_is_not_glass_compiles_no_refraction(surface, refracts):
    world = sheets.world(False, surface, 1.0, 0.5)
    plan = sw.make_plan(world, sheets.settings(8, 1))
    choice = plan.effects["grooves.transmission"]
    assert plan.on("grooves") and choice.enabled == refracts and kernel_key(world, plan).groove_glass == refracts
    assert ("glass" in choice.reason) == refracts
