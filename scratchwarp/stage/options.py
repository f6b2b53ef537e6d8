"""UsdRender settings, products and vars to RenderOptions."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from pxr import Sdf, Usd, UsdRender

from scratchwarp.scene import RenderOptions, RenderProduct, RenderVar, StageError

from .binding import PURPOSES as BINDING_PURPOSES
from .color import UNTOUCHED
from .reading import Reading

_PREFIX = "scratch:render:"


@dataclass(frozen=True)
class StageSettings:
    """What the stage's render settings say.

    Attributes:
        options: what the renderer is asked for.
        camera: prim path of their camera, None where none is named.
        purposes: includedPurposes, None where they are not authored.
        binding_purposes: materialBindingPurposes.
    """

    options: RenderOptions
    camera: str | None = None
    purposes: tuple[str, ...] | None = None
    binding_purposes: tuple[str, ...] = BINDING_PURPOSES


def read_settings(reading: Reading, wanted: str | None) -> StageSettings:
    """Read the settings prim ``wanted`` (a path), else the one that the stage's metadata names, else none.

    The first render product overrides what it authors itself. Raises StageError when ``wanted`` is no RenderSettings.
    """
    stage = reading.stage
    path = settings_path(stage, wanted)
    if not path:
        return StageSettings(RenderOptions())
    prim = stage.GetPrimAtPath(path) if Sdf.Path.IsValidPathString(path) else None
    if not prim or not prim.IsA(UsdRender.Settings):
        if wanted:
            raise StageError(f"{reading.path}: {wanted} is no RenderSettings prim; give the path of one")
        reading.warn(path, "the stage's renderSettingsPrimPath leads to no RenderSettings; it is ignored")
        return StageSettings(RenderOptions())

    products = [p for p in _targets(stage, prim, "products") if p.IsA(UsdRender.Product)]
    if len(products) > 1:
        reading.warn(path, f"has {len(products)} render products; the camera and the frame of the first are used")
    merged = _Merged(reading, prim, products[:1])
    _complain(reading, prim)
    cameras = merged.targets("camera")
    included = prim.GetAttribute("includedPurposes")
    return StageSettings(
        options=_options(reading, prim, merged, [_product(reading, p) for p in products]),
        camera=str(cameras[0]) if cameras else None,
        purposes=tuple(map(str, included.Get())) if included.HasAuthoredValue() else None,
        binding_purposes=tuple(map(str, reading.value(prim, "materialBindingPurposes", BINDING_PURPOSES))),
    )


def settings_path(stage: Usd.Stage, wanted: str | None) -> str:
    """Path of the settings prim that is meant, "" where there is none."""
    return wanted or (stage.GetMetadata("renderSettingsPrimPath") if _has_metadata(stage) else "") or ""


@dataclass(frozen=True)
class _Merged:
    """Settings with a product's authored opinions over them."""

    reading: Reading
    settings: Usd.Prim
    products: Sequence[Usd.Prim]

    def value(self, name: str, otherwise: Any = None) -> Any:
        for prim in self.products:
            if prim.GetAttribute(name).HasAuthoredValue():
                return self.reading.value(prim, name, otherwise)
        return self.reading.value(self.settings, name, otherwise)

    def authored(self, name: str) -> bool:
        return any(p.GetAttribute(name).HasAuthoredValue() for p in (*self.products, self.settings))

    def targets(self, name: str) -> list[Sdf.Path]:
        for prim in self.products:
            if prim.GetRelationship(name).HasAuthoredTargets():
                return prim.GetRelationship(name).GetForwardedTargets()
        return self.settings.GetRelationship(name).GetForwardedTargets()


def _options(reading: Reading, prim: Usd.Prim, merged: _Merged, products: Sequence[RenderProduct]) -> RenderOptions:
    own = {
        name: reading.value(prim, _PREFIX + name) if prim.GetAttribute(_PREFIX + name).HasAuthoredValue() else None
        for name in ("samplesPerPixel", "seed", "maxError", "quality", "integrator", "maxDepth", "filterWidth")
    }
    resolution = None
    if merged.authored("resolution"):
        wide, high = (int(v) for v in merged.value("resolution"))
        resolution = (wide, high) if min(wide, high) >= 1 else None
        if resolution is None:
            reading.warn(prim.GetPath(), f"resolution is {(wide, high)}; it is ignored")
    x0, y0, x1, y1 = (float(v) for v in merged.value("dataWindowNDC", (0, 0, 1, 1)))
    if not (x0 < x1 and y0 < y1):
        reading.warn(prim.GetPath(), f"dataWindowNDC is {(x0, y0, x1, y1)}; it is ignored")
        x0, y0, x1, y1 = 0.0, 0.0, 1.0, 1.0
    forced = {str(name): False for name in reading.value(prim, _PREFIX + "disableEffects", [])}
    forced |= {str(name): True for name in reading.value(prim, _PREFIX + "enableEffects", [])}
    knobs = [str(text) for text in reading.value(prim, _PREFIX + "knobs", [])]
    for text in (text for text in knobs if not all(text.partition("="))):
        reading.warn(prim.GetPath(), f"{_PREFIX}knobs has {text!r}, which is not NAME=VALUE; it is ignored")
    try:
        return RenderOptions(
            path=str(prim.GetPath()),
            resolution=resolution,
            pixel_aspect=float(merged.value("pixelAspectRatio", 1.0)),
            conform=str(merged.value("aspectRatioConformPolicy", "expandAperture")),
            data_window=(x0, y0, x1, y1),
            depth_of_field=not merged.value("disableDepthOfField", False),
            spp=_whole(own["samplesPerPixel"]),
            seed=_whole(own["seed"]),
            max_error=None if own["maxError"] is None else float(own["maxError"]),
            quality=_text(own["quality"]),
            integrator=_text(own["integrator"]),
            max_depth=_whole(own["maxDepth"]),
            filter=str(reading.value(prim, _PREFIX + "pixelFilter", "blackmanHarris")),
            filter_width=None if own["filterWidth"] is None else float(own["filterWidth"]),
            effects=tuple(sorted(forced.items())),
            products=tuple(products),
            knobs=tuple((t.partition("=")[0], t.partition("=")[2]) for t in knobs if all(t.partition("="))),
        )
    except ValueError as error:
        raise StageError(f"{reading.path}: {error}") from None


def _product(reading: Reading, prim: Usd.Prim) -> RenderProduct:
    name = str(reading.value(prim, "productName", "")) or prim.GetName()
    found = []
    for var in _targets(reading.stage, prim, "orderedVars"):
        kind = str(reading.value(var, "sourceType", "raw"))
        source = str(reading.value(var, "sourceName", "")) or var.GetName()
        if kind not in ("raw", "intrinsic"):
            reading.warn(var.GetPath(), f"sourceType {kind!r} is not honoured; the var is left out")
            continue
        found.append(RenderVar(name=var.GetName(), source=source))
    kind = str(reading.value(prim, "productType", "raster"))
    if kind != "raster":
        reading.warn(prim.GetPath(), f"productType {kind!r} is not honoured; a raster image is written")
    return RenderProduct(path=str(prim.GetPath()), name=name, vars=tuple(found))


def _complain(reading: Reading, prim: Usd.Prim) -> None:
    space = str(reading.value(prim, "renderingColorSpace", "") or "")
    if space not in UNTOUCHED:
        reading.warn(prim.GetPath(), f"renderingColorSpace is {space!r}; images are rendered in linear Rec.709")


def _has_metadata(stage: Usd.Stage) -> bool:
    return bool(stage.HasAuthoredMetadata("renderSettingsPrimPath"))


def _targets(stage: Usd.Stage, prim: Usd.Prim, name: str) -> list[Usd.Prim]:
    found = [stage.GetPrimAtPath(t) for t in prim.GetRelationship(name).GetForwardedTargets()]
    return [p for p in found if p]


def _whole(value: Any) -> int | None:
    return None if value is None else int(value)


def _text(value: Any) -> str | None:
    return None if value is None else str(value)
