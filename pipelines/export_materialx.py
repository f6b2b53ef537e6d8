"""Scratched materials as a MaterialX document: for each an OpenPBR and a standard_surface material.

Each is a mixture, by the baked coverage, of the base and of a second surface that stands for the scratches: their
reflectance, with baked roughness, anisotropy and direction. Needs the package MaterialX (extra ``export``).
"""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import texture_files
from .baked_look import Look, Nearest
from .fates import lost

Array = np.ndarray

KINDS = ("open_pbr_surface", "standard_surface")
# UsdPreviewSurface-like values -> inputs of each; those of opacity and tangent differ in type, too.
_INPUTS = {
    "open_pbr_surface": {
        "color": "base_color", "metallic": "base_metalness", "roughness": "specular_roughness",
        "anisotropy": "specular_roughness_anisotropy", "ior": "specular_ior", "coat": "coat_weight",
        "coat_roughness": "coat_roughness", "normal": "geometry_normal", "tangent": "geometry_tangent",
        "opacity": "geometry_opacity", "specular": "specular_weight",
    },
    "standard_surface": {
        "color": "base_color", "metallic": "metalness", "roughness": "specular_roughness",
        "anisotropy": "specular_anisotropy", "ior": "specular_IOR", "coat": "coat", "coat_roughness": "coat_roughness",
        "normal": "normal", "tangent": "tangent", "opacity": "opacity", "specular": "specular",
    },
}  # fmt: skip


def write(pairs: Sequence[tuple[Look, Nearest]], target: Path) -> tuple[list[dict[str, Any]], list[str]]:
    """Write ``target``, a .mtlx, and its textures into the folder textures beside it; a record of each material, and
    notes.

    Raises ImportError without MaterialX, ValueError where the document does not validate.
    """
    try:
        import MaterialX as mx
    except ImportError as error:
        raise ImportError("MaterialX is missing: pip install scratchwarp[export]") from error
    from scratchwarp.whole import whole

    library = mx.createDocument()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
    document = mx.createDocument()
    document.setDataLibrary(library)
    document.setColorSpace("lin_rec709")
    records: list[dict[str, Any]] = []
    notes: list[str] = []
    for look, near in pairs:
        name = mx.createValidName(look.path.strip("/").replace("/", "_"))
        maps = _maps(look, near)
        for kind in KINDS:
            _material(document, f"{name}_{'openpbr' if kind == KINDS[0] else kind}", kind, look, near, maps, target)
        width, height = look.size
        records.append({"material": look.path, "texels": [width, height], "texel_um": list(look.texel)})
        notes += [*look.notes, *lost(look.fates, rough=True)]
    valid, message = document.validate()
    if not valid:
        raise ValueError(f"{target}: the MaterialX document is not valid: {' '.join(message.split())}")
    with whole(target) as draft:
        mx.writeToXmlFile(document, str(draft))
    return records, list(dict.fromkeys(notes))


def aspect(wide: Array, narrow: Array, kind: str) -> tuple[Array, Array]:
    """(roughness, anisotropy) inputs that give GGX's two alphas, by the definition of each surface.

    OpenPBR: wide = r^2 sqrt(2 / (1 + (1 - a)^2)), narrow = (1 - a) wide. standard_surface: wide = r^2 / sqrt(1 - a),
    narrow = r^2 sqrt(1 - a), a at most 0.98.
    """
    ratio = np.clip(narrow / np.maximum(wide, 1e-9), 0.0, 1.0)
    if kind == "open_pbr_surface":
        return np.sqrt(np.clip(wide * np.sqrt(0.5 * (1.0 + ratio**2)), 0.0, 1.0)), 1.0 - ratio
    return np.sqrt(np.clip(np.sqrt(wide * narrow), 0.0, 1.0)), np.minimum(1.0 - ratio, 0.98)


def _maps(look: Look, near: Nearest) -> dict[str, Array]:
    """What is baked: everything in [0, 1]."""
    slope = near.slope + (0.0 if look.base["normal"] is None else look.base["normal"])
    made = {"coverage": np.clip(near.coverage, 0.0, 1.0), "direction": 0.5 + 0.5 * near.two}
    made["normal"] = texture_files.normals(slope)
    for kind in KINDS:
        made[f"roughness_{kind}"], made[f"anisotropy_{kind}"] = aspect(near.wide, near.narrow, kind)
    return made


def _material(
    document: Any, name: str, kind: str, look: Look, near: Nearest, maps: Mapping[str, Array], target: Path
) -> None:
    graph = document.addNodeGraph(f"NG_{name}")
    base = look.base
    stem = name.replace("_openpbr", "").replace("_standard_surface", "")
    place: list[Any] = []

    def read(part: str, values: Array, color: bool = False) -> Any:
        """A node that reads a baked map, or None where it is constant."""
        if not look.mapped or not texture_files.varies(values):
            return None
        if not place:
            place.append(_place(graph, look))
        file = texture_files.write(target.parent / "textures" / f"{stem}_{part}.png", values, color)
        shape = "float" if values.ndim == 2 else "color3" if color else "vector3"
        node = graph.addNode("image", f"{part}_image", shape)
        node.setInputValue("file", f"textures/{file.name}", "filename")
        if color:
            node.getInput("file").setColorSpace("srgb_texture")
        node.addInput("texcoord", "vector2").setConnectedNode(place[0])
        return node

    def output(part: str, node: Any) -> Any:
        made = graph.addOutput(f"{part}_out", node.getType())
        made.setConnectedNode(node)
        return made

    normal = read("normal", maps["normal"])
    if normal is not None:
        mapped = graph.addNode("normalmap", "normal_world", "vector3")
        mapped.addInput("in", "vector3").setConnectedNode(normal)
        normal = output("normal", mapped)
    inputs = _INPUTS[kind]

    def surface(part: str, values: Mapping[str, Any], tangent: Any, nodes: Mapping[str, Any]) -> Any:
        node = document.addNode(kind, f"{name}_{part}", "surfaceshader")
        for entry, value in values.items():
            if entry == "opacity" and kind == KINDS[1]:
                node.setInputValue(inputs[entry], _color(value), "color3")
            elif entry in nodes:
                given = node.addInput(inputs[entry], nodes[entry].getType())
                given.setConnectedOutput(nodes[entry])
            elif entry == "color":
                node.setInputValue(inputs[entry], _color(value), "color3")
            else:
                node.setInputValue(inputs[entry], float(np.mean(value)), "float")
        for entry, own in (("normal", normal), ("tangent", tangent)):
            if own is not None:
                node.addInput(inputs[entry], "vector3").setConnectedOutput(own)
        return node

    alpha, skew = np.asarray(base["alpha"], float), float(base["anisotropy"])
    wide, narrow = alpha * (1.0 + abs(skew)), alpha * (1.0 - abs(skew))
    rough, level = aspect(wide, narrow, kind)
    shared = {
        "metallic": base["metallic"], "ior": base["ior"], "coat": base["clearcoat"],
        "coat_roughness": np.sqrt(base["clearcoat_alpha"]), "opacity": base["opacity"], "specular": base["specular"],
    }  # fmt: skip
    plain = {"color": _color(base["color"]), "roughness": rough, "anisotropy": level, **shared}
    nodes = {}
    for entry in ("color", "metallic", "roughness"):
        values = np.asarray(plain[entry] if entry != "color" else base["color"], float)
        found = read(f"base_{entry}", values, entry == "color") if values.ndim >= 2 else None
        if found is not None:
            nodes[entry] = output(f"base_{entry}", found)
    turned = None
    if abs(skew) > 1e-6:
        axis = base["rotation"] + (0.0 if skew > 0.0 else 0.5 * np.pi)
        turned = output("base_tangent", _tangent(graph, "base", lambda: None, float(axis)))
    under = surface("base", plain, turned, nodes)
    result = under
    if look.layers:
        own = np.asarray(base["color"], float).reshape(-1, 3).mean(0)
        metallic = float(np.mean(base["metallic"]))
        color = (1.0 - near.matte) * (metallic * near.color + (1.0 - metallic) * own) + near.matte * near.matte_color
        scratch = {
            "color": color, "roughness": maps[f"roughness_{kind}"], "anisotropy": maps[f"anisotropy_{kind}"],
            **shared, "metallic": metallic * (1.0 - near.matte),
        }  # fmt: skip
        nodes = {}
        for entry in ("roughness", "anisotropy"):
            found = read(f"{entry}_{kind}", scratch[entry])
            if found is not None:
                nodes[entry] = output(entry, found)
        mean = texture_files.mean(near.two)
        along = 0.5 * float(np.arctan2(mean[1], mean[0]))
        tangent = _tangent(graph, "scratch", lambda: read("direction", maps["direction"]), along)
        over = surface("scratches", scratch, output("scratch_tangent", tangent), nodes)
        result = document.addNode("mix", f"{name}_mix", "surfaceshader")
        result.addInput("fg", "surfaceshader").setConnectedNode(over)
        result.addInput("bg", "surfaceshader").setConnectedNode(under)
        covered = read("coverage", maps["coverage"])
        if covered is None:
            result.setInputValue("mix", float(maps["coverage"].mean()), "float")
        else:
            result.addInput("mix", "float").setConnectedOutput(output("coverage", covered))
    material = document.addNode("surfacematerial", name, "material")
    material.addInput("surfaceshader", "surfaceshader").setConnectedNode(result)


def _color(values: Any) -> Any:
    import MaterialX as mx

    array = np.asarray(values, float)
    array = array.reshape(-1, array.shape[-1]).mean(0) if array.ndim > 1 else np.broadcast_to(array, 3)
    return mx.Color3(*(float(x) for x in array))


def _place(graph: Any, look: Look) -> Any:
    """The node that says where in the maps a point lies."""
    import MaterialX as mx

    node = graph.addNode("texcoord", "st", "vector2")
    u0, v0, u1, v1 = look.window
    if look.window == (0.0, 0.0, 1.0, 1.0):
        return node
    for kind, other in (("subtract", (u0, v0)), ("divide", (u1 - u0, v1 - v0))):
        made = graph.addNode(kind, f"st_{kind}", "vector2")
        made.addInput("in1", "vector2").setConnectedNode(node)
        made.setInputValue("in2", mx.Vector2(*other), "vector2")
        node = made
    return node


def _tangent(graph: Any, part: str, read: Callable[[], Any], angle: float) -> Any:
    """The world vector that the wide side of a lobe lies along: the tangent turned by a map's direction (cos and sin of
    twice the angle, times 1/2 plus 1/2), or by ``angle`` [rad]."""
    import MaterialX as mx

    def node(kind: str, name: str, shape: str, **inputs: Any) -> Any:
        made = graph.addNode(kind, f"{part}_{name}", shape)
        for entry, value in inputs.items():
            if isinstance(value, float):
                made.setInputValue(entry, value, "float")
            elif isinstance(value, str):
                made.setInputValue(entry, value, "string")
            elif isinstance(value, mx.Vector3):
                made.setInputValue(entry, value, "vector3")
            else:
                made.addInput(entry, value.getType()).setConnectedNode(value)
        return made

    direction = read()
    x, y = (node(kind, kind, "vector3", space="world") for kind in ("tangent", "bitangent"))
    if direction is None:
        cos: Any = float(np.cos(angle))
        sin: Any = float(np.sin(angle))
    else:
        two = node("subtract", "two", "vector3", in1=direction, in2=mx.Vector3(0.5, 0.5, 0.5))
        parts = []
        for index, axis in enumerate("xy"):
            one = node("extract", axis, "float", **{"in": two})
            one.setInputValue("index", index, "integer")
            parts.append(one)
        turn = node("atan2", "turn", "float", iny=parts[1], inx=parts[0])
        half = node("multiply", "half", "float", in1=turn, in2=0.5)
        cos, sin = (node(kind, kind, "float", **{"in": half}) for kind in ("cos", "sin"))
    along = node("multiply", "along", "vector3", in1=x, in2=cos)
    aside = node("multiply", "aside", "vector3", in1=y, in2=sin)
    return node("normalize", "unit", "vector3", **{"in": node("add", "sum", "vector3", in1=along, in2=aside)})
