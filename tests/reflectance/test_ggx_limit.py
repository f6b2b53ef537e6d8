"""Where a scratch's slopes are distributed as GGX has them, its table is anisotropic GGX.

The one-dimensional slope distribution of GGX, alpha^2 / (2 (alpha^2 + s^2)^(3/2)), is that of half an ellipse of depth
alpha / 2: with t = 2 x - 1 its slope is alpha t / sqrt(1 - t^2), and t is even over [-1, 1]. So the shape "round" of
depth alpha / 2 is GGX of alpha across the scratch and 0 along it, up to masking (one bounce of V cavities against
Smith's), which at alpha 0.1 and these angles moves less than alpha^2 / 2 of the energy.
"""

import numpy as np
import pytest

from scratchwarp import profiles
from scratchwarp.reflectance.base import BaseSurface, evaluate_base

ALPHA = 0.1
# bins of 0.7 degrees average a lobe of 11.5 degrees' width (2 alpha): curvature times width^2 / 24 is below 1 %
PHI_O = np.radians([-40.0, -12.0, 5.0, 30.0])


def density(phi_o, phi_i):
    """rho of a one-dimensional GGX without masking: each slope reflects by what it shows of itself to the viewer."""
    half = 0.5 * (phi_o + phi_i)
    slope = np.tan(half)
    p = ALPHA**2 / (2 * (ALPHA**2 + slope**2) ** 1.5)
    return p * np.cos(phi_o - half) / (2 * np.cos(half) ** 3 * np.cos(phi_o) * np.cos(phi_i))


def direction(theta, phi):
    """The scratch's frame: u = x, v = y, n = z."""
    theta, phi = np.broadcast_arrays(theta, phi)
    return np.stack([np.sin(theta), np.cos(theta) * np.sin(phi), np.cos(theta) * np.cos(phi)], -1)


@pytest.fixture(scope="module")
def table():
    return profiles.simulate(profiles.shape("round", depth=ALPHA / 2), resolution=256, rays=512)


def test_the_table_of_half_an_ellipse_is_ggx(table):
    for phi_o in PHI_O:
        row = np.argmin(np.abs(table.angles - phi_o))
        core = np.abs(table.angles + table.angles[row]) < 2.5 * ALPHA
        want = density(table.angles[row], table.angles[core])
        # 1 %: blur of bins at the peak, energy of later bounces, and towards the wings the chords that draw the ellipse
        np.testing.assert_allclose(table.mirror[row, core] / want, 1.0, atol=0.01)


def test_our_anisotropic_ggx_integrated_across_the_cone_is_that_density():
    # The table is the integral of f cos^2(theta_i) over theta_i, as alpha along the scratch goes to 0. Smith's masking
    # of 0.1 at 45 degrees and alpha 0.1 is below 0.3 %; alpha_x 4e-3 leaves terms of its order.
    surface = BaseSurface(f0=1.0, alpha_x=4e-3, alpha_y=ALPHA)
    spread = np.linspace(-0.5, 0.5, 20001)
    for phi_o in PHI_O:
        for theta_o in (0.0, 0.4):
            phi_i = -phi_o + np.linspace(-2, 2, 7) * ALPHA
            wi = direction(-theta_o + spread, phi_i[:, None])
            wo = direction(theta_o, phi_o)
            value = evaluate_base(surface, wi, wo)[..., 0].astype(np.float64)  # f cos(theta_i) cos(phi_i)
            cosine = np.cos(-theta_o + spread)
            rho = np.trapezoid(value * cosine / np.cos(phi_i)[:, None], spread, axis=1)
            np.testing.assert_allclose(rho / density(phi_o, phi_i), 1.0, atol=0.015)
