"""NaN and infinity in any number or array that comes in: refused by name, or of no effect; never in an image.

Records of a scene and every argument of the NumPy functions; what stages author is in ``test_bad_stages``.
"""

from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest

from scratchwarp import diffraction, grooves, lights, mdf, optics, profiles, scene, stencils

from ..render import scenes

BAD = (float("nan"), float("inf"), float("-inf"))
ONE = (1.0, 1.0, 1.0)
PLACE = {"center": (0, 0, 1), "ex": (1, 0, 0), "ey": (0, 1, 0), "normal": (0, 0, -1)}
BALL = scenes.sphere(4, 8)
RECORDS = {
    "Mesh": replace(
        BALL,
        tangents=BALL.normals,
        colors=np.abs(BALL.normals),
        primvars={"wear": np.ones((len(BALL.triangles), 3, 1))},
    ),
    "Instance": scenes.place(),
    "Camera": scenes.camera(lens_radius=0.1, focus_distance=3.0),
    "Texture": scene.Texture("/t", np.ones((2, 2, 4))),
    "TextureInput": scene.TextureInput(0),
    "PreviewSurface": scene.PreviewSurface(),
    "ScratchSurface": scene.ScratchSurface(),
    "Measured": scene.Measured(**dict.fromkeys(("azimuth", "width", "a", "b", "kd", "ks", "alpha"), (1,)), color=[ONE]),
    "Layer": scenes.scratched().layers[0],
    "Profile": scene.Profile(path="/p", shape="points", points=((0, 0), (0.5, -1), (1, 0))),
    "Wave": scene.Wave(ior=np.ones((2, 3))),
    "Curves": scene.Curves(path="/c", points=[ONE, (2, 2, 2)], counts=[2], widths=[1, 1], depths=[1, 1]),
    "NormalMap": scene.NormalMap(texture=0),
    "DistantLight": scene.DistantLight(path="/l", radiance=ONE, direction=(0, 0, -1)),
    "SphereLight": scene.SphereLight(path="/l", radiance=ONE, center=(0, 0, 1), radius=1.0),
    "RectLight": scene.RectLight(path="/l", radiance=ONE, **PLACE),
    "DiskLight": scene.DiskLight(path="/l", radiance=ONE, **PLACE),
    "CylinderLight": scene.CylinderLight(path="/l", radiance=ONE, center=(0, 0, 1), axis=(1, 0, 0), radius=1.0),
    "DomeLight": scene.DomeLight(path="/l", radiance=ONE),
    "MeshLight": scene.MeshLight(path="/l", radiance=ONE, instance=0),
    "Shaping": scene.Shaping(),
}
# what infinity means there
ENDLESS = {"far": "nothing is too far", "shadow_distance": "all the way"}


def spoilt(value, bad):
    """A number or array with one value bad; None where it holds none."""
    if isinstance(value, bool | str) or value is None:
        return None
    if isinstance(value, float):
        return bad
    if hasattr(value, "keys"):
        return {name: spoilt(v, bad) for name, v in value.items()} or None
    try:
        array = np.array(value, float)
    except (TypeError, ValueError):
        return None
    if isinstance(value, int) or np.asarray(value).dtype.kind != "f" or not array.size:
        return None
    array.flat[-1] = bad
    return tuple(map(float, array)) if isinstance(value, tuple) and array.ndim == 1 else array


NUMBERS = [
    (kind, field.name)
    for kind, record in RECORDS.items()
    for field in fields(record)
    if spoilt(getattr(record, field.name), np.nan) is not None
]


@pytest.mark.parametrize(("kind", "name"), NUMBERS, ids=lambda v: v)
def test_records_refuse_what_is_no_number(kind, name):
    record = RECORDS[kind]
    for bad in BAD:
        if np.isinf(bad) and name in ENDLESS:
            continue
        with pytest.raises(ValueError, match=r"nan|inf"):
            replace(record, **{name: spoilt(getattr(record, name), bad)})


def test_every_record_is_here():
    records = {n for n in scene.__all__ if is_dataclass(getattr(scene, n))}
    others = {
        "Control",
        "Light",
        "Material",
        "RenderOptions",
        "RenderProduct",
        "RenderVar",
        "Scene",
        "Settings",
        "StageError",
    }
    assert records - others == set(RECORDS)


UP, SLANT = np.array([0.0, 0.0, 1.0]), np.array([0.6, 0.0, 0.8])
MODES = [stencils.Mode(0.3, 0.1, 1.0, 0.0, 0.5, 0.2, 5.0, ONE)]
STENCIL = {"modes": MODES, "beta": 0.1, "background": 0.1, "k": 0.1, "specular_alpha": 9.0}
FACE = grooves.Pattern([[[0.0, 0.0], [1.0, 0.0]]], [[-0.1, 0.0], [0.0, -0.1], [0.1, 0.0]])
ELLIPSE = {"center": [0.5, 0.0], "axis1": [0.1, 0.0], "axis2": [0.0, 0.1], "omega_o": UP, "omega_i": SLANT}
FUNCTIONS = {
    "diffraction.Scratch": (diffraction.Scratch, {"width": 3.0, "depth": 1.0, "azimuth": 0.2, "offset": 1.0,
                                                  "coherence_radius": 60.0}),
    "diffraction.brdf": (diffraction.brdf, {"omega_i": UP, "omega_o": SLANT, "s": diffraction.Scratch(),
                                            "wavelength": 500.0}),
    "diffraction.SphereLight": (diffraction.SphereLight, {"center": UP, "radius": 0.1}),
    "diffraction.PolygonLight": (diffraction.PolygonLight, {"vertices": np.eye(3)}),
    "diffraction.radiance": (diffraction.radiance, {"light": diffraction.SphereLight(UP, 0.1), "omega_o": SLANT,
                                                    "s": diffraction.Scratch(), "wavelength": 500.0}),
    "diffraction.footprint": (diffraction.footprint, {"a1": 9.0, "a2": 5.0, "angle": 0.2, "offset": 1.0,
                                                      "coherence_radius": 60.0}),
    "diffraction.coverage": (diffraction.coverage, {"a1": 9.0, "a2": 5.0, "angle": 0.2, "offset": 1.0, "width": 3.0}),
    "diffraction.rgb": (diffraction.rgb, {"width": 3.0, "depth": 1.0, "xi2": 0.1}),
    "grooves.visibility": (grooves.visibility, {"points": np.array([[0.0, 0], [0.5, -0.5], [1, 0]]), "theta_o": 0.2,
                                                "theta_i": 0.1}),
    "grooves.radiance": (lambda **k: grooves.radiance(FACE, reflectance=grooves.Diffuse(0.5), **k), ELLIPSE),
    "grooves.Diffuse": (grooves.Diffuse, {"albedo": 0.5}),
    "grooves.GGX": (grooves.GGX, {"alpha": 0.5}),
    "mdf.ashikhmin_shirley": (mdf.ashikhmin_shirley, {"h": UP, "ex": 9.0, "ey": 5.0}),
    "mdf.ward": (mdf.ward, {"h": UP, "ax": 0.2, "ay": 0.1}),
    "mdf.inverse_deform": (mdf.inverse_deform, {"p": np.array([0.1, 0.2]), "delta": np.array([0.3, 0.1])}),
    "mdf.deformed": (mdf.deformed, {"h": UP, "delta": np.array([0.3, 0.1]), "ex": 9.0, "ey": 5.0}),
    "stencils.Model": (stencils.Model, STENCIL),
    "stencils.evaluate": (stencils.evaluate, {"model": stencils.Model(**STENCIL), "omega_i": UP, "omega_o": SLANT}),
    "profiles.Profile": (profiles.Profile, {"points": np.array([[0.0, 0], [0.5, -0.5], [1, 0]])}),
    "profiles.shape": (lambda depth: profiles.shape("quartic", depth=depth), {"depth": 0.5}),
    "optics.Conductor": (optics.Conductor, {"eta": 1.5, "k": 3.0}),
    "optics.Dielectric": (optics.Dielectric, {"ior": 1.5}),
    "lights.irradiance": (lights.irradiance, {"light": scene.SphereLight(path="/l", radiance=ONE, center=(0, 0, 1),
                                              radius=0.1), "x": np.zeros(3), "n": UP}),
    "lights.hit": (lights.hit, {"light": scene.DomeLight(path="/l", radiance=ONE), "x": np.zeros(3), "w": UP}),
}  # fmt: skip
ARGUMENTS = [
    (name, argument)
    for name, (_, given) in FUNCTIONS.items()
    for argument, value in given.items()
    if spoilt(value, np.nan) is not None
]


@pytest.mark.parametrize(("name", "argument"), ARGUMENTS, ids=lambda v: v)
def test_functions_refuse_what_is_no_number(name, argument):
    """By the name of the argument."""
    function, given = FUNCTIONS[name]
    for bad in BAD:
        with pytest.raises(ValueError, match=argument):
            function(**{**given, argument: spoilt(given[argument], bad)})
