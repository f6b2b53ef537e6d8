"""What other renderers need of a scratched material, on texels of its uv square: its base, what each set of scratches
covers and which way it runs, and the nearest rough surface.

The nearest surface follows from moments of slopes (Olano and Baker 2010, LEAN mapping): a scratch of a profile with the
mean square slope m across has GGX's alpha sqrt(2 m) there and almost none along; sets add up by what they cover. What
the texels resolve of the scratches' heights becomes the normal map, what they do not becomes roughness.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from scratchwarp.scene import PreviewSurface, Scene, TextureInput

from .drawn_curves import drawn
from .fates import LEFT_OUT, Fate, shown

Array = np.ndarray

WITHOUT = ("grooves", "diffraction", "scratches.variation", "scratches.textured")
_ALONG = 0.03  # alpha along a scratch: what other renderers can draw in place of 0
_STEEPEST = 2.0  # slope that steeper walls count with
_MOST_TEXELS = 1 << 24


@dataclass(frozen=True, eq=False)
class Laid:
    """A sublayer on the texels: its ``plan``, the ``share`` of each texel [h, w], direction as (cos, sin) of twice the
    angle from dP/du [h, w, 2], mean ``width`` [um], how our own pictures show it (``fate``: see ``fates.Fate``)."""

    plan: Any
    share: Array
    two: Array
    width: float
    fate: str


DIFFRACTED = 0.34 * 0.55
"""Width of a groove [um] times the roughness that spreads light as its diffraction does: lobes whose peaks are half as
high at the same angle, at 550 nm."""


@dataclass(frozen=True, eq=False)
class Look:
    """One material laid out over a part of the uv square, row 0 where v is largest.

    Attributes:
        material: its number in the scene; path. window: (u0, v0, u1, v1). mapped: False without a uv set: then all maps
            are one texel, the mean. texel: edges of a texel on the surface [um]. scale: micrometres a unit of u and v.
        bare: share of the base's specular lobe [h, w]; kept: of scratches that keep its diffuse term.
        layers: its sublayers. base: UsdPreviewSurface inputs, constants or maps: color, metallic, alpha, anisotropy,
            rotation, ior, specular_color (of a specular workflow, else None), clearcoat, clearcoat_alpha, opacity,
            emissive, normal (slopes), and of a ScratchSurface specular, fresnel (of ``BaseSurface``), eta, k.
        notes: what is not in it. fates: of its layers.
    """

    material: int
    path: str
    window: tuple[float, float, float, float]
    mapped: bool
    texel: tuple[float, float]
    scale: tuple[float, float]
    bare: Array
    kept: Array
    layers: tuple[Laid, ...]
    base: Mapping[str, Any]
    notes: tuple[str, ...] = ()
    fates: tuple[Fate, ...] = ()

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in texels."""
        return self.bare.shape[1], self.bare.shape[0]


@dataclass(frozen=True, eq=False)
class Nearest:
    """The nearest rough surface of the scratches of a look: ``coverage`` [h, w]; GGX ``wide`` and ``narrow`` alphas
    [h, w] with the wide one along ``two`` (as of ``Laid``); ``color`` reflectance at the normal, [3]; ``matte``: share
    of Lambert scratches; ``slope``: of what the texels resolve [h, w, 2]."""

    coverage: Array
    wide: Array
    narrow: Array
    two: Array
    color: Array
    matte: float
    matte_color: Array
    slope: Array


def plan_tables(scene: Scene, settings: Any) -> Any:
    """The plan of a scene whose scratches all reflect by tables, or as Lambert surfaces."""
    import scratchwarp as sw

    effects = {**settings.effects, **dict.fromkeys(WITHOUT, False)}
    return sw.make_plan(scene, replace(settings, effects=effects))


def first_user(scene: Scene, material: int) -> int:
    """Number of the first instance with triangles of a material, -1 for none."""
    for number, instance in enumerate(scene.instances):
        mesh = scene.meshes[instance.mesh]
        if material in instance.materials and mesh.slots is not None and len(mesh.triangles):
            if material in {instance.materials[slot] for slot in np.unique(mesh.slots)}:
                return number
    return -1


def lay_out(
    scene: Scene, plan: Any, material: int, longest: int = 512, density: float = 0.0, instance: int = -1
) -> Look:
    """A material on texels: ``longest`` of them on the longer side, or ``density`` of them a metre.

    ``instance``: whose mapping counts, -1 for the first that the material is bound to. Raises ValueError where no
    geometry has the material, or for more texels than 16 million.
    """
    from scratchwarp.kernels.geometry import instance_arrays, uv_set
    from scratchwarp.kernels.pattern import covered, mapping_scale

    found = scene.materials[material]
    number = first_user(scene, material) if instance < 0 else instance
    if number < 0:
        raise ValueError(f"{found.path}: no geometry is bound to it; there is nothing to bake it for")
    placed = scene.instances[number]
    mesh = scene.meshes[placed.mesh]
    arrays = instance_arrays(mesh, placed, scene.materials, False)
    mapped = uv_set(found) in mesh.uvs or "st" in mesh.uvs
    uv = arrays["uv"][arrays["material"] == material].reshape(-1, 2)
    window = _window(uv)
    scale = mapping_scale(arrays)
    extent = np.array([abs(scale[0]) * (window[2] - window[0]), abs(scale[1]) * (window[3] - window[1])]) * 1e-6
    per_metre = density or longest / max(float(extent.max()), 1e-12)
    width, height = (int(max(round(float(x)), 1)) for x in extent * per_metre)
    if not mapped:
        width = height = 1
    if width * height > _MOST_TEXELS:
        raise ValueError(f"{found.path}: {width} x {height} texels are too many; choose a smaller --density")
    notes = [f"{found.path}: without a uv set; its maps are their means"] if not mapped else []
    alphas: list[Array] = []
    laid: list[Laid] = []
    fates: list[Fate] = []
    for one in plan.layers[material]:
        sub = one.sublayer
        record = scene.curves[sub.curves] if sub.distribution == "curves" else None
        ours = shown(found, one)
        differs = max(sub.layer.width_variation, sub.layer.depth_variation, sub.layer.profile_variation) > 0.0
        lost = f"model {sub.layer.model} cannot be baked" if one.response >= 0 else ""
        if record is not None and (record.space != "uv" or not mapped):
            lost = "explicit curves in space cannot be baked"
        fates.append(Fate(sub.layer.label, ours, LEFT_OUT if lost else "table", differs))
        if lost:
            notes.append(f"{sub.layer.label}: {lost} and are left out")
            continue
        if record is not None:
            alpha, two = drawn(record, window, (width, height), scale)
        elif mapped:
            alpha, two = covered(one, window, (width, height), scale)
        else:
            alpha = np.full((1, 1), sub.coverage, np.float32)
            two = np.full((1, 1, 2), (np.cos(2 * sub.angle), np.sin(2 * sub.angle)), np.float32)
        alpha, two = _maps(scene, sub, alpha, two, window, notes)
        alphas.append(alpha)
        unit = 1.0 if record is None or record.width_unit == "um" else float(np.sqrt(abs(scale[0] * scale[1])))
        wide = sub.layer.width if record is None else unit * float(record.widths.mean())
        laid.append(Laid(one, alpha, two, wide, ours))
    total = np.sum(alphas, axis=0) if alphas else np.zeros((height, width), np.float32)
    bare = np.prod([1.0 - np.minimum(a, 1.0) for a in alphas], axis=0) if alphas else np.ones((height, width))
    factor = np.divide(1.0 - bare, total, out=np.zeros_like(total), where=total > 0.0)
    layers = tuple(replace(one, share=one.share * factor) for one in laid)
    kept = sum((x.share for x in layers if x.plan.keeps_diffuse), np.zeros((height, width), np.float32))
    texel = (1e6 * float(extent[0]) / width, 1e6 * float(extent[1]) / height)
    base = _base(scene, found, window, (width, height), notes)
    if found.uses_display_color:
        base["color"] = np.full(3, 0.18) if mesh.colors is None else np.asarray(mesh.colors, float).mean((0, 1))
        if mesh.colors is not None and np.ptp(mesh.colors.reshape(-1, 3), axis=0).max() > 1e-3:
            notes.append(f"{found.path}: the display colour of {placed.path} counts with its mean")
    return Look(
        material, found.path, window, mapped, texel, scale, bare.astype(np.float32), kept, layers, base, tuple(notes),
        tuple(fates),
    )  # fmt: skip


def _window(uv: Array) -> tuple[float, float, float, float]:
    """The part of the uv plane that is used: the unit square where it holds all of it."""
    low, high = uv.min(0), uv.max(0)
    if (low >= -1e-6).all() and (high <= 1.0 + 1e-6).all():
        return 0.0, 0.0, 1.0, 1.0
    high = np.maximum(high, low + 1e-9)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _maps(
    scene: Scene, sub: Any, alpha: Array, two: Array, window: tuple[float, ...], notes: list[str]
) -> tuple[Array, Array]:
    """Masks multiply what is covered; a texture of directions turns it."""
    from scratchwarp.reflectance.pyramid import doubled

    layer, size = sub.layer, (alpha.shape[1], alpha.shape[0])
    if layer.mask_primvar or layer.orientation_primvar:
        notes.append(f"{layer.label}: primvars that mask or turn it cannot be baked and are left out")
    if layer.mask_texture >= 0:
        mask = sample(scene, TextureInput(layer.mask_texture, "r"), window, size)
        alpha = (alpha * np.clip(mask, 0.0, 1.0)).astype(np.float32)
    if layer.orientation_texture >= 0 and not layer.orientation_primvar and sub.distribution in ("worley", "linear"):
        pairs = doubled(scene.textures[layer.orientation_texture].pixels, layer.orientation_encoding)
        found = _bilinear(pairs, window, size, TextureInput(0))[..., :2]
        c, s = np.cos(2 * sub.angle), np.sin(2 * sub.angle)
        turned = np.stack([c * found[..., 0] - s * found[..., 1], s * found[..., 0] + c * found[..., 1]], -1)
        two = (turned / np.maximum(np.linalg.norm(turned, axis=-1, keepdims=True), 1e-9)).astype(np.float32)
    return alpha, two


def sample(scene: Scene, value: Any, window: tuple[float, ...], size: tuple[int, int]) -> Array:
    """A material's input at texel centres: [h, w, 3] or [h, w] of a texture, else the constant as an array."""
    if not isinstance(value, TextureInput):
        return np.asarray(value, np.float64)
    texels = _bilinear(scene.textures[value.texture].pixels, window, size, value)
    texels = texels * value.scale + value.bias
    return texels[..., :3] if value.channel == "rgb" else texels[..., "rgba".index(value.channel)]


def _bilinear(pixels: Array, window: tuple[float, ...], size: tuple[int, int], how: TextureInput) -> Array:
    """Bilinear texels [h, w, 4] of an image at the centres of another grid, wrapped as ``how`` says."""
    u = window[0] + (np.arange(size[0]) + 0.5) / size[0] * (window[2] - window[0])
    v = window[3] - (np.arange(size[1]) + 0.5) / size[1] * (window[3] - window[1])
    uu, vv = np.meshgrid(u, v)
    at = np.einsum("ij,jhw->ihw", how.transform, np.stack([uu, vv, np.ones_like(uu)]))
    high, wide = pixels.shape[:2]
    x, y = at[0] * wide - 0.5, (1.0 - at[1]) * high - 0.5
    i, j = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    found = np.zeros((*x.shape, 4))
    for dj in (0, 1):
        for di in (0, 1):
            weight = np.abs(1 - di - (x - i)) * np.abs(1 - dj - (y - j))
            column, here = _wrapped(i + di, wide, how.wrap_s)
            row, there = _wrapped(j + dj, high, how.wrap_t)
            found += (weight * here * there)[..., None] * pixels[row, column]
    return found


def _wrapped(index: Array, size: int, wrap: str) -> tuple[Array, Array]:
    inside = np.ones(index.shape)
    if wrap == "repeat":
        return index % size, inside
    if wrap == "mirror":
        folded = index % (2 * size)
        return np.where(folded < size, folded, 2 * size - 1 - folded), inside
    if wrap == "black":
        inside = ((index >= 0) & (index < size)).astype(float)
    return np.clip(index, 0, size - 1), inside


def _base(
    scene: Scene, material: Any, window: tuple[float, ...], size: tuple[int, int], notes: list[str]
) -> dict[str, Any]:
    """The base as other renderers take it; see ``Look``."""
    from scratchwarp.plan.layers import conductor_index

    s = material.surface
    plain: dict[str, Any] = {
        "metallic": 0.0, "alpha": 0.0, "anisotropy": 0.0, "rotation": 0.0, "ior": 1.5, "specular_color": None,
        "clearcoat": 0.0, "clearcoat_alpha": 1e-4, "opacity": 1.0, "emissive": (0.0, 0.0, 0.0), "normal": None,
        "specular": 1.0, "fresnel": 0, "eta": (1.0, 1.0, 1.0), "k": (0.0, 0.0, 0.0),
    }  # fmt: skip
    if material.measured is not None:
        notes.append(f"{material.path}: its measured base is left out; the surface stands for it")
    if not isinstance(s, PreviewSurface):
        own: dict[str, Any] = {"color": np.asarray(s.color, float)}
        if s.base == "conductor":
            eta, k = (np.asarray(x) for x in conductor_index(s))
            f0 = ((eta - 1) ** 2 + k**2) / ((eta + 1) ** 2 + k**2)
            own = {"color": f0, "metallic": 1.0, "fresnel": 1, "eta": eta, "k": k}
        elif s.base == "diffuse":
            own |= {"ior": 1.0, "specular": 0.0, "alpha": 1.0}
        if s.base != "diffuse":
            own |= {"alpha": s.roughness, "anisotropy": s.anisotropy, "rotation": s.rotation}
        if s.base == "dielectric":
            own |= {"ior": s.ior, "fresnel": 2}
        return plain | own

    def at(value: Any, low: float = 0.0, high: float = 1.0) -> Array:
        return np.clip(sample(scene, value, window, size), low, high)

    normal = None
    if s.normal is not None:
        n = sample(scene, s.normal, window, size)
        normal = -n[..., :2] / np.maximum(n[..., 2:3], 1e-3)
    return plain | {
        "color": at(s.diffuse_color),
        "metallic": at(s.metallic),
        "alpha": at(s.roughness) ** 2,
        "ior": s.ior,
        "specular_color": at(s.specular_color) if s.use_specular_workflow else None,
        "clearcoat": at(s.clearcoat),
        "clearcoat_alpha": at(s.clearcoat_roughness) ** 2,
        "opacity": at(s.opacity),
        "emissive": at(s.emissive_color, 0.0, np.inf),
        "normal": normal,
    }


def slopes(profile: Any) -> tuple[float, float]:
    """(mean square slope, mean height over width) of a cross-section scaled to its aspect."""
    line = profile.polyline()
    dx, dz = np.diff(line[:, 0]), np.diff(line[:, 1])
    width = float(line[-1, 0] - line[0, 0])
    flat = np.abs(dx) > 1e-12
    m = np.clip(np.abs(dz[flat] / dx[flat]), 0.0, _STEEPEST)
    run = np.abs(dx[flat])
    middle = 0.5 * (line[1:, 1] + line[:-1, 1])[flat]
    return float((m**2 * run).sum() / run.sum()), float((middle * dx[flat]).sum() / width) / width


def f0_of(fresnel: Any) -> Array:
    """Reflectance at the normal of an ``optics`` reflector, None for a mirror; linear Rec.709."""
    if fresnel is None:
        return np.ones(3)
    return np.broadcast_to(np.asarray(fresnel.reflectance(1.0), float), 3).copy()


def nearest(look: Look, tables: Sequence[Any]) -> Nearest:
    """The nearest rough surface of a look's scratches; ``tables``: of its plan."""
    high, wide = look.bare.shape
    coverage = np.zeros((high, wide))
    moment = np.zeros((3, high, wide))  # half the trace, and the double-angle part of the covariance of slopes times 2
    height, color, matte, matte_color, weight = np.zeros((high, wide)), np.zeros(3), 0.0, np.zeros(3), 0.0
    for laid in look.layers:
        mean = float(laid.share.mean())
        coverage += laid.share
        weight += mean
        if laid.plan.lambert:
            moment[0] += laid.share
            matte += mean
            matte_color += mean * np.asarray(laid.plan.diffuse)
            continue
        table = tables[laid.plan.table]
        square, middle = slopes(table.profile)
        spread = DIFFRACTED / laid.width if laid.fate == "diffraction" and laid.width > 0.0 else 0.0
        across, along = min(2.0 * square + spread**2, 1.0), _ALONG**2
        moment[0] += laid.share * 0.5 * (across + along)
        # v lies across: twice its angle is the scratch's turned by half a turn
        moment[1] -= laid.share * 0.5 * (across - along) * laid.two[..., 0]
        moment[2] -= laid.share * 0.5 * (across - along) * laid.two[..., 1]
        color += mean * f0_of(table.fresnel)
        if laid.plan.sublayer.layer.space == "surface":
            height += laid.share * middle * laid.width
    safe = np.maximum(coverage, 1e-9)
    half, cos, sin = moment / safe
    apart = np.hypot(cos, sin)
    down, right = np.gradient(height) if min(high, wide) > 1 else (np.zeros_like(height),) * 2
    slope = np.stack([right / look.texel[0], -down / look.texel[1]], -1)
    part = max(weight - matte, 1e-12)
    return Nearest(
        coverage,
        np.sqrt(np.clip(half + apart, 1e-6, 1.0)),
        np.sqrt(np.clip(half - apart, 1e-6, 1.0)),
        np.stack([cos, sin], -1) / np.maximum(apart, 1e-12)[..., None],
        np.clip(color / part, 0.0, 1.0),
        matte / max(weight, 1e-12),
        matte_color / max(matte, 1e-12),
        slope,
    )


def isotropic(look: Look, near: Nearest) -> dict[str, Array]:
    """UsdPreviewSurface inputs of base and scratches together: color [.., 3], metallic, roughness, normal slopes."""
    base, cover = look.base, np.clip(near.coverage, 0.0, 1.0)
    # one lobe for two: of means of their alphas the harmonic one, with a fifth of the relMSE of the mean square and
    # half of its FLIP (brass, steel, gold and plastic of the gallery)
    own = np.maximum(np.asarray(base["alpha"], float), 0.01)
    alpha = 1.0 / ((1.0 - cover) / own + cover / np.sqrt(0.5 * (near.wide**2 + near.narrow**2)))
    metallic = np.broadcast_to(np.asarray(base["metallic"], float), cover.shape)
    shiny = cover * (1.0 - near.matte)
    color = np.broadcast_to(np.asarray(base["color"], float), (*cover.shape, 3))
    made = color * (1.0 - cover)[..., None]
    reflected = metallic[..., None] * near.color + (1.0 - metallic[..., None]) * color
    made = made + shiny[..., None] * reflected + (cover * near.matte)[..., None] * near.matte_color
    slope = near.slope + (0.0 if base["normal"] is None else base["normal"])
    return {
        "color": np.clip(made, 0.0, 1.0),
        "metallic": metallic * (1.0 - cover * near.matte),
        "roughness": np.sqrt(np.clip(alpha, 0.0, 1.0)),
        "slope": slope,
    }
