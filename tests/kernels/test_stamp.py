"""The stamp that keeps an edited device function from running out of a stale kernel cache."""

from dataclasses import replace
from pathlib import Path

import pytest

from scratchwarp.kernels import KernelKey
from scratchwarp.kernels import stamp as stamps


@pytest.fixture(autouse=True)
def fresh():
    stamps.device_code.cache_clear()
    yield
    stamps.device_code.cache_clear()


def test_one_number_for_one_key():
    assert stamps.stamp(KernelKey()) == stamps.stamp(KernelKey())
    assert stamps.stamp(KernelKey()) != stamps.stamp(replace(KernelKey(), shadows=True))
    assert 0 < stamps.stamp(KernelKey()) < 2**31


@pytest.mark.parametrize("edited", ["lights/rect_device.py", "scratches/worley_device.py", "kernels/render_device.py"])
def test_an_edited_device_file_changes_it(edited, monkeypatch):
    before, read = stamps.stamp(KernelKey()), Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda p: read(p) + (b" " if p.as_posix().endswith(edited) else b""))
    stamps.device_code.cache_clear()
    assert stamps.stamp(KernelKey()) != before


def test_host_files_do_not(monkeypatch):
    before, read = stamps.stamp(KernelKey()), Path.read_bytes
    monkeypatch.setattr(Path, "read_bytes", lambda p: read(p) + (b"" if p.name.endswith("_device.py") else b" "))
    stamps.device_code.cache_clear()
    assert stamps.stamp(KernelKey()) == before
