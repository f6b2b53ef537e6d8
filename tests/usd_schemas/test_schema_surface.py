"""ScratchSurface, the shading node of the base."""

import pytest
from pxr import Sdr, UsdShade, UsdValidation

from scratchwarp import usd_schemas

INPUTS = {
    "base": "conductor",
    "metal": "aluminium",
    "eta": (1.3456, 0.9652, 0.6172),
    "k": (7.4746, 6.3995, 5.3031),
    "color": (0, 0, 0),
    "roughness": 0.05,
    "anisotropy": 0.0,
    "anisotropyRotation": 0.0,
    "ior": 1.5,
}


@pytest.fixture
def node():
    usd_schemas.register_shaders()
    return Sdr.Registry().GetShaderNodeByIdentifier("ScratchSurface")


def test_inputs_and_output(node):
    assert set(node.GetShaderInputNames()) == set(INPUTS)
    assert list(node.GetShaderOutputNames()) == ["surface"]


@pytest.mark.parametrize("name", INPUTS)
def test_default(node, name):
    default, expected = node.GetShaderInput(name).GetDefaultValueAsSdfType(), INPUTS[name]
    if isinstance(expected, str):
        assert default == expected
    else:
        assert default == pytest.approx(expected, rel=1e-6)


def test_registering_again_adds_nothing(node):
    usd_schemas.register_shaders()
    assert len(Sdr.Registry().GetShaderNodesByIdentifier("ScratchSurface")) == 1


def test_other_renderers_keep_their_surface(stage, material, node):
    """The render context scratchwarp wins for us; every other context falls back to outputs:surface."""
    surface = UsdShade.Material(material)
    for name, identifier in (("Preview", "UsdPreviewSurface"), ("Own", "ScratchSurface")):
        shader = UsdShade.Shader.Define(stage, f"/Material/{name}")
        shader.CreateIdAttr(identifier)
        context = "scratchwarp" if name == "Own" else ""
        surface.CreateSurfaceOutput(context).ConnectToSource(shader.ConnectableAPI(), "surface")
    assert surface.ComputeSurfaceSource("scratchwarp")[0].GetPath() == "/Material/Own"
    assert surface.ComputeSurfaceSource("")[0].GetPath() == "/Material/Preview"


def test_passes_the_shader_check_of_usd(stage, material, node):
    shader = UsdShade.Shader.Define(stage, "/Material/Own")
    shader.CreateIdAttr("ScratchSurface")
    registry = UsdValidation.ValidationRegistry()
    validator = registry.GetOrLoadValidatorByName("usdShadeValidators:ShaderSdrCompliance")
    assert [error.GetMessage() for error in validator.Validate(shader.GetPrim())] == []
