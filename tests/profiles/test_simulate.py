"""Tables against brute force, closed forms and conservation laws."""

import numpy as np
import pytest

from scratchwarp import optics, profiles
from scratchwarp.optics import Conductor

UNDERCUT = [[0, 0], [0.3, 0.1], [0.1, -0.4], [0.9, -0.5], [0.7, 0.05], [1, 0]]


def row_error(table, reference, weights):
    """Row-L1 of probabilities, a column."""
    return (np.abs(table - reference) * weights[:, None]).sum(axis=0)


@pytest.mark.parametrize("name", profiles.shape_names())
def test_columns_conserve_energy_and_swap_light_and_viewer(name):
    """Mirror columns sum to 1 less what is lost; the table is its own transpose up to sampling error."""
    table = profiles.simulate(profiles.shape(name, depth=0.6), resolution=64, rays=128)
    total = (table.mirror * table.weights[:, None]).sum(axis=0)
    np.testing.assert_allclose(total + table.lost, 1.0, atol=1e-5)
    assert table.lost.max() < 1e-3
    # what the last scaling by column leaves of the asymmetry: the sampling error of 128 rays, a few times 1e-3
    flow = table.mirror * table.weights[:, None] * table.weights[None, :]
    assert np.abs(flow - flow.T).sum() < 1e-2 * flow.sum()


@pytest.mark.parametrize("isolated", [False, True])
@pytest.mark.parametrize("sampler", profiles.SAMPLERS)
def test_undercut_bulging_profile_against_brute_force(brute_force, isolated, sampler):
    """An outline that is no height field and stands out of the ground, by an independent float64 tracer."""
    columns = [1, 9, 15, 16, 25]
    reference, lost = brute_force.table(UNDERCUT, 32, 3000, columns=columns, isolated=isolated)
    assert lost == 0
    profile = profiles.Profile(UNDERCUT, isolated=isolated)
    table = profiles.simulate(profile, resolution=32, rays=512 if sampler == "beam" else 3000, sampler=sampler)
    # 3000 rays over at most 32 bins: row-L1 of counting noise below sqrt(2 * 32 / (pi * 3000)) = 0.08, twice where
    # both sides count
    assert row_error(table.mirror[:, columns], reference, table.weights).max() < 0.12


def test_flat_profile_is_the_anti_diagonal():
    """phi_o = -phi_i: all energy in the opposite bin, whatever the sampler and incidence."""
    for arguments in ({"sampler": "beam"}, {"sampler": "random"}, {"sampler": "stratified", "incidence": "centre"}):
        table = profiles.simulate(profiles.shape("flat"), resolution=64, rays=64, **arguments)
        share = table.mirror * table.weights[:, None]
        # float32 angles are known to 1e-7 of a bin of 0.05
        np.testing.assert_allclose(np.diag(share[:, ::-1]), 1.0, atol=1e-4)
        assert np.all(table.by_bounce[1:] == 0.0)
    assert np.all(profiles.simulate(profiles.shape("vGroove", depth=0.0), resolution=8, rays=8).by_bounce[1:] == 0.0)


def test_shallow_v_groove_is_two_deltas():
    """phi_o = +-2 alpha - phi_i with weights (1 +- tan alpha tan phi_i) / 2, each spread over one bin's width about
    it."""
    alpha, bins = np.radians(9.3), 180
    table = profiles.simulate(profiles.shape("vGroove", depth=0.5 * np.tan(alpha)), resolution=bins, rays=256)
    width = np.pi / bins
    share = table.mirror * table.weights[:, None]
    for i in range(40, 140, 7):
        phi_i = table.angles[i]
        for side in (1, -1):
            weight = 0.5 * (1 + side * np.tan(alpha) * np.tan(phi_i))
            place = (2 * side * alpha - phi_i + np.pi / 2) / width
            low = int(np.floor(place - 0.5))
            # the cell of incidence is as wide as a bin: the delta becomes a box over two bins; weights change by
            # tan(alpha) D / cos^2 / 2 < 0.003 across it
            expected = weight * np.array([low + 1 - (place - 0.5), place + 0.5 - (low + 1)])
            np.testing.assert_allclose(share[low : low + 2, i], expected, atol=4e-3)


def test_retro_reflection_of_a_right_angle():
    """A 90 degree V returns the share 1 - |tan phi_i| to where it came from; those deltas lie on the bins' edges and
    corners."""
    table = profiles.simulate(profiles.shape("vGroove", depth=0.5), resolution=64, rays=128)
    share = table.by_bounce[1] * table.weights[:, None]
    expected = np.maximum(0.0, 1 - np.abs(np.tan(table.angles)))
    # 128 rays, split where the path changes to 1/64 of a strip
    np.testing.assert_allclose(share.sum(axis=0), expected, atol=2e-3)
    # exit and entry cells coincide: nothing strays further than one bin
    for i in range(20, 44):
        assert share[i, i] > 0.98 * expected[i] - 2e-3


def test_deltas_on_bin_edges_are_shared():
    """A slope of half a bin sends the centre of a bin exactly to a bin's edge: half to either side, not to where
    rounding falls."""
    bins = 64
    alpha = 2.25 * np.pi / bins
    table = profiles.simulate(
        profiles.shape("vGroove", depth=0.5 * np.tan(alpha)), resolution=bins, rays=64, incidence="centre"
    )
    share = table.mirror * table.weights[:, None]
    for i in range(20, 44):
        weight = 0.5 * (1 + np.tan(alpha) * np.tan(table.angles[i]))
        edge = bins - 1 - i + 5
        np.testing.assert_allclose(share[edge - 1 : edge + 1, i], 0.5 * weight, atol=0.02)


def semicircle_table(bins, rays):
    """Table of half a circle from the closed form of single paths, by stratified rays with phi_i spread over its
    bin."""
    width = np.pi / bins
    rng = np.random.default_rng(0)
    u = -1 + 2 * (np.arange(rays) + rng.random(rays)) / rays
    weights = 2 * np.sin(width / 2) * np.cos((np.arange(bins) + 0.5) * width - np.pi / 2)
    table = np.zeros((bins, bins))
    for i in range(bins):
        low, high = np.sin(i * width - np.pi / 2), np.sin((i + 1) * width - np.pi / 2)
        phi = np.arcsin(low + (high - low) * ((0.6180339887 * np.arange(rays) + rng.random()) % 1.0))
        eta = np.arcsin(u * np.cos(phi))
        side = np.where(eta < 0, -1.0, 1.0)
        eta, phi = np.abs(eta), phi * side
        count = np.ceil((eta - phi + np.pi / 2) / (np.pi - 2 * eta))
        phi_o = side * ((np.pi + phi - count * (np.pi + 2 * eta) + np.pi) % (2 * np.pi) - np.pi)
        j = np.clip(((phi_o + np.pi / 2) / width).astype(int), 0, bins - 1)
        table[:, i] = np.bincount(j, minlength=bins) / rays / weights
    return table


def test_semicircle_table_matches_its_closed_form():
    """Row-L1 against 100,000 closed-form rays a column."""
    table = profiles.simulate(profiles.shape("round", depth=0.5), resolution=64, rays=1024)
    error = row_error(table.mirror, semicircle_table(64, 100_000), table.weights)
    # the reference's own noise: stratified rays leave about 2e-3 (measured between two of them); ours is as large
    assert error.mean() < 6e-3
    # many rays on a fine polygon are a comb of deltas instead
    polygon = profiles.Profile(profiles.shape("round", depth=0.5, segments=32).points)
    comb = row_error(profiles.simulate(polygon, resolution=64, rays=1024).mirror, table.mirror, table.weights)
    assert comb.mean() > 0.1


@pytest.mark.parametrize("name", ["quartic", "gaussian", "trapezoid"])
def test_beams_converge_and_beat_counting(name):
    """At 256 rays a bin, beams are at least ten times nearer to the answer than counted random rays, and 4 times the
    rays bring them nearer still."""
    profile = profiles.shape(name, depth=0.5)
    truth = profiles.simulate(profile, resolution=64, rays=20000)
    weights = truth.weights

    def error(**arguments):
        table = profiles.simulate(profile, resolution=64, **arguments)
        return row_error(table.mirror, truth.mirror, weights).mean()

    coarse, fine = error(rays=256), error(rays=1024)
    counted = error(rays=256, sampler="random")
    stratified = error(rays=20000, sampler="stratified")
    assert coarse < 0.1 * counted
    assert fine < 0.6 * coarse
    # an unrelated estimate of the same table: within the noise of 20,000 counted rays
    assert stratified < 0.02


def test_same_bits_always():
    """Two calls, one or two threads, and blocks of columns: the same bits; another seed: other bits for the random
    samplers."""
    profile = profiles.shape("gaussian", depth=0.6, rim=0.2)
    for sampler in profiles.SAMPLERS:
        arguments = {"resolution": 33, "rays": 96, "sampler": sampler, "fresnel": Conductor(2.91, 3.09)}
        tables = [profiles.simulate(profile, threads=threads, **arguments) for threads in (1, 2, 2, 3)]
        for table in tables[1:]:
            np.testing.assert_array_equal(table.mirror, tables[0].mirror)
            np.testing.assert_array_equal(table.gamma, tables[0].gamma)
        other = profiles.simulate(profile, seed=7, **arguments)
        assert np.array_equal(other.mirror, tables[0].mirror) == (sampler == "beam")


def test_blocks_of_columns_change_nothing(monkeypatch):
    """A table too large to trace at once is the same table."""
    profile = profiles.shape("vGroove", apex=0.3)
    whole = {s: profiles.simulate(profile, resolution=24, rays=32, sampler=s).mirror for s in profiles.SAMPLERS}
    monkeypatch.setattr("scratchwarp.profiles.tracing._BLOCK", 200)
    for sampler, mirror in whole.items():
        parts = profiles.simulate(profile, resolution=24, rays=32, sampler=sampler).mirror
        np.testing.assert_array_equal(parts, mirror)


def test_symmetry_is_used_but_changes_nothing():
    """Half the columns of a symmetric profile are mirrored; a profile off by 1e-6 is traced whole and agrees."""
    profile = profiles.shape("trapezoid", depth=0.5)
    points = np.array(profile.points)
    points[1, 0] += 1e-6
    whole, half = (profiles.simulate(p, resolution=48, rays=256) for p in (profiles.Profile(points), profile))
    assert half.rays < 0.6 * whole.rays
    np.testing.assert_allclose(half.mirror[::-1, ::-1], half.mirror, rtol=1e-6)
    assert row_error(whole.mirror, half.mirror, half.weights).max() < 0.02


@pytest.mark.parametrize("name", profiles.shape_names())
def test_dug_in_shapes_are_the_same_alone_and_repeated(name):
    """Light cannot leave a dug-in profile sideways."""
    alone, repeated = (
        profiles.simulate(profiles.shape(name, depth=0.7, isolated=i), resolution=32, rays=64) for i in (True, False)
    )
    np.testing.assert_allclose(alone.mirror, repeated.mirror, atol=1e-4 * repeated.mirror.max())


def test_deep_box_reports_what_it_loses():
    """max_bounces cuts paths between walls; what is cut is in lost, not silently missing."""
    table = profiles.simulate(profiles.shape("rectangle", depth=3.0), resolution=32, rays=64, max_bounces=4)
    total = (table.mirror * table.weights[:, None]).sum(axis=0)
    assert table.lost.max() > 0.5
    np.testing.assert_allclose(total + table.lost, 1.0, atol=1e-5)
    whole = profiles.simulate(profiles.shape("rectangle", depth=3.0), resolution=32, rays=64)
    assert whole.lost.max() < 1e-3


def test_the_bounce_cap_counts_whole_paths():
    """A path of as many reflections as allowed is whole: one is enough where light cannot meet the profile twice."""
    for fresnel in (None, optics.Schlick((0.5, 0.4, 0.3))):
        once, often = (
            profiles.simulate(profiles.shape("flat"), resolution=32, rays=64, fresnel=fresnel, max_bounces=cap)
            for cap in (1, 2000)
        )
        assert once.lost.max() == 0.0
        np.testing.assert_array_equal(once.mirror, often.mirror)
        if fresnel is not None:
            np.testing.assert_array_equal(once.normal, often.normal)
    # head-on, a V of 45 degrees reflects everything twice
    vee = profiles.shape("vGroove", depth=0.5)
    assert profiles.trace(vee, 0.0, [0.2, 0.8], max_bounces=2).bounces.tolist() == [2, 2]
    assert profiles.trace(vee, 0.0, [0.2, 0.8], max_bounces=1).bounces.tolist() == [-1, -1]


def test_grazing_bins_conserve_energy():
    """1 / cos of single rays would have no mean in the last bin; with the bin's weight its column holds exactly 1."""
    for bins in (16, 64, 256):
        table = profiles.simulate(profiles.shape("flat"), resolution=bins, rays=32, sampler="random")
        assert (table.mirror * table.weights[:, None]).sum(axis=0)[[0, -1]] == pytest.approx([1.0, 1.0], abs=1e-5)


@pytest.mark.parametrize(
    "arguments",
    [
        {"resolution": 1},
        {"rays": 2.5},
        {"rays": float("nan")},
        {"incidence": "edge"},
        {"sampler": "magic"},
        {"max_bounces": 0},
        {"seed": -1},
        {"theta_model": "cubic"},
        {"fresnel": "gold"},
        {"rays": "many"},
        {"threads": 0},
        {"threads": "all"},
    ],
)
def test_arguments_are_checked(arguments):
    """Each message names the argument."""
    with pytest.raises(ValueError, match=next(iter(arguments))):
        profiles.simulate(profiles.shape("flat"), **arguments)


def test_only_profiles_are_simulated():
    """Raw points are refused with advice; thetas are checked."""
    with pytest.raises(ValueError, match="profile must"):
        profiles.simulate([[0, 0], [1, 0]])
    with pytest.raises(ValueError, match="thetas"):
        profiles.simulate_full(profiles.shape("flat"), [2.0])
    with pytest.raises(ValueError, match="thetas .* got .'steep'"):
        profiles.simulate_full(profiles.shape("flat"), ["steep"])
    with pytest.raises(ValueError, match="depth .* got 'deep'"):
        profiles.shape("sine", depth="deep")
    with pytest.raises(ValueError, match="points .* got 'v'"):
        profiles.Profile("v")
    with pytest.raises(ValueError, match="theta"):
        profiles.simulate(profiles.shape("flat"), resolution=8, rays=8).slice(2.0)
