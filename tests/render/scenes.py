"""Small scenes made without USD, shared by the tests of the renderer."""

import numpy as np

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
