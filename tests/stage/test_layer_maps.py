"""Masks and orientations of layers: textures without a colour space, primvars of the meshes."""

import numpy as np
import pytest

from scratchwarp.stage import LiveStage

from .test_layer import PROFILE, ST, VEE, layer, scratched

MAPS = """
    uniform asset scratch:layer:fine:maskTexture = @mask.png@
    uniform asset scratch:layer:fine:orientationTexture = @brush.exr@
    uniform token scratch:layer:fine:orientationEncoding = "angle"
"""
NAMED = """
    uniform token scratch:layer:fine:maskPrimvar = "wear"
    uniform token scratch:layer:fine:orientationPrimvar = "brush"
"""


@pytest.fixture
def images(tmp_path):
    """Files that exist; a loader that notes what it was asked for."""
    for name in ("mask.png", "brush.exr"):
        (tmp_path / name).write_bytes(b"")
    asked = []

    def load(path, space):
        asked.append((str(path).rpartition("/")[2], space))
        return np.full((2, 2, 4), 0.5, np.float32)

    return load, asked


def test_textures_are_read_raw(read, images):
    load, asked = images
    scene = read(scratched(PROFILE + MAPS, children=VEE), load_texture=load)
    got = layer(scene)
    assert asked == [("mask.png", "raw"), ("brush.exr", "raw")]
    assert (got.mask_texture, got.orientation_texture, got.orientation_encoding) == (0, 1, "angle")
    assert len(scene.textures) == 2 and not any("mask" in w or "orientation" in w for w in scene.warnings)
    plain = layer(read(scratched(PROFILE, children=VEE)))
    assert (plain.mask_texture, plain.orientation_texture, plain.mask_primvar) == (-1, -1, "")
    assert plain.orientation_encoding == "vector"


def test_a_missing_image_warns(read, said):
    scene = read(scratched(PROFILE + MAPS, children=VEE))
    said(scene, "/mat layer 'fine'", "mask.png")
    assert layer(scene).mask_texture == -1


@pytest.mark.parametrize(
    ("declared", "shape"),
    [
        ('float[] primvars:wear = [0, 1, 2, 3] (interpolation = "vertex")', 1),
        ('float[] primvars:wear = [0.5] (interpolation = "uniform")', 1),
        ("double primvars:wear = 0.25", 1),
    ],
)
def test_masks_from_primvars(read, declared, shape):
    scene = read(scratched(PROFILE + NAMED, children=VEE, mesh=ST + declared + "\n"))
    values = scene.meshes[0].primvars["wear"]
    assert values.shape == (2, 3, shape)
    if "vertex" in declared:
        np.testing.assert_array_equal(values[..., 0], scene.meshes[0].triangles)


@pytest.mark.parametrize(
    ("declared", "shape"),
    [
        ('vector3f[] primvars:brush = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0)] (interpolation = "vertex")', 3),
        ('float2[] primvars:brush = [(1, 0), (0, 1), (0, 1), (1, 0)] (interpolation = "faceVarying")', 2),
        ('float[] primvars:brush = [30] (interpolation = "constant")', 1),
    ],
)
def test_directions_from_primvars(read, said, declared, shape):
    scene = read(scratched(PROFILE + NAMED, children=VEE, mesh=ST + declared + "\n"))
    assert scene.meshes[0].primvars["brush"].shape == (2, 3, shape)
    assert layer(scene).orientation_primvar == "brush"
    said(scene, "/m:", "primvars:wear", "'fine'")
    assert "wear" not in scene.meshes[0].primvars


def test_primvars_that_no_layer_reads_stay_away(read):
    scene = read(scratched(PROFILE, children=VEE, mesh=ST + "float primvars:wear = 1\n"))
    assert not scene.meshes[0].primvars


def test_what_goes_unused_warns(read, said, images):
    body = PROFILE + MAPS + NAMED
    mesh = ST + "float primvars:wear = 1\nfloat primvars:brush = 1\n"
    said(read(scratched(body, children=VEE, mesh=mesh), load_texture=images[0]), "the primvar is used")
    rings = 'uniform token scratch:layer:fine:distribution = "spiral"\n'
    said(read(scratched(rings + body, children=VEE, mesh=mesh), load_texture=images[0]), "directions of its own")


def test_an_edit_that_names_another_primvar_reads_it(write):
    mesh = ST + "float primvars:wear = 1\nfloat primvars:dust = 0.5\n"
    live = LiveStage(write(scratched(PROFILE + NAMED, children=VEE, mesh=mesh)))
    assert set(live.scene.meshes[0].primvars) == {"wear"}
    scene = live.edit({"/mat.scratch:layer:fine:maskPrimvar": "dust"})
    assert "dust" in scene.meshes[0].primvars and layer(scene).mask_primvar == "dust"
