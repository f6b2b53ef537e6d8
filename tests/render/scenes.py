"""Small scenes made without USD, shared by the tests of the renderer."""

from dataclasses import replace

import numpy as np

import scratchwarp as sw
from scratchwarp.plan.effects import EFFECTS
from scratchwarp.reflectance.responses import RESPONSES
from scratchwarp.scene import (
    Camera,
    DomeLight,
    Instance,
    Layer,
    Material,
    Mesh,
    PreviewSurface,
    Profile,
    Scene,
    ScratchSurface,
)

# Code for everything, so that the tests of this folder share a few kernels. ``test_effects`` shows that an effect which
# nothing calls for changes no bit. Left out: what changes how lights are sampled or
# layers combined, responses in place of tables, and what needs data of its own.
RESPONDING = {response.effect for response in RESPONSES.values()}
EVERYTHING = {
    name: True
    for name in EFFECTS
    if name.split(".")[0] in ("lights", "base", "scratches", "shadows", "lens", "highlights", "indirect")
    and name not in ("lights.multipliers", "scratches.curves", "scratches.sumCoverage", "scratches.stencil")
    and name not in RESPONDING
} | {"lights.closedForm": False, "grooves.handover": False}


def shoot(world, effects=None, **settings):
    """The film of a scene, 32 x 32 box-filtered pixels and every effect's code compiled unless said otherwise."""
    settings = {"width": 32, "height": 32, "spp": 16, "filter": "box", **settings}
    return sw.render(
        world, sw.make_plan(world, sw.Settings(effects=EVERYTHING if effects is None else effects, **settings))
    )


def sphere(rings=24, sides=48, radius=1.0, smooth=True, path="/ball"):
    """Unit sphere about the y axis with u around it and v from pole to pole."""
    v, u = np.meshgrid(np.linspace(0, 1, rings + 1), np.linspace(0, 1, sides + 1), indexing="ij")
    points = np.stack(
        [np.sin(np.pi * v) * np.sin(2 * np.pi * u), -np.cos(np.pi * v), np.sin(np.pi * v) * np.cos(2 * np.pi * u)], -1
    ).reshape(-1, 3)
    a = (np.arange(rings)[:, None] * (sides + 1) + np.arange(sides)).ravel()
    quads = np.stack([a, a + 1, a + sides + 2, a + sides + 1], 1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    corners = points[triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    triangles = triangles[area > 1e-12]
    st = np.stack([u, v], -1).reshape(-1, 2)
    return Mesh(
        path=path,
        points=points * radius,
        triangles=triangles,
        normals=points[triangles] if smooth else None,
        uvs={"st": st[triangles]},
    )


def plane(size=2.0, path="/floor", axis="z"):
    """Square of edge ``size`` in the plane across ``axis``, facing +axis."""
    h = size / 2
    points = np.array([[-h, -h, 0], [h, -h, 0], [h, h, 0], [-h, h, 0]], float)
    if axis == "y":
        points = points[:, [0, 2, 1]] * np.array([1, 1, -1.0])
    triangles = np.array([[0, 1, 2], [0, 2, 3]])
    st = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    return Mesh(path=path, points=points, triangles=triangles, uvs={"st": st[triangles]})


def box(size=1.0, path="/box"):
    """Cube of edge ``size`` about the origin, without uvs."""
    points = (np.indices((2, 2, 2)).reshape(3, -1).T - 0.5) * size
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    return Mesh(path=path, points=points, triangles=quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3))


def cone(sides=40, path="/cone"):
    """Closed cone about the y axis, height 1.6, radius 0.8, with u around it and facets for normals."""
    u = np.arange(sides + 1) / sides
    rim = np.stack([0.8 * np.sin(2 * np.pi * u), np.full_like(u, -0.8), 0.8 * np.cos(2 * np.pi * u)], -1)
    points = np.concatenate([rim, [[0, 0.8, 0], [0, -0.8, 0]]])
    k = np.arange(sides)
    top, low = np.full(sides, sides + 1), np.full(sides, sides + 2)
    triangles = np.concatenate([np.stack([k, k + 1, top], 1), np.stack([k + 1, k, low], 1)])
    middle = u[:-1] + 0.5 / sides
    st = np.stack([np.stack([u[:-1], u[1:], middle], 1), np.tile([0.0, 0.0, 1.0], (sides, 1))], -1)
    return Mesh(path=path, points=points, triangles=triangles, uvs={"st": np.concatenate([st, st[:, [1, 0, 2]]])})


def slotted(mesh, count):
    """The mesh with its triangles dealt to ``count`` material slots, neighbours to different ones."""
    return replace(mesh, slots=np.arange(len(mesh.triangles)) // 2 % count)


def place(mesh=0, material=0, at=(0, 0, 0), path="/placed", light=-1, linear=None):
    """An instance at ``at``."""
    m = np.eye(4)
    if linear is not None:
        m[:3, :3] = linear
    m[:3, 3] = at
    return Instance(path=path, mesh=mesh, transform=m, materials=(material,), light=light)


def camera(aperture=20.0, focal=50.0, **fields):
    """Camera at the origin looking down -z."""
    return Camera(
        path="/cam",
        transform=np.eye(4),
        horizontal_aperture=aperture,
        vertical_aperture=aperture,
        focal_length=focal,
        **fields,
    )


def dome(radiance=1.0):
    """Uniform dome."""
    return DomeLight(path="/dome", radiance=np.full(3, radiance))


def scratched(surface=None, **fields):
    """A material with one worley layer of mirror V grooves unless ``fields`` say otherwise."""
    fields = {"width": 50.0, "depth": 25.0, "length": 5000.0, "coverage": 0.5, "fresnel": "mirror", **fields}
    profile = fields.pop("profile", Profile(path="/mat/vee", shape="vGroove"))
    layer = Layer(name="fine", prim="/mat", profile=profile, **fields)
    return Material(path="/mat", surface=surface or white_metal(), layers=(layer,))


def white_metal(roughness=0.0):
    """A lossless mirror."""
    return PreviewSurface(diffuse_color=(1.0, 1.0, 1.0), metallic=1.0, roughness=roughness)


def lambert(albedo=1.0):
    """A diffuse surface."""
    return ScratchSurface(base="diffuse", color=(albedo,) * 3)


def scene(meshes, materials, lights, instances=None, cam=None, **fields):
    """A Scene; each mesh is placed 6 m before the camera with material 0 unless ``instances`` are given."""
    instances = instances or [place(i, 0, (0, 0, -6)) for i in range(len(meshes))]
    return Scene(
        path="test",
        meshes=tuple(meshes),
        instances=tuple(instances),
        materials=tuple(materials),
        lights=tuple(lights),
        camera=cam or camera(),
        **fields,
    )
