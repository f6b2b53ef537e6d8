"""What every test stands on: schemas that USD finds whoever opens the first stage, and a cache of its own."""

import os
import shutil
import tempfile

from scratchwarp import usd_schemas

usd_schemas.set_environment()
_cache = tempfile.mkdtemp(prefix="scratchwarp-tests-")
os.environ["SCRATCHWARP_CACHE"] = _cache


def pytest_unconfigure():
    """Remove the tests' cache."""
    shutil.rmtree(_cache, ignore_errors=True)
