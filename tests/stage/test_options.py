"""Render settings, products and vars."""

import pytest

from scratchwarp.scene import RenderOptions, StageError

SETTINGS = """
def Scope "Render" {
    def RenderSettings "rs" {
        rel products = [</Render/p>, </Render/q>]
        rel camera = </a>
        int2 resolution = (300, 200)
        float pixelAspectRatio = 2
        token aspectRatioConformPolicy = "cropAperture"
        float4 dataWindowNDC = (0.25, 0, 1, 0.5)
        BODY
    }
    def RenderProduct "p" {
        rel camera = </b>
        int2 resolution = (30, 20)
        token productName = "beauty.exr"
        rel orderedVars = [</Render/color>, </Render/lpe>]
    }
    def RenderProduct "q" {
        rel orderedVars = [</Render/color>]
    }
    def RenderVar "color" {
        string sourceName = "Ci"
    }
    def RenderVar "lpe" {
        token sourceType = "lpe"
        string sourceName = "C.*"
    }
}
def Camera "a" {}
def Camera "b" {}
def Camera "main_cam" {
    float fStop = 2
    float focusDistance = 5
}
"""
NAMED = 'renderSettingsPrimPath = "/Render/rs"'


def settings(body=""):
    return SETTINGS.replace("BODY", body)


def test_products_override_what_they_author(read, said):
    scene = read(settings(), more=NAMED)
    options = scene.options
    assert options.path == "/Render/rs" and scene.camera.path == "/b"
    assert options.resolution == (30, 20) and options.pixel_aspect == 2 and options.conform == "cropAperture"
    assert options.data_window == (0.25, 0, 1, 0.5)
    assert [(p.path, p.name) for p in options.products] == [("/Render/p", "beauty.exr"), ("/Render/q", "q")]
    assert [(v.name, v.source) for v in options.products[0].vars] == [("color", "Ci")]
    said(scene, "/Render/lpe", "lpe")
    said(scene, "/Render/rs", "2 render products")


def test_without_settings_nothing_is_asked_for(read):
    scene = read(settings())
    assert vars(scene.options) == vars(RenderOptions()) and scene.camera.path == "/main_cam"


def test_settings_may_be_named_by_the_caller(read):
    assert read(settings(), render_settings="/Render/rs").options.path == "/Render/rs"
    assert read(settings(), render_settings="/Render/rs", camera="a").camera.path == "/a"
    for wrong in ("/Render/p", "/nowhere", "not a path"):
        with pytest.raises(StageError, match=f"{wrong} is no RenderSettings"):
            read(settings(), render_settings=wrong)


def test_a_dangling_name_in_the_stage_warns(read, said):
    said(read(settings(), more='renderSettingsPrimPath = "/gone"'), "/gone", "no RenderSettings")


def test_scratch_settings_are_taken_only_when_authored(read):
    bare = read(settings(), more=NAMED).options
    assert (bare.spp, bare.seed, bare.max_error, bare.quality, bare.integrator, bare.max_depth) == (None,) * 6
    assert bare.filter == "blackmanHarris" and bare.filter_width is None and bare.effects == ()
    body = """
        uniform int scratch:render:samplesPerPixel = 8
        uniform int scratch:render:seed = 3
        uniform float scratch:render:maxError = 0.25
        uniform token scratch:render:quality = "final"
        uniform token scratch:render:integrator = "path"
        uniform int scratch:render:maxDepth = 5
        uniform token scratch:render:pixelFilter = "box"
        uniform float scratch:render:filterWidth = 2
        uniform string[] scratch:render:enableEffects = ["shadows"]
        uniform string[] scratch:render:disableEffects = ["domeLight"]
        uniform string[] scratch:render:knobs = ["tables.rays=64", "tables.sampler=random"]
"""
    got = read(settings(body), more=NAMED).options
    assert (got.spp, got.seed, got.max_error, got.quality, got.integrator) == (8, 3, 0.25, "final", "path")
    assert (got.max_depth, got.filter, got.filter_width) == (5, "box", 2)
    assert dict(got.effects) == {"shadows": True, "domeLight": False}
    assert dict(got.knobs) == {"tables.rays": "64", "tables.sampler": "random"}


def test_a_knob_without_a_value_is_said(read, said):
    scene = read(settings('uniform string[] scratch:render:knobs = ["spp"]'), more=NAMED)
    said(scene, "/Render/rs", "'spp'", "NAME=VALUE")
    assert scene.options.knobs == ()


def test_depth_of_field_may_be_off(read):
    assert read(settings(), camera="main_cam", more=NAMED).camera.lens_radius > 0
    off = read(settings("bool disableDepthOfField = 1"), camera="main_cam", more=NAMED)
    assert off.camera.lens_radius == 0 and not off.options.depth_of_field


def test_odd_values(read, said):
    scene = read(
        settings('token renderingColorSpace = "lin_ap1_scene"\nfloat4 dataWindowNDC = (1, 0, 0, 1)').replace(
            "float4 dataWindowNDC = (0.25, 0, 1, 0.5)", ""
        ),
        more=NAMED,
    )
    said(scene, "/Render/rs", "lin_ap1_scene")
    said(scene, "/Render/rs", "dataWindowNDC")
    with pytest.raises(StageError, match="/Render/rs: aspectRatioConformPolicy is 'stretch'"):
        read(settings().replace("cropAperture", "stretch"), more=NAMED)


def test_included_purposes_of_the_settings(read):
    mesh = """def Mesh "m" {
    uniform token purpose = "proxy"
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0)]
}"""
    text = settings('uniform token[] includedPurposes = ["default", "proxy"]') + mesh
    assert len(read(text, more=NAMED).instances) == 1
    assert len(read(text, more=NAMED, purposes=("default",)).instances) == 0
    assert len(read(text).instances) == 0
