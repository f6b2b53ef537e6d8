"""How much of the image each material fills: the scene's triangles on a coarse grid, the nearest one in each cell."""

import numpy as np

from ...scene import Scene

EDGE = 48
"""Cells along the longer edge of the image."""
MOST = 120_000
"""Triangles that are looked at; of more, every second, third and so on."""
NEAR = 1e-4


def visible(scene: Scene, size: tuple[int, int], window: tuple[int, int, int, int]) -> np.ndarray:
    """Share of the rendered window's samples that meet each material, shape [materials].

    ``size``: of the image in pixels; ``window``: the rendered pixels x0, x1, y0, y1. An estimate within some percent:
    small triangles count by their middles, large ones by the cells whose middles they cover.
    """
    shares = np.zeros(max(len(scene.materials), 1))
    corners, materials = _triangles(scene)
    if not len(corners):
        return shares
    x0, x1, y0, y1 = window
    cell = max(x1 - x0, y1 - y0) / EDGE
    columns, rows = max(1, round((x1 - x0) / cell)), max(1, round((y1 - y0) / cell))
    camera = scene.camera
    left, right, bottom, top = camera.window(*size, scene.options.conform, scene.options.pixel_aspect)
    local = (corners - camera.transform[:3, 3]) @ camera.transform[:3, :3]
    near = max(NEAR * float(np.abs(local[..., 2]).max()), camera.near, 1e-12)
    local, materials = _before(local, materials, near)
    if not len(local):
        return shares
    depth = -local[..., 2]
    flat = local[..., :2] / (depth[..., None] if camera.projection == "perspective" else 1.0)
    px = ((flat[..., 0] - left) / (right - left) * size[0] - x0) / (x1 - x0) * columns
    py = ((top - flat[..., 1]) / (top - bottom) * size[1] - y0) / (y1 - y0) * rows
    nearest = np.full((rows, columns), np.inf)
    found = np.full((rows, columns), -1)
    low = np.stack([px.min(1), py.min(1)], 1)
    high = np.stack([px.max(1), py.max(1)], 1)
    on = (high[:, 0] > 0) & (high[:, 1] > 0) & (low[:, 0] < columns) & (low[:, 1] < rows)
    small = on & ((high - low).max(1) < 1.0)
    middles = np.floor(np.stack([px[small].mean(1), py[small].mean(1)], 1)).astype(int)
    far = depth[small].mean(1)
    order = np.argsort(-far)  # the nearest is written last
    at = middles[order]
    good = (at >= 0).all(1) & (at[:, 0] < columns) & (at[:, 1] < rows)
    column, row = at[good].T
    nearest[row, column], found[row, column] = far[order][good], materials[small][order][good]
    for k in np.flatnonzero(on & ~small):
        _fill(px[k], py[k], depth[k], int(materials[k]), nearest, found)
    for material in np.unique(found[found >= 0]):
        shares[material] = float((found == material).mean())
    return shares


def _before(local: np.ndarray, materials: np.ndarray, near: float) -> tuple[np.ndarray, np.ndarray]:
    """Triangles [n, 3, 3] in the camera's frame, cut at ``near``."""
    beyond = -local[..., 2] >= near
    whole = beyond.all(axis=1)
    made, owners = [local[whole]], [materials[whole]]
    for k in np.flatnonzero(beyond.any(axis=1) & ~whole):
        points: list[np.ndarray] = []
        for a, b in zip(local[k], np.roll(local[k], -1, axis=0), strict=True):
            if -a[2] >= near:
                points.append(a)
            if (-a[2] >= near) != (-b[2] >= near):
                points.append(a + (near + a[2]) / (a[2] - b[2]) * (b - a))
        fan = [np.stack([points[0], points[i], points[i + 1]]) for i in range(1, len(points) - 1)]
        made.append(np.array(fan).reshape(-1, 3, 3))
        owners.append(np.full(len(fan), materials[k]))
    return np.concatenate(made), np.concatenate(owners)


def _fill(x: np.ndarray, y: np.ndarray, z: np.ndarray, material: int, nearest: np.ndarray, found: np.ndarray) -> None:
    """Write a triangle into the cells whose middles it covers."""
    rows, columns = found.shape
    c0, c1 = max(int(np.floor(x.min())), 0), min(int(np.ceil(x.max())), columns)
    r0, r1 = max(int(np.floor(y.min())), 0), min(int(np.ceil(y.max())), rows)
    area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
    if c1 <= c0 or r1 <= r0 or area == 0.0:
        return
    u, v = np.meshgrid(np.arange(c0, c1) + 0.5, np.arange(r0, r1) + 0.5)
    b = ((u - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (v - y[0])) / area
    c = ((x[1] - x[0]) * (v - y[0]) - (u - x[0]) * (y[1] - y[0])) / area
    far = z[0] + b * (z[1] - z[0]) + c * (z[2] - z[0])
    hit = (b >= 0) & (c >= 0) & (b + c <= 1) & (far < nearest[r0:r1, c0:c1])
    nearest[r0:r1, c0:c1][hit] = far[hit]
    found[r0:r1, c0:c1][hit] = material


def _triangles(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """(corners [n, 3, 3] in the world, material [n]) of every so-manieth triangle, large ones first kept."""
    step = max(1, -(-scene.triangles // MOST))
    corners, materials = [], []
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        if not len(mesh.triangles) or not instance.materials:
            continue
        some = slice(None, None, step if len(mesh.triangles) > 1000 else None)
        points = mesh.points @ instance.transform[:3, :3].T + instance.transform[:3, 3]
        corners.append(points[mesh.triangles[some]])
        slots = mesh.slots if mesh.slots is not None else np.zeros(len(mesh.triangles), int)
        materials.append(np.asarray(instance.materials)[slots[some]])
    if not corners:
        return np.zeros((0, 3, 3)), np.zeros(0, int)
    return np.concatenate(corners), np.concatenate(materials)
