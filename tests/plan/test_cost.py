"""What a render is predicted to cost, and which knobs an error buys."""

import json
from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.plan.cost import forecast, models, slow
from scratchwarp.plan.cost.aim import BIAS_SHARE, QUALITY_SHARE, aim, suited, wanted
from scratchwarp.plan.cost.footprints import footprints
from scratchwarp.plan.cost.models import Costs, Errors
from scratchwarp.plan.cost.visible import visible
from scratchwarp.plan.cost.work import of_table, work
from scratchwarp.scene import DistantLight, Profile, SphereLight, Texture, Wave

from ..render import scenes as S

ONE = Costs({}, "a machine on which every unit takes 100 ns", spread=1.5)
LEFT = Errors(
    {
        "tables.resolution": {"64": 0.02, "128": 0.004, "256": 0.001, "512": 0.0},
        "tables.rays": {"32": 0.003, "512": 0.0},
    },
    (0.5, 1.0),
)


def world(**fields):
    return S.scene([S.sphere(16, 32)], [S.scratched(fresnel="exact", material="conductor", metal="gold")], [S.dome()],
                   **fields)  # fmt: skip


def plan(scene=None, **settings):
    return sw.make_plan(scene or world(), sw.Settings(**{"width": 64, "height": 64, "threads": 1, **settings}))


def test_a_sphere_fills_its_disc():
    """Radius 1 at 6 m, 20 mm of aperture at 50 mm: its rim is seen at tan asin(1/6) = 0.169 of 0.2, so that it fills
    pi / 4 times 0.845 squared = 0.561; cells are a 48th of the image wide."""
    shares = visible(world(), (64, 64), (0, 64, 0, 64))
    assert shares == pytest.approx([0.561], abs=0.03)
    assert visible(world(), (64, 64), (24, 40, 24, 40)) == pytest.approx([1.0])
    assert visible(world(), (64, 64), (0, 4, 0, 4)) == pytest.approx([0.0])


def test_the_nearest_counts_and_what_crosses_the_camera_is_cut():
    floor = S.plane(40.0, axis="y", path="/floor")
    scene = S.scene(
        [S.sphere(16, 32), floor], [S.scratched(), S.scratched()], [S.dome()],
        instances=[S.place(0, 0, (0, 0, -6)), S.place(1, 1, (0, -0.5, 0))],
    )  # fmt: skip
    ball, ground = visible(scene, (64, 64), (0, 64, 0, 64))
    whole = visible(replace(scene, instances=scene.instances[1:]), (64, 64), (0, 64, 0, 64))[1]
    assert 0.3 < whole < 0.5  # below the horizon, up to 20 m away
    assert ball > 0.3 and ground == pytest.approx(whole - 0.18, abs=0.1)


def test_work_grows_with_what_there_is_to_do():
    one = work(world(), plan(spp=4))
    two = work(world(), plan(spp=8))
    assert two.samples == 2 * one.samples == 64 * 64 * 8 and dict(two.each) == dict(one.each)
    lit = work(replace(world(), lights=(*world().lights, S.dome(2.0))), plan(spp=4))
    assert lit.each["lights.dome", "lights.dome"] == 2 * one.each["lights.dome", "lights.dome"]
    table = plan().tables[0]
    rays = ("scratches.interreflection", "tables.rayBounced")
    assert of_table(replace(table, rays=2 * table.rays))[rays] == 2 * of_table(table)[rays]


def test_a_forecast_adds_up_and_says_so():
    made = plan(spp=4)
    found = forecast(world(), made, ONE)
    counted = work(world(), made)
    assert found.part("trace") == pytest.approx(counted.samples * sum(counted.each.values()) * 1e-7)
    assert found.seconds == pytest.approx(sum(found.part(part) for part in ("simulate", "build", "trace")))
    assert set(found.record()["effects"]) == {"simulate", "build", "trace"}
    said = found.text({"simulate": 1.0, "trace": 2.0, "compile": 3.0})
    assert "lights.dome" in said and "a factor of 1.5" in said and "took 2 s" in said
    assert forecast(world(), replace(made, settings=replace(made.settings, threads=2)), ONE).seconds < found.seconds


def test_what_takes_long_is_warned_of():
    made = plan(spp=4)
    found = forecast(world(), made, ONE)
    assert slow(found, made) == ""
    long = replace(found, effects={("trace", "scratches.table"): 6000.0, ("trace", "camera"): 6000.0 / 9.0})
    said = slow(long, made)
    assert "about 1.1e+02 minutes" in said and "90 % of them to trace scratches.table" in said
    assert "--spp" in said and "tables.rays" in said and "diffraction" not in said


def test_every_effect_with_a_price_is_an_effect_or_a_part_of_every_render():
    counted = work(world(), plan())
    names = {effect for units in (counted.each, counted.tables, counted.build) for effect, _ in units}
    assert names <= set(plan().effects) | {"camera", "base", "geometry", "kernel", "scratches.responses"}


def test_an_error_is_bought_at_the_lowest_price():
    made = plan(max_error=0.02, quality="preview")
    found = aim(world(), made, {}, None, ONE, LEFT)
    assert found.bias <= BIAS_SHARE * 0.02 and found.noise == pytest.approx(0.02 - found.bias)
    # 64 bins alone take more than half of the error
    assert found.knobs["tables.resolution"] in (128, 256) and found.samples == wanted(found.noise, LEFT)
    for bins in (128, 256, 512):
        for rays in (32, 512):
            knobs = {"tables.resolution": bins, "tables.rays": rays}
            turned = plan(max_error=0.02, quality="preview", knobs=knobs)
            assert aim(world(), turned, knobs, None, ONE, LEFT).seconds >= 0.999 * found.seconds
    assert found.combinations >= 4
    given = aim(world(), made, {"tables.resolution": 512}, 7, ONE, LEFT)
    assert "tables.resolution" not in given.knobs and given.samples == given.first == 7


def test_tight_errors_take_the_reference():
    found = aim(world(), plan(max_error=1e-5, quality="preview"), {}, None, ONE, LEFT)
    assert found.knobs == {"tables.resolution": 512, "tables.rays": 512} and found.bias == 0.0


def test_a_plan_with_a_target_chooses_its_knobs_and_says_so():
    loose, tight = plan(max_error=0.1), plan(max_error=0.003)
    assert loose.aim.first == 2 and loose.settings.spp < tight.settings.spp
    assert loose.tables[0].resolution < tight.tables[0].resolution
    assert loose.tables[0].rays <= tight.tables[0].rays
    assert "combinations" in tight.explain() and "samples grow from 2" in tight.explain()
    kept = plan(max_error=0.1, knobs={"tables.rays": 512}, spp=8)
    assert kept.tables[0].rays == 512 and kept.settings.spp == kept.aim.first == 8
    assert plan(max_error=0.1, quality="draft").aim is None


def test_prices_of_the_user_go_before_those_shipped(tmp_path, monkeypatch):
    monkeypatch.setenv("SCRATCHWARP_CACHE", str(tmp_path))
    shipped = models.costs()
    assert "costs.json" in shipped.source and shipped.of("camera") > 0.0
    record = {"format": models.FORMAT, "machine": "mine", "nanoseconds": {"camera": 7.0}, "cold": [1, 2],
              "indirect": 1.0, "spread": 2.0, "efficiency": 1.0}  # fmt: skip
    models.user_file().write_text(json.dumps(record))
    assert models.costs().machine == "mine" and models.costs().of("camera") == pytest.approx(7e-9)
    models.user_file().write_text("{")
    assert models.costs().machine == shipped.machine


def test_shipped_errors_fall_from_value_to_value():
    left = models.errors()
    for name, values in left.bias.items():
        assert np.all(np.diff(list(values.values())) <= 0.0), name
        assert list(values.values())[-1] == 0.0, name


def test_a_quality_leaves_a_part_of_its_noise_at_the_lowest_price():
    made = plan(quality="preview")
    found = suited(world(), made, {}, 16, ONE, LEFT)
    assert found.most == pytest.approx(QUALITY_SHARE * 0.5 / 16) and found.bias <= found.most
    assert found.knobs == {"tables.resolution": 256, "tables.rays": 512}  # 0.001 and 0 of 0.00195
    assert suited(world(), made, {}, 4, ONE, LEFT).knobs["tables.resolution"] in (128, 256)
    assert suited(world(), made, {"tables.resolution": 64}, 16, ONE, LEFT).knobs == {"tables.rays": 512}
    elsewhere = replace(world(), camera=S.camera(focal=0.2))
    assert suited(elsewhere, sw.make_plan(elsewhere, sw.Settings(width=64, height=64)), {}, 16, ONE, LEFT) == found


SUN = DistantLight(path="/sun", radiance=np.ones(3), direction=np.array([0.3, 0.0, -0.954]))
GROOVE = replace(S.scratched().layers[0], distribution="linear", width=400.0, depth=100.0, pitch=8000.0, model="groove")


def grooved(*layers, **settings):
    scene = S.scene([S.plane()], [replace(S.scratched(), layers=layers)], [SUN])
    made = sw.make_plan(scene, sw.Settings(**{"width": 64, "height": 64, "threads": 1, "spp": 4, **settings}))
    return work(scene, made)


def test_grooves_cost_by_what_lies_under_a_footprint():
    """Twice as dense, twice the facets a line; crossing ones take as many lines as asked for, parallel ones one."""
    one = grooved(GROOVE).each["grooves", "grooves.lineFacets"]
    two = grooved(replace(GROOVE, pitch=4000.0)).each["grooves", "grooves.lineFacets"]
    assert 1.5 < two / one < 3.0
    crossed = replace(GROOVE, name="cross", distribution="crosshatch")
    few, many = (grooved(crossed, knobs={"grooves.lines": n}).each["grooves.crossings", "grooves.lines"]
                 for n in (48, 192))  # fmt: skip
    assert many == pytest.approx(4.0 * few, rel=1e-6) and few > 5.0 * grooved(GROOVE).each["grooves", "grooves.lines"]


def test_a_footprint_is_a_part_of_a_pixel():
    """At 6 m, 20 mm of aperture at 50 mm over 64 pixels: 37.5 mm a pixel, seen head-on, a fourth of it for 16."""
    scene = S.scene([S.plane()], [S.scratched()], [S.dome()])
    found, = footprints(scene, (64, 64), 16)
    assert found.edge == pytest.approx(1e6 * 0.0375 / 4, rel=0.05) and found.stretch == pytest.approx(1.0, abs=0.05)
    assert found.area == pytest.approx(1e12 * 4.0, rel=1e-6)


def test_scratches_that_diffract_cost_by_the_lights_that_they_see():
    layer = replace(S.scratched().layers[0], distribution="random", density=1.0, width=2.0, depth=0.5)

    def units(light, **knobs):
        scene = S.scene([S.plane()], [replace(S.scratched(), wave=Wave(), layers=(layer,))], [light])
        return work(scene, sw.make_plan(scene, sw.Settings(width=64, height=64, spp=4, knobs=knobs))).each

    area = "diffraction.areaLights"
    dome, few = units(S.dome()), units(S.dome(), **{"diffraction.slices": 2})
    assert dome[area, "diffraction.domes"] > few[area, "diffraction.domes"] > 0.0
    assert units(SUN)["diffraction", "diffraction.points"] > 0.0
    summed = {"diffraction.colors": "wavelengths", "diffraction.wavelengths": 12}
    assert units(S.dome(), **summed)[area, "diffraction.domes"] == pytest.approx(12.0 * dome[area, "diffraction.domes"])
    assert dome["diffraction.segments", "diffraction.strands"] > 0.0


def test_facets_without_tables_are_summed_node_by_node():
    """Each facet at each wavelength, under a dome half as often as under a light with edges, under the sun not."""
    groove = replace(S.scratched().layers[0].profile, shape="vGroove")
    layer = replace(S.scratched().layers[0], distribution="random", density=1.0, width=2.0, depth=0.5, profile=groove)

    def nodes(*lights, colors="wavelengths"):
        scene = S.scene([S.plane()], [replace(S.scratched(), wave=Wave(), layers=(layer,))], lights)
        knobs = {"diffraction.colors": colors, "diffraction.wavelengths": 12}
        found = work(scene, sw.make_plan(scene, sw.Settings(width=64, height=64, spp=4, knobs=knobs)))
        return found.each.get(("diffraction.outlines", "diffraction.nodes"), 0.0)

    assert nodes(S.dome()) > 0.0 and nodes(SUN) == 0.0 and nodes(S.dome(), colors="lookup") == 0.0
    bulb = SphereLight(path="/bulb", radiance=np.ones(3), center=np.array([1.0, 1.0, 3.0]), radius=0.1)
    assert nodes(bulb) == pytest.approx(2.0 * nodes(S.dome()))


def test_cheaper_values_of_knobs_are_predicted_to_be_cheaper():
    """Cone taps under a dome with a picture, lines over crossing grooves, facets of a round section, wavelengths of
    light without extent that no table has, surfaces of a path between two plates."""

    def traced(scene, **knobs):
        settings = sw.Settings(width=64, height=64, spp=4, threads=1, integrator="path", knobs=knobs)
        return forecast(scene, sw.make_plan(scene, settings), ONE).part("trace")

    pictured = replace(S.dome(), texture=0)
    sky = replace(world(), lights=(pictured,), textures=(Texture("/sky", np.ones((2, 4, 4), np.float32)),))
    arc = replace(GROOVE, distribution="crosshatch", profile=Profile("/arc", shape="round"))
    cut = S.scene([S.plane()], [replace(S.scratched(), layers=(arc,))], [SUN])
    thin = replace(S.scratched().layers[0], distribution="random", density=1.0, width=2.0, depth=0.5)
    wave = Wave(phase="exact")
    spectral = S.scene([S.plane()], [replace(S.scratched(), wave=wave, layers=(thin,))], [SUN])
    plates = S.scene([S.plane(), S.plane(path="/other")], [S.scratched()], [S.dome()],
                     instances=[S.place(0, 0, (0, 0, -6)), S.place(1, 0, (0, 0, -5), path="/other")])  # fmt: skip
    cases = (
        (sky, "lights.coneTaps", (1, 4, 64)),
        (cut, "grooves.lines", (4, 24, 192)),
        (cut, "grooves.section", (20, 5, 0)),
        (spectral, "diffraction.wavelengths", (4, 16, 64)),
        (plates, "pathDepth", (1, 2, 4, 8)),
    )
    for scene, name, values in cases:
        seconds = [traced(scene, **{name: value}) for value in values]
        assert np.all(np.diff(seconds) > 0.0), name


def test_noisier_values_take_more_samples():
    """Twice the noise takes twice the samples where relMSE falls as one over samples."""
    taps = {"1": 2.0, "64": 1.0}
    left = replace(LEFT, bias={"lights.coneTaps": {"1": 0.0, "64": 0.0}}, noisier={"lights.coneTaps": taps})
    assert left.more_samples("lights.coneTaps", 1) == 2.0 and left.more_samples("spp", 4) == 1.0
    assert wanted(0.01, left, 2.0) == 2 * wanted(0.01, left) == 128
    pictured = replace(world(), lights=(replace(S.dome(), texture=0),))
    pictured = replace(pictured, textures=(Texture("/sky", np.ones((2, 4, 4), np.float32)),))
    dear = replace(ONE, nanoseconds={"lights.coneTaps": 1e6})
    found = aim(pictured, plan(pictured, max_error=0.02), {}, None, dear, left)
    assert found.knobs["lights.coneTaps"] == 1 and found.samples == wanted(0.02, left, 2.0)


def test_what_costs_nothing_or_is_meant_by_the_stage_is_left_alone():
    """An even dome is integrated without taps; light of one wavelength stays so."""
    left = replace(LEFT, bias={"lights.coneTaps": {"1": 0.001, "64": 0.0}})
    assert not aim(world(), plan(max_error=0.02), {}, None, ONE, left).knobs
    thin = replace(S.scratched().layers[0], distribution="random", density=1.0, width=2.0, depth=0.5)
    left = replace(LEFT, bias={"diffraction.wavelengths": {"4": 0.001, "64": 0.0}})
    for wave, turned in ((Wave(phase="exact"), True), (Wave(phase="exact", wavelength_range=(630.0, 640.0)), False)):
        scene = S.scene([S.plane()], [replace(S.scratched(), wave=wave, layers=(thin,))], [SUN])
        made = plan(scene)
        made = replace(made, settings=replace(made.settings, max_error=0.02))
        found = aim(scene, made, {}, None, ONE, left)
        assert ("diffraction.wavelengths" in found.knobs) == turned


def test_errors_count_by_how_much_of_the_image_shows_them():
    """From ten times as far the ball fills a hundredth, and coarser tables do."""
    far = replace(world(), instances=(S.place(0, 0, (0, 0, -60)),))
    near, small = (aim(w, plan(w, max_error=0.02), {}, None, ONE, LEFT) for w in (world(), far))
    assert small.knobs["tables.resolution"] == 64 < near.knobs["tables.resolution"]
    given = aim(far, plan(far, max_error=0.02), {"tables.resolution": 64, "tables.rays": 512}, None, ONE, LEFT)
    assert given.bias < 0.1 * 0.02
