"""One profile with its sliders: what moves when they move, and that nothing is left behind."""

import gc
import weakref

import numpy as np
import pytest

import scratchwarp.viewers as viewers
from scratchwarp import profiles
from scratchwarp.plan.profiles import PARAMETERS
from scratchwarp.viewers import cross_sections, display, live_profile, sliders, tables

pyvista = pytest.importorskip("pyvista")


@pytest.fixture
def live():
    """A small window on a V groove."""
    with display.canvas(True, (320, 240)) as plotter:
        yield live_profile.LiveProfile(plotter, *live_profile.chosen("vGroove"), resolution=32, rays=16)


def on_screen(live):
    return np.array(live.plotter.screenshot(return_img=True), float)


def test_depth_changes_table_outline_and_window_in_place(live):
    """The same actors show other pixels and other points, the window other colours."""
    live.set_depth(0.5)
    actors, pixels, points = set(live.plotter.actors), live.sheet.pixels, live.line.points
    before = on_screen(live)
    live.set_depth(0.2)
    assert (live.sheet.pixels != pixels).any()
    # to scale: as wide as before, and two fifths as deep
    assert np.isclose(np.ptp(live.line.points[:, 1]), 0.4 * np.ptp(points[:, 1]))
    assert np.allclose(live.line.points[:, 0], points[:, 0])
    assert set(live.plotter.actors) == actors
    height, width = before.shape[:2]
    changed = np.abs(on_screen(live) - before).max(-1) > 30
    table, outline = changed[height // 5 : 3 * height // 4, : width // 2], changed[: 3 * height // 4, width // 2 :]
    assert table.mean() > 0.05 and outline.sum() > 20


def test_the_table_is_the_one_of_the_depth(live):
    """As simulated by itself, and drawn as ``profiles.picture`` draws it."""
    live.set_depth(0.8)
    wanted = profiles.simulate(profiles.shape("vGroove", depth=0.8), resolution=32, rays=16)
    assert np.array_equal(live.table.mirror, wanted.mirror)
    assert np.array_equal(live.sheet.pixels, (255 * tables.bounces(wanted) + 0.5).astype(np.uint8))
    assert min(live.spent) > 0


def test_bounces_are_red_green_and_blue():
    """A groove of slope 3 sends steep light back after one to three bounces; grey is the margin, sRGB of 0.18."""
    pixels = tables.bounces(profiles.simulate(profiles.shape("vGroove", depth=1.5), resolution=32, rays=64))
    inner = pixels[5:-5, 5:-5]
    assert all((inner.argmax(-1)[inner.sum(-1) > 0] == channel).any() for channel in range(3))
    assert np.allclose(pixels[0, 0], 1.055 * 0.18 ** (1 / 2.4) - 0.055)


def test_a_mouse_on_the_slider_turns_it(live):
    """VTK's own events: grab the depth slider where it is, move it to its right end, let go."""
    live.plotter.show(auto_close=False, interactive=False)
    wide, high = live.plotter.window_size
    (left, y), (right, _) = live_profile.PLACES[0]
    interactor = live.plotter.iren.interactor
    share = live.section.depth / 2.0
    # the tube is as long as the two ends are apart, less the end caps: grab within the slider's own length
    places = [left + share * (right - left), left + 0.75 * (right - left), right]
    for event, x in zip(("LeftButtonPress", "MouseMove", "MouseMove"), places, strict=True):
        interactor.SetEventInformation(round(x * wide), round(y * high), 0, 0)
        interactor.InvokeEvent(f"{event}Event")
    assert "simulated in" in live._status.input
    coarse = live.table.metadata["rays"]
    interactor.InvokeEvent("LeftButtonReleaseEvent")
    assert np.isclose(live.section.depth, 2.0)
    assert live.table.metadata["rays"] == live_profile.FINE * coarse
    assert np.ptp(live.line.points[:, 1]) > 0.8


def test_every_number_of_a_shape_has_a_slider(live):
    """The schema's parameters, and rims; turning each changes what is simulated."""
    assert set(cross_sections.KNOBS) == {schema for pairs in PARAMETERS.values() for schema, _ in pairs}
    assert max(len(cross_sections.of_shape(name).knobs) for name in profiles.shape_names()) <= len(live_profile.PLACES)
    assert list(live.sliders) == ["depth", "rim", "rimWidth", "apex"]
    live.set("rim", 0.3)
    for name, value in (("rimWidth", 0.1), ("apex", 0.3), ("depth", 0.6)):
        before = live.profile.token
        live.set(name, value)
        assert live.profile.token != before
        assert np.isclose(live.sliders[name].GetRepresentation().GetValue(), value)
    wanted = profiles.shape("vGroove", depth=0.6, rim=0.3, rim_width=0.1, apex=0.3, isolated=True)
    assert live.profile.token == wanted.token


def test_numbers_start_where_the_schema_does():
    """The defaults of the sliders are those of ``profiles.shape``."""
    for name in profiles.shape_names():
        section = cross_sections.of_shape(name)
        turned = section.turned({knob.name: knob.value for knob in section.knobs})
        assert turned.profile().token == profiles.shape(name, isolated=True).token


def test_a_bad_number_is_refused_and_nothing_moves(live):
    """ValueError names it; the slider and the picture stay."""
    before = live.section
    for name, value in (("depth", -1.0), ("sigma", 0.1)):
        with pytest.raises(ValueError, match=name):
            live.set(name, value)
    assert live.section is before and live.sliders["depth"].GetRepresentation().GetValue() == before.depth


def test_keys_go_through_shapes(live):
    """n takes the next choice, k the next shape at this depth, g repeats; sliders follow the shape."""
    live.connect()
    live.set_depth(0.7)
    live.next_choice()
    assert live.section.record.shape == "rectangle" and live.section.depth == 0.5
    live.set_depth(0.7)
    live.next_shape()
    assert live.section.record.shape == "trapezoid" and live.section.depth == 0.7
    assert list(live.sliders) == ["depth", "rim", "rimWidth", "floorWidth", "apex"]
    live.repeat()
    assert live.profile.isolated is False and live.section.depth == 0.7
    # three periods, end to end
    assert np.isclose(np.ptp(live_profile.outline(live.profile)[:, 0]), 3.0)


def test_flat_ground_can_be_shown(live):
    """Zero depth is a line of no height."""
    live.set_depth(0.0)
    assert np.ptp(live.line.points[:, 1]) == 0.0


def test_layers_of_a_scene(make_scene, make_layer):
    """Each with its depth in widths; other layers can be put back into the scene."""
    scene = make_scene((make_layer("fine", width=10.0, depth=4.0), make_layer("deep", width=2.0, depth=6.0)))
    found = cross_sections.of_scene(scene)
    assert [(s.title, s.depth) for s in found] == [("mtl: fine", 0.4), ("mtl: deep", 3.0)]
    assert found[1].knobs[0].high == 6.0  # room for twice the depth
    from dataclasses import replace

    from scratchwarp.viewers.colors import shown

    items = shown(scene)
    items[1] = items[1]._replace(layer=replace(items[1].layer, depth=1.0))
    changed = cross_sections.rescratched(scene, items)
    assert [layer.depth for layer in changed.materials[0].layers] == [4.0, 1.0]
    assert [layer.depth for layer in scene.materials[0].layers] == [4.0, 6.0]


def test_a_stage_is_asked_for_a_layer_by_name(tmp_path):
    """Its short name will do; one that is not there is told with those that are."""
    from scratchwarp.pipelines import author_demo

    stage = author_demo.author(tmp_path, 0.1, ["ball"])[0]
    choices, first = live_profile.chosen(stage, "hairlines")
    assert choices[first].title == "ball: hairlines" and len(choices) > 5
    with pytest.raises(ValueError, match=r"nothing.*ball: hairlines"):
        live_profile.chosen(stage, "nothing")


def test_a_screenshot_without_a_display(tmp_path, monkeypatch):
    """The entry that the command line uses: sliders, table and outline are in the picture."""
    monkeypatch.delenv("DISPLAY", raising=False)
    viewers.view_profile("quartic", tmp_path / "look.png", depth=0.3, size=(320, 240))
    pixels = pyvista.read(tmp_path / "look.png").active_scalars.reshape(240, 320, -1)[..., :3].astype(float)
    for part in (pixels[60:, :160], pixels[60:, 160:], pixels[:50]):
        assert (np.abs(part - part[0, 0]).max(-1) > 30).sum() > 50
    with pytest.raises(ValueError, match="depth"):
        viewers.view_profile("quartic", tmp_path / "no.png", depth=-1.0)
    with pytest.raises(ValueError, match="no.foo"):
        viewers.view_profile("quartic", tmp_path / "no.foo")
    assert [p.name for p in tmp_path.iterdir()] == ["look.png"]


def test_nothing_is_left_when_the_window_closes():
    """Neither the plotter nor what its sliders call."""
    left = []
    with display.canvas(True, (64, 48)) as plotter:
        made = live_profile.LiveProfile(plotter, *live_profile.chosen("sine"), resolution=16, rays=8)
        made.connect()
        made.next_choice()
        left += [weakref.ref(made), weakref.ref(plotter), weakref.ref(made.sheet)]
    del made, plotter
    gc.collect()
    assert [ref() for ref in left] == [None, None, None]


def test_a_slider_is_silent_until_it_is_moved(live):
    """Making one calls nothing: the number is there already."""
    calls = []
    knob = cross_sections.Knob("x", 0.0, 1.0, 0.25)
    widget = sliders.slider(live.plotter, knob, ((0.1, 0.5), (0.4, 0.5)), calls.append)
    assert calls == []
    widget.GetRepresentation().SetValue(0.5)
    widget.InvokeEvent("InteractionEvent")
    assert calls == [0.5]
