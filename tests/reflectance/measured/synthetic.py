"""Files of measured BRDFs made up for the tests: nothing measured may be handed on."""

import struct

import numpy as np

CODES = {"uint8": 1, "float32": 10, "float64": 11}


def direction(theta, phi):
    return np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)), -1)


def grid():
    """Directions of the UTIA grid, [288, 3]."""
    return direction(np.radians(np.repeat(15.0 * np.arange(6), 48)), np.radians(np.tile(7.5 * np.arange(48), 6)))


def smooth(wi, wo, wide=0.5, narrow=0.25):
    """A smooth anisotropic BRDF, reciprocal, its lobe wide along x."""
    h = (wi + wo) / np.linalg.norm(wi + wo, axis=-1, keepdims=True)
    lobe = np.exp(-((h[..., 0] / wide) ** 2) - (h[..., 1] / narrow) ** 2)
    return 0.1 + lobe[..., None] * np.array([0.5, 0.4, 0.3])


def write_merl(path, values):
    """``values`` [3, 90, 90, 180], as stored."""
    path.write_bytes(struct.pack("<3i", *values.shape[1:]) + values.astype("<f8").tobytes())


def write_tensors(path, fields):
    """A tensor file: header, list of fields with offsets, data."""
    size = 18 + sum(13 + len(name) + 8 * a.ndim for name, a in fields.items())
    head, body = b"", b""
    for name, a in fields.items():
        head += struct.pack("<H", len(name)) + name.encode()
        head += struct.pack("<HBQ", a.ndim, CODES[a.dtype.name], size + len(body)) + struct.pack(
            f"<{a.ndim}Q", *a.shape
        )
        body += a.tobytes()
    path.write_bytes(b"tensor_file\0" + bytes([1, 0]) + struct.pack("<I", len(fields)) + head + body)


def rgl_fields(phi, thetas=5, seed=0):
    """Positive random tables of an RGL file for incident azimuths ``phi``."""
    rng = np.random.default_rng(seed)

    def table(*shape):
        return (0.2 + rng.random(shape)).astype(np.float32)

    n = len(phi)
    return {
        "description": np.frombuffer(b"made up", np.uint8),
        "phi_i": np.array(phi, np.float32),
        "theta_i": np.linspace(0.0, 1.54, thetas).astype(np.float32),
        "ndf": table(8, 9),
        "sigma": table(7, 6),
        "vndf": table(n, thetas, 8, 10),
        "luminance": table(n, thetas, 6, 6),
        "rgb": table(n, thetas, 3, 6, 6),
        "jacobian": np.array([1], np.uint8),
    }
