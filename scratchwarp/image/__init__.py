"""Film to EXR, PNG and NPZ, and image files to textures; the only importer of OpenImageIO.

Files:
    layers      which channels and precision a layer of an image has
    exr         layers to and from multi-layer EXR
    npz         layers to and from NumPy archives
    view        scene-linear pixels through a named OpenColorIO view
    png         a film as a picture to look at
    quick       the same for pictures that follow a slider, in memory
    normals     tangent-space normal maps
    texture     an image file as a texture: linear Rec.709; bounds: what it may claim
    writer      write(film, path) chooses by suffix
"""

from .normals import NORMAL_SUFFIXES, read_normals, write_normals
from .texture import read_texture
from .view import LINEAR, SRGB, View, color_view
from .writer import SUFFIXES, check_writable, read_layers, write, write_layers

__all__ = [
    "LINEAR",
    "NORMAL_SUFFIXES",
    "SRGB",
    "SUFFIXES",
    "View",
    "check_writable",
    "color_view",
    "read_layers",
    "read_normals",
    "read_texture",
    "write",
    "write_layers",
    "write_normals",
]
