"""Can any geometry stand between a surface and a light, or reflect another? If not, no ray looks for it."""

import numpy as np

from ..scene import Mesh, Scene

# Flatness of an edge or a plane, relative to the mesh's size.
FLAT = 1e-6


def is_convex(mesh: Mesh) -> bool:
    """Whether a mesh is one flat patch or one closed convex body.

    A closed connected surface without boundary on which every edge is convex is convex (Tietze, Nakajima).
    """
    size = float(np.ptp(mesh.points, axis=0).max()) if len(mesh.points) else 0.0
    if size == 0.0:
        return True
    _, kept, index = np.unique((mesh.points / (FLAT * size)).round(), axis=0, return_index=True, return_inverse=True)
    points, triangles = mesh.points[kept], index.ravel()[mesh.triangles]
    triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(1)]
    if not len(triangles):
        return True
    a, b, c = (points[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)
    first = normals[length.argmax()]
    if np.abs((points - a[length.argmax()]) @ first).max() <= FLAT * size:
        return True

    m = len(triangles)
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    opposite = np.concatenate([triangles[:, 2], triangles[:, 0], triangles[:, 1]])
    owner = np.tile(np.arange(m), 3)
    key = np.sort(edges, axis=1)
    order = np.lexsort((key[:, 1], key[:, 0]))
    key, opposite, owner = key[order], opposite[order], owner[order]
    if len(key) % 2 or not (key[0::2] == key[1::2]).all() or (key[1:-1:2] == key[2::2]).all(1).any():
        return False  # a boundary or more than two triangles at an edge
    one, two = owner[0::2], owner[1::2]
    height = ((points[opposite[1::2]] - points[key[0::2, 0]]) * normals[one]).sum(1)
    if (height > FLAT * size).any():
        return False
    # one body: join triangles over their edges
    group = np.arange(m)
    while True:
        low = np.minimum(group[one], group[two])
        joined = group.copy()
        np.minimum.at(joined, one, low)
        np.minimum.at(joined, two, low)
        joined = joined[joined]
        if (joined == group).all():
            break
        group = joined
    return bool((group == group[0]).all()) and len(points) - len(key) // 2 + m == 2


def _encloses(scene: Scene, mesh: Mesh, transform: np.ndarray) -> bool:
    """Whether the camera may be inside a convex body: on the same side of all its planes (a flat one has no inside)."""
    eye = np.linalg.solve(transform, scene.camera.transform[:, 3])[:3]
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    height = (np.cross(b - a, c - a) * (eye - a)).sum(1)
    return bool((height >= 0.0).all() or (height <= 0.0).all())


def can_occlude(scene: Scene, transparent: bool = False) -> bool:
    """False when no surface that the camera sees can be reached from another: no geometry, or one flat or convex body,
    opaque (or ``transparent``) and seen from outside."""
    shown = [i for i in scene.instances if len(scene.meshes[i.mesh].triangles)]
    if not shown:
        return False
    if len(shown) > 1:
        return True
    mesh = scene.meshes[shown[0].mesh]
    if len(mesh.triangles) > 200_000 or not is_convex(mesh):
        return True
    flat = np.linalg.matrix_rank(mesh.points - mesh.points[0], tol=FLAT * float(np.ptp(mesh.points, axis=0).max())) < 3
    if flat or abs(np.linalg.det(shown[0].transform[:3, :3])) == 0.0:
        return False
    return transparent or _encloses(scene, mesh, shown[0].transform)
