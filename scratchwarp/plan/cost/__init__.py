"""What a render will cost, before it is rendered, and which settings are the cheapest for an error.

Files:
    shares    about what share of the time each effect takes, for ``explain``
    visible   how much of the image each material fills
    work      what a plan makes the renderer do, counted: samples, lights, layers, grooves, rays of tables
    footprints, groove_work, wave_work  what grooves and diffraction do under a footprint
    models    measured seconds of each unit of work and errors of each value of a knob: shipped, or the user's own
    forecast  seconds by effect: work times units
    aim       the cheapest values of all knobs whose predicted error is below the one asked for
"""

from .forecast import Forecast, forecast, slow
from .shares import LIGHT, SET, shares

__all__ = ["LIGHT", "SET", "Forecast", "forecast", "shares", "slow"]
