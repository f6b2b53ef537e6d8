"""EffectPlan -> one specialised kernel and its arguments.

Files (host):
    key             KernelKey: what a kernel is specialised by
    assemble        scene, plan and tables -> key and arguments
    parts           what was built earlier and need not be built again
    stamp           a number that changes with the device code
    geometry        instances -> world triangles and their hierarchy
    material        materials and layers -> device records
    highlights      where lights are mirrored in spots smaller than a pixel; highlight_search finds them
    glints, grooves, maps  scratches that diffract, grooves one by one, textures -> arrays; glint_crowds: in groups
Files (device):
    render_device   make_kernel(key): the kernel itself
    world_device    LightSet, ScratchSet
    camera_device, film_device, geometry_device, material_device: structs and what is read from them
    base_at_device  a material at a point
    layers_device   coverage of all layers under a footprint
    lobe_device     the lobe a sample chose
    bounce_device   choosing a lobe and going on from a surface
    highlights_device  samples near such spots
    glint*_device   scratches that diffract; groove*_device: grooves one by one
    direct_device   light sampling and lights that rays meet
"""

from .assemble import Assembled, assemble, camera_data, kernel_key
from .key import KernelKey
from .parts import Parts

__all__ = ["Assembled", "KernelKey", "Parts", "assemble", "camera_data", "kernel_key"]
