"""From a measured height map to a look: its cross-section, a preset with it, and a page that shows both."""

import argparse
import sys
from pathlib import Path
from typing import Any

from . import pictures
from .command import Command, Report, WrongUsage

Array = Any  # of NumPy, which loads when a pipeline runs


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What ``scratchwarp topography`` understands."""
    parser.add_argument("map", metavar="MAP", help=".npz (height_m, dx_m, dy_m), .npy, .csv or text [um], or an image")
    parser.add_argument("out", metavar="OUT", help="preset: .usda, .usdc or .usd, for author --preset; or points: .csv")
    add_section(parser)
    look = parser.add_argument_group("the look")
    look.add_argument("--metal", default="iron", help="aluminium, gold, copper, silver, iron or brass [iron]")
    look.add_argument("--roughness", type=float, default=0.1, help="GGX alpha of what is between the scratches [0.1]")
    look.add_argument("--coverage", type=float, default=0.3, help="share of the area that scratches cover [0.3]")
    look.add_argument("--length", type=float, default=3000.0, help="of a scratch, micrometres [3000]")
    look.add_argument("--angleSpread", type=float, default=0.0, help="of scratches, degrees [0]")
    parser.add_argument("--report", metavar="DIR", help="a folder with index.html: the map, the profile, the look")
    pictures.add_rendering(parser, width=192, spp=32)


def add_section(parser: argparse.ArgumentParser) -> None:
    """How a cross-section is taken out of a map."""
    parser.add_argument("--pitch", type=float, help="micrometres between samples, for all but .npz")
    parser.add_argument("--height", type=float, help="micrometres from black to white, for images")
    parser.add_argument("--direction", type=float, help="of the grooves, degrees from the map's x axis [found]")
    parser.add_argument("--whole", action="store_true", help="keep the whole mean profile as one period")
    parser.add_argument("--smooth", type=float, default=0.0, help="deviation of a Gaussian over the profile [0 um]")
    parser.add_argument("--tolerance", type=float, default=0.0, help="height that points may be left out for [0 um]")
    parser.add_argument("--waviness", type=float, default=80.0, help="longest wavelength that stays [80 um]; 0: all do")
    parser.add_argument("--degree", type=int, default=2, choices=(0, 1, 2, 3), help="of the polynomial removed [2]")


def cut(options: argparse.Namespace) -> tuple[Any, Any]:
    """(the levelled map, its cross-section) as ``add_section`` was parsed into; ValueError and OSError naming the
    map."""
    import math

    from . import profile_from_topography as source

    for name in ("pitch", "height"):
        value = getattr(options, name)
        if value is not None and not 0.0 < value < math.inf:
            raise WrongUsage(f"--{name} {value} is not above 0")
    for name in ("smooth", "tolerance", "waviness"):
        if not 0.0 <= getattr(options, name) < math.inf:
            raise WrongUsage(f"--{name} {getattr(options, name)} is below 0")
    topography = source.levelled(source.load(options.map, options.pitch, options.height), options.degree)
    if options.waviness > 0.0:
        topography = source.without_waviness(topography, options.waviness)
    direction = None if options.direction is None else math.radians(options.direction)
    found = source.section(topography, direction, options.whole, options.smooth)
    return topography, source.thinned(found, options.tolerance) if options.tolerance > 0.0 else found


def run(options: argparse.Namespace) -> Report:
    """What ``add_arguments`` were parsed into; ValueError and OSError where the input is at fault."""
    import math

    from . import profile_from_topography as source

    pictures.check_out(options.out, [options.map])
    topography, found = cut(options)
    points = Path(options.out).suffix == ".csv"
    if points:
        source.write_points(found, options.out)
    else:
        write_preset(found, Path(options.out), options)
    record: dict[str, Any] = {
        "out": options.out, "points": len(found.x), "width_um": found.width, "depth_um": found.depth,
        "direction_degrees": math.degrees(found.direction), "periodic": found.periodic,
    }  # fmt: skip
    lines = [
        f"{options.out}: {len(found.x)} points, {found.width:.4g} um wide, {found.depth:.4g} um deep, "
        f"grooves at {math.degrees(found.direction):.2f} degrees"
    ]
    if options.report:
        record["report"] = _report(options, topography, found, points)
        lines.append(record["report"])
    return Report(record, tuple(lines))


def write_preset(found: Any, out: Path, options: argparse.Namespace) -> None:
    """A preset file of the cross-section: a Material of scratches in metal, for ``author --preset``; ValueError where a
    value is out of range, OSError where the file cannot be written."""
    from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade, Vt

    from scratchwarp import usd_schemas
    from scratchwarp.optics import metals
    from scratchwarp.stage.overlay import export, reload
    from scratchwarp.whole import whole

    if out.suffix not in (".usda", ".usdc", ".usd"):
        raise WrongUsage(f"OUT {out} is no .usda, .usdc, .usd or .csv")
    for name, most in (("coverage", 1.0), ("roughness", 1.0), ("length", 1e6), ("angleSpread", 360.0)):
        value = getattr(options, name)
        if not 0.0 <= value <= most:
            raise WrongUsage(f"--{name} {value} is not in [0, {most:g}]")
    eta, k = metals.rgb(options.metal)
    usd_schemas.register()
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    material = UsdShade.Material.Define(stage, "/Measured")
    prim = material.GetPrim()
    stage.SetDefaultPrim(prim)
    profile = stage.DefinePrim("/Measured/Section", "ScratchProfile")
    profile.GetAttribute("scratch:shape").Set("points")
    pairs = [Gf.Vec2f(float(x), float(z)) for x, z in found.points]
    profile.GetAttribute("scratch:points").Set(Vt.Vec2fArray(pairs))
    profile.GetAttribute("scratch:periodic").Set(found.periodic)
    prim.ApplyAPI("ScratchLayerAPI", "measured")
    values: dict[str, Any] = {"width": found.width, "depth": found.depth}
    if found.periodic:  # one period after the other
        values |= {"distribution": "linear", "pitch": found.width}
    else:
        values |= {"coverage": options.coverage, "length": options.length, "angleSpread": options.angleSpread}
    for name, value in values.items():
        prim.GetAttribute(f"scratch:layer:measured:{name}").Set(value)
    prim.GetRelationship("scratch:layer:measured:profile").SetTargets([profile.GetPath()])
    f0 = [float(((n - 1) ** 2 + x**2) / ((n + 1) ** 2 + x**2)) for n, x in zip(eta, k, strict=True)]
    preview = UsdShade.Shader.Define(stage, "/Measured/Preview")
    preview.CreateIdAttr("UsdPreviewSurface")
    preview.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(*f0))
    preview.CreateInput("metallic", Sdf.ValueTypeNames.Float).Set(1.0)
    preview.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(options.roughness**0.5)
    ours = UsdShade.Shader.Define(stage, "/Measured/Metal")
    ours.CreateIdAttr("ScratchSurface")
    ours.CreateInput("base", Sdf.ValueTypeNames.Token).Set("conductor")
    ours.CreateInput("metal", Sdf.ValueTypeNames.Token).Set(options.metal)
    ours.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(options.roughness)
    token = Sdf.ValueTypeNames.Token
    material.CreateSurfaceOutput().ConnectToSource(preview.CreateOutput("surface", token))
    material.CreateSurfaceOutput("scratchwarp").ConnectToSource(ours.CreateOutput("surface", token))
    root = stage.GetRootLayer()
    root.documentation = (
        f"Measured. A cross-section {found.width:.4g} micrometres wide and {found.depth:.4g} deep, from "
        f"{Path(options.map).name}."
    )
    with whole(out) as draft:
        export(root, draft, out)
    reload(out)


def _report(options: argparse.Namespace, topography: Any, found: Any, points: bool) -> str:
    """The page: what was measured, what was cut out, and what it looks like."""
    import tempfile

    import numpy as np

    import scratchwarp as sw
    from scratchwarp import profiles

    folder = Path(options.report)
    folder.mkdir(parents=True, exist_ok=True)
    profile = profiles.Profile(np.stack([found.x, found.z], 1), isolated=not found.periodic)
    table = profiles.simulate(profile, resolution=128, rays=128, store=profiles.store())
    figures = {
        f"the map, {topography.height.shape[1] * topography.dx:.4g} um wide, levelled": drawn_map(topography),
        "the cross-section and what it does to light": np.asarray(profiles.picture(table, profile)),
    }
    if not points:
        from .looks import read_preset
        from .preset_gallery import blank
        from .put_on import put_on

        with tempfile.TemporaryDirectory() as place:
            ball = blank(Path(place) / "blank.usda", "measured")
            stage = Path(place) / "shown.usda"
            put_on(ball, stage, read_preset(Path(options.out)), "shown", surface=True)
            figures["the look on a ball"] = np.asarray(pictures.film(sw.read(stage), options, "look")["color"])
    rows = [
        ("source", Path(options.map).name),
        ("width", f"{found.width:.4g} um"),
        ("depth", f"{found.depth:.4g} um"),
        ("grooves", f"{np.degrees(found.direction):.2f} degrees from the map's x axis"),
        ("points", str(len(found.x))),
    ]
    pictures.write_page(folder / "index.html", pictures.page("A measured cross-section", figures, rows))
    return str(folder / "index.html")


def drawn_map(topography: Any, side: int = 256) -> Array:
    """A height map in grey, at most ``side`` pixels each way: black to white over three deviations to either side."""
    import numpy as np

    height = topography.height
    step = max(1, -(-max(height.shape) // side))
    cropped = height[: height.shape[0] // step * step, : height.shape[1] // step * step]
    small = cropped.reshape(cropped.shape[0] // step, step, -1, step).mean(axis=(1, 3))
    shown = np.clip(0.5 + (small - np.median(small)) / (6.0 * max(float(small.std()), 1e-12)), 0.0, 1.0) ** 2.2
    return np.repeat(shown[..., None], 3, -1).astype(np.float32)


COMMAND = Command(
    name="topography",
    says="turn a measured height map into a cross-section and a look",
    examples=(
        "scratchwarp topography ground.npz ground.usda --report ground",
        "scratchwarp topography scan.png scan.usda --pitch 0.5 --height 4 --metal brass --json",
        "scratchwarp author cup.usda worn.usda --preset ground.usda --surface",
    ),
    add_arguments=add_arguments,
    run=run,
    renders=True,
)


main = COMMAND.main

if __name__ == "__main__":
    sys.exit(main())
