"""ScratchLayerAPI, ScratchProfile and ScratchWaveAPI to Layer, Profile and Wave."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from pxr import Sdf, Usd

from scratchwarp.scene import Layer, Profile, StageError, Wave

from .color import color
from .curves import CurveSets
from .normal_map import read_normal_map
from .reading import Reading
from .texture import Textures

_API = "ScratchLayerAPI:"
_PREFIX = "scratch:layer:"
_ANGLES = ("angle", "angleSpread", "curvature")
_NUMBERS = {
    "width": "width",
    "depth": "depth",
    "length": "length",
    "coverage": "coverage",
    "density": "density",
    "pitch": "pitch",
    "angle": "angle",
    "angleSpread": "angle_spread",
    "curvature": "curvature",
    "widthVariation": "width_variation",
    "depthVariation": "depth_variation",
    "profileVariation": "profile_variation",
    "variationLength": "variation_length",
    "ior": "ior",
}
_TOKENS = {
    "model": "model",
    "distribution": "distribution",
    "space": "space",
    "material": "material",
    "metal": "metal",
    "fresnelModel": "fresnel",
}
_PROFILE_PARAMETERS = ("apex", "floorWidth", "sigma")
_EXTRA = ("ends",)
_MAPS = {"maskTexture": "mask_texture", "orientationTexture": "orientation_texture"}
PRIMVARS = {"maskPrimvar": "mask_primvar", "orientationPrimvar": "orientation_primvar"}
"""Attribute that names a primvar of the meshes -> field of Layer."""


def read_layers(reading: Reading, prim: Usd.Prim, curves: CurveSets, textures: Textures) -> tuple[Layer, ...]:
    """The enabled layers applied to a material, in cutting order: by ``order``, ties by name.

    Values that no layer can have raise StageError, naming the prim, the layer and the value.
    """
    names = [s.removeprefix(_API) for s in prim.GetAppliedSchemas() if s.startswith(_API)]
    enabled = [n for n in names if reading.value(prim, f"{_PREFIX}{n}:enabled", True)]
    layers = [_layer(reading, prim, name, curves, textures) for name in enabled]
    return tuple(sorted(layers, key=lambda layer: (layer.order, layer.name)))


def degenerate(distribution: str, sizes: Mapping[str, float]) -> list[str]:
    """What is to be said of a layer's sizes that leave nothing of it, or make something else of it."""
    if distribution == "curves":
        return []
    if sizes["width"] == 0.0:
        return ["width is 0; the layer is invisible"]
    said = []
    if distribution in ("worley", "random"):
        if sizes["coverage"] == 0.0 and sizes["density"] == 0.0:
            return ["coverage and density are 0; the layer is invisible"]
        if sizes["length"] == 0.0:
            said.append("length is 0; its scratches are as long as they are wide")
    elif sizes["pitch"] == 0.0:
        return ["pitch is 0; the layer is invisible"]
    if sizes["depth"] == 0.0:
        said.append("depth is 0; its scratches are flat")
    return said


def layer_primvars(stage: Usd.Stage) -> frozenset[str]:
    """Names of the primvars that any scratch layer of the stage reads."""
    found = set()
    for prim in Usd.PrimRange(stage.GetPseudoRoot(), Usd.TraverseInstanceProxies()):
        for schema in prim.GetAppliedSchemas():
            if schema.startswith(_API):
                values = [prim.GetAttribute(f"{_PREFIX}{schema.removeprefix(_API)}:{a}").Get() for a in PRIMVARS]
                found |= {str(v) for v in values if v}
    return frozenset(found)


def _layer(reading: Reading, prim: Usd.Prim, name: str, curves: CurveSets, textures: Textures) -> Layer:
    def get(attribute: str, otherwise: Any = None) -> Any:
        return reading.value(prim, f"{_PREFIX}{name}:{attribute}", otherwise)

    where = f"{prim.GetPath()} layer {name!r}"
    fields: dict[str, Any] = {field: float(get(attribute)) for attribute, field in _NUMBERS.items()}
    for attribute in _ANGLES:
        fields[_NUMBERS[attribute]] = float(np.radians(fields[_NUMBERS[attribute]]))
    tokens: dict[str, Any] = {field: str(get(attribute)) for attribute, field in _TOKENS.items()}
    for attribute, field in _MAPS.items():
        asset = get(attribute)
        fields[field] = textures.index(where, asset, "raw") if _path_or_text(asset) else -1
    tokens |= {field: str(get(attribute)) for attribute, field in PRIMVARS.items()}
    tokens["orientation_encoding"] = str(get("orientationEncoding"))
    if tokens["orientation_primvar"] and fields["orientation_texture"] >= 0:
        reading.warn(where, "has an orientationPrimvar and an orientationTexture; the primvar is used")
    unturned = ("concentric", "spiral", "curves")
    if (tokens["orientation_primvar"] or fields["orientation_texture"] >= 0) and tokens["distribution"] in unturned:
        reading.warn(where, f"distribution {tokens['distribution']} has directions of its own; no map turns it")
    targets = prim.GetRelationship(f"{_PREFIX}{name}:curves").GetForwardedTargets()
    if tokens["distribution"] == "curves" and not targets:
        reading.warn(where, "distribution is curves but its relationship curves has no target; it has no scratches")
    for fault in () if tokens["model"] == "normalMap" else degenerate(tokens["distribution"], fields):
        reading.warn(where, fault)
    tint = _albedo(reading, prim.GetAttribute(f"{_PREFIX}{name}:diffuseColor"), get("diffuseColor"), where)
    extra = tuple((attribute, get(attribute)) for attribute in _EXTRA)
    sizes = fields["width"], fields["depth"]  # of curves without their own; what is no number Layer refuses
    try:
        return Layer(
            name=name,
            prim=str(prim.GetPath()),
            profile=_profile(reading, prim, name, where),
            order=int(get("order")),
            offset=_pair(get("offset")),
            center=_pair(get("center")),
            seed=int(get("seed")),
            eta=_triple(get("eta")),
            k=_triple(get("k")),
            diffuse_color=_triple(tint),
            curves=curves.indices(where, targets, *sizes, tokens["space"]) if np.isfinite(sizes).all() else (),
            patterns=int(get("patterns")),
            cross_angle=float(np.radians(get("crossAngle"))),
            extra=extra,
            profile_end=_profile_end(reading, prim, name, where),
            normal_map=read_normal_map(reading, where, get, textures),
            **fields,
            **tokens,
        )
    except StageError:
        raise
    except ValueError as error:
        raise StageError(f"{reading.path}: {error}") from None


def _albedo(reading: Reading, attribute: Usd.Attribute, authored: Any, where: str) -> np.ndarray:
    """The colour of diffuse scratches, held in [0, 1], with a warning where that changes it. A NaN stays."""
    tint = color(reading, attribute, np.array(authored, np.float64))
    held = np.clip(tint, 0.0, 1.0)
    if np.any(np.abs(tint - held) > 1e-6):
        reading.warn(where, f"diffuseColor is {_triple(tint)}; an albedo lies in [0, 1], {_triple(held)} is used")
    return held


def _profile(reading: Reading, prim: Usd.Prim, name: str, where: str) -> Profile:
    """The profile that a layer's relationship names; without one a V groove, with a warning."""
    targets = prim.GetRelationship(f"{_PREFIX}{name}:profile").GetForwardedTargets()
    if len(targets) > 1:
        reading.warn(where, f"its profile has {len(targets)} targets; the first is used")
    found = reading.stage.GetPrimAtPath(targets[0]) if targets else None
    if found and found.GetTypeName() == "ScratchProfile":
        return read_profile(reading, found)
    reason = f"its profile {targets[0]} is no ScratchProfile" if targets else "has no profile"
    reading.warn(where, f"{reason}; a V groove is used")
    return Profile(path=str(prim.GetPath()))


def _profile_end(reading: Reading, prim: Usd.Prim, name: str, where: str) -> Profile | None:
    """The second profile that a layer's relationship names, if it names one."""
    targets = prim.GetRelationship(f"{_PREFIX}{name}:profileEnd").GetForwardedTargets()
    found = reading.stage.GetPrimAtPath(targets[0]) if targets else None
    if found and found.GetTypeName() == "ScratchProfile":
        return read_profile(reading, found)
    if targets:
        reading.warn(where, f"its profileEnd {targets[0]} is no ScratchProfile; it is ignored")
    return None


def read_profile(reading: Reading, prim: Usd.Prim) -> Profile:
    """Read a ScratchProfile prim; StageError on NaN points and unknown shapes."""
    shape = str(reading.value(prim, "scratch:shape"))
    points = np.asarray(reading.value(prim, "scratch:points", []), np.float64).reshape(-1, 2)
    try:
        return Profile(
            path=str(prim.GetPath()),
            shape=shape,
            points=points if len(points) else None,
            rim=float(reading.value(prim, "scratch:rim")),
            rim_width=float(reading.value(prim, "scratch:rimWidth")),
            periodic=bool(reading.value(prim, "scratch:periodic")),
            parameters=tuple((n, float(reading.value(prim, f"scratch:{n}"))) for n in _PROFILE_PARAMETERS),
        )
    except ValueError as error:
        raise StageError(f"{reading.path}: {error}") from None


def read_wave(reading: Reading, prim: Usd.Prim) -> Wave | None:
    """ScratchWaveAPI's values, None where it is not applied."""
    if "ScratchWaveAPI" not in prim.GetAppliedSchemas():
        return None

    def get(attribute: str) -> Any:
        return reading.value(prim, f"scratch:wave:{attribute}")

    columns = [np.asarray(get(f"ior:{c}"), np.float64) for c in ("wavelengths", "eta", "k")]
    path = prim.GetPath()
    ior = None
    if len({len(c) for c in columns}) > 1:
        reading.warn(path, "scratch:wave:ior's wavelengths, eta and k differ in length; they are ignored")
    elif len(columns[0]):
        ior = np.stack(columns, axis=1)
    try:
        return Wave(
            coherence_radius=float(get("coherenceRadius")),
            wavelength_range=_pair(get("wavelengthRange")),
            samples=int(get("samples")),
            ior=ior,
            phase=str(get("phase")),
            summation=str(get("summation")),
            sampling=str(get("sampling")),
            roughness=float(get("roughness")),
        )
    except ValueError as error:
        raise StageError(f"{reading.path}: {path}: {error}") from None


def _pair(values: Any) -> tuple[float, float]:
    return float(values[0]), float(values[1])


def _triple(values: Any) -> tuple[float, float, float]:
    return float(values[0]), float(values[1]), float(values[2])


def _path_or_text(value: Any) -> str:
    return value.path if isinstance(value, Sdf.AssetPath) else str(value or "")
