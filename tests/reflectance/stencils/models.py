"""Models that the tests share."""

import numpy as np

from scratchwarp.reflectance.stencils import Mode, Model

ONE = Model((Mode(0.5, 0.7, 1.0, 0.01, 0.02, 0.3, 12.0, (0.3, 0.5, 0.9)),), background=0.02, k=1.5, specular_alpha=30)
TWO = Model(
    (
        Mode(0.5, 0.7, 0.9, 0.02, 0.02, 0.3, 12.0, (0.3, 0.5, 0.9)),
        Mode(1.9, 0.6, 1.0, 0.0, 0.03, 0.2, 9.0, (0.9, 0.4, 0.2)),
    ),
    beta=0.2,
    background=0.03,
    k=1.3,
    specular_alpha=20,
)
THREE = Model(
    (
        Mode(2.6, 0.65, 1.0, 0.01, 0.03, 0.35, 16.0, (0.8, 0.8, 0.7)),
        Mode(0.4, 0.7, 1.0, 0.005, 0.02, 0.3, 9.0, (0.9, 0.4, 0.2)),
        Mode(1.4, 0.75, 1.0, 0.015, 0.02, 0.25, 12.0, (0.2, 0.8, 0.3)),
    ),
    beta=(0.1, 0.3),
    background=0.04,
)
MODELS = {"one": ONE, "two": TWO, "three": THREE}


def noisy(values, seed=0, share=0.01):
    """Values with noise of a share of each."""
    return values * (1.0 + share * np.random.default_rng(seed).standard_normal(values.shape))
