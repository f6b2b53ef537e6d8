"""All kinds of light: a new one is its two files and a line here."""

from scratchwarp.lights.cylinder import CYLINDER
from scratchwarp.lights.disk import DISK
from scratchwarp.lights.distant import DISTANT
from scratchwarp.lights.dome import DOME
from scratchwarp.lights.mesh import MESH
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
        DISK,
        CYLINDER,
        DOME,
        MESH,
    )
}
"""Record class -> its kind of light."""
