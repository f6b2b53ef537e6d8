"""What each theta model costs in accuracy on a given profile and reflector, measured."""

from typing import Any

import numpy as np

from scratchwarp.profiles.profile import Profile
from scratchwarp.profiles.theta import THETA_MODELS
from scratchwarp.profiles.tracing import trace_paths

_THETAS = np.radians((20.0, 40.0, 55.0, 65.0, 72.0, 78.0, 83.0, 86.0, 88.5))


def theta_model_errors(profile: Profile, fresnel: Any, *, resolution: int = 32, rays: int = 256) -> dict[str, float]:
    """Largest error of a directional albedo (a share of the incident light, over phi_i and theta up to 88.5 degrees)
    of every theta model against the slices themselves, from one coarse trace. The outermost bins of phi_i, where
    light meets the profile at less than ``pi / resolution`` and hardly any arrives, are left out."""
    traced = trace_paths(profile, resolution=resolution, rays=rays)
    truth = traced.slices(_THETAS, fresnel)
    errors = {}
    for name in THETA_MODELS:
        table = traced.table(fresnel, theta_model=name)
        weights = table.weights.reshape(-1, *[1] * (truth.ndim - 2))
        found = [((table.slice(float(a), name) - truth[k]) * weights).sum(axis=0)[1:-1] for k, a in enumerate(_THETAS)]
        errors[name] = float(np.abs(found).max())
    return errors


def choose_theta_model(profile: Profile, fresnel: Any, max_error: float) -> str:
    """The cheapest theta model whose largest albedo error is at most ``max_error``, or the most accurate one."""
    if not max_error > 0.0:
        raise ValueError(f"max_error must be above 0, got {max_error}")
    errors = theta_model_errors(profile, fresnel)
    return next((name for name in THETA_MODELS if errors[name] <= max_error), THETA_MODELS[-1])
