"""Write a stencil model, fitted to a measured BRDF, as a USD Material: ScratchMeasuredAPI with the model, and a
UsdPreviewSurface for every other program.

The model carries the measurement; the UsdPreviewSurface is an isotropic likeness of it (albedo and width of the
highlight), because that shader has no anisotropy.
"""

import argparse
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade, Vt

from scratchwarp import usd_schemas
from scratchwarp.stage.overlay import save_layer

from .command import script

if TYPE_CHECKING:
    from scratchwarp.reflectance.stencils.model import Model

SUFFIXES = (".usda", ".usdc", ".usd")
STAGES = (".usda", ".usdc", ".usd", ".usdz")


def author(model: "Model", path: Path | str, name: str | None = None, comment: str = "") -> Path:
    """Write ``model`` (a ``stencils.Model``) as the Material /``name``, the default prim of a layer of its own.

    Args:
        path: .usda, .usdc or .usd; appears whole or not at all.
        name: of the Material; by default the file's own name, with what USD forbids replaced.
        comment: of the layer.

    Raises ValueError on another suffix, and where the model has what the schema has no attribute for; OSError where the
    file cannot be written.
    """
    target = Path(path)
    if target.suffix.lower() not in SUFFIXES:
        raise ValueError(f"{target}: the suffix {target.suffix!r} is not one of {', '.join(SUFFIXES)}")
    usd_schemas.register()
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    root = f"/{name or re.sub('[^A-Za-z0-9_]', '_', target.stem)}"
    if not Sdf.Path.IsValidPathString(root):
        root = f"/_{root[1:]}"
    material = UsdShade.Material.Define(stage, root)
    stage.SetDefaultPrim(material.GetPrim())
    material.GetPrim().ApplyAPI("ScratchMeasuredAPI")
    for key, value in _attributes(model).items():
        attribute = material.GetPrim().GetAttribute(f"scratch:measured:{key}")
        if not attribute:
            raise ValueError(f"{target}: the schema has no scratch:measured:{key}, which this model needs")
        attribute.Set(value)
    _preview(stage, material, likeness(model))
    stage.GetRootLayer().comment = comment
    save_layer(stage.GetRootLayer(), target)
    return target


def _attributes(model: "Model") -> dict[str, Any]:
    """What the model is, by the schema's names without ``scratch:measured:``."""
    modes = model.modes
    found: dict[str, Any] = {
        "source": "stencils",
        "beta": float(np.mean(model.beta)) if len(model.beta) else 0.0,
        "background": Gf.Vec3f(model.background),
        "k": model.k,
        "specularAlpha": model.specular_alpha,
        "modes:azimuth": Vt.FloatArray([float(np.degrees(m.azimuth)) for m in modes]),
        "modes:color": Vt.Vec3fArray([Gf.Vec3f(*m.color) for m in modes]),
    }
    found |= {
        f"modes:{key}": Vt.FloatArray([getattr(m, key) for m in modes])
        for key in ("width", "a", "b", "kd", "ks", "alpha")
    }
    if len(set(model.beta)) > 1:
        found["modes:beta"] = Vt.FloatArray(list(model.beta))
    if model.retro:
        found["retro"] = True
    if model.mask != "smooth":
        found["mask"] = model.mask
    return found


def likeness(model: "Model") -> dict[str, Any]:
    """Inputs of a UsdPreviewSurface that looks a little like the model: ``diffuseColor``, ``metallic``, ``roughness``.

    Albedos of the view along the normal, of the model with and without its highlights; the roughness is that of the
    isotropic lobe as wide as the highlight is on the mean of all azimuths.
    """
    from scratchwarp import stencils

    polar, azimuth = np.radians(np.arange(2.0, 88.0, 4.0)), np.radians(np.arange(0.0, 360.0, 7.5))
    theta, phi = np.meshgrid(polar, azimuth, indexing="ij")
    wi = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    value = stencils.evaluate(model, wi, (0.0, 0.0, 1.0), energy_conserving=True).astype(float)
    solid = np.sin(theta) * np.radians(4.0) * np.radians(7.5)
    albedo = np.sum(value * (np.cos(theta) * solid)[..., None], axis=(0, 1))
    floor = np.pi * np.min(value, axis=(0, 1))
    color = np.clip(albedo, 0.0, 1.0)
    shining = float(np.clip(1.0 - floor.sum() / max(albedo.sum(), 1e-12), 0.0, 1.0))
    # alpha of a lobe is the root mean square slope of its half vectors
    lobe = np.maximum(value.sum(-1) - value.sum(-1).min(), 0.0) * solid
    slope = np.tan(0.5 * theta) ** 2
    alpha = float(np.sqrt(np.sum(lobe * slope) / max(np.sum(lobe), 1e-12))) if shining > 0.0 else 1.0
    return {
        "diffuseColor": tuple(float(c) for c in color),
        "metallic": round(shining, 3),
        "roughness": round(float(np.clip(np.sqrt(alpha), 0.05, 1.0)), 3),
    }


def _preview(stage: Usd.Stage, material: UsdShade.Material, inputs: dict[str, Any]) -> None:
    shader = UsdShade.Shader.Define(stage, material.GetPath().AppendChild("preview"))
    shader.CreateIdAttr("UsdPreviewSurface")
    for key, value in inputs.items():
        if isinstance(value, tuple):
            shader.CreateInput(key, Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(*value))
        else:
            shader.CreateInput(key, Sdf.ValueTypeNames.Float).Set(value)
    output = shader.CreateOutput("surface", Sdf.ValueTypeNames.Token)
    material.CreateSurfaceOutput().ConnectToSource(output)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What this script understands."""
    parser.add_argument("measured", type=Path, help="measured BRDF: UTIA .bin, MERL .binary or RGL .bsdf")
    parser.add_argument("out", type=Path, help=".usda, .usdc or .usd")
    parser.add_argument("--modes", type=int, help="how many axes of anisotropy; found when not given")
    parser.add_argument("--no-refine", action="store_true", help="the direct fit alone, which needs no scipy")


def run(options: argparse.Namespace) -> list[str]:
    """Fit and write, and say how near the model is."""
    from scratchwarp import measured, stencils

    brdf = measured.load(options.measured)
    model = stencils.fit(brdf, options.modes, refine=not options.no_refine)
    path = author(model, options.out, comment=f"Fitted to {options.measured.name}.")
    psnr = measured.compare(brdf, stencils.unfolded(model))["psnr"]
    return [f"{path}: {len(model.modes)} modes, PSNR {psnr:.1f} dB"]


main = script(
    "measured_material", __doc__, add_arguments, run,
    "python -m scratchwarp.pipelines.measured_material fabric106.bin fabric106.usda",
)  # fmt: skip


def brdf_of(source: str, material: str | None = None) -> tuple[Any, list[str]]:
    """(BRDF [288, 288, 3], what it stands for) of a measured file, or of a scratched material of a stage from far away.

    ``material``: by path or name; None for the first with scratches. Raises ValueError or OSError naming the file.
    """
    import scratchwarp as sw
    from scratchwarp.plan.far_field import tabulate
    from scratchwarp.reflectance import measured

    if Path(source).suffix.lower() not in STAGES:
        return measured.load(source), []
    scene = sw.read(source)
    scratched = [i for i, one in enumerate(scene.materials) if one.layers]
    if material is None and not scratched:
        raise ValueError(f"{source}: no material has scratches; choose one by --material")
    _, values, notes = tabulate(scene, scratched[0] if material is None else material)
    return values, list(notes)


if __name__ == "__main__":
    sys.exit(main())
