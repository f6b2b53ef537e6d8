"""A scratched material as one BRDF, and stencils fitted to it."""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp import optics, profiles
from scratchwarp.plan import far_field
from scratchwarp.plan.choice import LayerPlan, TablePlan
from scratchwarp.scene import Camera, Instance, Layer, Material, Mesh, Profile, Scene, ScratchSurface
from scratchwarp.scratches.expand import Sublayer

BLUR = far_field.BLUR


def _layer(**fields):
    fields = {"width": 50.0, "depth": 10.0, "length": 5000.0, "coverage": 0.5, **fields}
    profile = Profile(path="/mat/groove", shape=fields.pop("shape", "round"))
    return Layer(name="fine", prim="/mat", profile=profile, **fields)


def _scene(*layers, surface=None):
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], float)
    mesh = Mesh(path="/tri", points=points, triangles=np.array([[0, 1, 2]]), uvs={"st": points[None, :, :2]})
    camera = Camera("/cam", np.eye(4), horizontal_aperture=20.0, vertical_aperture=20.0, focal_length=50.0)
    material = Material(path="/mat", surface=surface or ScratchSurface(metal="gold", roughness=0.2), layers=layers)
    return Scene(
        path="test", meshes=(mesh,), instances=(Instance("/tri", 0, np.eye(4), (0,)),), materials=(material,),
        lights=(), camera=camera,
    )  # fmt: skip


def _direction(theta, phi):
    parts = np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta))
    return np.stack(parts, axis=-1)


def _hemisphere(nt=240, nphi=480):
    """Directions and solid angles times cosine."""
    s = (np.arange(nt) + 0.5) / nt
    t, phi = np.meshgrid(np.arcsin(np.sqrt(s)), (np.arange(nphi) + 0.5) / nphi * 2 * np.pi, indexing="ij")
    return _direction(t, phi).reshape(-1, 3), np.pi / (nt * nphi)


@pytest.fixture(scope="module")
def plan():
    profile = profiles.shape("round", depth=0.2)
    return TablePlan((), profile, optics.Conductor(*optics.metals.rgb("gold")), 2000, ())


@pytest.mark.parametrize(("theta", "phi"), [(0.0, 0.0), (0.7, 0.4), (1.0, 1.9), (1.1, -2.5)])
def test_against_samples_of_the_table(plan, theta, phi):
    """Means of a smooth function under the blurred reflectance and under rays drawn from the sharp table agree.

    The blur moves a ray by 0.065 rad, off its cone and about it, so that a function changes by 0.065^2 times its second
    derivatives, which are 2 at most; the table is sampled in the mirror's proportions and weighted by rho_s / rho.
    """
    azimuth = 0.6
    wo = _direction(theta, phi)
    u, v = np.array([np.cos(azimuth), np.sin(azimuth), 0.0]), np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])

    def seen(w):
        return np.stack([np.ones(len(w)), 0.5 + 0.5 * w @ _direction(0.8, 1.0), w[:, 2] ** 2], axis=-1)

    table = profiles.simulate(plan.profile, resolution=128, rays=256, fresnel=plan.fresnel)
    theta_o, phi_o = np.arcsin(wo @ u), np.arctan2(wo @ v, wo[2])
    count = 20000
    phi_i, _ = table.sample(np.full(count, phi_o), (np.arange(count) + 0.5) / count)
    wi = (
        -np.sin(theta_o) * u[None]
        + np.cos(theta_o) * (np.sin(phi_i)[:, None] * v + np.cos(phi_i)[:, None] * (0.0, 0.0, 1.0))
    )  # fmt: skip
    bins = [np.clip(((a / np.pi + 0.5) * 128).astype(int), 0, 127) for a in (np.full(count, phi_o), phi_i)]
    ratio = table.slice(float(theta_o))[bins[0], bins[1]] / table.mirror[bins[0], bins[1]][:, None]
    row = (table.mirror[bins[0][0]] * table.weights).sum()
    expected = np.einsum("ic,if->cf", ratio, seen(wi)) / count * row

    grid, cell = _hemisphere()
    rho = far_field.blurred_slices(plan, BLUR)
    value = far_field.parallel(rho, azimuth, grid, np.broadcast_to(wo, grid.shape), BLUR)
    found = np.einsum("ic,if->cf", value, seen(grid)) * cell
    np.testing.assert_allclose(found, expected, rtol=0.01, atol=2.0 * BLUR**2)


def test_reciprocal(plan):
    rng = np.random.default_rng(0)
    a, b = (_direction(rng.uniform(0, 1.3, 400), rng.uniform(-np.pi, np.pi, 400)) for _ in range(2))
    rho = far_field.blurred_slices(replace(plan, fresnel=None), BLUR)
    there, back = (far_field.parallel(rho, 0.6, x, y, BLUR) for x, y in ((a, b), (b, a)))
    # the table is reciprocal to the rounding of its rays
    np.testing.assert_allclose(there, back, rtol=2e-3, atol=2e-3 * there.max())


def test_layers_share_the_area():
    """Two Lambert layers at 50 % over a Lambert base: 1 - 0.25 of it covered, in equal shares."""
    base = ScratchSurface(base="diffuse", color=(0.2, 0.2, 0.2))
    layer = _layer(material="diffuse", diffuse_color=(0.8, 0.4, 0.0), distribution="linear", pitch=100.0)
    scene = _scene(layer, surface=base)
    one = LayerPlan(Sublayer(layer, "linear", 0.0, 0.5), -1, False, 1.0, (0.8, 0.4, 0.0))
    other = LayerPlan(Sublayer(layer, "linear", 1.0, 0.5), -1, False, 1.0, (0.0, 0.0, 0.6))
    w = np.array([[0.0, 0.0, 1.0]])
    value = far_field.evaluate(scene, scene.materials[0], (one, other), (), w, w)
    expected = 0.25 * 0.2 + 0.375 * np.array([0.8, 0.4, 0.6])
    np.testing.assert_allclose(np.pi * value[0], expected, rtol=1e-5)


def test_crossed_scratches_are_two_modes():
    """Axes where the scratches run, and an error that is said."""
    found = sw.fit_far_field(_scene(_layer(distribution="crosshatch", pitch=100.0, angle=0.3)), "mat")
    assert found.material == "/mat" and len(found.model.modes) == 2
    axes = np.sort([mode.azimuth for mode in found.model.modes])
    np.testing.assert_allclose(axes, [0.3, 0.3 + 0.5 * np.pi], atol=0.03)
    assert found.error["psnr"] > 35.0 and 0.0 < found.albedo < 0.4
    # gold reflects red, green and blue in this order
    mean = found.values.mean(axis=(0, 1))
    assert mean[0] > mean[1] > mean[2]
    assert any("2 sets" in note for note in found.notes)


def test_what_is_no_one_brdf():
    for layer, message in (
        (_layer(distribution="concentric"), "'fine': concentric scratches run in other directions"),
        (_layer(distribution="spiral"), "spiral"),
    ):
        with pytest.raises(ValueError, match=message):
            far_field.tabulate(_scene(layer), 0)
    with pytest.raises(ValueError, match="'wood' is none of test: /mat"):
        far_field.tabulate(_scene(_layer()), "wood")
    with pytest.raises(ValueError, match="blur"):
        far_field.tabulate(_scene(_layer()), 0, blur=0.0)


def test_the_planner_on_request():
    """Forced on: the base is a stencil model and no scratch is left; what is no one BRDF keeps its scratches."""
    scene = _scene(_layer(distribution="crosshatch", pitch=100.0, angle=0.3))
    plain = sw.make_plan(scene)
    assert not plain.on("scratches.stencil") and plain.on("scratches") and "stencils" not in plain.numbers
    plan = sw.make_plan(scene, sw.Settings(effects={"scratches.stencil": True}))
    model = plan.responses[plan.bases[0]].values
    assert len(model.modes) == 2 and plan.responses[plan.bases[0]].users == ("/mat",)
    assert plan.layers == ((),) and plan.tables == () and not plan.warnings
    assert plan.on("base.stencils") and not plan.on("scratches") and not plan.on("scratches.table")
    assert "/mat 2 modes, PSNR" in plan.explain()
    turned = _scene(_layer(distribution="concentric"))
    kept = sw.make_plan(turned, sw.Settings(effects={"scratches.stencil": True}))
    assert kept.on("scratches") and not kept.on("base.stencils")
    assert any("is rendered with its scratches" in warning for warning in kept.warnings)
