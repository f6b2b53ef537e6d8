"""Tables against a 3D path tracer by others: Mitsuba on extruded groove meshes under a smooth sky."""

import numpy as np
import pytest

from scratchwarp import profiles
from scratchwarp.optics import Conductor

mi = pytest.importorskip("mitsuba", reason="Mitsuba is in the test extra")

PERIOD = 100.0  # Mitsuba offsets secondary rays by about 1e-4: micrometres as units would spoil the result
VIEWS = np.radians([(0.0, 20.0), (40.0, -35.0), (65.0, 12.0)])
ETA, K = 2.91, 3.09
OUTLINES = {
    "vGroove": profiles.shape("vGroove", depth=0.5 * np.tan(np.radians(57.0)), apex=0.4),
    "quartic": profiles.shape("quartic", depth=0.6),
    "undercut": profiles.Profile([[0, 0], [0.25, 0], [0.1, -0.4], [0.85, -0.45], [0.7, 0], [1, 0]]),
}


mi.set_variant("scalar_rgb")


def groove_mesh(profile, bsdf):
    """The outline times PERIOD, extruded far along u (Mitsuba's x), facing up (z)."""
    line = profile.polyline(12) * PERIOD - (PERIOD / 2, 0.0)
    keep = np.concatenate(([True], np.any(np.diff(line, axis=0) != 0.0, axis=1)))
    line = line[keep]
    count, length = len(line), 400 * PERIOD
    near, far = (np.column_stack((np.full(count, s * length), line)) for s in (-1, 1))
    k = np.arange(count - 1)
    faces = np.concatenate((np.column_stack((k, k + count, k + 1)), np.column_stack((k + 1, k + count, k + count + 1))))
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(bsdf)
    properties["face_normals"] = True
    mesh = mi.Mesh("groove", 2 * count, len(faces), props=properties)
    held = mi.traverse(mesh)
    held["vertex_positions"] = np.concatenate((near, far)).ravel().astype(np.float32)
    held["faces"] = faces.ravel().astype(np.uint32)
    held.update()
    return mesh


def sky_colour(d):
    """A smooth sky that differs in every direction."""
    x, y, z = d[..., 0], d[..., 1], d[..., 2]
    return np.stack((1 + 0.5 * x + 0.3 * y * z, 1 - 0.4 * z + 0.3 * x * x, 1 + 0.6 * y - 0.2 * x * z), axis=-1)


def sky():
    """The same as an environment map: Mitsuba's rows lie on the poles' corners, its columns in their middles, y is
    up."""
    height, width = 256, 512
    v = np.linspace(0, np.pi, height)[:, None]
    u = (np.arange(width)[None, :] + 0.5) * 2 * np.pi / width
    d = np.stack((np.sin(v) * np.sin(u), np.cos(v) * np.ones_like(u), -np.sin(v) * np.cos(u)), axis=-1)
    return {"type": "envmap", "bitmap": mi.Bitmap(sky_colour(d).astype(np.float32))}


def direction(theta, phi):
    """Mitsuba axes: x along u, y along v, z along n."""
    return np.stack(
        (np.sin(theta) * np.ones_like(phi), np.cos(theta) * np.sin(phi), np.cos(theta) * np.cos(phi)), axis=-1
    )


def mitsuba_radiance(scene, theta, phi, samples=64):
    """Mean radiance over exactly one period: the film's y axis is u less its part along the view, so that its x axis
    alone runs across."""
    d = direction(theta, np.array(phi))
    half = 0.5 * PERIOD * np.cos(phi)
    up = np.array([1.0, 0, 0]) - d[0] * d
    origin = d * 20 * PERIOD
    frame = mi.ScalarTransform4f().look_at(origin=origin.tolist(), target=[0, 0, 0], up=up.tolist())
    sensor = mi.load_dict(
        {
            "type": "orthographic",
            "to_world": frame @ mi.ScalarTransform4f().scale([half, half, 1.0]),
            "near_clip": 1.0,
            "film": {"type": "hdrfilm", "width": 64, "height": 16, "rfilter": {"type": "box"}},
            "sampler": {"type": "stratified", "sample_count": samples},
        }
    )
    integrator = mi.load_dict({"type": "path", "max_depth": 200, "rr_depth": 1000})
    return np.array(mi.render(scene, sensor=sensor, integrator=integrator, spp=samples)).reshape(-1, 3).mean(axis=0)


@pytest.mark.parametrize("material", ["mirror", "iron"])
@pytest.mark.parametrize("name", OUTLINES)
def test_radiance_under_a_sky(name, material):
    """Three views of each groove and metal, three colours of sky: within 0.5 %."""
    bsdf = {"type": "conductor", "material": "none"}
    if material == "iron":
        spectra = {"eta": ETA, "k": K}
        bsdf = {"type": "conductor", **{n: {"type": "rgb", "value": [v] * 3} for n, v in spectra.items()}}
    mesh = groove_mesh(OUTLINES[name], bsdf)
    scene = mi.load_dict({"type": "scene", "sky": sky(), "groove": mesh})
    bins = 256
    slices = profiles.simulate_full(
        OUTLINES[name],
        VIEWS[:, 0],
        resolution=bins,
        rays=512,
        fresnel=None if material == "mirror" else Conductor(ETA, K),
    )
    angles, weights = profiles.table.bin_angles(bins), profiles.table.bin_weights(bins)
    for k, (theta, phi) in enumerate(VIEWS):
        light = sky_colour(direction(-theta, angles))
        place = (phi + np.pi / 2) / np.pi * bins - 0.5
        low = int(place)
        row = (low + 1 - place) * slices[k, low] + (place - low) * slices[k, low + 1]
        predicted = (row * weights) @ light
        measured = mitsuba_radiance(scene, theta, phi)
        np.testing.assert_allclose(predicted, measured, rtol=5e-3)
