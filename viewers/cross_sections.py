"""Cross-sections whose numbers can be turned: the layers of a stage, and the named shapes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from scratchwarp import profiles
from scratchwarp.plan.profiles import PARAMETERS, cross_section
from scratchwarp.scene import Layer, Profile, Scene

from .colors import PALETTE, Shown, shown


class Knob(NamedTuple):
    """A number of a cross-section: its name, the range of its slider, and where it starts."""

    name: str
    low: float
    high: float
    value: float


DEPTH = Knob("depth", 0.0, 2.0, 0.5)
RIM = (Knob("rim", 0.0, 1.0, 0.0), Knob("rimWidth", 0.02, 0.48, 0.25))

# The shapes' own numbers by their names in the schema, with the defaults of ``profiles.shape``.
KNOBS = {
    "apex": Knob("apex", 0.0, 1.0, 0.5),
    "floorWidth": Knob("floorWidth", 0.0, 1.0, 0.5),
    "sigma": Knob("sigma", 0.02, 0.5, 1 / 6),
}


@dataclass(frozen=True, eq=False)
class CrossSection:
    """What is shown: ``record`` at ``depth`` widths, under a title and in a colour."""

    title: str
    record: Profile
    depth: float = DEPTH.value
    color: str = PALETTE[0]

    @property
    def knobs(self) -> tuple[Knob, ...]:
        """The numbers it has, starting where the record is."""
        authored = {**dict(self.record.parameters), "rim": self.record.rim, "rimWidth": self.record.rim_width}
        names = [schema for schema, _ in PARAMETERS.get(self.record.shape, ())]
        own = () if self.record.shape == "points" else (*RIM, *(KNOBS[name] for name in names))
        deep = DEPTH._replace(high=max(DEPTH.high, 2.0 * self.depth), value=self.depth)
        return (deep, *(knob._replace(value=authored.get(knob.name, knob.value)) for knob in own))

    def turned(self, values: Mapping[str, float]) -> "CrossSection":
        """This one with other numbers, by the names of ``knobs``; ValueError where the record refuses them."""
        parameters = {**dict(self.record.parameters), **{k: v for k, v in values.items() if k in KNOBS}}
        record = replace(
            self.record,
            rim=values.get("rim", self.record.rim),
            rim_width=values.get("rimWidth", self.record.rim_width),
            parameters=tuple(parameters.items()),
        )
        return replace(self, record=record, depth=values.get("depth", self.depth))

    def repeated(self, periodic: bool) -> "CrossSection":
        """This one repeated for ever, or alone in flat ground."""
        return replace(self, record=replace(self.record, periodic=periodic))

    def profile(self) -> profiles.Profile:
        """What is simulated, in widths; ValueError naming the number that is out of range."""
        layer = Layer(self.title, self.record.path, self.record, width=1.0, depth=self.depth)
        return cross_section(self.record, layer)


def of_scene(scene: Scene) -> list[CrossSection]:
    """One for every layer on something, in the order of ``colors.shown``."""
    return [
        CrossSection(s.title, s.layer.profile, s.layer.depth / s.layer.width if s.layer.width > 0 else 0.0, s.color)
        for s in shown(scene)
    ]


def rescratched(scene: Scene, items: Sequence[Shown]) -> Scene:
    """The scene with the layers of ``items``, which are ``colors.shown(scene)`` in order with layers replaced."""
    layers = {i: tuple(s.layer for s in items if s.material == i) for i in {s.material for s in items}}
    materials = (replace(m, layers=layers.get(i, m.layers)) for i, m in enumerate(scene.materials))
    return replace(scene, materials=tuple(materials))


def of_shape(name: str, depth: float = DEPTH.value) -> CrossSection:
    """A named shape at ``depth`` widths; ValueError on an unknown name."""
    return CrossSection(name, Profile(name, shape=name), depth)
