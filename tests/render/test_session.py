"""Look development: a change does again what it touched and nothing else, and the image ends as a fresh render's."""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp import profiles
from scratchwarp.kernels import geometry
from scratchwarp.render import Session, session
from scratchwarp.render.steps import steps
from scratchwarp.scene import PreviewSurface, SphereLight

from . import scenes

SIZE = {"width": 40, "height": 36, "spp": 5, "filter": "box", "threads": 2, "tile": 8, "effects": scenes.EVERYTHING}
GOLD = PreviewSurface(diffuse_color=(1.0, 0.8, 0.4), metallic=1.0, roughness=0.2)


def lamp(x=2.0):
    return SphereLight(path="/lamp", radiance=(90.0, 80.0, 70.0), center=(x, 2.0, -3.0), radius=0.3)


def world():
    """A scratched ball before a scratched wall of another profile under a lamp and a sky."""
    ball = scenes.scratched(GOLD, fresnel="schlick", width=20000.0, depth=8000.0, length=3e5)
    wall = scenes.scratched(scenes.lambert(0.5), width=9000.0, depth=900.0, length=9e5)
    placed = [scenes.place(0, 0, (0, 0, -6), "/ball"), scenes.place(1, 1, (0.2, 0, -8), "/wall")]
    meshes = [scenes.sphere(), scenes.plane(3.0)]
    return scenes.scene(meshes, [ball, wall], [lamp(), scenes.dome(0.3)], placed)


def with_layer(scene, number=0, **fields):
    """The scene with fields of a material's only layer replaced."""
    materials = list(scene.materials)
    materials[number] = replace(materials[number], layers=(replace(materials[number].layers[0], **fields),))
    return replace(scene, materials=tuple(materials))


@pytest.fixture
def counted(monkeypatch):
    """How often tables are simulated and geometry is built."""
    counts = {"simulate": 0, "geometry": 0}

    def counting(name, function):
        def call(*args, **options):
            counts[name] += 1
            return function(*args, **options)

        return call

    monkeypatch.setattr(profiles, "simulate", counting("simulate", profiles.simulate))
    monkeypatch.setattr(geometry, "pack", counting("geometry", geometry.pack))
    return counts


def finish(looking):
    """The finished film."""
    film = None
    while not looking.finished:
        film = looking.refine() or film
    return film


def rendered(scene, **settings):
    return sw.render(scene, sw.make_plan(scene, sw.Settings(**SIZE | settings)))


def same(a, b):
    for name in b:
        np.testing.assert_array_equal(a[name], b[name], err_msg=name)


def test_the_image_ends_as_a_fresh_render_whatever_was_changed(counted):
    """Camera, light, depth and samples are changed one after the other, at every stage of refinement."""
    looking = Session(world(), sw.Settings(**SIZE))
    looking.refine()
    moved = replace(looking.scene.camera, focal_length=40.0)
    looking.change(camera=moved)
    for _ in range(3):
        looking.refine()
    looking.change(lights=(lamp(-2.0), looking.scene.lights[1]))
    looking.refine(lambda: True)  # one tile, perhaps two
    looking.change(with_layer(looking.scene, depth=5000.0))
    finish(looking)
    looking.change(settings=sw.Settings(**SIZE | {"spp": 7}))
    ends = finish(looking)
    fresh = rendered(looking.scene, spp=7)
    same(ends, fresh)
    assert ends.stats["rays"] == fresh.stats["rays"] and ends.stats["samples"] == fresh.stats["samples"]
    timed = ("scratchwarp:seconds", "scratchwarp:cpuSeconds")
    assert {k: v for k, v in ends.metadata.items() if k not in timed} == {
        k: v for k, v in fresh.metadata.items() if k not in timed
    }


def test_only_what_a_change_touched_is_done_again(counted):
    """Named parts of the record, checked against how often the simulation and the geometry builder were called."""
    looking = Session(world(), sw.Settings(**SIZE))
    first = looking.redone
    assert {"plan", "simulate", "geometry", "lights", "layers", "tables", "film"} <= set(first.seconds)
    assert counted == {"simulate": 2, "geometry": 1} and len(first.simulated) == 2 and first.kept == 0

    def redone(**change):
        before = dict(counted)
        found = looking.change(**change)
        assert (counted["simulate"] > before["simulate"]) == ("simulate" in found)
        assert (counted["geometry"] > before["geometry"]) == ("geometry" in found)
        return set(found.seconds) - {"plan"}

    base = looking.scene
    assert redone() == set()
    assert redone(camera=replace(base.camera, focal_length=45.0)) == {"film"}
    assert redone(lights=(lamp(-1.0), base.lights[1])) == {"lights", "film"}
    assert redone(scene=with_layer(looking.scene, width=19000.0)) == {"simulate", "layers", "tables", "film"}
    assert looking.redone.simulated == (("/mat layer 'fine'",),) and looking.redone.kept == 1
    assert redone(scene=with_layer(looking.scene, coverage=0.2, angle=0.3)) == {"layers", "film"}
    assert redone(scene=with_layer(looking.scene, width=20000.0)) == {"layers", "tables", "film"}, "known table"
    assert redone(scene=with_layer(looking.scene, fresnel="mirror")) == {"simulate", "layers", "tables", "film"}
    gone = replace(looking.scene.materials[0], layers=())
    assert redone(materials=(gone, looking.scene.materials[1])) == {"layers", "tables", "film"}
    assert redone(settings=sw.Settings(**SIZE | {"seed": 3})) == {"film"}
    assert redone(settings=sw.Settings(**SIZE | {"seed": 3, "threads": 1, "tile": 16})) == set()
    bigger = (scenes.sphere(radius=1.1), looking.scene.meshes[1])
    assert redone(meshes=bigger) == {"geometry", "film"}
    assert "redone: plan" in looking.plan.explain()


def test_it_refines_from_small_to_whole():
    """Smaller images come first; each film is that of a render with as many samples, but for the footprint."""
    looking = Session(world(), sw.Settings(**SIZE))
    films = []
    while (film := looking.refine()) is not None:
        films.append((film.full_size, film.metadata["scratchwarp:spp"]))
    assert films == [((10, 9), 1), ((20, 18), 1), ((40, 36), 1), ((40, 36), 2), ((40, 36), 4), ((40, 36), 5)]
    assert looking.finished and looking.samples == 5
    assert [(s.first, s.count) for s in steps(sw.make_plan(world(), sw.Settings(**SIZE | {"spp": 100})))[-4:]] == [
        (16, 16), (32, 32), (64, 32), (96, 4),
    ]  # fmt: skip


def test_a_small_image_shows_the_whole():
    """Each body takes the share of the smaller images that it takes of the whole, at the same distance."""
    looking = Session(world(), sw.Settings(**SIZE | {"width": 64, "height": 64, "spp": 4}))
    smaller = [looking.refine(), looking.refine()]
    whole = finish(looking)
    assert [film["color"].shape for film in smaller] == [(16, 16, 3), (32, 32, 3)]
    for film in smaller:
        for body in (0, 1):
            there, wanted = film["primId"] == body, whole["primId"] == body
            # the outline of either crosses less than 16 * 4 of the 256 pixels, each wrong by a half at most, at random
            assert abs(there.mean() - wanted.mean()) < 0.06
            assert np.median(film["depth"][there]) == pytest.approx(np.median(whole["depth"][wanted]), abs=0.1)


def test_an_interrupted_step_goes_on():
    looking = Session(world(), sw.Settings(**SIZE | {"threads": 1}))
    asked = []
    while looking.refine(lambda: bool(asked.append(1)) or len(asked) % 3 == 0) is None:
        assert not looking.finished
    assert len(asked) >= 3
    same(finish(looking), rendered(looking.scene))


def test_a_crop_refines_to_the_bits_of_the_crop():
    crop = {"crop": (0.2, 0.6, 0.3, 0.9)}
    looking = Session(world(), sw.Settings(**SIZE | crop))
    same(finish(looking), rendered(looking.scene, **crop))


def test_a_senseless_change_leaves_the_session_as_it_was():
    looking = Session(world(), sw.Settings(**SIZE))
    kept = looking.scene
    with pytest.raises(ValueError, match="no such effect"):
        looking.change(settings=sw.Settings(effects={"no such effect": True}))
    assert looking.scene is kept and looking.refine() is not None


def test_tables_that_nobody_asked_for_lately_are_forgotten(counted, monkeypatch):
    monkeypatch.setattr(session, "SPARE_TABLES", 1)
    looking = Session(with_layer(world(), depth=100.0), sw.Settings(**SIZE))
    for depth in (200.0, 300.0, 200.0):
        looking.change(with_layer(looking.scene, depth=depth))
    assert counted["simulate"] == 4
    looking.change(with_layer(looking.scene, depth=100.0))
    assert counted["simulate"] == 5
