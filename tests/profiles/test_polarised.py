"""Polarised products along a path against closed forms and an unrelated float64 Jones calculus."""

import numpy as np
import pytest

from scratchwarp import profiles
from scratchwarp.optics import Conductor, Dielectric, Schlick
from scratchwarp.optics.fresnel import amplitudes

ETA, K = 2.91, 3.09


def two_reflections(theta, phi):
    """Unpolarised reflectance of light that meets two facets at right angles to each other (a 90 degree V), by
    vectors in 3D.

    The field is followed as a complex vector: at each facet it is split along s = d x n and p, and turned by r_s, r_p.
    """
    d = -np.array([np.sin(theta), np.cos(theta) * np.sin(phi), np.cos(theta) * np.cos(phi)])
    normals = [np.array([0, 1, 1]) / np.sqrt(2), np.array([0, -1, 1]) / np.sqrt(2)]
    if np.dot(d, normals[0]) > np.dot(d, normals[1]):
        normals.reverse()
    first = np.cross(d, [1.0, 0.3, 0.2])
    first /= np.linalg.norm(first)
    power = 0.0
    for field in (first, np.cross(d, first)):
        ray, e = d, field.astype(complex)
        for n in normals:
            cosine = -np.dot(ray, n)
            r_s, r_p = amplitudes(cosine, ETA, K)
            s = np.cross(ray, n)
            s /= np.linalg.norm(s)
            out = ray + 2 * cosine * n
            e = r_s * np.dot(e, s) * s + r_p * np.dot(e, np.cross(s, ray)) * np.cross(s, out)
            ray = out
        power += 0.5 * np.vdot(e, e).real
    return power


@pytest.mark.parametrize("theta", [0.0, 0.4, 0.9, 1.3])
def test_double_reflection_in_a_right_angle(theta):
    """A 90 degree V sends light back after two reflections; its share there carries the Jones product."""
    profile = profiles.shape("vGroove", depth=0.5)
    bins = 180
    arguments = {"resolution": bins, "rays": 256, "incidence": "centre"}
    table = profiles.simulate(profile, **arguments)
    slices = profiles.simulate_full(profile, [theta], fresnel=Conductor(ETA, K), polarised=True, **arguments)
    for i in (60, 80, 89):
        phi = table.angles[i]
        ratio = slices[0, i, i] / table.mirror[i, i]
        # both walls take part: left first and right first are mirror images and carry the same
        assert ratio == pytest.approx(two_reflections(theta, phi), rel=2e-4), phi


def test_unpolarised_product_is_too_dark():
    """In the plane (Rs^2 + Rp^2) / 2 exceeds ((Rs + Rp) / 2)^2: by 4.8 % for two reflections off iron at 45 degrees."""
    profile = profiles.shape("vGroove", depth=0.5)
    arguments = {"resolution": 181, "rays": 64, "incidence": "centre", "fresnel": Conductor(ETA, K)}
    plain, polarised = (profiles.simulate(profile, polarised=p, **arguments) for p in (False, True))
    assert polarised.normal[90, 90] / plain.normal[90, 90] == pytest.approx(1.048, abs=1e-3)


def test_single_reflections_do_not_care():
    """One reflection of unpolarised light is (Rs + Rp) / 2 either way, at any theta."""
    for fresnel in (Conductor(ETA, K), Dielectric(1.5), Conductor((0.2, 1.0, 1.5), (3.0, 2.0, 1.9))):
        plain, polarised = (
            profiles.simulate_full(
                profiles.shape("vGroove", depth=0.1),
                [0.0, 0.7, 1.4],
                resolution=32,
                rays=64,
                fresnel=fresnel,
                polarised=p,
            )
            for p in (False, True)
        )
        # steep only beyond 80 degrees, where light may meet both walls: keep the middle
        np.testing.assert_allclose(polarised[:, :, 8:24], plain[:, :, 8:24], rtol=1e-4, atol=1e-5)


def test_needs_amplitudes():
    """Approximate reflectances have no phase."""
    with pytest.raises(ValueError, match="polarised"):
        profiles.simulate(profiles.shape("flat"), resolution=8, rays=8, fresnel=Schlick(0.5), polarised=True)
