"""Fine scratches diffract: wave optics of single scratches, area lights in closed form, footprints and colours.

Source: Velinov, Werner and Hullin 2018, Real-Time Rendering of Wave-Optical Effects on Scratched Surfaces, with its
Eq. 16, 18, 26, 31, 35 and 40 mended. Lengths in micrometres, wavelengths in nanometres, the shading frame has n = +z.

Files: ``scratch``, ``light``, ``outline`` the records; ``reflection``, ``lighting``, ``ellipse``, ``color``,
``wide_color``, ``energy`` the calls; ``quadrature`` the reference in NumPy; ``inputs``, ``arrays`` between Python and
the device. On the device: ``scratch_device`` the response of a scratch (``faddeeva_device`` its ends, ``lobe_device``
its width, ``outline_device`` its profile), ``slice_device`` one slice of a light, ``sphere_device`` and
``polygon_device`` where lights are cut, ``few_device`` at most four slices (``round_rules``, ``round_device`` of round
lights), ``radiance_device`` more, ``dome_device``, ``ellipse_device``, ``color_device``, ``wide_color_device``;
``*_kernels`` loop over arrays.
Public names load on first use.
"""

from ...lazy import lazily

_PUBLIC = {
    "Scratch": "scratch",
    "SphereLight": "light",
    "PolygonLight": "light",
    "DomeLight": "light",
    "brdf": "reflection",
    "brdf_coherent": "reflection",
    "radiance": "lighting",
    "footprint": "ellipse",
    "coverage": "ellipse",
    "rgb": "color",
    "wide_rgb": "wide_color",
    "balance": "energy",
}

__all__ = sorted(_PUBLIC)

__getattr__, __dir__ = lazily(__name__, _PUBLIC)
