"""What every test stands on: schemas that USD finds whoever opens the first stage, and a cache of the run's own.

The processes of one run (pytest-xdist) share that cache: whoever starts first makes it, those it starts inherit it.
"""

import os
import shutil
import tempfile

from scratchwarp import usd_schemas

usd_schemas.set_environment()
_made = None
if "PYTEST_XDIST_WORKER" not in os.environ:
    _made = os.environ["SCRATCHWARP_CACHE"] = tempfile.mkdtemp(prefix="scratchwarp-tests-")


def pytest_unconfigure():
    """Remove the cache that this process made."""
    if _made:
        shutil.rmtree(_made, ignore_errors=True)
