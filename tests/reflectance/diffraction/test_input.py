"""Bad input names its argument and its value."""

import re

import numpy as np
import pytest

from scratchwarp import diffraction, profiles

UP = [0.0, 0.0, 1.0]
SCRATCH = diffraction.Scratch()
BALL = diffraction.SphereLight([0, 0, 1], 0.1)
NAN = float("nan")

BAD = [
    (lambda: diffraction.Scratch(width=-1.0), "width", "-1"),
    (lambda: diffraction.Scratch(width=[1.0, NAN]), "width", "nan"),
    (lambda: diffraction.Scratch(depth=-0.5), "depth", "-0.5"),
    (lambda: diffraction.Scratch(depth=None), "depth", "None"),
    (lambda: diffraction.Scratch(depth="deep"), "depth", "deep"),
    (lambda: diffraction.Scratch(azimuth=np.inf), "azimuth", "inf"),
    (lambda: diffraction.Scratch(offset=NAN), "offset", "nan"),
    (lambda: diffraction.Scratch(coherence_radius=0.0), "coherence_radius", "0"),
    (lambda: diffraction.Scratch(ends=(1.0, 2.0, 3.0)), "ends", "3"),
    (lambda: diffraction.Scratch(ends=(1.0, NAN)), "ends", "nan"),
    (lambda: diffraction.Scratch(ends=np.zeros((2, 3))), "ends", "[2, 3]"),
    (lambda: diffraction.Scratch(profile=[[0, 0], [1, 0]]), "profile", "[[0, 0], [1, 0]]"),
    (lambda: diffraction.Scratch(roughness=0.1, profile=profiles.shape("sine")), "roughness", "0.1"),
    (lambda: diffraction.Scratch(width=[1.0, 2.0], depth=[1.0, 2.0, 3.0]), "width", "[3]"),
    (lambda: diffraction.SphereLight([0, 1], 0.1), "center", "[2]"),
    (lambda: diffraction.SphereLight([0, 0, NAN], 0.1), "center", "nan"),
    (lambda: diffraction.SphereLight([0, 0, 1], -0.1), "radius", "-0.1"),
    (lambda: diffraction.PolygonLight([[0, 0, 1], [1, 0, 1]]), "vertices", "[2, 3]"),
    (lambda: diffraction.PolygonLight([[0, 0], [1, 0], [1, 1]]), "vertices", "[3, 2]"),
    (lambda: diffraction.PolygonLight([[0, 0, 1], [1, 0, 1], [1, np.inf, 1]]), "vertices", "inf"),
    (lambda: diffraction.brdf([0, 0, 1.01], UP, SCRATCH, 500.0), "omega_i", "1.01"),
    (lambda: diffraction.brdf(UP, [0, 0], SCRATCH, 500.0), "omega_o", "[2]"),
    (lambda: diffraction.brdf(UP, [NAN, 0, 1], SCRATCH, 500.0), "omega_o", "nan"),
    (lambda: diffraction.brdf(UP, UP, SCRATCH, 0.0), "wavelength", "0"),
    (lambda: diffraction.brdf(UP, UP, SCRATCH, -500.0), "wavelength", "-500"),
    (lambda: diffraction.brdf(UP, UP, SCRATCH, 500.0, phase="large"), "phase", "large"),
    (lambda: diffraction.brdf(UP, UP, "scratch", 500.0), "s", "scratch"),
    (lambda: diffraction.brdf([UP, UP], UP, SCRATCH, [500.0] * 3), "wavelength", "[3]"),
    (lambda: diffraction.brdf_coherent(UP, UP, SCRATCH, 500.0), "scratches", "Scratch"),
    (lambda: diffraction.brdf_coherent(UP, UP, [1], 500.0), "scratches", "1"),
    (
        lambda: diffraction.brdf_coherent(UP, UP, [SCRATCH, diffraction.Scratch(coherence_radius=5.0)], 500.0),
        "coherence_radius",
        "5",
    ),
    (lambda: diffraction.brdf_coherent(UP, UP, [diffraction.Scratch(depth_spread=0.1)], 500.0), "depth_spread", "0.1"),
    (lambda: diffraction.radiance("sun", UP, SCRATCH, 500.0), "light", "sun"),
    (lambda: diffraction.radiance(BALL, [0, 0, 2.0], SCRATCH, 500.0), "omega_o", "2"),
    (lambda: diffraction.radiance(BALL, UP, SCRATCH, NAN), "wavelength", "nan"),
    (lambda: diffraction.radiance(BALL, UP, SCRATCH, 500.0, method="montecarlo"), "method", "montecarlo"),
    (lambda: diffraction.radiance(BALL, UP, SCRATCH, 500.0, slices=0), "slices", "0"),
    (lambda: diffraction.radiance(BALL, UP, SCRATCH, 500.0, slices=2.5), "slices", "2.5"),
    (
        lambda: diffraction.radiance(BALL, UP, SCRATCH, 500.0, "angle-dependent", "closed-form-paper"),
        "method",
        "closed-form-paper",
    ),
    (lambda: diffraction.footprint(-1.0, 1.0, 0.0, 0.0), "a1", "-1"),
    (lambda: diffraction.footprint(1.0, NAN, 0.0, 0.0), "a2", "nan"),
    (lambda: diffraction.footprint(1.0, 1.0, np.inf, 0.0), "angle", "inf"),
    (lambda: diffraction.footprint(1.0, 1.0, 0.0, 0.0, -60.0), "coherence_radius", "-60"),
    (lambda: diffraction.footprint(1.0, 1.0, 0.0, 0.0, method="box"), "method", "box"),
    (lambda: diffraction.coverage(1.0, 1.0, 0.0, 0.0, -2.0), "width", "-2"),
    (lambda: diffraction.rgb(1.0, 1.0, 2.5), "xi2", "2.5"),
    (lambda: diffraction.rgb(-1.0, 1.0, 0.5), "width", "-1"),
    (lambda: diffraction.rgb(1.0, 1.0, 0.5, wavelengths=0), "wavelengths", "0"),
    (lambda: diffraction.rgb(1.0, 1.0, 0.5, wavelengths=[500.0, 400.0]), "wavelengths", "400"),
    (lambda: diffraction.rgb(1.0, 1.0, 0.5, wavelengths=[100.0, 200.0]), "wavelengths", "100"),
    (lambda: diffraction.rgb(1.0, 1.0, 0.5, wavelengths="cmyk"), "wavelengths", "cmyk"),
    (lambda: diffraction.balance([0.1, -0.2]), "visible", "-0.2"),
]


@pytest.mark.parametrize(("call", "name", "value"), BAD, ids=[f"{i} {name}" for i, (_, name, _) in enumerate(BAD)])
def test_message(call, name, value):
    with pytest.raises(ValueError) as caught:
        call()
    assert re.search(rf"\b{name}\b", str(caught.value)) and value in str(caught.value), str(caught.value)


def test_almost_unit_directions_are_made_unit():
    exact = diffraction.brdf([0.0, 0.6, 0.8], [0.0, -0.5, np.sqrt(0.75)], SCRATCH, 500.0)
    near = diffraction.brdf([0.0, 0.6003, 0.8004], [0.0, -0.5, np.sqrt(0.75)], SCRATCH, 500.0)
    np.testing.assert_allclose(near, exact, rtol=1e-9)


def test_names_load_on_first_use():
    import scratchwarp

    assert "diffraction" in dir(scratchwarp) and set(diffraction.__all__) <= set(dir(diffraction))
    assert callable(diffraction.brdf) and callable(diffraction.radiance)
    with pytest.raises(AttributeError):
        _ = diffraction.nothing
