"""All kinds of light: a new one is its two files and a line here."""

from scratchwarp.lights.distant import DISTANT
from scratchwarp.lights.dome import DOME
from scratchwarp.lights.model import LightModel
from scratchwarp.lights.rect import RECT
from scratchwarp.lights.sphere import SPHERE
from scratchwarp.scene.light import Light

MODELS: dict[type[Light], LightModel] = {
    model.record: model
    for model in (
        DISTANT,
        SPHERE,
        RECT,
        DOME,
    )
}
"""Record class -> its kind of light."""
