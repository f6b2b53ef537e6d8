"""Lights from Python: samples, hits, scratch-cone intervals and irradiance of one light, over NumPy arrays.

Each function takes a light record or, for lights that refer to textures or instances, the ``pack_lights`` of one light.
Positions in metres, directions unit, radiance linear Rec.709. Leading dimensions broadcast.
"""

from typing import Any

import numpy as np
import warp as wp
from numpy.typing import ArrayLike

from scratchwarp.lights.light_device import LightHit, LightSample, Span
from scratchwarp.lights.pack import PackedLights, pack_lights
from scratchwarp.lights.query_kernels import hit_kernel, irradiance_kernel, sample_kernel, span_kernel
from scratchwarp.reflectance.vectors import UNIT_TOLERANCE, directions, numbers, to_device, uniforms, vectors
from scratchwarp.scene.light import Light


def _packed(light: Light | PackedLights) -> PackedLights:
    packed = pack_lights([light]) if isinstance(light, Light) else light
    if len(packed.slots) != 1:
        raise ValueError(f"light holds {len(packed.slots)} lights, expected one; pack it alone")
    return packed


def _launch(
    kernel: Any, packed: PackedLights, arrays: list[np.ndarray], dtypes: list[Any], out: Any, *rest: Any
) -> Any:
    device = packed.arrays.triangles.device
    lead, inputs = to_device(arrays, dtypes, device)
    result = wp.zeros(int(np.prod(lead)), dtype=out, device=device)
    lights = packed.lights[packed.kinds[0]]
    wp.launch(kernel, result.shape[0], inputs=[lights, packed.arrays, *inputs, *rest], outputs=[result], device=device)
    return lead, result.numpy()


def sample(light: Light | PackedLights, x: ArrayLike, u: ArrayLike) -> dict[str, np.ndarray]:
    """Directions towards a light from points ``x`` [..., 3] by ``u`` [..., 2] in [0, 1).

    Returns wi [..., 3], distance [...] (1e10 at infinity), radiance [..., 3], pdf [...] in 1/sr: 0 nothing, -1 a light
    without extent, whose radiance is then its irradiance across wi. Raises ValueError on another shape or range.
    """
    packed = _packed(light)
    arrays = [vectors("x", x, 3), uniforms("u", u, 2)]
    lead, out = _launch(sample_kernel(packed.models[0]), packed, arrays, [wp.vec3, wp.vec2], LightSample)
    return {k: out[k].reshape(lead + out[k].shape[1:]) for k in ("wi", "distance", "radiance", "pdf")}


def hit(light: Light | PackedLights, x: ArrayLike, w: ArrayLike) -> dict[str, np.ndarray]:
    """What rays from ``x`` [..., 3] along ``w`` [..., 3] meet of a light.

    Returns distance [...] (negative: missed), radiance [..., 3], pdf [...] with which ``sample`` picks w. Mesh lights
    are geometry and always missed. Raises ValueError on another shape or a direction that is not unit.
    """
    packed = _packed(light)
    lead, out = _launch(
        hit_kernel(packed.models[0]),
        packed,
        [vectors("x", x, 3), directions("w", w)],
        [wp.vec3, wp.vec3],
        LightHit,
    )
    return {k: out[k].reshape(lead + out[k].shape[1:]) for k in ("distance", "radiance", "pdf")}


def span(
    light: Light | PackedLights, x: ArrayLike, u: ArrayLike, n: ArrayLike, sin_theta: ArrayLike
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where the scratch cone {w: w.u = sin_theta} at ``x`` may meet a light above the plane of normal ``n``.

    w = sin_theta u + cos_theta (sin phi v + cos phi n), v = n x u. Returns (lo, hi, ok): the light lies in phi within
    [lo, hi] of [-pi/2, pi/2], nowhere when not ok. Raises ValueError on another shape, a direction that is not unit, u
    and n that are not orthogonal, or |sin_theta| > 1.
    """
    packed = _packed(light)
    axis, normal = directions("u", u), directions("n", n)
    sines = numbers("sin_theta", sin_theta, -1.0, 1.0)
    skew = np.abs((axis * normal).sum(-1)).max(initial=0.0)
    if skew > UNIT_TOLERANCE:
        raise ValueError(f"u and n have a cosine of {skew:g} between them; they must be orthogonal")
    lead, out = _launch(
        span_kernel(packed.models[0]),
        packed,
        [vectors("x", x, 3), axis, normal, sines],
        [wp.vec3, wp.vec3, wp.vec3, float],
        Span,
    )
    return out["lo"].reshape(lead), out["hi"].reshape(lead), out["ok"].reshape(lead) != 0


def irradiance(
    light: Light | PackedLights, x: ArrayLike, n: ArrayLike, samples: int = 1024, seed: int = 0
) -> np.ndarray:
    """Irradiance [..., 3] of an unoccluded light on points ``x`` [..., 3] facing ``n`` [..., 3], by Monte Carlo.

    ``samples`` Owen-scrambled Sobol points each. Raises ValueError on another shape, a normal that is not unit or
    samples < 1.
    """
    if samples < 1:
        raise ValueError(f"samples is {samples}, expected at least 1")
    packed = _packed(light)
    lead, out = _launch(
        irradiance_kernel(packed.models[0]),
        packed,
        [vectors("x", x, 3), directions("n", n)],
        [wp.vec3, wp.vec3],
        wp.vec3,
        samples,
        wp.uint32(seed),
    )
    return out.reshape((*lead, 3))
