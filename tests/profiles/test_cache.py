"""Tables on disk: what the key covers, damage, concurrent writers, the limit."""

import threading

import numpy as np
import pytest

from scratchwarp import profiles
from scratchwarp.optics import Conductor
from scratchwarp.profiles.cache import default_folder, table_key

IRON = Conductor(2.91, 3.09)
SMALL = {"resolution": 16, "rays": 16}


@pytest.fixture
def store(tmp_path):
    """An empty store."""
    return profiles.store(tmp_path / "tables")


def profile(depth=0.5):
    """A profile as a script would build it anew each time."""
    return profiles.shape("quartic", depth=depth)


def test_second_call_reads_what_the_first_wrote(store):
    """Every array comes back to the bit, with sampling data and metadata."""
    assert store.size == 0
    first = profiles.simulate(profile(), fresnel=IRON, store=store, theta_model="exact", **SMALL)
    assert store.count == 1 and store.size > 1000
    again = profiles.simulate(profile(), fresnel=IRON, store=store, theta_model="exact", **SMALL)
    assert again is not first
    for name in (
        "mirror",
        "by_bounce",
        "normal",
        "gamma",
        "lost",
        "cdf",
        "slices",
        "slice_cosines",
        "angles",
        "weights",
    ):
        np.testing.assert_array_equal(getattr(again, name), getattr(first, name))
    assert again.metadata == first.metadata and again.rays == first.rays
    assert store.clear() == 1 and store.size == 0


def test_everything_that_matters_is_in_the_key(store):
    """Each change makes a table of its own; threads do not."""
    base = {"fresnel": None, "resolution": 16, "rays": 16}
    profiles.simulate(profile(), store=store, **base)
    changes = [
        {"fresnel": IRON},
        {"fresnel": Conductor(2.91, 3.09, "lazanyi")},
        {"resolution": 17},
        {"rays": 17},
        {"seed": 1},
        {"incidence": "centre"},
        {"sampler": "random"},
        {"max_bounces": 3},
        {"theta_model": "quadratic"},
    ]
    for change in changes:
        profiles.simulate(profile(), store=store, **{**base, **change})
    profiles.simulate(profile(0.51), store=store, **base)
    profiles.simulate(profiles.Profile(profile().points), store=store, **base)
    profiles.simulate(profiles.shape("quartic", depth=0.5, isolated=True), store=store, **base)
    assert store.count == 1 + len(changes) + 3
    profiles.simulate(profile(), store=store, threads=1, **base)
    assert store.count == 1 + len(changes) + 3
    assert table_key(profile(), None, polarised=False) != table_key(profile(), None, polarised=True)


@pytest.mark.parametrize("damage", ["cut", "garbage", "empty"])
def test_damaged_files_heal(store, damage):
    """A truncated, overwritten or empty file is replaced by a good one."""
    first = profiles.simulate(profile(), store=store, **SMALL)
    (file,) = store.path.glob("*.npz")
    content = file.read_bytes()
    file.write_bytes({"cut": content[: len(content) // 2], "garbage": b"x" * len(content), "empty": b""}[damage])
    again = profiles.simulate(profile(), store=store, **SMALL)
    np.testing.assert_array_equal(again.mirror, first.mirror)
    assert file.read_bytes() == content


def test_concurrent_writers_and_readers(store):
    """Eight threads that want the same two tables: whole tables for everyone, two files, no leftovers."""
    results, failures = [], []

    def work():
        try:
            for depth in (0.3, 0.4) * 4:
                results.append((depth, profiles.simulate(profile(depth), store=store, threads=1, **SMALL).mirror))
        except Exception as error:  # a thread's failure must reach the test
            failures.append(error)

    workers = [threading.Thread(target=work) for _ in range(8)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert not failures
    for depth in (0.3, 0.4):
        mine = [mirror for d, mirror in results if d == depth]
        assert len(mine) == 32 and all(np.array_equal(mine[0], other) for other in mine)
    assert len(list(store.path.iterdir())) == 2


def test_store_stays_within_its_limit(tmp_path):
    """The least recently used go first; the one just written stays even if it alone is too large."""
    probe = profiles.store(tmp_path / "probe")
    profiles.simulate(profile(), store=probe, **SMALL)
    store = profiles.store(tmp_path / "tables", limit=int(probe.size * 2.5))
    for depth in (0.1, 0.2):
        profiles.simulate(profile(depth), store=store, **SMALL)
    import os

    key = table_key(
        profile(0.1),
        None,
        theta_model="gamma",
        polarised=False,
        incidence="cell",
        sampler="beam",
        max_bounces=2000,
        seed=0,
        **SMALL,
    )
    for file in store.path.iterdir():
        os.utime(file, (1, 1) if key in file.name else (2, 2))
    assert store.load(key) is not None
    profiles.simulate(profile(0.3), store=store, **SMALL)
    assert store.count == 2 and store.size <= store.limit
    assert store.load(key) is not None
    tiny = profiles.store(tmp_path / "tiny", limit=1)
    profiles.simulate(profile(), store=tiny, **SMALL)
    assert tiny.count == 1


def test_folder_comes_from_the_environment(tmp_path, monkeypatch):
    """SCRATCHWARP_CACHE, then XDG_CACHE_HOME; a limit of 0 is refused."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv("SCRATCHWARP_CACHE", raising=False)
    assert default_folder() == tmp_path / "scratchwarp" / "profiles"
    monkeypatch.setenv("SCRATCHWARP_CACHE", str(tmp_path / "own"))
    assert profiles.store().path == tmp_path / "own" / "profiles"
    with pytest.raises(ValueError, match="limit"):
        profiles.store(limit=0)
