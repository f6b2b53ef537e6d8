"""Scratches many hundred wavelengths wide: their lobe without fringes against the Fourier transform of the profile."""

import numpy as np
import pytest
import warp as wp

from scratchwarp.kernels.glint_across_device import across_numeric
from scratchwarp.kernels.glint_arrays_device import GlintArrays, Strand, WaveLayer

wp.set_module_options({"enable_backward": False})


@wp.kernel
def lobes(
    outlines: wp.array(dtype=wp.vec4d), angles: int, width: float, depth: float, o: wp.vec3,
    ends: wp.array(dtype=wp.vec2), out: wp.array(dtype=float),
):  # fmt: skip
    a = GlintArrays()
    a.outlines = outlines
    layer = WaveLayer()
    layer.facets = outlines.shape[0]
    layer.angles = angles
    strand = Strand()
    strand.width = width
    strand.depth = depth
    t = wp.tid()
    out[t] = across_numeric(a, layer, strand, 1.0, o, 0.0, ends[t][0], ends[t][1])


X = np.linspace(0.0, 1.0, 65)
PROFILES = {
    "v": np.array([[0.0, 0.0], [0.5, -1.0], [1.0, 0.0]]),
    "sine": np.stack([X, 0.5 * np.cos(2.0 * np.pi * X) - 0.5], 1),
}


def transformed(points, width, depth):
    """(xi_2, |P|^2) at small angles: by FFT of the profile at 16 places a wavelength, 16 values a fringe."""
    size = 1 << int(np.ceil(np.log2(256 * width)))
    x = (np.arange(size) + 0.5) / 16.0
    inside = x < width
    h = depth * np.interp(x / width, points[:, 0], points[:, 1])
    field = np.where(inside, 1.0 - np.exp(-4j * np.pi * h), 0.0)
    power = np.abs(np.fft.fft(field) / 16.0) ** 2
    return np.fft.fftshift(np.fft.fftfreq(size, 1.0 / 16.0)), np.fft.fftshift(power)


def facets(points):
    """Rows of a polyline's facets as ``outline.facets`` has them."""
    return np.concatenate([0.5 * (points[1:] + points[:-1]) - (0.5, 0.0), np.diff(points, axis=0)], 1)


def integrals(rows, width, depth, ends):
    """``across_numeric`` between pairs of xi_2, under a view straight down."""
    outlines = wp.array(rows, dtype=wp.vec4d, device="cpu")
    out = wp.zeros(len(ends), dtype=float, device="cpu")
    given = wp.array(ends.astype(np.float32), dtype=wp.vec2, device="cpu")
    wp.launch(lobes, len(ends), [outlines, 0, width, depth, wp.vec3(0.0, 0.0, 1.0), given], [out], device="cpu")
    return out.numpy()


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize(("width", "depth"), [(1000.0, 100.0), (8000.0, 600.0), (8000.0, 1.0)])
def test_the_mean_of_fringes(name, width, depth):
    """Deep and shallow: each within 2 % of the largest part (facets of the sine are 16 wavelengths and more wide)."""
    points = PROFILES[name]
    rows = facets(points)
    ends = np.array([(-0.7, -0.3), (-0.4, -0.05), (-0.3, 0.3), (0.05, 0.35), (0.25, 0.9)])
    xi, power = transformed(points, width, depth)
    step = xi[1] - xi[0]
    exact = np.array([power[(xi >= low) & (xi < high)].sum() * step for low, high in ends])
    np.testing.assert_allclose(integrals(rows, width, depth, ends), exact, atol=0.02 * exact.max())
    if width > 2048.0:  # however finely a light is cut
        cuts = np.linspace(*ends[2], 1001)
        parts = integrals(rows, width, depth, np.stack([cuts[:-1], cuts[1:]], 1))
        np.testing.assert_allclose(parts.sum(), exact[2], rtol=0.02)
