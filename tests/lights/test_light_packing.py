"""Records to device arrays: order, fields, shaping, textures."""

import numpy as np
import pytest

from scratchwarp import lights
from scratchwarp.lights.light_device import Light
from scratchwarp.scene import Light as LightRecord
from scratchwarp.scene import Shaping, Texture

from .light_cases import ORIGIN, UP, cylinder, disk, distant, dome, packed_mesh, rect, sphere


def test_lights_are_grouped_by_kind():
    packed = lights.pack_lights([sphere(), rect(), sphere(radius=0.1), dome(), rect(diffuse=0.5)])
    assert packed.kinds == ("sphere", "rect", "dome")
    assert [m.name for m in packed.models] == list(packed.kinds)
    assert packed.slots.tolist() == [0, 0, 1, 0, 1]
    spheres = packed.lights["sphere"].numpy()
    assert spheres["radius"].tolist() == [0.5, np.float32(0.1)] and spheres["index"].tolist() == [0, 2]
    assert packed.lights["rect"].numpy()["diffuse"].tolist() == [1.0, 0.5]
    assert lights.pack_lights([]).kinds == ()


def test_every_kind_has_its_name_and_record():
    names = [m.name for m in lights.MODELS.values()]
    assert len(set(names)) == len(names) == len(set(lights.MODELS))
    assert [m.name for m in lights.MODELS.values() if m.geometry] == ["mesh"]


def test_shadows_and_links():
    light = rect(shadow=False, shadow_color=(0.1, 0.2, 0.3), shadow_distance=5.0, linked=frozenset({1}))
    packed = lights.pack_lights([sphere(), light]).lights["rect"].numpy()[0]
    assert packed["shadow"] == 0 and packed["shadow_distance"] == 5.0 and packed["link"] == 1
    assert packed["shadow_link"] == -1
    np.testing.assert_allclose(packed["shadow_color"], (0.1, 0.2, 0.3), rtol=1e-6)
    plain = lights.pack_lights([sphere()]).lights["sphere"].numpy()[0]
    assert plain["link"] == -1 and plain["shadow"] == 1 and plain["shadow_distance"] >= 1e9
    assert set(plain.dtype.names) == set(Light.vars)


def test_lights_without_area_are_reported():
    packed = lights.pack_lights([rect(ex=(0, 0, 0)), sphere(radius=0.0), cylinder(radius=0.0)])
    assert len(packed.warnings) == 2 and packed.warnings[0].startswith("/rect") and "/cylinder" in packed.warnings[1]


def test_unknown_records_and_textures_are_refused():
    with pytest.raises(ValueError, match="/odd.*Light"):
        lights.pack_lights([LightRecord(path="/odd", radiance=(1, 1, 1))])
    with pytest.raises(ValueError, match="/rect.*texture 3"):
        lights.pack_lights([rect(texture=3)])


def test_textures_in_use_are_packed_once():
    textures = [Texture(f"/{i}", np.full((2, 2 + i, 4), float(i), np.float32)) for i in range(3)]
    packed = lights.pack_lights([rect(texture=2), dome(texture=1), rect(texture=2)], textures)
    assert packed.arrays.atlas.width.numpy().tolist() == [4, 3]
    assert packed.lights["rect"].numpy()["texture"].tolist() == [0, 0]


def test_image_on_a_rect_stands_upright():
    """Seen from the lit side with ey up, the image's first row is on top and its first column on the left."""
    pixels = np.zeros((2, 2, 4), np.float32)
    pixels[0, 0, :3], pixels[0, 1, :3], pixels[1, 0, :3] = (1, 0, 0), (0, 1, 0), (0, 0, 1)
    light = rect(center=(0, 0, 1), ex=(1, 0, 0), ey=(0, 1, 0), texture=0, radiance=(2, 2, 2))
    packed = lights.pack_lights([light], [Texture("/image", pixels)])
    corners = {(1, 1): (2, 0, 0), (-1, 1): (0, 2, 0), (1, -1): (0, 0, 2), (-1, -1): (0, 0, 0)}
    for (a, b), expected in corners.items():
        w = np.array([0.9 * a, 0.9 * b, 1.0])
        found = lights.hit(packed, ORIGIN, w / np.linalg.norm(w))["radiance"]
        np.testing.assert_allclose(found, expected, atol=1e-6)


LAMPS = [
    lambda s: sphere(center=(0, 0, 1), radius=0.3, shaping=s),
    lambda s: sphere(center=(0, 0, 1), radius=0.0, shaping=s),
    lambda s: rect(center=(0, 0, 1), shaping=s),
    lambda s: disk(center=(0, 0, 1), shaping=s),
    lambda s: cylinder(center=(0, 0, 1), axis=(0.4, 0, 0), shaping=s),
    lambda s: packed_mesh(shaping=s),
]


@pytest.mark.parametrize("lamp", LAMPS)
def test_shaping(lamp):
    """UsdLux: focus factor |cos|^focus between tint and white; 1 - smoothstep from (1 - softness) cone to cone."""
    shaping = Shaping(focus=3.0, focus_tint=(0.0, 0.2, 1.0), cone_angle=0.7, cone_softness=0.5)
    x = np.array([[0.0, 0, 0], [0.4, 0.1, 0.2], [0.9, 0.0, 0.5], [0.0, 0.0, 1.9]])[:, None]
    u = np.random.default_rng(0).random((50, 2))
    plain, shaped = lights.sample(lamp(None), x, u), lights.sample(lamp(shaping), x, u)
    np.testing.assert_array_equal(plain["wi"], shaped["wi"])
    cosine = shaped["wi"][..., 2].astype(float)  # of the emission against -z
    t = np.clip((np.arccos(np.clip(cosine, -1, 1)) - 0.35) / 0.35, 0, 1)
    fall = (1 - t * t * (3 - 2 * t))[..., None]
    tint = np.array([0.0, 0.2, 1.0])
    expected = plain["radiance"] * fall * (tint + (np.abs(cosine) ** 3)[..., None] * (1 - tint))
    np.testing.assert_allclose(shaped["radiance"], expected, atol=2e-6 * max(plain["radiance"].max(), 1))


def test_default_shaping_cuts_the_back():
    lamp = sphere(center=(0, 0, 1), radius=0.3, shaping=Shaping())
    assert lights.irradiance(lamp, ORIGIN, UP, samples=64)[0] > 0.2
    assert lights.irradiance(lamp, (0, 0, 2), -UP, samples=64)[0] == 0.0


def test_distant_direction_is_the_way_it_travels():
    s = lights.sample(distant(direction=(0, 0, -2.0), angle=0.0), ORIGIN, (0.5, 0.5))
    np.testing.assert_allclose(s["wi"], UP, atol=1e-7)
    assert s["pdf"] == -1
