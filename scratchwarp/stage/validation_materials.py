"""Rules about values that must agree with each other: sizes of a layer, wave optics, measured bases, settings."""

from collections.abc import Iterator

import numpy as np
from pxr import Usd, UsdGeom

from .validation_rule import LAYER_PREFIX, Problem, Rule, layer_attribute, layer_names, value

STATISTICAL = ("worley", "random")
REGULAR = ("linear", "concentric", "spiral", "crosshatch")


def check_sizes(prim: Usd.Prim) -> Iterator[Problem]:
    """Layers whose size cannot be meant: wider than the uv square, invisible, or set by an attribute nobody reads."""
    for layer in layer_names(prim):
        get = {
            name: value(layer_attribute(prim, layer, name))
            for name in ("space", "distribution", "width", "depth", "length", "pitch", "density", "coverage")
        }
        needed = {"worley": ("width", "length"), "random": ("width", "length"), "curves": ()}
        if get["space"] == "uv":
            for name in needed.get(get["distribution"], ("width", "pitch")):
                if get[name] is not None and get[name] > 1:
                    yield Problem(
                        layer_attribute(prim, layer, name).GetPath(),
                        f"{name} of layer {layer!r} is {get[name]:g} in space 'uv', more than the whole uv square; "
                        "author a fraction of it, or set space to 'surface' for micrometres",
                    )
        if get["width"] == 0:
            yield Problem(
                layer_attribute(prim, layer, "width").GetPath(),
                f"width of layer {layer!r} is 0, so the layer is invisible; author one above 0 or disable the layer",
                "warning",
            )
        model, image = layer_attribute(prim, layer, "model"), layer_attribute(prim, layer, "normalTexture")
        if value(model) == "normalMap":
            if not (value(image) and value(image).path):
                yield Problem(
                    model.GetPath(),
                    f"model of layer {layer!r} is 'normalMap' but normalTexture names no image; author one, or set the "
                    "model to 'auto'",
                )
            continue
        nothing = get["distribution"] in STATISTICAL and not get["coverage"] and not get["density"]
        if nothing:
            yield Problem(
                layer_attribute(prim, layer, "coverage").GetPath(),
                f"coverage and density of layer {layer!r} are 0, so the layer is invisible; author one above 0 or "
                "disable the layer",
                "warning",
            )
        if get["depth"] == 0 and get["width"] and not nothing and get["distribution"] != "curves":
            yield Problem(
                layer_attribute(prim, layer, "depth").GetPath(),
                f"depth of layer {layer!r} is 0, so its scratches are flat; author one above 0, or a profile of shape "
                "'flat' if that is meant",
                "warning",
            )
        yield from check_unread(prim, layer, get["distribution"])
        if get["distribution"] in REGULAR and get["width"] > get["pitch"] * (1 + 1e-6) > 0:
            yield Problem(
                layer_attribute(prim, layer, "width").GetPath(),
                f"width of layer {layer!r} is {get['width']:g} but its scratches lie {get['pitch']:g} apart and so "
                "overlap; widen the pitch, or narrow the scratches",
                "warning",
            )
        yield from check_variation(prim, layer)


def check_variation(prim: Usd.Prim, layer: str) -> Iterator[Problem]:
    """Variations that lack what they vary."""
    kinds = ("width", "depth", "profile")
    get = {kind: value(layer_attribute(prim, layer, f"{kind}Variation")) or 0 for kind in kinds}
    end = prim.GetRelationship(f"{LAYER_PREFIX}{layer}:profileEnd").GetTargets()
    if bool(get["profile"]) != bool(end):
        here, missing = ("profileVariation", "profileEnd") if get["profile"] else ("profileEnd", "profileVariation")
        path = prim.GetPath().AppendProperty(f"{LAYER_PREFIX}{layer}:{here}")
        yield Problem(path, f"{here} of layer {layer!r} has no effect without {missing}; author both", "warning")
    length = layer_attribute(prim, layer, "variationLength")
    if value(length) and not any(get.values()):
        yield Problem(
            length.GetPath(),
            f"variationLength of layer {layer!r} has no effect; author widthVariation, depthVariation or "
            "profileVariation",
            "warning",
        )


def check_up(stage: Usd.Stage) -> Iterator[Problem]:
    """An upAxis that is neither Y nor Z."""
    axis = str(UsdGeom.GetStageUpAxis(stage))
    if axis not in ("Y", "Z"):
        root = stage.GetPseudoRoot().GetPath()
        yield Problem(root, f"upAxis is {axis!r}; author 'Y' or 'Z' and turn the scene's root instead")


def check_unread(prim: Usd.Prim, layer: str, distribution: str) -> Iterator[Problem]:
    """Amounts that the distribution does not read, or that override each other."""
    read = {**dict.fromkeys(STATISTICAL, ("coverage", "density")), **dict.fromkeys(REGULAR, ("pitch",))}
    for name in ("coverage", "density", "pitch"):
        attribute = layer_attribute(prim, layer, name)
        if attribute.HasAuthoredValue() and name not in read.get(distribution, ()):
            instead = " or ".join(read.get(distribution, ())) or "the curves themselves"
            yield Problem(
                attribute.GetPath(),
                f"{name} of layer {layer!r} is {value(attribute):g}, but distribution {distribution!r} does not read "
                f"it; the amount comes from {instead}",
                "warning",
            )
    density, coverage = layer_attribute(prim, layer, "density"), layer_attribute(prim, layer, "coverage")
    if distribution in STATISTICAL and coverage.HasAuthoredValue() and (value(density) or 0) > 0:
        yield Problem(
            coverage.GetPath(),
            f"coverage of layer {layer!r} is {value(coverage):g} but its density {value(density):g} wins; set density "
            "to 0 or remove coverage",
            "warning",
        )


def check_wave(prim: Usd.Prim) -> Iterator[Problem]:
    """Layers that ask for diffraction without ScratchWaveAPI, and spectra that do not fit together."""
    if not prim.HasAPI("ScratchWaveAPI"):
        for layer in layer_names(prim):
            attribute = layer_attribute(prim, layer, "model")
            if value(attribute) == "diffraction":
                yield Problem(
                    attribute.GetPath(),
                    f"model of layer {layer!r} is 'diffraction' but {prim.GetPath()} lacks ScratchWaveAPI; apply it, "
                    "or set the model to 'auto'",
                )
        return
    first, last = value(prim.GetAttribute("scratch:wave:wavelengthRange"))
    if not first < last:
        yield Problem(
            prim.GetPath().AppendProperty("scratch:wave:wavelengthRange"),
            f"scratch:wave:wavelengthRange is ({first:g}, {last:g}); the first wavelength must be the smaller",
        )
    names = [f"scratch:wave:ior:{name}" for name in ("wavelengths", "eta", "k")]
    arrays = [np.asarray(value(prim.GetAttribute(name)), dtype=float) for name in names]
    yield from check_lengths(prim, names, arrays)
    if (np.diff(arrays[0]) <= 0).any():
        at = int(np.argmax(np.diff(arrays[0]) <= 0)) + 1
        yield Problem(
            prim.GetPath().AppendProperty(names[0]),
            f"{names[0]}[{at}] is {arrays[0][at]:g} after {arrays[0][at - 1]:g}; sort the wavelengths ascending",
        )


def check_lengths(prim: Usd.Prim, names: list[str], arrays: list[np.ndarray]) -> Iterator[Problem]:
    """Arrays that belong together but differ in length."""
    if len({len(array) for array in arrays}) > 1:
        lengths = ", ".join(f"{name} {len(array)}" for name, array in zip(names, arrays, strict=True))
        yield Problem(prim.GetPath(), f"arrays differ in length ({lengths}); give all the same number of values")


def check_measured(prim: Usd.Prim) -> Iterator[Problem]:
    """A measured base without a file, or with modes whose arrays differ in length."""
    source = value(prim.GetAttribute("scratch:measured:source"))
    names = [f"scratch:measured:modes:{name}" for name in ("azimuth", "width", "a", "b", "kd", "ks", "alpha", "color")]
    arrays = [np.asarray(value(prim.GetAttribute(name)), dtype=float) for name in names]
    yield from check_lengths(prim, names, arrays)
    betas = value(prim.GetAttribute("scratch:measured:modes:beta")) or ()
    if len(betas) not in (0, max(len(arrays[0]) - 1, 0)):
        path = prim.GetPath().AppendProperty("scratch:measured:modes:beta")
        wanted = max(len(arrays[0]) - 1, 0)
        yield Problem(path, f"scratch:measured:modes:beta has {len(betas)} entries; {wanted} crossings need {wanted}")
    if source == "file" and not value(prim.GetAttribute("scratch:measured:file")):
        path = prim.GetPath().AppendProperty("scratch:measured:file")
        yield Problem(path, "scratch:measured:source is 'file' but scratch:measured:file is empty; author the file")
    if source == "stencils" and not any(len(array) for array in arrays):
        yield Problem(
            prim.GetPath(), "scratch:measured:source is 'stencils' but it has no mode; author scratch:measured:modes:*"
        )


def check_settings(prim: Usd.Prim) -> Iterator[Problem]:
    """Effects that are switched on and off at once."""
    both = set(value(prim.GetAttribute("scratch:render:enableEffects")) or ()) & set(
        value(prim.GetAttribute("scratch:render:disableEffects")) or ()
    )
    for effect in sorted(both):
        yield Problem(
            prim.GetPath(),
            f"effect {effect!r} is in both scratch:render:enableEffects and scratch:render:disableEffects; keep one",
        )


RULES = (
    Rule("ScratchUpAxis", "The stage's up axis is Y or Z.", check_up, whole_stage=True),
    Rule("ScratchSizes", "The size and amount of a layer can be meant.", check_sizes, ("UsdShadeMaterial",)),
    Rule("ScratchWave", "Wave optics is applied where asked for, and consistent.", check_wave, ("UsdShadeMaterial",)),
    Rule("ScratchMeasured", "A measured base has its data.", check_measured, ("ScratchMeasuredAPI",)),
    Rule("ScratchSettings", "Effects are not both on and off.", check_settings, ("UsdRenderSettings",)),
)
