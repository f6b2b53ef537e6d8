"""Profile tables on the device: every theta model against the host's own evaluation, sampling against its density."""

import numpy as np
import pytest
import warp as wp

from scratchwarp import optics, profiles
from scratchwarp.reflectance import profile_table
from scratchwarp.reflectance.profile_table_device import TableArrays, table_pdf, table_sample, table_value

wp.set_module_options({"enable_backward": False})
BINS = 48


@wp.kernel
def values(tables: TableArrays, table: int, sin_theta: float, out: wp.array2d(dtype=wp.vec3)):
    row, column = wp.tid()
    out[row, column] = table_value(tables, table, row, column, sin_theta)


@wp.kernel
def samples(tables: TableArrays, row: int, u: wp.array(dtype=float), out: wp.array(dtype=wp.vec3)):
    i = wp.tid()
    s = table_sample(tables, 0, row, 0.3, u[i])
    out[i] = wp.vec3(s.phi, s.pdf, table_pdf(tables, 0, row, s.phi))


def simulated(model, fresnel):
    profile = profiles.shape("quartic", 0.3)
    return profiles.simulate(profile, resolution=BINS, rays=64, fresnel=fresnel, theta_model=model)


IRON = optics.Conductor((2.9, 2.6, 2.4), (3.1, 2.9, 2.7))
GLASS = optics.Dielectric(1.5)


@pytest.mark.parametrize("fresnel", [IRON, GLASS], ids=["iron", "glass"])
@pytest.mark.parametrize("model", profile_table.RENDERED)
def test_every_theta_model_is_what_the_host_evaluates(model, fresnel):
    """gamma and quadratic are the same formulas in float32; the device joins "table" by parabolas, the host by lines,
    which differ by at most twice the model's own albedo error (below 0.006)."""
    table = simulated(model, fresnel)
    packed = profile_table.pack([simulated("gamma", None), table])
    for theta in (0.0, 0.5, 1.2, 1.5, np.pi / 2):
        out = wp.zeros((BINS, BINS), dtype=wp.vec3, device="cpu")
        wp.launch(values, dim=(BINS, BINS), inputs=[packed, 1, float(np.sin(theta)), out], device="cpu")
        unit = profile_table.rows_to_unit_energy(np.asarray(table.mirror, float), table.weights)
        scale = np.divide(unit, table.mirror, out=np.ones_like(unit), where=table.mirror > 0)
        expected = table.slice(theta)
        expected = expected if expected.ndim == 3 else expected[..., None]
        albedo = np.einsum("jic,i->jc", out.numpy(), table.weights)
        wanted = np.einsum("jic,i->jc", expected * scale[..., None], table.weights)
        assert np.abs(albedo - wanted).max() < (0.012 if model == "table" else 2e-4)


def test_a_mirror_reflects_all():
    packed = profile_table.pack([simulated("gamma", None)])
    out = wp.zeros((BINS, BINS), dtype=wp.vec3, device="cpu")
    wp.launch(values, dim=(BINS, BINS), inputs=[packed, 0, 0.7, out], device="cpu")
    energy = out.numpy()[..., 0] @ simulated("gamma", None).weights
    assert np.abs(energy - 1.0).max() < 1e-5


@pytest.mark.parametrize("row", [0, 10, 24, 47])
def test_samples_follow_their_density(row):
    """Chi-square over the occupied bins at 0.1 %: 20,000 stratified samples have less variance than it assumes."""
    table = simulated("gamma", None)
    packed = profile_table.pack([table])
    n = 20000
    u = ((np.arange(n) + 0.5) / n).astype(np.float32)
    out = wp.zeros(n, dtype=wp.vec3, device="cpu")
    wp.launch(samples, dim=n, inputs=[packed, row, wp.array(u, dtype=float, device="cpu"), out], device="cpu")
    phi, pdf, again = out.numpy().T
    assert (pdf > 0).all() and np.allclose(pdf, again, rtol=2e-3)
    counts = np.histogram(phi, BINS, (-np.pi / 2, np.pi / 2))[0]
    unit = profile_table.rows_to_unit_energy(np.asarray(table.mirror, float), table.weights)[row] * table.weights
    expected = n * unit / unit.sum()
    full = expected > 5
    statistic = ((counts[full] - expected[full]) ** 2 / expected[full]).sum()
    assert statistic < 100.0  # 99.9 % of chi-square with 60 degrees of freedom, more than there are bins
    assert counts[~full].sum() <= expected[~full].sum() + 5 * np.sqrt(5 * BINS)


def test_a_model_without_equal_steps_is_refused():
    with pytest.raises(ValueError, match="exact"):
        profile_table.pack([simulated("exact", IRON)])


def test_one_table_in_the_place_of_another():
    """Arrays that are written over equal new ones; where a table does not fit, new ones are made."""
    old = [simulated("gamma", None), simulated("quadratic", IRON), simulated("gamma", GLASS)]
    fitting = [old[0], simulated("quadratic", GLASS), old[2]]
    packed = profile_table.pack(old)
    replaced = profile_table.pack(fitting, earlier=(old, packed))
    assert replaced is packed
    for tables, found in ((fitting, replaced), ([old[0], old[2], old[2]], None), (old[:2], None)):
        found = found or profile_table.pack(tables, earlier=(fitting, packed))
        fresh = profile_table.pack(tables)
        for name in ("mirror", "cdf", "slices", "first", "steps", "shift"):
            np.testing.assert_array_equal(getattr(found, name).numpy(), getattr(fresh, name).numpy(), err_msg=name)


def test_tables_among_others_are_taken_over():
    """More tables than before, in another order, with the sums along a cone: the arrays of all packed anew."""
    old = [simulated("gamma", None), simulated("quadratic", IRON)]
    packed = profile_table.pack(old, summed=True)
    more = [old[1], simulated("table", GLASS), old[0]]
    found, fresh = (profile_table.pack(more, earlier=e, summed=True) for e in ((old, packed), None))
    assert found is not packed
    for name in ("mirror", "cdf", "slices", "sums", "first", "first_sum", "steps", "shift"):
        np.testing.assert_array_equal(getattr(found, name).numpy(), getattr(fresh, name).numpy(), err_msg=name)


@pytest.mark.parametrize("summed", [False, True])
def test_tables_find_room_among_earlier_ones(summed):
    """Tables come, go and change places; what each of them reads are the bits of all packed anew."""
    models = ("table", "quadratic") if summed else ("table", "quadratic", "gamma")  # widest first
    some = [simulated(model, fresnel) for model in models for fresnel in (None, IRON, GLASS)]
    tables = some[:3]
    packed = profile_table.pack(tables, summed=summed, roomy=True)
    few = [some[3], some[1], some[0]]
    for now in (some[:4], few, some[2:5], [some[4]], [some[4], some[5], some[0]], some, some[1:]):
        last, packed = packed, profile_table.pack(now, earlier=(tables, packed), summed=summed, roomy=True)
        assert now is some or packed.slices.ptr == last.slices.ptr  # some do not fit
        tables = now
        fresh = profile_table.pack(now, summed=summed)
        for name in ("mirror", "cdf", "steps", "shift"):
            np.testing.assert_array_equal(getattr(packed, name).numpy(), getattr(fresh, name).numpy(), err_msg=name)
        for k, steps in enumerate(fresh.steps.numpy()):
            assert (fresh.first.numpy()[k] < 0) == (packed.first.numpy()[k] < 0)
            rows = 0 if fresh.first.numpy()[k] < 0 else steps + 1 if steps else 3
            for name, at, wide in (("slices", "first", rows), ("sums", "first_sum", max(rows, 1) * summed)):
                starts = [getattr(a, at).numpy()[k] for a in (packed, fresh)]
                arrays = [getattr(a, name).numpy() for a in (packed, fresh)]
                np.testing.assert_array_equal(*(a[:, s : s + wide] for a, s in zip(arrays, starts, strict=True)))


@pytest.mark.parametrize("model", [None, "gamma", "quadratic", "table"])
@pytest.mark.parametrize("summed", [False, True])
def test_the_stated_memory_is_what_is_taken(model, summed):
    """Within what is kept once a table and for the ends of running sums."""
    if summed and model == "gamma":
        return
    fresnel = None if model is None else optics.Dielectric(1.5, "exact")
    table = profiles.simulate(
        profiles.shape("vGroove", depth=0.3), resolution=64, rays=16, fresnel=fresnel, theta_model=model or "gamma"
    )
    packed = profile_table.pack([table], summed=summed)
    arrays = (packed.mirror, packed.cdf, packed.slices, packed.sums)
    taken = sum(a.numpy().nbytes for a in arrays)
    assert profile_table.table_bytes(64, model, summed) == pytest.approx(taken, rel=0.02)
