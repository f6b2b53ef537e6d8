"""Frames: orthonormal for every normal; scratch angles there and back."""

import numpy as np
import warp as wp

from scratchwarp.optics import frames_device as fr

wp.set_module_options({"enable_backward": False})


@wp.kernel
def _frames(n: wp.array(dtype=wp.vec3), t: wp.array(dtype=wp.vec3), out: wp.array2d(dtype=wp.vec3)):
    i = wp.tid()
    f = fr.frame_with_tangent(n[i], t[i])
    out[i, 0] = f.x
    out[i, 1] = f.y
    out[i, 2] = fr.to_world(f, fr.to_local(f, t[i]))


@wp.kernel
def _angles(w: wp.array(dtype=wp.vec3), azimuth: float, out: wp.array(dtype=wp.vec2), back: wp.array(dtype=wp.vec3)):
    i = wp.tid()
    out[i] = fr.scratch_angles(w[i], azimuth)
    back[i] = fr.scratch_direction(out[i][0], out[i][1], azimuth)


def _directions(count=500):
    w = np.random.default_rng(1).normal(size=(count, 3))
    w[:6] = [[0, 0, 1], [0, 0, -1], [1, 0, 0], [0, 1, 0], [0, 1e-4, -1], [1e-7, 0, -1]]
    return w / np.linalg.norm(w, axis=1, keepdims=True)


def test_frames_are_right_handed_and_keep_the_tangent():
    n, t = _directions(), np.roll(_directions(), 3, axis=0)
    t[10], t[11], t[12] = n[10], 0.0, 5.0 * n[12]
    out = wp.zeros((len(n), 3), dtype=wp.vec3, device="cpu")
    arrays = [wp.array(a, dtype=wp.vec3, device="cpu") for a in (n, t)]
    wp.launch(_frames, len(n), inputs=arrays, outputs=[out], device="cpu")
    x, y, back = out.numpy().astype(float).transpose(1, 0, 2)
    np.testing.assert_allclose(np.linalg.norm(x, axis=1), 1.0, atol=1e-5)
    np.testing.assert_allclose(np.sum(x * n, axis=1), 0.0, atol=1e-5)
    np.testing.assert_allclose(np.cross(n, x), y, atol=1e-5)
    np.testing.assert_allclose(back, t, atol=2e-5)
    flat = t - np.sum(t * n, axis=1, keepdims=True) * n
    clear = np.linalg.norm(flat, axis=1) > 1e-2
    np.testing.assert_allclose(x[clear], flat[clear] / np.linalg.norm(flat[clear], axis=1, keepdims=True), atol=1e-4)


def test_scratch_angles_are_those_of_the_convention():
    w = _directions()
    out, back = wp.zeros(len(w), dtype=wp.vec2, device="cpu"), wp.zeros(len(w), dtype=wp.vec3, device="cpu")
    a = 0.7
    wp.launch(_angles, len(w), inputs=[wp.array(w, dtype=wp.vec3, device="cpu"), a], outputs=[out, back], device="cpu")
    theta, phi = out.numpy().astype(float).T
    u, v, n = [np.cos(a), np.sin(a), 0], [-np.sin(a), np.cos(a), 0], [0, 0, 1]
    np.testing.assert_allclose(np.sin(theta), w @ u, atol=1e-6)
    np.testing.assert_allclose(np.cos(theta) * np.sin(phi), w @ v, atol=1e-6)
    np.testing.assert_allclose(np.cos(theta) * np.cos(phi), w @ n, atol=1e-6)
    np.testing.assert_allclose(back.numpy(), w, atol=1e-6)
