"""For each effect of the plan a scene that calls for it and one that does not, otherwise alike.

Two balls, of which the left one alone has what the effect is for. ``FIELDS``: of the kernel's key, which the effect
changes: what of them is off leaves no code, for a kernel is made of its key. ``tables``: profile tables more.
``grows``: whether it needs memory of its own (None: it takes the place of something). ``where``: what of the image it
may change: "left" the left ball, "light" how surfaces are lit, "image" all (what lies behind a pane, what is out of
focus); "" where it is another way to the same image, or one of other methods (the rooms' tests compare their images).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from scratchwarp.reflectance.responses import RESPONSES
from scratchwarp.scene import (
    Camera,
    Curves,
    CylinderLight,
    DiskLight,
    DistantLight,
    Material,
    Measured,
    MeshLight,
    NormalMap,
    PreviewSurface,
    Profile,
    RectLight,
    Scene,
    ScratchSurface,
    SphereLight,
    Texture,
    TextureInput,
    Wave,
)

from ..render import scenes

ROUGH = PreviewSurface(diffuse_color=(0.6, 0.4, 0.3), roughness=0.4)
PLAIN = Material("/mat", ROUGH)
OTHER = Material("/other", ROUGH)
LAMP = RectLight(
    path="/lamp", radiance=(9, 7, 5), center=(0, 3, -3), ex=(0.5, 0, -0.5), ey=(0, 0.7, 0), normal=(0, -0.8, -0.6)
)
SUN = DistantLight(path="/sun", radiance=(2, 2, 2), direction=(0.3, -0.6, -0.74))
BULB = SphereLight(path="/bulb", radiance=(9, 9, 9), center=(0, 3, -4), radius=0.1)
PIXELS = Texture("/pixels", np.random.default_rng(1).random((8, 8, 4)).astype(np.float32))
READ = TextureInput(texture=0)
BUMPS = TextureInput(texture=0, scale=(2, 2, 2, 1), bias=(-1, -1, -1, 0))
VEE = Profile(path="/mat/cut", shape="vGroove")
FLAT = Profile(path="/mat/cut", shape="flat")
BOX = Profile(path="/mat/cut", shape="rectangle")
DEEP = {"width": 3e4, "depth": 2.4e4, "length": 3e5, "pitch": 1.1e5, "coverage": 0.6}
FINE = {
    "width": 3.0,
    "depth": 1.0,
    "length": 3e5,
    "pitch": 40.0,
    "density": 1e-5,
    "profile": BOX,
    "model": "diffraction",
}
LINE = Curves(
    path="/line",
    points=[(-1.1 + 0.7 * np.sin(a), 0.7 * np.cos(a), -5.3) for a in np.linspace(0, 6, 30)],
    counts=[30],
    widths=np.full(30, 3e4),
    depths=np.full(30, 1e4),
)


@dataclass(frozen=True)
class Case:
    """See the module; ``with_it`` and ``without``: scenes, or functions of a folder; ``forced``: only by force is it
    on; ``settings``: of both."""

    with_it: Any
    without: Any
    tables: int = 0
    grows: bool | None = False
    where: str = "left"
    settings: Mapping[str, Any] = field(default_factory=dict)
    only_with: Mapping[str, Any] = field(default_factory=dict)


def world(
    left: Material = PLAIN, lights: Any = None, camera: Camera | None = None, right: Material = OTHER, **fields: Any
) -> Scene:
    """The two balls."""
    ball = scenes.sphere(8, 16)
    m = len(ball.triangles)
    wear = np.linspace(0.0, 1.0, 3 * m).reshape(m, 3, 1)
    ball = replace(ball, primvars={"wear": wear, "flow": np.concatenate([wear, 1 - wear, wear * 0], -1)})
    placed = [scenes.place(0, 0, (-1.1, 0, -6), "/left"), scenes.place(0, 1, (1.1, 0, -6), "/right")]
    lights = [LAMP, scenes.dome(0.3)] if lights is None else lights
    return scenes.scene([ball], [left, right], lights, placed, camera or scenes.camera(30.0), **fields)


def scratched(surface: Any = ROUGH, **fields: Any) -> Material:
    """Deep scratches on the left ball."""
    return scenes.scratched(surface, **{**DEEP, **fields})


SAMPLED = Wave(samples=4, sampling="uniform")  # every wavelength by itself, no table


def waves(wave: Wave | None = None, lights: Any = None, **fields: Any) -> Scene:
    """Scratches that diffract on the left ball."""
    layered = scenes.scratched(ROUGH, **{**FINE, "distribution": "random", **fields})
    return world(replace(layered, wave=wave or Wave(samples=4)), [SUN] if lights is None else lights)


def grooved(**fields: Any) -> Scene:
    """Scratches laid out one by one."""
    return world(scratched(model="groove", **{"distribution": "linear", **fields}), [SUN])


def lit_by(*more: Any, left: Material = PLAIN, **fields: Any) -> Scene:
    """With more lights than the dome."""
    return world(left, [scenes.dome(0.3), *more], **fields)


def measured(name: str) -> Callable[[Any], Scene]:
    """A file of measurements as the base of the left ball, written to a folder."""

    def make(folder: Any) -> Scene:
        from scratchwarp import measured as files

        from ..reflectance.measured.synthetic import grid, rgl_fields, smooth, write_merl, write_tensors

        path = folder / {"utia": "a.bin", "merl": "b.binary", "rgl": "c.bsdf"}[name]
        if name == "utia":
            w = grid()
            files.save_utia(path, smooth(w[:, None], w[None]))
        elif name == "merl":
            write_merl(path, np.broadcast_to(np.float32(90.0), (3, 90, 90, 180)))
        else:
            write_tensors(path, rgl_fields(np.linspace(-np.pi, np.pi, 7)))
        return world(replace(PLAIN, measured=Measured(source="file", file=str(path))))

    return make


MODE = {"azimuth": (0.3,), "width": (0.2,), "a": (1.0,), "b": (0.0,), "kd": (0.5,), "ks": (0.2,), "alpha": (5.0,)}
STENCILS = Measured(**MODE, color=[(1.0, 1.0, 1.0)], beta=0.1, background=0.1, k=0.1)
TEXTURED = PreviewSurface(diffuse_color=READ, roughness=0.3, metallic=1.0)
PLATE = ((-1, 3, -6), (1, 3, -6), (0, 3, -4))
TILTED = ScratchSurface(roughness=0.3, anisotropy=0.8)
STRAIGHT = ScratchSurface(roughness=0.3)
HERE = {"distribution": "linear"}
WAVY = {"distribution": "crosshatch", "width": 1e5, "depth": 2e4, "pitch": 3e5, "width_variation": 0.3}
ON = "forced on"
EXTENT = [LAMP]
SCRATCHED = world(scratched())
POLISHED = replace(ROUGH, roughness=0.1)
BULBS = [SphereLight(path="/l", radiance=(900, 900, 900), center=(0, 3, -4), radius=0.02), scenes.dome(0.3)]
GLOWING = MeshLight(path="/glow", radiance=(2, 2, 2), instance=0)


def force(name: str, scene: Any, **more: Any) -> Case:
    """An effect that is on by force only."""
    return Case(scene, scene, where="", only_with={"effects": {name: True}}, **more)


FIELDS = {
    "scratches": "distributions directed closed_form",
    "scratches.worley": "distributions directed closed_form",
    "scratches.linear": "distributions directed closed_form",
    "scratches.concentric": "distributions directed closed_form",
    "scratches.spiral": "distributions directed closed_form",
    "scratches.full": "distributions directed closed_form",
    "scratches.curves": "distributions directed closed_form",
    "scratches.table": "distributions directed closed_form",
    "scratches.interreflection": "",
    "scratches.fresnel": "",
    "scratches.diffuse": "distributions directed diffuse_scratches",
    "scratches.ashikhminShirley": "distributions directed responses",
    "scratches.normalMap": "distributions directed responses",
    "base.stencils": "directed measured responses",
    "base.utia": "directed measured responses",
    "base.merl": "directed measured responses",
    "base.rgl": "directed measured responses",
    "scratches.sumCoverage": "sum_coverage",
    "scratches.stencil": "distributions measured responses closed_form",
    "scratches.variation": "variation",
    "scratches.textured": "textures tints",
    "scratches.masks": "masks",
    "scratches.orientation": "orientations",
    "diffraction": "glints glint_segments glint_hierarchy glint_fringes",
    "diffraction.segments": "glint_segments glint_hierarchy glint_bands",
    "diffraction.lists": "glint_lists",
    "diffraction.hierarchy": "glint_segments glint_hierarchy glint_bands",
    "diffraction.crowds": "glint_crowds",
    "diffraction.bands": "glints glint_bands glint_fringes",
    "diffraction.coherent": "glint_gratings",
    "diffraction.masks": "glint_masks",
    "diffraction.orientation": "glint_orientations",
    "diffraction.pairs": "glint_pairs",
    "diffraction.pointFootprint": "glint_footprint",
    "diffraction.areaLights": "lights glint_areas",
    "diffraction.lookup": "glint_lookup",
    "diffraction.distantLookup": "glint_fringes",
    "diffraction.outlines": "glint_numeric",
    "diffraction.angles": "glint_numeric",
    "diffraction.exactFootprint": "glint_footprint",
    "diffraction.paperFootprint": "glint_footprint",
    "diffraction.closedForm": "glint_method",
    "diffraction.paperLights": "glint_lookup glint_method",
    "grooves": "grooves groove_bounces",
    "grooves.crossings": "groove_crossings",
    "grooves.interreflection": "groove_bounces",
    "grooves.transmission": "groove_glass",
    "grooves.handover": "grooves groove_bounces groove_handover",
    "grooves.tapers": "groove_tapers",
    "base.preview": "preview",
    "base.measured": "measured",
    "base.direction": "directed",
    "base.textures": "textures",
    "base.normalMaps": "normal_maps textures",
    "base.displayColor": "display_colors",
    "base.opacity": "opacity",
    "base.emission": "emission",
    "lights.distant": "lights",
    "lights.sphere": "lights",
    "lights.rect": "lights",
    "lights.disk": "lights",
    "lights.cylinder": "lights",
    "lights.dome": "lights",
    "lights.mesh": "lights mesh_lights",
    "lights.closedForm": "lights closed_form",
    "lights.small": "small_lights",
    "lights.sampleLights": "sample_lights",
    "lights.sampleCones": "sample_cones",
    "lights.links": "light_links",
    "lights.multipliers": "light_multipliers",
    "shadows": "shadows",
    "indirect": "path",
    "lens": "lens",
    "highlights": "highlights",
}
"""Effect -> the fields of the kernel's key that differ: what it brings, and what it brings with it."""
CASES: dict[str, Case] = {
    "scratches": Case(SCRATCHED, world(), tables=1, grows=True),
    **{
        f"scratches.{kind}": Case(world(scratched(distribution=kind)), world(), tables=1, grows=True)
        for kind in ("worley", "linear", "concentric", "spiral")
    },
    "scratches.full": Case(world(scratched(coverage=1.0)), world(), tables=1, grows=True),
    "scratches.curves": Case(
        world(scratched(distribution="curves", curves=(0,)), curves=(LINE,)), world(), tables=1, grows=True
    ),
    "scratches.table": Case(SCRATCHED, world(), tables=1, grows=True),
    "scratches.interreflection": Case(SCRATCHED, world(scratched(profile=FLAT)), grows=None),
    "scratches.fresnel": Case(world(scratched(fresnel="exact")), SCRATCHED, grows=True),
    "scratches.diffuse": Case(world(scratched(material="diffuse")), world(), grows=True),
    "scratches.ashikhminShirley": Case(world(scratched(model="ashikhminShirley")), world(), grows=True),
    "scratches.normalMap": Case(
        world(scratched(model="normalMap", normal_map=NormalMap(texture=0)), textures=(PIXELS,)), world(), grows=True
    ),
    "base.stencils": Case(world(replace(PLAIN, measured=STENCILS)), world(), grows=True),
    **{f"base.{name}": Case(measured(name), world(), grows=True) for name in ("utia", "merl", "rgl")},
    "scratches.sumCoverage": force("scratches.sumCoverage", SCRATCHED),
    "scratches.stencil": force("scratches.stencil", world(scratched(coverage=0.1)), tables=-1, grows=None),
    "scratches.variation": Case(world(scratched(width_variation=0.5)), SCRATCHED, tables=7, grows=True),
    "scratches.textured": Case(
        world(scratched(TEXTURED, fresnel="schlick"), textures=(PIXELS,)),
        world(scratched(replace(TEXTURED, diffuse_color=(0.5, 0.5, 0.5)), fresnel="schlick"), textures=(PIXELS,)),
        grows=None,
    ),
    "scratches.masks": Case(world(scratched(mask_primvar="wear")), SCRATCHED, grows=True),
    "scratches.orientation": Case(
        world(scratched(orientation_primvar="flow", **HERE)), world(scratched(**HERE)), grows=True
    ),
    "diffraction": Case(waves(), world(lights=[SUN]), grows=True),
    "diffraction.segments": Case(waves(), waves(**HERE), grows=True),
    "diffraction.lists": Case(waves(), waves(), grows=True, where="", only_with={"spp": 64}),
    "diffraction.hierarchy": Case(waves(), waves(**HERE), grows=True),
    "diffraction.crowds": Case(
        waves(density=1e-3), waves(density=1e-3), only_with={"knobs": {"diffraction.strands": 16}}
    ),
    "diffraction.bands": Case(waves(**HERE), world(lights=[SUN]), grows=True),
    "diffraction.coherent": Case(waves(Wave(samples=4, summation="coherent"), **HERE), waves(**HERE), grows=True),
    "diffraction.masks": Case(waves(mask_primvar="wear"), waves(), grows=True),
    "diffraction.orientation": Case(waves(orientation_primvar="flow", **HERE), waves(**HERE), grows=None),
    "diffraction.pairs": Case(waves(Wave(samples=4, summation="coherent")), waves(), grows=None),
    "diffraction.pointFootprint": force("diffraction.pointFootprint", waves(), grows=None),
    # wavelengths are sampled on both sides, so that none has the table of lights without extent
    "diffraction.areaLights": Case(waves(SAMPLED, EXTENT), waves(SAMPLED), where="light", grows=True),
    "diffraction.lookup": Case(waves(lights=EXTENT), waves(SAMPLED, EXTENT), grows=True),
    "diffraction.distantLookup": Case(waves(), waves(SAMPLED), grows=True),
    "diffraction.outlines": Case(waves(SAMPLED, profile=VEE), waves(SAMPLED), grows=True),
    "diffraction.angles": Case(waves(replace(SAMPLED, phase="angleDependent")), waves(SAMPLED)),
    "diffraction.exactFootprint": force("diffraction.exactFootprint", waves(), grows=True),
    "diffraction.paperFootprint": force("diffraction.paperFootprint", waves(), grows=True),
    "diffraction.closedForm": force("diffraction.closedForm", waves(lights=EXTENT)),
    "diffraction.paperLights": force("diffraction.paperLights", waves(lights=EXTENT), grows=None),
    "grooves": Case(grooved(), world(lights=[SUN]), grows=True),
    "grooves.crossings": Case(grooved(distribution="crosshatch"), grooved(), grows=True),
    "grooves.interreflection": Case(grooved(), grooved(depth=0.0), grows=True),
    "grooves.transmission": Case(
        world(scratched(replace(ROUGH, opacity=0.4), model="groove", **HERE), [SUN]),
        world(scratched(replace(ROUGH, opacity=0.4, opacity_mode="presence"), model="groove", **HERE), [SUN]),
        grows=None,
        where="",
    ),
    "grooves.handover": force("grooves.handover", world(scratched(**HERE), [SUN]), grows=True),
    "grooves.tapers": Case(grooved(variation_length=1e6, **WAVY), grooved(**WAVY), grows=True),
    "base.preview": Case(
        world(right=Material("/other", STRAIGHT)),
        world(Material("/mat", STRAIGHT), right=Material("/other", STRAIGHT)),
    ),
    "base.measured": Case(world(Material("/mat", STRAIGHT)), world()),
    "base.direction": Case(world(Material("/mat", TILTED)), world(Material("/mat", STRAIGHT)), grows=True),
    "base.textures": Case(world(Material("/mat", TEXTURED), textures=(PIXELS,)), world(), grows=True),
    "base.normalMaps": Case(
        world(Material("/mat", replace(ROUGH, normal=BUMPS)), textures=(PIXELS,)), world(), grows=True
    ),
    "base.displayColor": Case(world(replace(PLAIN, uses_display_color=True)), world(), grows=True),
    "base.opacity": Case(world(Material("/mat", replace(ROUGH, opacity=0.4))), world(), where="image"),
    "base.emission": Case(
        world(Material("/mat", replace(ROUGH, emissive_color=(0.1, 0.2, 0.3)))), world(), where="light"
    ),
    "lights.distant": Case(lit_by(SUN), lit_by(), where="light", grows=True),
    "lights.sphere": Case(lit_by(SphereLight(path="/l", radiance=(9, 9, 9), center=(0, 3, -4), radius=0.3)), lit_by(),
                          where="light", grows=True),
    "lights.rect": Case(lit_by(LAMP), lit_by(), where="light", grows=True),
    "lights.disk": Case(lit_by(DiskLight(path="/l", radiance=(9, 9, 9), center=(0, 3, -4), ex=(1, 0, 0), ey=(0, 0, 1),
                                         normal=(0, -1, 0))), lit_by(), where="light", grows=True),
    "lights.cylinder": Case(lit_by(CylinderLight(path="/l", radiance=(9, 9, 9), center=(0, 3, -4), axis=(1, 0, 0),
                                                 radius=0.2)), lit_by(), where="light", grows=True),
    "lights.dome": Case(lit_by(LAMP), world(lights=[LAMP]), where="light", grows=True),
    "lights.mesh": Case(lit_by(GLOWING), lit_by(), where="light", grows=True),
    "lights.closedForm": Case(SCRATCHED, world(scratched(), [SUN]), where="light", grows=True),
    "lights.small": Case(world(scratched(), [BULB]), world(scratched(), [replace(BULB, radius=0.9)]), where="light"),
    "lights.sampleLights": force("lights.sampleLights", SCRATCHED),
    "lights.sampleCones": force("lights.sampleCones", SCRATCHED),
    "lights.links": Case(world(lights=[LAMP, replace(scenes.dome(0.3), linked=frozenset({1}))]), world(), where="left"),
    "lights.multipliers": Case(world(lights=[replace(LAMP, specular=0.2)]), world(lights=[LAMP]), where="light"),
    "shadows": Case(world(), world(lights=[replace(LAMP, shadow=False), replace(scenes.dome(0.3), shadow=False)]),
                    where="light"),
    "indirect": Case(world(), world(), where="light", only_with={"integrator": "path"}),
    "lens": Case(world(camera=scenes.camera(30.0, lens_radius=0.2, focus_distance=9.0)), world(), where="image"),
    "highlights": Case(world(Material("/mat", POLISHED), BULBS), world(Material("/mat", ROUGH), BULBS), grows=True),
}  # fmt: skip
assert {r.effect for r in RESPONSES.values()} <= set(CASES)
