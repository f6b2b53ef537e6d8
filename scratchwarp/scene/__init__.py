"""Scene and its records: what a stage says, in metres and linear Rec.709, knowing neither USD nor Warp.

Files:
    checks      how records check and freeze the arrays they hold
    geometry    Mesh, Instance
    texture     Texture, TextureInput
    material    PreviewSurface, ScratchSurface, Material
    layer       Profile, Layer, Wave, Curves: the scratches on a material
    normal_map  NormalMap: what model normalMap reflects by
    light       one record for each light
    camera      Camera and the window it sees
    output      RenderProduct, RenderOptions: what the stage asks the renderer for
    settings    Settings: what the user asks for
    world       Scene
    control     Control: an attribute that can be turned
    digest      a hash of records and arrays
    errors      StageError: the input is at fault
    memory      Budget: how much of it a stage may take; TooLarge
    archive     what NumPy files claim to hold
"""

from .archive import check_archive
from .camera import Camera
from .control import Control
from .errors import StageError
from .geometry import Instance, Mesh
from .layer import Curves, Layer, Profile, Wave
from .light import (
    CylinderLight,
    DiskLight,
    DistantLight,
    DomeLight,
    Light,
    MeshLight,
    RectLight,
    Shaping,
    SphereLight,
)
from .material import Material, Measured, PreviewSurface, ScratchSurface
from .memory import Budget, TooLarge
from .normal_map import NormalMap
from .output import RenderOptions, RenderProduct, RenderVar
from .settings import Settings
from .texture import Texture, TextureInput
from .world import Scene

__all__ = [
    "Budget",
    "Camera",
    "Control",
    "Curves",
    "CylinderLight",
    "DiskLight",
    "DistantLight",
    "DomeLight",
    "Instance",
    "Layer",
    "Light",
    "Material",
    "Measured",
    "Mesh",
    "MeshLight",
    "NormalMap",
    "PreviewSurface",
    "Profile",
    "RectLight",
    "RenderOptions",
    "RenderProduct",
    "RenderVar",
    "Scene",
    "ScratchSurface",
    "Settings",
    "Shaping",
    "SphereLight",
    "StageError",
    "TooLarge",
    "Texture",
    "TextureInput",
    "Wave",
    "check_archive",
]
