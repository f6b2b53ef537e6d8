"""Which theta model a table needs: the cheapest whose largest albedo error is within what was asked for."""

from functools import lru_cache
from typing import Any

from .. import profiles
from ..reflectance.profile_table import RENDERED, SUMMED

# Largest error of a directional albedo where nothing else is asked for.
DEFAULT_ERROR = 0.01


class _Asked:
    """A profile and its reflector: alike where the profile's token and the reflector are."""

    def __init__(self, profile: profiles.Profile, fresnel: Any) -> None:
        self.profile, self.fresnel = profile, fresnel
        self._is = (profile.token, fresnel)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Asked) and self._is == other._is

    def __hash__(self) -> int:
        return hash(self._is)


@lru_cache(maxsize=256)
def _errors(asked: _Asked) -> dict[str, float]:
    """Of every theta model; a stage that is planned again and again, with other knobs each time, asks once."""
    return profiles.theta_model_errors(asked.profile, asked.fresnel)


def theta_model(
    profile: profiles.Profile, fresnel: Any, max_error: float | None, summed: bool = False
) -> tuple[str, float]:
    """(theta model, its error) for one table; "gamma" and 0 for a mirror, which does not vary along the cone.

    ``summed``: of the models whose integrals along a cone follow from sums of slices. The most accurate model that the
    renderer reads is taken where none is accurate enough.
    """
    if fresnel is None:
        return "gamma", 0.0
    errors = _errors(_Asked(profile, fresnel))
    bound = DEFAULT_ERROR if max_error is None else max_error
    names = SUMMED if summed else RENDERED
    name = next((name for name in names if errors[name] <= bound), names[-1])
    return name, errors[name]
