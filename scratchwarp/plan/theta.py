"""Which theta model a table needs: the cheapest whose largest albedo error is within what was asked for."""

from typing import Any

from .. import profiles
from ..reflectance.profile_table import RENDERED, SUMMED

# Largest error of a directional albedo where nothing else is asked for.
DEFAULT_ERROR = 0.01


def theta_model(
    profile: profiles.Profile, fresnel: Any, max_error: float | None, summed: bool = False
) -> tuple[str, float]:
    """(theta model, its error) for one table; "gamma" and 0 for a mirror, which does not vary along the cone.

    ``summed``: of the models whose integrals along a cone follow from sums of slices. The most accurate model that the
    renderer reads is taken where none is accurate enough.
    """
    if fresnel is None:
        return "gamma", 0.0
    errors = profiles.theta_model_errors(profile, fresnel)
    bound = DEFAULT_ERROR if max_error is None else max_error
    names = SUMMED if summed else RENDERED
    name = next((name for name in names if errors[name] <= bound), names[-1])
    return name, errors[name]
