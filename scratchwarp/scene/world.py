"""Scene: everything the renderer needs to know about a stage at one time."""

from dataclasses import dataclass

import numpy as np

from .camera import Camera
from .checks import constant, freeze, put
from .geometry import Instance, Mesh
from .layer import Curves
from .light import Light, MeshLight
from .material import Material
from .output import RenderOptions
from .texture import Texture


@dataclass(frozen=True, eq=False)
class Scene:
    """A stage at one time, in metres relative to ``origin``.

    Attributes:
        path: file the stage was read from; time: its time code, None where none was asked for.
        origin: world position of the local origin [m], float64, shape [3]; the camera's position, so that a scene far
            from the world's origin keeps its precision.
        up: world up axis, unit, shape [3].
        meshes, instances, materials, textures, lights, curves: the records; instances refer to them by index.
        camera: what to look through; options: what the stage asks the renderer for.
        warnings: what could not be honoured, one sentence each, naming the prim.
        seconds: how long reading took.
    """

    path: str
    meshes: tuple[Mesh, ...]
    instances: tuple[Instance, ...]
    materials: tuple[Material, ...]
    lights: tuple[Light, ...]
    camera: Camera
    textures: tuple[Texture, ...] = ()
    curves: tuple[Curves, ...] = ()
    time: float | None = None
    origin: np.ndarray = constant((0.0, 0.0, 0.0))
    up: np.ndarray = constant((0.0, 1.0, 0.0))
    options: RenderOptions = RenderOptions()
    warnings: tuple[str, ...] = ()
    seconds: float = 0.0

    def __post_init__(self) -> None:
        put(
            self,
            origin=freeze(self.path, "origin", self.origin, (3,)),
            up=freeze(self.path, "up", self.up, (3,)),
        )
        for name in ("meshes", "instances", "materials", "textures", "lights", "curves", "warnings"):
            put(self, **{name: tuple(getattr(self, name))})
        for instance in self.instances:
            if not 0 <= instance.mesh < len(self.meshes):
                raise ValueError(f"{instance.path}: mesh {instance.mesh} is not one of the {len(self.meshes)} meshes")
            slots = self.meshes[instance.mesh].slots
            if slots is not None and len(slots) and slots.max() >= len(instance.materials):
                raise ValueError(f"{instance.path}: the mesh uses slot {slots.max()}, materials has no such entry")
            for index in instance.materials:
                if not 0 <= index < len(self.materials):
                    raise ValueError(f"{instance.path}: material {index} is not one of {len(self.materials)}")
        for layer in (layer for material in self.materials for layer in material.layers):
            for index in (layer.mask_texture, layer.orientation_texture):
                if not -1 <= index < len(self.textures):
                    raise ValueError(f"{layer.label}: texture {index} is not one of {len(self.textures)}")
        for light in self.lights:
            if isinstance(light, MeshLight) and not 0 <= light.instance < len(self.instances):
                raise ValueError(f"{light.path}: instance {light.instance} is not one of {len(self.instances)}")

    @property
    def triangles(self) -> int:
        """Triangles over all instances."""
        return sum(len(self.meshes[i.mesh].triangles) for i in self.instances)

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner of all geometry [m], relative to ``origin``; zeros when there is none."""
        corners = []
        for instance in self.instances:
            points = self.meshes[instance.mesh].points
            if len(points):
                box = np.array([points.min(0), points.max(0)])
                eight = np.array([[box[i, 0], box[j, 1], box[k, 2], 1] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
                corners.append((eight @ instance.transform.T)[:, :3])
        if not corners:
            return np.zeros(3), np.zeros(3)
        every = np.concatenate(corners)
        return every.min(0), every.max(0)
