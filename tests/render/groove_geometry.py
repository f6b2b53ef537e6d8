"""V grooves as triangles, and the same sheet of them seen by Mitsuba 3 and by us, pixel by pixel.

Grooves are half a period wide and a quarter deep, at y = (i + 1/4) periods, and at x = (i + 3/4) where they cross.
Mitsuba's sheet has a period of 100, for its offsets are absolute; ours one of 200 micrometres.
"""

from dataclasses import replace

import numpy as np

import scratchwarp as sw
from scratchwarp.scene import Camera, DistantLight, DomeLight, Mesh, ScratchSurface

from . import scenes
from .mitsuba_reference import T, film, matrix, mi, rgb, shoot

PERIOD = 100.0
COUNT = 30  # periods of the true sheet
VIEW = np.array([0.6, 0.0, 0.8])  # a square image is 5 periods by 4
TO_LIGHT = np.array([-0.35, 0.45, 0.82]) / np.linalg.norm([-0.35, 0.45, 0.82])


def triangles(crossing):
    """(points [n, 3], faces [m, 3]) of the sheet about the origin; without crossings it runs along x."""
    cells = (np.arange(4 * COUNT + 1) - 2 * COUNT) / 4.0
    fall = np.where(np.arange(4 * COUNT + 1) % 4 == 1, -0.25, 0.0)
    if crossing:
        x, y = np.meshgrid(cells, cells, indexing="ij")
        z = np.minimum(*np.meshgrid(np.roll(fall, 2), fall, indexing="ij"))
        n = len(cells)
    else:
        x, y = np.meshgrid(cells[[0, -1]], cells, indexing="ij")
        z = np.stack([fall, fall])
        n = 2
    points = np.stack([x, y, z], -1).reshape(-1, 3) * PERIOD
    i, j = (k.ravel() for k in np.meshgrid(np.arange(n - 1), np.arange(4 * COUNT), indexing="ij"))
    m = 4 * COUNT + 1
    a, b, c, d = i * m + j, (i + 1) * m + j, (i + 1) * m + j + 1, i * m + j + 1
    # the crease where two grooves meet runs towards the crossing of their middles
    towards = np.isin(i % 4, (2, 3)) & np.isin(j % 4, (0, 1)) & (i % 4 - 2 != j % 4)
    first = np.where(towards[:, None], np.stack([a, b, d], 1), np.stack([a, b, c], 1))
    second = np.where(towards[:, None], np.stack([b, c, d], 1), np.stack([a, c, d], 1))
    return points, np.concatenate([first, second])


def looking(omega, distance):
    """Camera along ``omega`` with +X of the image along +y of the sheet."""
    right = np.array([0.0, 1.0, 0.0])
    m = np.eye(4)
    m[:3] = np.stack([right, np.cross(omega, right), omega, distance * omega], 1)
    return m


def true_mesh(crossing, folder):
    """The sheet as a PLY file."""
    points, faces = triangles(crossing)
    mesh = mi.Mesh("grooves", len(points), len(faces))
    params = mi.traverse(mesh)
    params["vertex_positions"] = points.astype(np.float32).ravel()
    params["faces"] = faces.astype(np.uint32).ravel()
    params.update()
    file = str(folder / f"grooves{int(crossing)}.ply")
    mesh.write_ply(file)
    return file, mesh.vertex_count() * 12 + mesh.face_count() * 12


def bsdf(surface):
    """A ScratchSurface as Mitsuba has it."""
    if surface.base == "diffuse":
        made = {"type": "diffuse", "reflectance": rgb(surface.color)}
    else:
        made = {"type": "roughconductor", "eta": rgb(surface.eta), "k": rgb(surface.k), "alpha": surface.roughness}
        made["distribution"] = "ggx"
    return {"type": "twosided", "nested": made}


def theirs(file, surface, sun, sky, pixels, spp, bounces=-1, seed=3):
    """(image [pixels, pixels, 3], variance of its luminance) of the true sheet."""
    place = matrix(looking(VIEW, 30 * PERIOD) @ np.diag([-1.0, 1, -1, 1])) @ T().scale([2 * PERIOD, 2 * PERIOD, 1])
    view = {"type": "orthographic", "to_world": place, "near_clip": PERIOD, "film": film(pixels, pixels)}
    parts = {"grooves": {"type": "ply", "filename": file, "face_normals": True, "bsdf": bsdf(surface)}}
    if sun > 0:
        parts["sun"] = {"type": "directional", "direction": (-TO_LIGHT).tolist(), "irradiance": rgb(sun)}
    if sky > 0:
        parts["sky"] = {"type": "constant", "radiance": rgb(sky)}
    integrator = {"type": "path", "max_depth": bounces, "rr_depth": 1000, "hide_emitters": True}
    return shoot(parts, view, spp, integrator)


def world(crossing, surface, sun, sky, **fields):
    """Our scene."""
    cam = Camera(
        path="/cam", transform=looking(VIEW, 1.0), projection="orthographic",
        horizontal_aperture=8e-4, vertical_aperture=8e-4,
    )  # fmt: skip
    layer = {"width": 100.0, "pitch": 200.0, "depth": 50.0, "fresnel": "exact", "model": "groove"}
    layer["distribution"] = "crosshatch" if crossing else "linear"
    lights = [DistantLight(path="/sun", radiance=np.full(3, sun), direction=-TO_LIGHT, angle=0.0)] if sun > 0 else []
    lights += [DomeLight(path="/sky", radiance=np.full(3, sky))] if sky > 0 else []
    material = scenes.scratched(surface, **{**layer, **fields})
    return scenes.scene([scenes.plane(0.1)], [material], lights, [scenes.place()], cam)


def ours(crossing, surface, sun, sky, pixels, spp, effects=None, **fields):
    """The film of the sheet by us."""
    scene = world(crossing, surface, sun, sky, **fields)
    return sw.render(scene, sw.make_plan(scene, settings(pixels, spp, effects)))


def twin(crossing, surface, sun, sky, pixels, spp, stretch=None):
    """The film by us of the true sheet: its triangles, path traced, x and y multiplied with ``stretch``."""
    scene = world(crossing, surface, sun, sky)
    points, faces = triangles(crossing)
    if stretch is not None:
        points[:, :2] = points[:, :2] @ stretch.T
    bare = replace(scene.materials[0], layers=())
    scene = replace(scene, meshes=(Mesh("/true", points * (2e-4 / PERIOD), faces),), materials=(bare,))
    asked = settings(pixels, spp, {"lights.dome": True, "lights.distant": True})
    asked = replace(asked, integrator="path", max_depth=16)
    return sw.render(scene, sw.make_plan(scene, asked))


def settings(pixels, spp, effects=None):
    """A square image of box-filtered pixels."""
    asked = {"width": pixels, "height": pixels, "spp": spp, "filter": "box", "integrator": "direct"}
    return sw.Settings(**asked, effects=effects or {})


LAMBERT = ScratchSurface(base="diffuse", color=(0.8, 0.8, 0.8))
ROUGH = ScratchSurface(metal="custom", eta=(2.9,) * 3, k=(3.1,) * 3, roughness=0.3)
