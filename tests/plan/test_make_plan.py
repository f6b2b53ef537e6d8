"""The plan: which effects a scene calls for, why, and with what settings."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp import optics
from scratchwarp.plan.layers import reflector
from scratchwarp.plan.occlusion import is_convex
from scratchwarp.scene import Curves, Layer, Material, PreviewSurface, Profile, RenderOptions, ScratchSurface

spec = importlib.util.spec_from_file_location("scenes", Path(__file__).parent.parent / "render" / "scenes.py")
S = importlib.util.module_from_spec(spec)
spec.loader.exec_module(S)


def plain(**fields):
    return S.scene([S.sphere(8, 16)], [Material("/mat")], [S.dome()], **fields)


def test_a_plain_scene_calls_for_no_scratch_effect():
    plan = sw.make_plan(plain())
    on = {name for name, choice in plan.effects.items() if choice.enabled}
    assert not {n for n in plan.effects if n.startswith("scratches") or n in ("diffraction", "grooves")} & on
    assert on == {"base.preview", "lights.dome"}
    assert plan.tables == () and all(own == () for own in plan.layers)


def test_reasons_name_the_prims():
    plan = sw.make_plan(S.scene([S.sphere(8, 16)], [S.scratched()], [S.dome()]))
    assert plan.on("scratches.worley") and plan.effects["scratches.worley"].prims == ("/mat layer 'fine'",)
    assert not plan.on("scratches.fresnel"), "a mirror needs the mirror table alone"
    assert plan.on("base.direction")
    assert "scratches.worley" in plan.explain() and "/mat layer 'fine'" in plan.explain()


@pytest.mark.parametrize(
    "fields",
    [{"width": 0.0}, {"coverage": 0.0}, {"distribution": "linear", "pitch": 0.0}, {"distribution": "curves"}],
)
def test_layers_that_show_nothing_are_off(fields):
    plan = sw.make_plan(S.scene([S.sphere(8, 16)], [S.scratched(**fields)], [S.dome()]))
    assert not plan.on("scratches") and plan.tables == ()


def test_a_flat_profile_needs_one_bounce():
    material = S.scratched(profile=Profile(path="/mat/flat", shape="flat"))
    plan = sw.make_plan(S.scene([S.sphere(8, 16)], [material], [S.dome()]))
    assert not plan.on("scratches.interreflection") and plan.tables[0].max_bounces == 1


def test_layers_of_one_profile_and_aspect_share_a_table():
    vee = Profile(path="/mat/vee")
    layers = tuple(Layer(name=n, prim="/mat", profile=vee, width=w, depth=w / 2) for n, w in (("a", 10.0), ("b", 40.0)))
    plan = sw.make_plan(S.scene([S.sphere(8, 16)], [Material("/mat", layers=layers)], [S.dome()]))
    assert len(plan.tables) == 1 and plan.tables[0].users == ("/mat layer 'a'", "/mat layer 'b'")


def test_density_decides_coverage_and_a_huge_one_covers_everything():
    plan = sw.make_plan(S.scene([S.sphere(8, 16)], [S.scratched(density=1e9)], [S.dome()]))
    assert plan.on("scratches.full") and not plan.on("scratches.worley")
    assert plan.layers[0][0].sublayer.coverage == 1.0


def test_user_beats_stage_beats_default():
    options = RenderOptions(path="/Render", resolution=(200, 100), spp=7, seed=3, filter="box", integrator="path")
    stage = plain(options=options)
    plan = sw.make_plan(stage)
    assert (plan.size, plan.settings.spp, plan.settings.seed) == ((200, 100), 7, 3)
    assert plan.settings.filter == "box" and plan.settings.filter_width == 1.0
    assert plan.settings.integrator == "path"
    plan = sw.make_plan(stage, sw.Settings(width=50, spp=2, integrator="direct"))
    assert (plan.size, plan.settings.spp) == ((50, 25), 2) and not plan.on("indirect")
    assert sw.make_plan(plain()).size == (640, 640) and sw.make_plan(plain()).settings.spp == 16


def test_crop_counts_from_the_top_left_and_the_data_window_from_the_bottom_left():
    assert sw.make_plan(plain(), sw.Settings(width=100, crop=(0.1, 0.5, 0.0, 0.25))).window == (10, 50, 0, 25)
    options = RenderOptions(resolution=(100, 100), data_window=(0.1, 0.75, 0.5, 1.0))
    assert sw.make_plan(plain(options=options)).window == (10, 50, 0, 25)


def test_forcing_says_so_and_unknown_names_are_refused():
    plan = sw.make_plan(plain(), sw.Settings(effects={"lens": True, "lights.dome": False}))
    assert plan.effects["lens"].forced and plan.on("lens") and not plan.on("lights.dome")
    assert "forced on; by itself off" in plan.effects["lens"].reason
    with pytest.raises(ValueError, match="glitter"):
        sw.make_plan(plain(), sw.Settings(effects={"glitter": True}))


def test_a_profile_that_cannot_be_simulated_names_the_file_and_the_prim():
    backwards = Profile(path="/mat/p", shape="points", points=[(1, 0), (0.5, -1), (0, 0)])
    scene = S.scene([S.sphere(8, 16)], [S.scratched(profile=backwards)], [S.dome()])
    with pytest.raises(ValueError, match=r"^test: /mat/p \(for /mat layer 'fine'\): points"):
        sw.make_plan(scene)


def test_forcing_scratches_off_drops_their_tables():
    scene = S.scene([S.sphere(8, 16)], [S.scratched()], [S.dome()])
    plan = sw.make_plan(scene, sw.Settings(effects={"scratches": False}))
    assert plan.tables == () and not plan.on("scratches.worley")


def test_what_scratches_do_can_be_forced_off():
    scene = S.scene([S.sphere(8, 16)], [S.scratched(fresnel="exact", surface=PreviewSurface(metallic=1.0))], [S.dome()])
    by_itself = sw.make_plan(scene).tables[0]
    assert by_itself.max_bounces > 1 and by_itself.fresnel is not None

    def forced(name, value=False):
        return sw.make_plan(scene, sw.Settings(effects={name: value}))

    once = forced("scratches.interreflection")
    assert once.tables[0].max_bounces == 1 and "by itself on" in once.effects["scratches.interreflection"].reason
    assert forced("scratches.fresnel").tables[0].fresnel is None
    assert forced("scratches.table").tables == () and not any(forced("scratches.table").layers)
    assert forced("grooves", True).on("grooves")


@pytest.mark.parametrize(
    ("mesh", "convex"),
    [(S.sphere(8, 16), True), (S.plane(), True), (S.sphere(8, 16, smooth=False), True)],
)
def test_convex_bodies_cast_no_shadow(mesh, convex):
    assert is_convex(mesh) is convex
    assert not sw.make_plan(S.scene([mesh], [Material("/mat")], [S.dome()])).on("shadows")


def test_paths_are_followed_only_where_a_surface_can_reflect_another():
    path = sw.Settings(integrator="path")
    ball, glass = [S.sphere(8, 16)], [Material("/mat", PreviewSurface(opacity=0.5))]
    alone = S.scene(ball, [Material("/mat")], [S.dome()])
    assert not sw.make_plan(alone, path).on("indirect")
    from_within = S.scene(ball, [Material("/mat")], [S.dome()], instances=[S.place(0, 0)])
    assert sw.make_plan(from_within, path).on("indirect") and sw.make_plan(from_within, path).on("shadows")
    assert sw.make_plan(S.scene(ball, glass, [S.dome()]), path).on("indirect")
    pair = [S.place(0, 0, (0, 0, -6)), S.place(0, 0, (3, 0, -6))]
    assert sw.make_plan(S.scene(ball, [Material("/mat")], [S.dome()], instances=pair), path).on("indirect")
    assert not sw.make_plan(S.scene([S.plane()], glass, [S.dome()]), path).on("indirect")


def test_dents_and_second_bodies_cast_shadows():
    ball = S.sphere(8, 16)
    points = np.array(ball.points)
    points[20] *= 0.5
    dented = S.Mesh(path="/dented", points=points, triangles=ball.triangles)
    assert not is_convex(dented)
    both = S.scene([ball, S.plane()], [Material("/mat")], [S.dome()])
    assert sw.make_plan(both).on("shadows")


def test_inherited_reflectance_follows_the_base():
    scene = plain()

    def inherited(surface, **fields):
        layer = Layer(name="a", prim="/mat", profile=Profile(path="/p"), **fields)
        return reflector(scene, Material("/mat", surface=surface, layers=(layer,)), layer)

    assert inherited(S.white_metal()) == (optics.Mirror(), False)
    assert inherited(PreviewSurface(ior=1.4)) == (optics.Dielectric(1.4), True)
    gold, keeps = inherited(PreviewSurface(diffuse_color=(1.0, 0.8, 0.3), metallic=1.0))
    assert isinstance(gold, optics.Schlick) and gold.f0 == pytest.approx((1.0, 0.8, 0.3)) and not keeps
    iron, keeps = inherited(ScratchSurface(base="conductor", metal="iron"), fresnel="lazanyi")
    assert isinstance(iron, optics.Conductor) and iron.model == "lazanyi" and not keeps
    assert inherited(ScratchSurface(base="diffuse")) == (None, False)


def test_a_profile_that_cannot_be_simulated_is_named():
    bad = Profile(path="/mat/bad", shape="points", points=[[1.0, 0.0], [0.0, 0.0]])
    with pytest.raises(ValueError, match="/mat/bad"):
        sw.make_plan(S.scene([S.sphere(8, 16)], [S.scratched(profile=bad)], [S.dome()]))


def test_curves_of_many_depths_take_as_many_tables_as_they_differ():
    """Explicit scratches of one depth share a table; of depths from 1 to 10 um, tables over the aspects that occur."""
    points = np.array([[0, 0, 0], [1, 0, 0]] * 3, float)

    def plan(depths):
        strokes = Curves("/c", points, np.array([2, 2, 2]), np.full(6, 20.0), np.repeat(depths, 2).astype(float))
        material = S.scratched(distribution="curves", curves=(0,))
        return sw.make_plan(S.scene([S.plane()], [material], [S.dome()], curves=(strokes,)))

    assert len(plan([3, 3, 3]).tables) == 1 and not plan([3, 3, 3]).on("scratches.variation")
    varied = plan([1, 4, 10])
    how = varied.layers[0][0].variation
    assert varied.on("scratches.variation") and how.explicit and len(varied.tables) == how.aspects > 4
    assert np.tan(how.low) / 2 == pytest.approx(0.05) and np.tan(how.high) / 2 == pytest.approx(0.5)
