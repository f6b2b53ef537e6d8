"""The reference tracer as a fixture."""

import importlib.util
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def brute_force():
    """The module ``brute_force`` beside this file."""
    spec = importlib.util.spec_from_file_location("profiles_brute_force", Path(__file__).with_name("brute_force.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
