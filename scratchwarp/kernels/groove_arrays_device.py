"""What grooves read: the pieces of all patterns, where the grid of each begins, and facets of their own."""

import warp as wp

from ..optics.frames_device import Frame
from ..reflectance.base_device import Base
from ..reflectance.grooves.footprint_device import Footprint
from ..reflectance.grooves.solid_device import GroovePath, GrooveSet, Taper
from ..scratches.grid_device import Grid

wp.set_module_options({"enable_backward": False})

GROOVE_ROOM = wp.constant(64)  # pieces near a footprint


@wp.struct
class GrooveRecord:
    """One pattern, laid out in micrometres over a surface: ``scale`` micrometres a unit of u and of v; ``width``, the
    mean of its grooves; ``handover`` 1: only where they are near, 2: they diffract elsewhere; then ``smooth`` is the
    roughness of facets; ``most``: widest footprint [um] that is looked at at once, wider ones by parts. The other
    fields are those of ``GrooveSet`` and of ``Grid``."""

    scale: wp.vec2d
    width: wp.float64
    handover: int
    smooth: float
    most: wp.float64
    bottom: wp.float64
    top: wp.float64
    skin: wp.float64
    mixed: int
    wide: wp.float64
    first_path: int
    path_count: int
    sets: int
    first_step: int
    origin: wp.vec2d
    cell: wp.float64
    columns: int
    rows: int
    first: int
    halved: int


@wp.struct
class GrooveArrays:
    """All patterns.

    Attributes:
        of_face: pattern of each triangle, or -1. records: of patterns. paths, points, vertices, tapers, steps, starts,
            items: of all of them.
        own: of each path, what its facets are made of in ``bases``, or -1 for what the surface is made of.
        slices: lines over a footprint where grooves cross or end. bounces: facets met after the first one.
        near, far: widths of a footprint in widths of a groove below which grooves are laid out, above which not.
    """

    of_face: wp.array(dtype=int)
    records: wp.array(dtype=GrooveRecord)
    paths: wp.array(dtype=GroovePath)
    points: wp.array(dtype=wp.vec2d)
    vertices: wp.array(dtype=wp.vec2d)
    tapers: wp.array(dtype=Taper)
    steps: wp.array(dtype=wp.vec3d)
    starts: wp.array(dtype=int)
    items: wp.array(dtype=int)
    own: wp.array(dtype=int)
    bases: wp.array(dtype=Base)
    slices: int
    bounces: int
    near: float
    far: float


@wp.struct
class GrooveSpot:
    """A footprint on a pattern.

    ``frame``: of the surface, in the world; ``there``: from its x and y to the pattern's, a turn but where the mapping
    stretches or shears; ``back``: its inverse; ``o``: towards the viewer, in the pattern; ``near``: 1 where grooves are
    to be laid out; ``smooth``: roughness of facets, 0 for that of the surface; ``inside`` 1: the viewer looks from
    within the glass, and the frame is still that of the air's side; ``scale``: of the pattern's record, 0 where there
    is none.
    """

    grooves: GrooveSet
    grid: Grid
    footprint: Footprint
    frame: Frame
    there: wp.mat22d
    back: wp.mat22d
    o: wp.vec3d
    near: int
    smooth: float
    inside: int
    scale: wp.vec2d


@wp.struct
class FacetStuff:
    """What facets under a footprint are made of: the surface's ``base``, scaled lobes, x axis of its anisotropy in the
    surface's frame; ``there``, ``back``, ``smooth`` as in ``GrooveSpot``, ``own`` and ``bases`` as in ``GrooveArrays``;
    ``clear``: how much of what is not reflected goes through."""

    base: Base
    w_diffuse: float
    w_specular: float
    smooth: float
    x: wp.vec3
    there: wp.mat22d
    back: wp.mat22d
    own: wp.array(dtype=int)
    bases: wp.array(dtype=Base)
    clear: float
