"""Integrals of tables along a cone, from running sums, against sums over the bins in float64; their inverse."""

import numpy as np
import pytest
import warp as wp

from scratchwarp import optics, profiles
from scratchwarp.reflectance import profile_table
from scratchwarp.reflectance.cone_sums_device import cone_integral, cone_rows, place
from scratchwarp.reflectance.profile_table_device import TableArrays, table_value

wp.set_module_options({"enable_backward": False})
BINS, COUNT = 48, 400
GOLD = optics.Conductor((0.14, 0.37, 1.44), (4.1, 2.3, 1.8))


@wp.kernel
def integrals(
    tables: TableArrays,
    table: int,
    sin_theta: float,
    ends: wp.array2d(dtype=float),
    out: wp.array(dtype=wp.vec4),
    back: wp.array(dtype=float),
    values: wp.array2d(dtype=wp.vec3),
):
    i = wp.tid()
    rows = cone_rows(tables, table, 0.3, sin_theta)
    out[i] = cone_integral(tables, rows, i % tables.bins, ends[i, 0], ends[i, 1])
    back[i] = place(tables, rows, i % tables.bins, ends[i, 0], ends[i, 1], ends[i, 2] * out[i][3])
    for k in range(tables.bins):
        values[i, k] = table_value(tables, table, i % tables.bins, k, sin_theta)


@pytest.mark.parametrize("theta", [0.0, 0.7, 1.4])
@pytest.mark.parametrize("table", [0, 1, 2])
def test_integrals_and_their_inverse(table, theta):
    """Every other interval is short (down to 1e-4 of a radian): nothing cancels."""
    profile = profiles.shape("quartic", 0.3)
    made = [
        profiles.simulate(profile, resolution=BINS, rays=64, fresnel=fresnel, theta_model=model)
        for fresnel, model in ((None, "gamma"), (GOLD, "table"), (GOLD, "quadratic"))
    ]
    packed = profile_table.pack(made, summed=True)
    rng = np.random.default_rng(table)
    a = rng.uniform(-np.pi / 2, np.pi / 2, COUNT)
    width = np.where(np.arange(COUNT) % 2, 10 ** rng.uniform(-4, -1, COUNT), rng.uniform(0, np.pi, COUNT))
    b = np.minimum(a + width, np.pi / 2)
    share = rng.random(COUNT)
    ends = wp.array(np.stack([a, b, share], 1).astype(np.float32), dtype=float, device="cpu")
    out, back = wp.zeros(COUNT, dtype=wp.vec4, device="cpu"), wp.zeros(COUNT, dtype=float, device="cpu")
    values = wp.zeros((COUNT, BINS), dtype=wp.vec3, device="cpu")
    wp.launch(integrals, COUNT, inputs=[packed, table, float(np.sin(theta)), ends, out, back, values], device="cpu")
    edges = np.linspace(-np.pi / 2, np.pi / 2, BINS + 1)
    a, b = ends.numpy().astype(float).T[:2]
    rho = values.numpy().astype(float)

    def upto(phi):
        covered = np.clip(phi[:, None], edges[:-1], edges[1:])
        return np.einsum("nic,ni->nc", rho, np.sin(covered) - np.sin(edges[:-1]))

    wanted = upto(b) - upto(a)
    found = out.numpy()
    # sums are up to 1 in float32, short intervals do not read them
    np.testing.assert_allclose(found[:, :3], wanted, rtol=1e-3, atol=3e-6 * rho.max())
    y = np.array([0.2126, 0.7152, 0.0722])
    np.testing.assert_allclose(found[:, 3], found[:, :3] @ y, rtol=1e-4, atol=1e-6)
    place_of = back.numpy().astype(float)
    assert (place_of >= a - 1e-6).all() and (place_of <= b + 1e-6).all()
    np.testing.assert_allclose((upto(place_of) - upto(a)) @ y, share * (wanted @ y), atol=3e-6 * rho.max())


def test_a_power_of_theta_has_no_sums():
    table = profiles.simulate(profiles.shape("quartic", 0.3), resolution=BINS, rays=64, fresnel=GOLD)
    with pytest.raises(ValueError, match="gamma"):
        profile_table.pack([table], summed=True)
