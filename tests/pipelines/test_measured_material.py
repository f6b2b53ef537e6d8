"""Stencil models as USD Materials: every number comes back, and other programs find a likeness."""

from dataclasses import replace

import numpy as np
from pxr import Usd, UsdShade

from scratchwarp import measured, stencils
from scratchwarp.pipelines import measured_material as pipeline
from scratchwarp.reflectance.stencils import Mode, Model
from scratchwarp.stage.validation import validate

TWO = Model(
    (
        Mode(0.5, 0.7, 0.9, 0.02, 0.02, 0.3, 12.0, (0.3, 0.5, 0.9)),
        Mode(1.9, 0.6, 1.0, 0.0, 0.03, 0.2, 9.0, (0.9, 0.4, 0.2)),
    ),
    beta=0.2, background=0.03, k=1.3, specular_alpha=20,
)  # fmt: skip


def _read(path):
    """The model of a layer, by the schema's names."""
    stage = Usd.Stage.Open(str(path))
    prim = stage.GetDefaultPrim()

    def get(name):
        return prim.GetAttribute(f"scratch:measured:{name}").Get()

    names = ("width", "a", "b", "kd", "ks", "alpha")
    rows = zip(get("modes:azimuth"), get("modes:color"), *(get(f"modes:{n}") for n in names), strict=True)
    modes = tuple(Mode(np.radians(row[0]), *row[2:], tuple(row[1])) for row in rows)
    beta = tuple(get("modes:beta")) or get("beta")
    numbers = get("background")[0], get("k"), get("specularAlpha")
    return Model(modes, beta, *numbers, retro=get("retro"), mask=get("mask"))


def test_every_number_comes_back(tmp_path):
    path = pipeline.author(TWO, tmp_path / "two-tone cloth.usda")
    assert [str(finding) for finding in validate(path)] == []
    stage = Usd.Stage.Open(str(path))
    prim = stage.GetDefaultPrim()
    assert prim.GetName() == "two_tone_cloth" and prim.HasAPI("ScratchMeasuredAPI")
    # degrees and float32
    np.testing.assert_allclose(stencils.unfolded(_read(path)), stencils.unfolded(TWO), rtol=1e-4, atol=1e-6)


def test_what_only_some_models_have(tmp_path):
    """A translucency for each crossing, retro-reflection, binary masks."""
    third = Mode(2.5, 0.6, 1.0, 0.0, 0.01, 0.2, 12.0, (0.1, 0.9, 0.2))
    model = replace(TWO, modes=(*TWO.modes, third), beta=(0.1, 0.7), retro=True, mask="binary")
    path = pipeline.author(model, tmp_path / "a.usda")
    assert [str(finding) for finding in validate(path)] == []
    found = _read(path)
    assert found.retro and found.mask == "binary"
    np.testing.assert_allclose(found.beta, (0.1, 0.7), rtol=1e-6)


def test_editing_the_layer_is_editing_the_model(tmp_path):
    """An axis moved in the file moves the highlight as ``edit`` does."""
    path = pipeline.author(TWO, tmp_path / "a.usda")
    stage = Usd.Stage.Open(str(path))
    attribute = stage.GetDefaultPrim().GetAttribute("scratch:measured:modes:azimuth")
    attribute.Set([attribute.Get()[0] + 30.0, attribute.Get()[1]])
    stage.Save()
    turned = TWO.edit(0, azimuth=0.5 + np.radians(30.0))
    np.testing.assert_allclose(stencils.unfolded(_read(path)), stencils.unfolded(turned), rtol=1e-4, atol=1e-6)


def test_likeness(tmp_path):
    """A matte model is a matte shader of its albedo; a shiny one is metallic, the narrower the smoother."""
    matte = pipeline.likeness(Model((Mode(0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, (0.2, 0.1, 0.05)),)))
    # a grid of 4 degrees over the cosine
    np.testing.assert_allclose(matte["diffuseColor"], np.pi * np.array([0.2, 0.1, 0.05]), rtol=0.01)
    assert matte["metallic"] < 0.01
    flat = Mode(0.0, 0.0, 1.0, 0.0, 2e-4, 0.0, 1.0)
    wide, narrow = (pipeline.likeness(Model((flat,), k=500.0, specular_alpha=alpha)) for alpha in (5.0, 100.0))
    assert narrow["metallic"] > 0.9 and narrow["roughness"] < wide["roughness"]
    path = pipeline.author(TWO, tmp_path / "a.usda")
    stage = Usd.Stage.Open(str(path))
    shader, _, _ = UsdShade.Material(stage.GetDefaultPrim()).ComputeSurfaceSource()
    assert shader.GetIdAttr().Get() == "UsdPreviewSurface" and 0 <= shader.GetInput("roughness").Get() <= 1


def test_the_script(tmp_path, capsys):
    measured.save_utia(tmp_path / "a.bin", stencils.unfolded(replace(TWO, beta=0.0)))
    words = [str(tmp_path / "a.bin"), str(tmp_path / "a.usda"), "--no-refine"]
    assert pipeline.main(words) == 0 and "2 modes" in capsys.readouterr().out
    assert pipeline.main([words[0], str(tmp_path / "a.obj"), "--no-refine"]) == 1
    error = capsys.readouterr().err
    assert error.startswith("measured_material: ") and ".usda" in error and len(error.splitlines()) == 1
