"""Random damage to a stage's layer, by the seed: values, types, links, times, prims, and the bytes of the file."""

import contextlib

import numpy as np
from pxr import Gf, Sdf, Tf, Vt

BAD = (float("nan"), float("inf"), float("-inf"), 0.0, -1.0, 1e-30, 1e-12, 1e-6, 1e6, 1e12, 1e30, 3e38)
INTS = (0, -1, 1, 2, 7, 2**31 - 1, -(2**31))
WORDS = (
    "",
    "auto",
    "x",
    "ünï",
    "../..",
    "table",
    "curves",
    "diffraction",
    "groove",
    "mitre",
    "vertex",
    "scratch",
    "1e5",
)
FILES = ("pixels.png", "missing.png", "broken.png", ".", "stage.usda", "pixels.png[0]", "tiny.exr")
APIS = ("ScratchLayerAPI:more", "ScratchLayerAPI", "ScratchWaveAPI", "ScratchCurvesAPI", "ScratchMeasuredAPI")
TYPES = ("float", "int", "token", "string", "float3", "float[]", "matrix4d", "bool", "asset", "color3f", "double2")
MATERIAL_TYPES = {
    "normalTexture": ("asset", "pixels.png"),
    "maskTexture": ("asset", "pixels.png"),
    "orientationTexture": ("asset", "pixels.png"),
    "maskPrimvar": ("token", "wear"),
    "orientationPrimvar": ("token", "flow"),
    "profileVariation": ("float", 0.5),
    "variationLength": ("float", 1000.0),
    "space": ("token", "uv"),
    "seed": ("int", 5),
    "ends": ("token", "mitre"),
    "metal": ("token", "gold"),
    "fresnelModel": ("token", "lazanyi"),
    "curvature": ("float", 720.0),
    "enabled": ("bool", False),
}


def _attributes(layer):
    found = []
    layer.Traverse("/", lambda path: found.append(path) if path.IsPropertyPath() else None)
    return [layer.GetAttributeAtPath(p) for p in found if layer.GetAttributeAtPath(p)]


def _relationships(layer):
    found = []
    layer.Traverse("/", lambda path: found.append(path) if path.IsPropertyPath() else None)
    return [layer.GetRelationshipAtPath(p) for p in found if layer.GetRelationshipAtPath(p)]


def _prims(layer):
    found = []
    layer.Traverse("/", lambda path: found.append(path) if path.IsPrimPath() else None)
    return [layer.GetPrimAtPath(p) for p in found if p != Sdf.Path.absoluteRootPath]


def _any(rng, items):
    items = list(items)
    return items[rng.integers(len(items))] if items else None


def _number(rng, value):
    """Another number in place of one: bad ones, or the same times a power of ten."""
    if rng.integers(3) == 0:
        return float(value) * 10.0 ** float(rng.integers(-6, 7))
    return float(_any(rng, BAD))


def changed(rng, value):
    """A value of the same type as ``value``, other in one place."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return int(_any(rng, INTS))
    if isinstance(value, float):
        return _number(rng, value)
    if isinstance(value, Sdf.AssetPath):
        return Sdf.AssetPath(_any(rng, FILES))
    if isinstance(value, str):
        return _any(rng, WORDS)
    kind = type(value)
    if isinstance(value, Gf.Matrix4d):
        m = np.array(value)
        spot = rng.integers(4, size=2)
        m[spot[0], spot[1]] = _number(rng, m[spot[0], spot[1]])
        if rng.integers(3) == 0:
            m[rng.integers(4)] = 0.0
        return Gf.Matrix4d(*m.ravel().tolist())
    if hasattr(value, "__len__") and kind.__module__ == "pxr.Vt":
        return _array(rng, value, kind)
    if hasattr(value, "__len__") and len(value):  # Gf vectors
        items = list(value)
        spot = int(rng.integers(len(items)))
        items[spot] = changed(rng, items[spot])
        return kind(*items)
    return value


def _array(rng, value, kind):
    items = list(value)
    how = int(rng.integers(6))
    if how == 0 or not items:
        return kind([])
    if how == 1:
        return kind(items[: int(rng.integers(len(items)))])
    if how == 2:
        return kind((items * 3)[: len(items) + int(rng.integers(1, 2 * len(items) + 1))])
    if how == 3:
        return kind([items[0]] * len(items))
    for _ in range(int(rng.integers(1, 3))):
        spot = int(rng.integers(len(items)))
        items[spot] = changed(rng, items[spot])
    return kind(items)


def value(rng, layer):
    """One attribute's value."""
    attribute = _any(rng, [a for a in _attributes(layer) if a.default is not None])
    if attribute:
        attribute.default = changed(rng, attribute.default)


def sample(rng, layer):
    """Time samples, one of them bad, none of them at the time that is read, perhaps."""
    attribute = _any(rng, [a for a in _attributes(layer) if a.default is not None])
    if attribute:
        for time in (1.0, 2.0, 2.5)[: int(rng.integers(1, 4))]:
            layer.SetTimeSample(attribute.path, time, changed(rng, attribute.default))


def matrix(rng, layer):
    """A transform that is singular, mirrored, sheared, huge or not a number."""
    prim = _any(rng, _prims(layer))
    if prim is None:
        return
    m = np.eye(4)
    spot = rng.integers(4, size=2)
    m[spot[0], spot[1]] = _any(rng, (*BAD, 0.5, -0.5))
    made = Sdf.AttributeSpec(prim, f"xformOp:transform:x{rng.integers(1000)}", Sdf.ValueTypeNames.Matrix4d)
    made.default = Gf.Matrix4d(*m.ravel().tolist())
    order = prim.attributes.get("xformOpOrder")
    if order is None:
        order = Sdf.AttributeSpec(prim, "xformOpOrder", Sdf.ValueTypeNames.TokenArray, Sdf.VariabilityUniform)
    order.default = Vt.TokenArray([*(order.default or []), made.name])


def other_type(rng, layer):
    """An attribute of another type."""
    attribute = _any(rng, _attributes(layer))
    if attribute is None:
        return
    prim, name = attribute.owner, attribute.name
    prim.RemoveProperty(attribute)
    kind = Sdf.ValueTypeNames.Find(_any(rng, TYPES))
    made = Sdf.AttributeSpec(prim, name, kind)
    default = kind.defaultValue
    made.default = changed(rng, default) if default is not None else None


def gone(rng, layer):
    """A prim or a property less."""
    if rng.integers(2):
        prim = _any(rng, _prims(layer))
        if prim:
            del (prim.nameParent or layer.pseudoRoot).nameChildren[prim.name]
        return
    attribute = _any(rng, [*_attributes(layer), *_relationships(layer)])
    if attribute:
        attribute.owner.RemoveProperty(attribute)


def link(rng, layer):
    """A relationship or connection to somewhere else: a cycle, nothing, a prim of another kind, several."""
    places = [p.path for p in _prims(layer)] + [Sdf.Path("/nowhere"), Sdf.Path("/mat/node.outputs:surface")]
    targets = [_any(rng, places) for _ in range(int(rng.integers(0, 3)))]
    relationship = _any(rng, _relationships(layer))
    if rng.integers(2) and relationship:
        relationship.targetPathList.explicitItems = list(dict.fromkeys(targets))
        return
    attribute = _any(rng, [a for a in _attributes(layer) if a.connectionPathList.explicitItems])
    if attribute:
        ports = [a.path for a in _attributes(layer)] + targets
        attribute.connectionPathList.explicitItems = [_any(rng, ports)]


def blocked(rng, layer):
    """A value that is blocked."""
    attribute = _any(rng, _attributes(layer))
    if attribute:
        attribute.default = Sdf.ValueBlock()


def kind(rng, layer):
    """A prim of another type, or with another schema applied."""
    prim = _any(rng, _prims(layer))
    if prim is None:
        return
    if rng.integers(2):
        prim.typeName = str(_any(rng, {p.typeName for p in _prims(layer)} | {"Xform", "Nonsense", "DomeLight_1"}))
        return
    schemas = prim.GetInfo("apiSchemas") if prim.HasInfo("apiSchemas") else Sdf.TokenListOp()
    more = Sdf.TokenListOp()
    more.prependedItems = [*dict.fromkeys([*schemas.prependedItems, _any(rng, APIS)])]
    prim.SetInfo("apiSchemas", more)


def added(rng, layer):
    """An attribute of a scratch layer that the stage did not author."""
    materials = [p for p in _prims(layer) if p.typeName == "Material"]
    prim = _any(rng, materials)
    if prim is None:
        return
    name, (type_name, default) = _any(rng, list(MATERIAL_TYPES.items()))
    full = f"scratch:layer:{_any(rng, ('fine', 'deep', 'more'))}:{name}"
    if full not in prim.attributes:
        made = Sdf.AttributeSpec(prim, full, Sdf.ValueTypeNames.Find(type_name))
        made.default = Sdf.AssetPath(default) if type_name == "asset" else default


def units(rng, layer):
    """Metadata of the stage."""
    if rng.integers(2):
        layer.pseudoRoot.SetInfo("metersPerUnit", float(_any(rng, (*BAD, 0.01, 1000.0))))
    else:
        layer.pseudoRoot.SetInfo("upAxis", _any(rng, ("X", "Y", "Z", "")))


def many(rng, layer):
    """A count that is large: scratches, curves, points."""
    prim = _any(rng, [p for p in _prims(layer) if p.typeName == "Material"])
    if prim is None:
        return
    name, amount = _any(rng, (("density", 0.02), ("pitch", 20.0), ("coverage", 1.0), ("length", 1e7), ("density", 1e4)))
    full = f"scratch:layer:fine:{name}"
    made = prim.attributes.get(full) or Sdf.AttributeSpec(prim, full, Sdf.ValueTypeNames.Float)
    made.default = float(amount)


MUTATIONS = (value, value, value, value, sample, matrix, other_type, gone, link, blocked, kind, added, units, many)


def mutate(rng: np.random.Generator, text: str) -> str:
    """The text of a stage with one to four mutations; now and then a few of its bytes are changed, too."""
    layer = Sdf.Layer.CreateAnonymous(".usda")
    if not layer.ImportFromString(text):
        raise ValueError("the stage to mutate is no USD")
    for _ in range(int(rng.integers(1, 5))):
        with contextlib.suppress(Tf.ErrorException):  # what Sdf itself refuses cannot be authored
            MUTATIONS[rng.integers(len(MUTATIONS))](rng, layer)
    made = layer.ExportToString()
    if rng.integers(12) == 0:
        letters = list(made)
        for _ in range(int(rng.integers(1, 4))):
            letters[rng.integers(len(letters))] = _any(rng, "{}()[]<>@\"'\n0 a#")
        made = "".join(letters[: rng.integers(1, len(letters))] if rng.integers(4) == 0 else letters)
    return made
