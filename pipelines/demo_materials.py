"""Four scratched materials on one goblet: gold, painted metal, plastic and finished wood (Raymond 2016, Figure 12).

Sizes are fractions of the uv square with lengths, widths, spreads and numbers of sets as in the paper's Table 1; its
threshold d of the noise is authored here as the share of the surface that all sets cover together. Lengths in
centimetres, +Y up. Plastic and wood have wider scratches than the table's, so that a goblet of 640 pixels shows them.
All ask for 64 samples; metals, in which neighbours mirror each other, for the path integrator.
"""

from pathlib import Path
from typing import Any

import numpy as np
from pxr import Sdf, Usd, UsdShade

from scratchwarp import image

from . import demo_shapes as shapes
from . import demo_usd as usd
from .demo_ball import metal

# name -> (sets of scratches, spread in degrees, length, width, aspect, covered share, profile)
TABLE_1: dict[str, tuple[int, float, float, float, float, float, str]] = {
    "gold": (4, 4.0, 0.1, 5e-5, 0.12, 0.5, "quartic"),
    "painted": (16, 360.0, 0.1, 2e-4, 0.3, 0.22, "vGroove"),
    "plastic": (32, 360.0, 0.15, 5e-4, 0.2, 0.5, "round"),
    "wood": (16, 360.0, 0.3, 6e-4, 0.2, 0.35, "round"),
}

# Radius in centimetres and radiance of the small lamp. Clear scratches send back a few percent and need a bright one to
# show; through a path tracer its caustics under metal would take far more than 64 samples.
SPARKS = {"path": (1.6, 150.0), "direct": (0.6, 3000.0)}


def gold(path: Path | str, detail: float = 1.0) -> Path:
    """Polished gold with tiny scratches around it, hardly seen one by one."""
    stage = usd.new_stage()
    owner = metal(stage, "gold", "gold", 0.01)
    scratch(owner, "gold")
    return arranged(stage, owner, path, detail, "Scratched gold.")


def painted(path: Path | str, detail: float = 1.0) -> Path:
    """Red paint that scratches have cut down to the aluminium."""
    stage = usd.new_stage()
    owner = usd.material(stage, "painted", diffuseColor=(0.5, 0.035, 0.02), roughness=0.16, ior=1.5)
    scratch(owner, "painted", material="conductor", metal="aluminium")
    return arranged(stage, owner, path, detail, "Scratched paint over metal.")


def plastic(path: Path | str, detail: float = 1.0) -> Path:
    """Blue plastic: scratches reflect like the clear interface and share the colour beneath it."""
    stage = usd.new_stage()
    owner = usd.material(stage, "plastic", diffuseColor=(0.02, 0.09, 0.3), roughness=0.07, ior=1.5)
    scratch(owner, "plastic", material="dielectric", ior=1.5)
    return arranged(stage, owner, path, detail, "Scratched plastic.", "direct")


def wood(path: Path | str, detail: float = 1.0) -> Path:
    """Varnished wood; writes the grain beside the stage, as <stage>_grain.png."""
    stage = usd.new_stage()
    path = Path(path)
    grain = path.with_name(f"{path.stem}_grain.png")
    path.parent.mkdir(parents=True, exist_ok=True)
    image.write_layers({"color": rings(max(16, int(512 * min(detail, 2.0))))}, grain)
    owner = usd.material(stage, "wood", diffuseColor=(0.3, 0.16, 0.07), roughness=0.1, ior=1.5)
    textured(owner, f"./{grain.name}")
    scratch(owner, "wood", material="dielectric", ior=1.5)
    return arranged(stage, owner, path, detail, "Scratched varnish over wood.", "direct")


def scratch(owner: UsdShade.Material, name: str, **reflects: Any) -> None:
    """The layer that Table 1 describes; ``reflects``: what the scratches are made of, the base when left out."""
    sets, spread, length, width, aspect, covered, shape = TABLE_1[name]
    usd.layer(
        owner, "scratches", usd.profile(owner, "cut", shape=shape, rim=0.15), distribution="worley", space="uv",
        patterns=sets, angleSpread=spread, length=length, width=width, depth=aspect * width, coverage=covered, seed=12,
        **reflects,
    )


def rings(size: int) -> np.ndarray:
    """Grain of wood [size, size, 3] in linear Rec.709, seamless from left to right: wavering streaks along v."""
    v, u = np.meshgrid(np.linspace(0, 1, size), np.linspace(0, 1, size, endpoint=False), indexing="ij")
    turn = 2 * np.pi * u
    waver = 0.5 * np.sin(2 * turn + 3.0 * v) + 0.3 * np.sin(5 * turn - 7.0 * v) + 0.15 * np.sin(9 * turn + 11.0 * v)
    streak = 0.5 + 0.5 * np.sin(22.0 * turn + 2.2 * waver + 1.5 * np.sin(4.0 * v))
    fine = 0.5 + 0.5 * np.sin(118.0 * turn + 9.0 * waver)
    share = (0.75 * streak**3 + 0.25 * fine)[..., None]
    return (1 - share) * np.array([0.36, 0.185, 0.08]) + share * np.array([0.15, 0.062, 0.024])


def textured(owner: UsdShade.Material, file: str) -> None:
    """Connect the diffuse colour of the material's UsdPreviewSurface to an image read by st."""
    stage, path = owner.GetPrim().GetStage(), owner.GetPath()
    reader = UsdShade.Shader.Define(stage, path.AppendChild("st"))
    reader.CreateIdAttr("UsdPrimvarReader_float2")
    reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set("st")
    grain = UsdShade.Shader.Define(stage, path.AppendChild("grain"))
    grain.CreateIdAttr("UsdUVTexture")
    grain.CreateInput("file", Sdf.ValueTypeNames.Asset).Set(Sdf.AssetPath(file))
    grain.CreateInput("sourceColorSpace", Sdf.ValueTypeNames.Token).Set("sRGB")
    for wrap in ("wrapS", "wrapT"):
        grain.CreateInput(wrap, Sdf.ValueTypeNames.Token).Set("repeat")
    st = reader.CreateOutput("result", Sdf.ValueTypeNames.Float2)
    grain.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(st)
    preview = UsdShade.Shader.Get(stage, path.AppendChild("preview"))
    color = preview.GetInput("diffuseColor")
    color.ConnectToSource(grain.CreateOutput("rgb", Sdf.ValueTypeNames.Float3))


def goblet(detail: float) -> shapes.Shape:
    """Foot, stem and cup, open at the top: the cup's inside sees itself."""
    n = max(4, int(28 * detail))
    foot = [(0.0, 0.0), (4.6, 0.0)]
    rise = shapes.smooth([(4.6, 0.0), (4.7, 0.25), (3.4, 0.9), (1.5, 1.7), (0.95, 3.0), (1.25, 3.7)], 2 * n)
    cup = shapes.smooth([(1.25, 3.7), (3.6, 5.0), (5.3, 7.6), (5.6, 10.6), (4.9, 14.0), (4.55, 15.4)], 3 * n)
    lip = shapes.smooth([(4.55, 15.4), (4.48, 15.52), (4.38, 15.42)], max(3, n // 4))
    hollow = shapes.smooth([(4.38, 15.42), (4.7, 14.0), (5.4, 10.6), (5.1, 7.7), (3.4, 5.2), (0.0, 4.4)], 3 * n)
    return shapes.lathe([foot, rise, cup, lip, hollow], max(16, int(160 * detail)))


def arranged(
    stage: Usd.Stage, owner: UsdShade.Material, path: Path | str, detail: float, comment: str, integrator: str = "path"
) -> Path:
    """The goblet and a ball of the material on a table, their lights and the camera."""
    rings = max(8, int(48 * detail))
    usd.mesh(stage, "goblet", goblet(detail), owner)
    ball = shapes.sphere(3.1, (0.25, 0.45, 0.86), rings, 2 * rings)
    usd.mesh(stage, "ball", ball, owner, (8.6, 3.1, 3.4))
    table = usd.material(stage, "table", diffuseColor=(0.24, 0.23, 0.22), roughness=0.6, ior=1.5)
    bend = np.linspace(0, np.pi / 2, max(6, int(24 * detail)))
    curve = np.stack([-38 - 26 * np.sin(bend), 26 - 26 * np.cos(bend)], axis=-1)
    outline = np.concatenate([[(60.0, 0.0), (20.0, 0.0), (-20.0, 0.0)], curve, [(-64.0, 50.0), (-64.0, 80.0)]])
    usd.mesh(stage, "backdrop", shapes.extruded(outline, 240.0), table)
    usd.rect_light(stage, "key", (-36.0, 40.0, 26.0), (2.0, 7.0, 0.0), (22.0, 22.0), 9.0, (1.0, 0.96, 0.9))
    usd.rect_light(stage, "side", (44.0, 18.0, 10.0), (2.0, 7.0, 0.0), (8.0, 34.0), 6.0, (0.86, 0.93, 1.0))
    usd.sphere_light(stage, "bulb", (16.0, 40.0, 42.0), 2.2, 160.0)
    usd.sphere_light(stage, "spark", (-20.0, 26.0, 44.0), *SPARKS[integrator], (1.0, 0.86, 0.72))
    usd.dome_light(stage, "ambient", 0.3, (0.85, 0.91, 1.0))
    usd.camera(stage, (4.0, 21.0, 52.0), (3.2, 6.9, 0.0))
    usd.settings(stage, integrator=integrator, samplesPerPixel=64)
    return usd.save(stage, path, comment)
