"""Draw what the deformation of facets is for: an anisotropic highlight on a scratched or bumpy ball, smooth, with plain
normal mapping, and with facets that follow the normal (Kang and Cho, figures 9, 12 and 13).

Plain normal mapping is their Eq. 2: the cosine turns with the normal, the exponents do not, so that a highlight on a
bump is round. Rows of a picture: lit by a lamp alone, and reflecting an environment.
"""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .command import script

EXPONENTS = (8.0, 160.0)  # along the ball's circles of latitude and across them
LAMP = (-0.45, 0.55, 0.70)
_METAL = np.array([0.95, 0.90, 0.82])
_GOLDEN = 0.6180339887498949


class Ball(NamedTuple):
    """The pixels that see a ball of radius 1 from far along +z: frames [n, 3] each and the place of each pixel."""

    x: np.ndarray  # along the circles of latitude
    y: np.ndarray
    normal: np.ndarray
    uv: np.ndarray  # [n, 2]
    inside: np.ndarray  # [size, size] bool


def ball(size: int) -> Ball:
    """A ball that fills a picture of ``size`` pixels; u runs around its vertical axis."""
    at = (np.arange(size) + 0.5) / size * 2.1 - 1.05
    px, py = np.meshgrid(at, -at)
    inside = px**2 + py**2 < 0.999
    n = np.stack([px[inside], py[inside], np.sqrt(1.0 - px[inside] ** 2 - py[inside] ** 2)], axis=-1)
    x = np.stack([n[:, 2], np.zeros(len(n)), -n[:, 0]], axis=-1)
    x /= np.maximum(np.linalg.norm(x, axis=-1, keepdims=True), 1e-9)
    uv = np.stack([np.arctan2(n[:, 0], n[:, 2]) / np.pi, np.arcsin(np.clip(n[:, 1], -1, 1)) / np.pi], axis=-1)
    return Ball(x, np.cross(n, x), n, uv, inside)


def environment(w: np.ndarray) -> np.ndarray:
    """Radiance [n, 3] of a room around: a window, two strips of light, a warm floor, a dim ceiling."""
    x, y, z = w[..., 0], w[..., 1], w[..., 2]
    front = z > 0.05
    tx, ty = x / np.maximum(z, 0.05), y / np.maximum(z, 0.05)
    window = front & (np.abs(tx + 0.9) < 0.45) & (np.abs(ty - 0.7) < 0.45)
    bars = (np.abs(tx + 0.9) < 0.03) | (np.abs(ty - 0.7) < 0.03)
    strip = (np.abs(x - 0.75) < 0.06) & (np.abs(y) < 0.55)
    value = np.where(y[..., None] < -0.25, (0.16, 0.11, 0.08), (0.10, 0.13, 0.18)) * (0.6 + 0.4 * np.abs(y[..., None]))
    value = value + (window & ~bars)[..., None] * np.array([3.0, 3.3, 3.6])
    return 1.5 * value + strip[..., None] * np.array([2.6, 2.2, 1.7])


def plain(h: np.ndarray, normal: np.ndarray, exponents: tuple[float, float]) -> np.ndarray:
    """Eq. 2 [n]: the density about ``normal`` [n, 3] with exponents by the azimuth of ``h`` [n, 3] on the surface."""
    ex, ey = exponents
    flat = np.maximum(h[..., 0] ** 2 + h[..., 1] ** 2, 1e-12)
    power = (ex * h[..., 0] ** 2 + ey * h[..., 1] ** 2) / flat
    cosine = np.maximum(np.sum(h * normal, axis=-1), 0.0)
    return np.sqrt((ex + 2.0) * (ey + 2.0)) / (2.0 * np.pi) * cosine**power


def reflectance(
    kind: str, wi: np.ndarray, wo: np.ndarray, normal: np.ndarray, exponents: tuple[float, float] = EXPONENTS
) -> np.ndarray:
    """f_r [n] of "smooth", "plain" or "deformed" facets; directions and mapped normals [n, 3], surface's frame."""
    from scratchwarp import mdf

    if kind == "plain":
        h = wi + wo
        h = h / np.maximum(np.linalg.norm(h, axis=-1, keepdims=True), 1e-9)
        below = 4.0 * np.maximum(np.sum(h * wo, axis=-1) * np.maximum(wi[..., 2], wo[..., 2]), 1e-6)
        above = (wi[..., 2] > 0.0) & (wo[..., 2] > 0.0)
        return np.where(above, plain(h, normal, exponents) * h[..., 2] / below, 0.0)
    delta = normal[..., :2] if kind == "deformed" else (0.0, 0.0)
    return mdf.evaluate(mdf.Lobe("ashikhmin-shirley", *exponents), wi, wo, delta)


def shade(kind: str, seen: Ball, normals: np.ndarray, samples: int = 48) -> tuple[np.ndarray, np.ndarray]:
    """(radiance under the lamp, radiance in the environment), [n, 3] each; ``normals`` [n, 3] of the map at each
    pixel."""

    def local(w: np.ndarray) -> np.ndarray:
        w = np.broadcast_to(w, seen.normal.shape)
        return np.stack([np.sum(w * axis, axis=-1) for axis in (seen.x, seen.y, seen.normal)], axis=-1)

    wo = local(np.array([0.0, 0.0, 1.0]))
    lamp = np.array(LAMP) / np.linalg.norm(LAMP)
    wi = local(lamp)
    lit = (reflectance(kind, wi, wo, normals) * np.maximum(wi[:, 2], 0.0) * 1.1)[:, None] * _METAL
    total = np.zeros_like(lit)
    rng = np.random.default_rng(1)
    start = rng.random((len(wo), 2))
    for k in range(samples):
        u = np.stack([(start[:, 0] + (k + 0.5) / samples) % 1.0, (start[:, 1] + k * _GOLDEN) % 1.0], axis=-1)
        wi, weight = _sampled(kind, wo, normals, u)
        world = wi[:, :1] * seen.x + wi[:, 1:2] * seen.y + wi[:, 2:] * seen.normal
        total += np.minimum(weight, 20.0)[:, None] * environment(world)
    return lit, total / samples * _METAL


def _sampled(kind: str, wo: np.ndarray, normals: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    from scratchwarp import mdf

    if kind != "plain":
        delta = normals[:, :2] if kind == "deformed" else np.zeros((len(wo), 2))
        lobe = mdf.Lobe("ashikhmin-shirley", *EXPONENTS)
        drawn = mdf.sample(lobe, wo, np.concatenate([u, np.full((len(u), 1), 0.5)], axis=1), delta)
        return drawn.omega_i.astype(float), drawn.weight.astype(float)
    # half vectors about the mapped normal by the widest exponent there is
    power = min(EXPONENTS)
    z = (1.0 - u[:, 1]) ** (1.0 / (power + 1.0))
    r, angle = np.sqrt(np.maximum(1.0 - z * z, 0.0)), 2.0 * np.pi * u[:, 0]
    side = np.cross(normals, (0.0, 1.0, 0.0))
    side /= np.maximum(np.linalg.norm(side, axis=-1, keepdims=True), 1e-9)
    h = (r * np.cos(angle))[:, None] * side + (r * np.sin(angle))[:, None] * np.cross(normals, side)
    h = h + z[:, None] * normals
    facing = np.sum(h * wo, axis=-1)
    wi = 2.0 * facing[:, None] * h - wo
    density = (power + 1.0) / (2.0 * np.pi) * z**power / (4.0 * np.maximum(facing, 1e-3))
    good = (facing > 1e-3) & (wi[:, 2] > 0.0)
    value = reflectance("plain", wi, wo, normals) * np.maximum(wi[:, 2], 0.0) / np.maximum(density, 1e-6)
    return np.where(good[:, None], wi, (0.0, 0.0, 1.0)), np.where(good, value, 0.0)


MAPS: dict[str, dict[str, Any]] = {
    "bumps": {"density": 30, "length": 0.15, "width": 0.15, "depth": 0.09, "variation": 0.2},
    "scratches": {"density": 420, "length": 0.16, "width": 0.011, "depth": 0.10, "variation": 0.5},
}
KINDS = ("smooth", "plain", "deformed")


def picture(name: str, size: int = 200, samples: int = 48, fine: int = 2) -> np.ndarray:
    """Linear pixels [2 size, 3 size, 3]: columns smooth, plain, deformed; rows lamp, environment.

    ``name``: one of ``MAPS``; ``fine`` x ``fine`` pixels are averaged. ValueError on another name.
    """
    from scratchwarp import mdf

    if name not in MAPS:
        raise ValueError(f"name must be one of {', '.join(MAPS)}, got {name!r}")
    seen = ball(size * fine)
    table = mdf.scratch_map(1024, seed=4, **MAPS[name])
    repeat = np.array([3.0, 3.0])
    at = (seen.uv * repeat) % 1.0
    normals = table[((1.0 - at[:, 1]) * 1023.999).astype(int), (at[:, 0] * 1023.999).astype(int)].astype(float)
    rows: list[list[np.ndarray]] = [[], []]
    for kind in KINDS:
        mapped = normals if kind != "smooth" else np.broadcast_to((0.0, 0.0, 1.0), normals.shape)
        for row, value in zip(rows, shade(kind, seen, np.ascontiguousarray(mapped), samples), strict=True):
            full = np.full((size * fine, size * fine, 3), 0.03)
            full[seen.inside] = value
            row.append(full.reshape(size, fine, size, fine, 3).mean(axis=(1, 3)))
    return np.concatenate([np.concatenate(row, axis=1) for row in rows]).astype(np.float32)


def author(folder: Path | str, size: int = 200, samples: int = 48, told: Callable[[str], None] = print) -> list[Path]:
    """Write ``anisotropy_bumps.png`` and ``anisotropy_scratches.png``; OSError where they cannot be written."""
    from scratchwarp import image

    Path(folder).mkdir(parents=True, exist_ok=True)
    paths = []
    for name in MAPS:
        path = Path(folder) / f"anisotropy_{name}.png"
        image.write_layers({"color": picture(name, size, samples)}, path)
        told(str(path))
        paths.append(path)
    return paths


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What this script understands."""
    parser.add_argument("folder", type=Path, help="folder to write into; made when it is not there")
    parser.add_argument("--size", type=int, default=200, help="pixels across a ball [200]")
    parser.add_argument("--samples", type=int, default=48, help="of the environment, a pixel [48]")


def run(options: argparse.Namespace) -> list[str]:
    """Write the pictures."""
    if not 8 <= options.size <= 4096 or not 1 <= options.samples <= 65536:
        raise ValueError(f"size and samples are {options.size}, {options.samples}; expected 8 to 4096, 1 to 65536")
    author(options.folder, options.size, options.samples)
    return []


main = script(
    "deformed_highlights", __doc__, add_arguments, run,
    "python -m scratchwarp.pipelines.deformed_highlights out --size 400",
)  # fmt: skip

if __name__ == "__main__":
    sys.exit(main())
