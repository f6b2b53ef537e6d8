"""A small film that holds what a rendering would."""

from types import SimpleNamespace

import numpy as np
import pytest


def _film(width: int = 7, height: int = 5, crop=None, full_size=None) -> SimpleNamespace:
    rng = np.random.default_rng(3)
    shape = (height, width)
    depth = rng.uniform(1, 10, shape).astype(np.float32)
    depth[0, 0] = np.inf
    aovs = {
        "color": rng.uniform(0, 4, (*shape, 3)).astype(np.float32),
        "alpha": np.ones(shape, np.float32),
        "depth": depth,
        "normal": rng.uniform(-1, 1, (*shape, 3)).astype(np.float32),
        "albedo": rng.uniform(0, 1, (*shape, 3)).astype(np.float32),
        "P": rng.uniform(-100, 100, (*shape, 3)).astype(np.float32),
        "primId": np.arange(height * width, dtype=np.int32).reshape(shape) - 1,
        "base": rng.uniform(0, 2, (*shape, 3)).astype(np.float32),
        "scratches": rng.uniform(0, 2, (*shape, 3)).astype(np.float32),
    }
    metadata = {
        "Software": "scratchwarp 0.1.0",
        "scratchwarp:seed": 4294967295,
        "scratchwarp:spp": 16,
        "scratchwarp:wallSeconds": 1.5,
        "worldToCamera": tuple(float(i) for i in range(16)),
        "worldToNDC": np.eye(4),
        "scratchwarp:wavelengths": (450.0, 550.0),
    }
    return SimpleNamespace(aovs=aovs, metadata=metadata, crop=crop, full_size=full_size or (width, height), stats={})


@pytest.fixture
def small_film():
    """Makes a film of a few random pixels: small_film(width, height, crop, full_size)."""
    return _film
