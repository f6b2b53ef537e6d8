"""What diffraction reads: scratches on the surface, wavelengths, and what scratches reflect by."""

import warp as wp

from ..optics.frames_device import Frame
from ..reflectance.diffraction.quadrature_device import Rules
from ..scratches.segments_device import Segment
from .maps_device import MapSet

wp.set_module_options({"enable_backward": False})

MOST_SLICES = wp.constant(16)
"""Of a light."""


@wp.struct
class WaveMaterial:
    """A material whose scratches diffract. ``first``, ``count``: its wavelengths, the longest last; ``bands``: its
    regular layers in ``GlintArrays.bands``, from ``first_band``; ``groups``: that its pieces are dealt into, a power of
    two, in ``GlintArrays.bvh`` from ``first_group`` (0: it has none); ``strands``: of a footprint that are lit at most
    (0: all)."""

    sigma: float  # coherence radius [um]
    first: int
    count: int
    longest: float  # wavelength [um]
    first_band: int
    bands: int
    coherent: int  # its scratches interfere
    bin: float  # what a wavelength stands for in 1 / wavelength [1/um]
    first_group: int
    groups: int
    strands: int


@wp.struct
class WaveLayer:
    """A layer that diffracts.

    Attributes:
        wave: its material in ``GlintArrays.waves``. reflect: row of ``reflect`` and of ``spectral``; whether the latter
            has anything to say: ``per_wavelength``.
        depth_spread, roughness [um].
        share, share_step, share_count: mean |D|^2 by depth, every ``share_step`` micrometres from 0.
        wide, wide_depths, wide_reaches, depth_first, depth_step, reach_step: its table in ``GlintArrays.wides``
            (``wide_depths`` 0: none), see ``wide_integral``.
        outline, facets: rows of its cross-section in ``GlintArrays.outlines``, none for a rectangle.
        angles: 1 where the phase that the depth gives depends on the directions. maps: in ``GlintArrays.maps``, or -1.
        fringes: 1 where ``GlintArrays.fringes`` holds its colours under lights without extent.
        lobe, lobe_reaches, lobe_depths, lobe_first, lobe_even: the table of its facets' lobe in ``GlintArrays.lobes``
            (``lobe_depths`` 0: none), see ``glint_lobes_device``.
    """

    wave: int
    reflect: int
    per_wavelength: int
    depth_spread: float
    roughness: float
    share: int
    share_step: float
    share_count: int
    wide: int
    wide_depths: int
    wide_reaches: int
    depth_first: float
    depth_step: float
    reach_step: float
    outline: int
    facets: int
    angles: int
    maps: int
    fringes: int
    lobe: int
    lobe_reaches: int
    lobe_depths: int
    lobe_first: float
    lobe_even: int


@wp.struct
class BandData:
    """A regular pattern; lengths in pattern units as in ``scratches.layer_device``. ``layer``: in
    ``GlintArrays.layers``; ``coherent``: its lines interfere; ``cos_a``, ``sin_a``: the way they run, ``cos_y``,
    ``sin_y``: by which they are laid out; ``share``: part of the lines that it stands for; ``maps``: as in
    ``WaveLayer``."""

    kind: int
    layer: int
    coherent: int
    uv_space: int
    cos_a: float
    sin_a: float
    width: wp.float64
    depth: float
    pitch: wp.float64
    offset: wp.float64  # pitches
    center: wp.vec2d
    cos_y: float
    sin_y: float
    share: float
    maps: int


@wp.struct
class Spectrum:
    """Linear Rec.709 a micrometre of wavelength, from ``first`` every ``step`` [um]; it integrates to (1, 1, 1)."""

    first: float
    step: float
    colors: wp.array(dtype=wp.vec3)


@wp.struct
class GlintArrays:
    """All of it. ``material``: material -> entry of ``waves``, or -1; ``colors``: linear Rec.709 of each wavelength,
    those of a material add up to 1; ``reflect[row, cosine]``, ``spectral[row, cosine, wavelength]``: reflectance at
    even steps of the cosine from 0 to 1; ``shares``: mean |D|^2 of each part of the spectrum, ``share_colors`` linear
    Rec.709 of these parts. The pieces of triangle t are
    ``segments[starts[t] .. starts[t + 1]]``; ``around[around_starts[t] .. around_starts[t + 1]]`` are the triangles
    that share a corner with it, and itself, which hold all within ``around_reach[t]`` [m] of it. A light that a scratch
    sees a part of is taken in ``slices``: (place, weight) ``nodes`` over [0, 1]."""

    material: wp.array(dtype=int)
    waves: wp.array(dtype=WaveMaterial)
    layers: wp.array(dtype=WaveLayer)
    wavelengths: wp.array(dtype=float)  # [um]
    colors: wp.array(dtype=wp.vec3)
    reflect: wp.array2d(dtype=wp.vec3)
    spectral: wp.array3d(dtype=float)
    shares: wp.array2d(dtype=float)
    share_colors: wp.array(dtype=wp.vec3)
    wides: wp.array(dtype=wp.vec3)
    outlines: wp.array(dtype=wp.vec4d)
    lobes: wp.array(dtype=float)
    segments: wp.array(dtype=Segment)
    starts: wp.array(dtype=int)
    around_starts: wp.array(dtype=int)
    around: wp.array(dtype=int)
    around_reach: wp.array(dtype=float)
    bvh: wp.uint64
    bands: wp.array(dtype=BandData)
    spectrum: Spectrum
    rules: Rules
    maps: MapSet
    fringes: wp.array3d(dtype=wp.vec3)
    slices: int
    nodes: wp.array(dtype=wp.vec2)


@wp.struct
class Pair:
    """The other scratch of a pair. ``kind``: 0 none, 1 itself, 2 another one. ``way``: -1 where it runs backwards;
    ``apart``: from it to the strand along y [um]; ``tilt`` [rad]; ``variance``: of the footprint along [um^2];
    ``widest``: of all under the footprint [um]."""

    kind: int
    width: float
    depth: float
    layer: int
    way: float
    apart: float
    tilt: float
    variance: float
    widest: float


@wp.struct
class Strand:
    """What a footprint sees of one scratch.

    Attributes:
        frame: x along it, y across, n the shading normal. bend: change of the direction along it, along y and n [1/m].
        length: of the scratch in the footprint, weighted by it [1/um]: times the width it is a share of the area; part:
            of what an endless line would have.
        mean, variance: of where along it that lies, from the shading point [m], [m^2].
        width, depth [um]. layer: in ``GlintArrays.layers``.
        at, low, high: where it lies across, begins and ends, from the shading point [m]; pair: with another one.
    """

    frame: Frame
    bend_y: float
    bend_n: float
    length: float
    part: float
    mean: float
    variance: float
    width: float
    depth: float
    layer: int
    pitch: float  # [um] of a grating, 0 for a scratch by itself
    at: float
    low: float
    high: float
    pair: Pair


@wp.struct
class Glints:
    """What diffraction adds at a point: radiance, what it leaves of the base, and the shadow rays that it took; where a
    path may go on, and what it carries."""

    radiance: wp.vec3
    left: wp.vec3
    rays: float
    way: wp.vec3
    carried: wp.vec3


@wp.func
def reflectance_color(a: GlintArrays, row: int, cosine: float) -> wp.vec3:
    """Linear Rec.709 reflectance at a cosine."""
    last = a.reflect.shape[1] - 1
    at = wp.clamp(cosine, 0.0, 1.0) * float(last)
    cell = wp.min(int(at), last - 1)
    t = at - float(cell)
    return (1.0 - t) * a.reflect[row, cell] + t * a.reflect[row, cell + 1]


@wp.func
def reflectance_at(a: GlintArrays, row: int, wavelength: int, cosine: float) -> float:
    """Reflectance at a wavelength of the row's material, counted from its first."""
    last = a.spectral.shape[1] - 1
    at = wp.clamp(cosine, 0.0, 1.0) * float(last)
    cell = wp.min(int(at), last - 1)
    t = at - float(cell)
    return (1.0 - t) * a.spectral[row, cell, wavelength] + t * a.spectral[row, cell + 1, wavelength]


@wp.func
def wide_node(a: GlintArrays, first: int, t: float, step: float) -> wp.vec3:
    """Cubic between two entries (value, slope) of a row."""
    low = a.wides[first]
    high = a.wides[first + 2]
    rise = high - low
    bend = (1.0 - t) * (step * a.wides[first + 1] - rise) - t * (step * a.wides[first + 3] - rise)
    return low + t * rise + t * (1.0 - t) * bend


@wp.func
def wide_integral(a: GlintArrays, layer: WaveLayer, depth: float, reach: float) -> wp.vec3:
    """T(X, D) = integral of cmf(lambda) |D|^2 / 2 M(2 pi X / lambda), X = W xi_2 [um]: linear Rec.709, odd in X.

    Across a slice of a light its difference is all wavelengths at once.
    """
    x = wp.min(wp.abs(reach) / layer.reach_step, float(layer.wide_reaches - 1) - 1.0e-3)
    y = wp.clamp((depth - layer.depth_first) / layer.depth_step, 0.0, float(layer.wide_depths - 1) - 1.0e-3)
    i = int(x)
    j = int(y)
    row = layer.wide + 2 * (j * layer.wide_reaches + i)
    below = wide_node(a, row, x - float(i), layer.reach_step)
    above = wide_node(a, row + 2 * layer.wide_reaches, x - float(i), layer.reach_step)
    t = y - float(j)
    r = (1.0 - t) * below + t * above
    return wp.where(reach < 0.0, -1.0, 1.0) * r
