"""Files of measured BRDFs as bases: drawn as said, never brighter than their light, and what they measured."""

import numpy as np
import pytest

from scratchwarp import measured
from scratchwarp.reflectance.responses import query, tabulated

from ..measured.synthetic import grid, rgl_fields, smooth, write_merl, write_tensors
from . import checks
from .checks import directions


def write_glossy(path):
    """A MERL file of a highlight of half a degree that returns more light than comes, over a diffuse floor."""
    half = np.radians(90 * (np.arange(90) / 90) ** 2)
    value = 60.0 + 3e6 * np.exp(-((np.tan(np.minimum(half, 1.5)) / np.tan(np.radians(0.5))) ** 2))
    write_merl(path, np.broadcast_to(value[None, :, None, None], (3, 90, 90, 180)))


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("files")
    w = grid()
    measured.save_utia(folder / "a.bin", smooth(w[:, None], w[None]))
    write_glossy(folder / "b.binary")
    write_tensors(folder / "c.bsdf", rgl_fields(np.linspace(-np.pi, np.pi, 7)))
    return folder


def response(files, name):
    return query.Queried(*tabulated.measured_file(str(files / name)))


@pytest.mark.parametrize("name", ["a.bin", "b.binary", "c.bsdf"])
def test_files_as_bases(files, name):
    base = response(files, name)
    checks.chi_square(base, {}, slack=0.02)
    checks.furnace(base, {})
    checks.reciprocity(base, {})


def test_values_are_the_measured_ones(files):
    brdf = measured.load(files / "a.bin")
    wi, wo = directions(np.linspace(0.1, 1.4, 9)[:, None], np.linspace(-3, 3, 7)), directions(0.9, 2.0)
    wanted = brdf.evaluate(wi, wo, reciprocal=True)
    np.testing.assert_allclose(query.evaluate(response(files, "a.bin"), wi, wo)[0], wanted, rtol=1e-3, atol=1e-6)
    # where it returns more than comes it is scaled, no channel more than another
    glossy = measured.load(files / "b.binary").evaluate(wi, wo, reciprocal=True)
    ratio = query.evaluate(response(files, "b.binary"), wi, wo)[0] / glossy
    assert ratio.max() < 0.9 and np.ptp(ratio, axis=-1).max() < 1e-3 * ratio.max()


def test_narrow_highlights_are_found(files):
    """Half vectors of half a degree: the weights vary little, where a cosine would find one in 10^4."""
    u = np.random.default_rng(1).random((20_000, 3))
    weight = query.sample(response(files, "b.binary"), directions(0.7, 1.0), u)[1][:, 0]
    assert weight.std() < 1.5 * weight.mean() and weight.max() < 20 * weight.mean()


def test_formats_and_changes(files, tmp_path):
    with pytest.raises(ValueError, match=r"b\.binary.*'utia'.*'merl'"):
        tabulated.measured_file(str(files / "b.binary"), "utia")
    with pytest.raises(OSError):
        tabulated.measured_file(str(tmp_path / "none.bin"))
    (tmp_path / "d.bin").write_bytes(b"123")
    with pytest.raises(ValueError, match=r"d\.bin"):
        tabulated.measured_file(str(tmp_path / "d.bin"))
