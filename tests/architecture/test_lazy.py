"""Packages whose public names load on first use."""

import importlib
import subprocess
import sys

import pytest

PACKAGES = ("scratchwarp.optics", "scratchwarp.reflectance", "scratchwarp.reflectance.mdf")


@pytest.mark.parametrize("package", PACKAGES)
def test_every_public_name_loads_and_is_listed(package):
    module = importlib.import_module(package)
    assert set(module.__all__) <= set(dir(module))
    assert all(getattr(module, name) is not None for name in module.__all__)
    with pytest.raises(AttributeError, match=f"{package}.*'glitter'"):
        _ = module.glitter


@pytest.mark.parametrize("package", PACKAGES)
def test_importing_the_package_loads_none_of_its_modules(package):
    code = f"import sys, {package}; print('warp' in sys.modules, 'numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "False"]
