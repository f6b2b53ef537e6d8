"""The whole window, off-screen: something is drawn everywhere, and nothing is left behind."""

import gc
import sys
import weakref

import numpy as np
import pytest

import scratchwarp.viewers as viewers
from scratchwarp.viewers import camera, display, image, profiles, tables, window

pyvista = pytest.importorskip("pyvista")


@pytest.fixture
def no_render(monkeypatch):
    """A checkerboard in place of the rendered image: these tests are about the window."""
    board = (np.indices((30, 40)).sum(0) // 5 % 2)[..., None] * np.ones(3)
    monkeypatch.setattr(image, "picture", lambda *args: board)


@pytest.fixture
def layers(make_layer):
    return make_layer("fine", distribution="worley", angle_spread=1.0), make_layer("turned", distribution="concentric")


def test_a_screenshot_shows_something_in_every_part(make_scene, layers, no_render, tmp_path, monkeypatch):
    """Without a display, each quarter of the picture has more than its background."""
    monkeypatch.delenv("DISPLAY", raising=False)
    path = tmp_path / "shot.png"
    window.show(make_scene(layers), path, size=(640, 480))
    pixels = pyvista.read(path).active_scalars.reshape(480, 640, -1)[..., :3].astype(float)
    for rows in (slice(0, 240), slice(240, 480)):
        for columns in (slice(0, 320), slice(320, 640)):
            part = pixels[rows, columns]
            other = np.abs(part - part[5, -5]).max(-1) > 30
            assert other.mean() > 0.01, (rows, columns)
    assert [p.name for p in tmp_path.iterdir()] == ["shot.png"]


def test_nothing_is_left_when_the_window_closes(make_scene, layers, no_render, tmp_path, monkeypatch):
    """The plotter is collected, also after an error while drawing."""
    seen = []
    real = pyvista.Plotter

    def plotter(*args, **keywords):
        made = real(*args, **keywords)
        seen.append(weakref.ref(made))
        return made

    monkeypatch.setattr(pyvista, "Plotter", plotter)
    window.show(make_scene(layers), tmp_path / "a.png", size=(64, 48))
    monkeypatch.setattr(profiles, "add", lambda *args: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        window.show(make_scene(layers), tmp_path / "b.png", size=(64, 48))
    gc.collect()
    assert len(seen) == 2 and [ref() for ref in seen] == [None, None]


@pytest.mark.parametrize(("name", "error"), [("no/such/a.png", OSError), ("a.foo", ValueError)])
def test_a_bad_file_name_is_told_before_anything_is_read(tmp_path, name, error):
    """The stage does not exist either, but the message is about the picture."""
    with pytest.raises(error, match=name):
        viewers.view(tmp_path / "nothing.usda", tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_keys_do_what_the_help_says(make_scene, make_layer, no_render):
    """Groups are hidden and shown, pages turn, and a picture from where the window looks has that camera."""
    scene = make_scene(tuple(make_layer(f"layer{i}", width=10.0 + i) for i in range(14)))
    with display.drawing(True):
        plotter = pyvista.Plotter(shape=(2, 2), off_screen=True, window_size=[320, 240])
        try:
            made = window.Window(plotter, scene, 64, 1, 0)
            made.toggle("directions")
            assert not any(actor.GetVisibility() for actor in made.groups["directions"])
            made.toggle("directions")
            assert all(actor.GetVisibility() for actor in made.groups["directions"])
            made.edges()
            assert all(actor.prop.show_edges for actor in made.groups["meshes"])
            made.next_page()
            plotter.subplot(1, 0)
            assert made.page == 1 and len(made.plots) == 2
            made.next_page()
            assert made.page == 0
            made.look_through()
            assert np.allclose(plotter.renderers[0].camera.position, [0, 0, 4])
            made.render_from_here()
        finally:
            plotter.close()


def test_the_depth_slider_moves_one_layer(make_scene, layers, monkeypatch):
    """Its outline, its numbers and its table change in place, the other's do not; rendering again has that depth."""
    given = []
    monkeypatch.setattr(image, "picture", lambda *args: given.append(args[0]) or np.zeros((3, 4, 3)))
    with display.canvas(True, (320, 240), (2, 2)) as plotter:
        made = window.Window(plotter, make_scene(layers), 64, 1, 0)
        made.next_layer()
        plotter.render_window.Render()
        upper = np.array(plotter.screenshot(return_img=True))[:120]
        made.slider.InvokeEvent("StartInteractionEvent")
        kept = [set(renderer.actors) for renderer in plotter.renderers]
        pixels, points = [s.pixels for s in made.sheets], [p.line.points for p in made.plots]
        made.set_depth(5.0)
        assert [(s.pixels != old).any() for s, old in zip(made.sheets, pixels, strict=True)] == [False, True]
        assert [(p.line.points != old).any() for p, old in zip(made.plots, points, strict=True)] == [False, True]
        assert "5 deep" in made.plots[1].size.input and "5 deep" not in made.plots[0].size.input
        assert [set(renderer.actors) for renderer in plotter.renderers] == kept
        made.slider.InvokeEvent("EndInteractionEvent")
        plotter.render_window.Render()
        assert np.array_equal(np.array(plotter.screenshot(return_img=True))[:120], upper)
        made.render_from_here()
        depths = [[layer.depth for layer in scene.materials[0].layers] for scene in given]
        assert depths == [[1.0, 1.0], [1.0, 5.0]]


def test_rendering_from_the_window_looks_through_its_camera(make_scene, make_layer, monkeypatch):
    """The camera handed to the renderer stands where the window's eye is and sees the same window."""
    given = []
    monkeypatch.setattr(image, "picture", lambda *args: given.append(args) or np.zeros((3, 4, 3)))
    scene = make_scene(())
    with display.drawing(True):
        plotter = pyvista.Plotter(shape=(2, 2), off_screen=True, window_size=[320, 240])
        try:
            window.Window(plotter, scene, 64, 1, 0).render_from_here()
        finally:
            plotter.close()
    here, stage = given[-1][3], scene.camera
    assert np.allclose(here.transform, stage.transform)
    assert np.allclose(here.window(640, 480), stage.window(640, 480))


def test_the_frustum_is_what_the_camera_sees(make_scene):
    """The far corners of the frustum lie on the camera's window, scaled by the depth."""
    seen = make_scene(()).camera
    lines = camera.frustum(seen, 4 / 3, 2.0)
    left, right, bottom, top = seen.window(400, 300)
    # the aspect is rounded to 1000 pixels: half a pixel of 750
    assert np.abs(lines[2, 1] - [2 * right, 2 * top, 4 - 2]).max() < 1e-3
    assert np.allclose(lines[:4, 0], [0, 0, 4])
    assert left < 0 < right and bottom < 0 < top


def test_a_light_without_a_place_has_no_shape(make_scene):
    """Domes are not drawn; every other light is."""
    shapes = [camera.light_shape(light, np.zeros(3), 1.0) for light in make_scene(()).lights]
    assert [shape is None for shape in shapes] == [False] * 5 + [True]
    assert all(shape.n_points > 0 for shape in shapes[:5])


def test_profiles_are_to_scale(make_layer):
    """A V groove 20 um wide and 5 um deep, about the middle."""
    line = profiles.micrometres(make_layer(width=20.0, depth=5.0))
    assert np.allclose(line, [[-10, 0], [0, -5], [10, 0]])


def test_a_table_is_brightest_where_it_reflects(make_scene, make_layer):
    """A flat profile is a mirror: phi_o = -phi_i, the diagonal from the top left of the picture to its bottom right."""
    from scratchwarp.viewers.colors import shown

    item = shown(make_scene((make_layer(depth=0.0),)))[0]
    pixels = tables.picture(item, resolution=16, rays=64).sum(-1)
    assert np.all(pixels.argmax(0) == np.arange(16))


def test_missing_pyvista_says_what_to_install(monkeypatch):
    """The message names the extra."""
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match=r'pip install "scratchwarp\[viewers\]"'):
        viewers.view("ball.usda", "a.png")


def test_no_display_says_so(monkeypatch):
    """On Linux without a display a window is refused before VTK crashes, and so is a picture without EGL or OSMesa."""
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv(display.WINDOW, raising=False)
    with pytest.raises(OSError, match="--screenshot"), display.drawing(False):
        pass
    monkeypatch.setattr("ctypes.util.find_library", lambda name: None)
    with pytest.raises(OSError, match="libEGL"), display.drawing(True):
        pass


def test_a_stage_is_shown_from_file_to_picture(tmp_path, monkeypatch):
    """The entry that the command line uses, with a rendered image."""
    from scratchwarp.pipelines import author_demo

    monkeypatch.delenv("DISPLAY", raising=False)
    stage = author_demo.author(tmp_path, 0.1, ["plain"])[0]
    viewers.view(stage, tmp_path / "look.png", width=48, spp=1, size=(320, 240))
    pixels = pyvista.read(tmp_path / "look.png").active_scalars.reshape(240, 320, -1)[120:, 160:, :3]
    assert pixels.std() > 10  # pyvista's rows run upwards: the upper right quarter is the image
