"""One colour for each layer, the same in every part of the window."""

from typing import NamedTuple

from scratchwarp.scene import Layer, Scene

# Distinct for colour-blind eyes, too (the Okabe-Ito set), then lighter ones.
PALETTE = ("#e69f00", "#56b4e9", "#009e73", "#f0e442", "#0072b2", "#d55e00", "#cc79a7", "#9ad0a0", "#c9b3e6", "#f4a9a0")
BACKGROUND = "#23262b"
TEXT = "#d8dce2"


class Shown(NamedTuple):
    """A layer, the material it is on (index into ``Scene.materials``), its title and its colour."""

    layer: Layer
    material: int
    title: str
    color: str


def shown(scene: Scene) -> list[Shown]:
    """Every layer of every material that is on something, in order."""
    used = {index for instance in scene.instances for index in instance.materials}
    pairs = [(layer, i) for i, material in enumerate(scene.materials) if i in used for layer in material.layers]
    result = []
    for i, (layer, material) in enumerate(pairs):
        name = scene.materials[material].path.rsplit("/", 1)[-1]
        title = name if name == layer.name else f"{name}: {layer.name}"
        result.append(Shown(layer, material, title, PALETTE[i % len(PALETTE)]))
    return result
