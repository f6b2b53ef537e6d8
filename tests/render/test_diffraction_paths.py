"""Light that reaches or leaves diffracting scratches over other surfaces."""

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.reflectance.diffraction.color import spectral_samples
from scratchwarp.scene import Camera, DistantLight, PreviewSurface, Wave

from . import scenes
from .test_diffraction import LUMINANCE, straight_down, waves

# one kernel for both tests
EFFECTS = {f"diffraction.{name}": True for name in ("bands", "segments", "lists", "hierarchy")}
EFFECTS |= {"lights.distant": True, "base.emission": True, "shadows": True, "indirect": True}


def render(world, **settings):
    asked = {"width": 8, "height": 8, "filter": "box", "integrator": "path", **settings}
    return sw.render(world, sw.make_plan(world, sw.Settings(effects=EFFECTS, **asked)))


def test_furnace_of_surfaces():
    """Scratches on a mirror inside a glowing ball, which no light stands for: the light of the scratches comes along
    paths alone. Base and scratches return what they meet, 1, but for what would leave below the horizon (lobe of 4 um:
    4 %); the scratches as much as they take, a |D|^2 (depth 0.2 um, sixteen wavelengths), within 5 % of noise."""
    glow = PreviewSurface(diffuse_color=(0, 0, 0), specular_color=(0, 0, 0), use_specular_workflow=True,
                          emissive_color=(1, 1, 1))  # fmt: skip
    mirror = PreviewSurface(diffuse_color=(1, 1, 1), metallic=1.0, roughness=0.0)
    wave = Wave(coherence_radius=20.0)
    layer = {"distribution": "linear", "pitch": 40.0, "width": 4.0, "depth": 0.2, "curves": ()}
    material = waves(surface=mirror, wave=wave, **layer)
    shining = sw.scene.Material(path="/glow", surface=glow)
    world = scenes.scene(
        [scenes.plane(0.5), scenes.sphere(12, 24, 4.0, path="/sky")],
        [material, shining],
        [DistantLight(path="/off", radiance=np.zeros(3), direction=np.array([0, 0, -1.0]))],
        instances=[scenes.place(0, 0, (0, 0, -1)), scenes.place(1, 1, (0, 0, 0), path="/around")],
        cam=straight_down(0.1),
    )
    film = render(world, spp=256)
    at, weights = spectral_samples(64)
    share = 0.1 * (4.0 * np.sin(2.0 * np.pi * 0.2 / (at * 1e-3)) ** 2) @ weights
    assert film["scratches"].mean((0, 1)) @ LUMINANCE == pytest.approx(share @ LUMINANCE, rel=0.05)
    color = film["color"].mean((0, 1))
    assert color.max() <= 1.01 and color.min() >= 0.96


def test_diffracted_light_reaches_a_wall():
    """Light from straight above on scratches along a wall that it does not touch itself. Lines along y send it into
    planes across them: with p(xi) = (W / lambda) sinc^2(W xi / lambda) what a floor from 0 to X sends onto a wall up
    to H is E a |D|^2 integral of p(xi) min(X, H xi / sqrt(1 - xi^2)) over xi > 0; the wall sends a pi-th of it on.
    Paths that find the lobe are one in a hundred: noise of 3 % for one deviation."""
    width, depth, pitch, extent, height, irradiance = 1.0, 0.14, 10.0, 1.0, 0.5, 3.0
    black = PreviewSurface(diffuse_color=(0, 0, 0), specular_color=(0, 0, 0), use_specular_workflow=True)
    layer = {"distribution": "linear", "pitch": pitch, "width": width, "depth": depth, "curves": (), "angle": np.pi / 2}
    floor = waves(surface=black, wave=Wave(coherence_radius=2.0, samples=16), **layer)
    wall = sw.scene.Material(path="/wall", surface=scenes.lambert(1.0))
    h = 0.5 * height
    # the wall stands at x = 0 and faces +x; the floor runs from 0 to 1
    upright = scenes.plane(1.0, path="/upright")
    turned = np.array([[0.0, 0.0, 1.0], [4.0, 0.0, 0.0], [0.0, height, 0.0]])
    eye = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    place = np.eye(4)
    place[:3, :3] = eye
    place[:3, 3] = (2.0, 0.0, h)
    camera = Camera(path="/cam", transform=place, horizontal_aperture=height, vertical_aperture=height,
                    projection="orthographic")  # fmt: skip
    linear = np.diag([0.5 * extent, 2.0, 1.0])
    world = scenes.scene(
        [scenes.plane(2.0), upright],
        [floor, wall],
        [DistantLight(path="/sun", radiance=np.full(3, irradiance), direction=np.array([0, 0, -1.0]))],
        instances=[
            scenes.place(0, 0, (0.5 * extent, 0, 0), linear=linear),
            scenes.place(1, 1, (0, 0, h), path="/stands", linear=turned),
        ],
        cam=camera,
    )
    film = render(world, spp=2048, max_depth=2)
    at, weights = spectral_samples(32)
    xi = (np.arange(4000) + 0.5) / 4000
    ratio = width / (at * 1e-3)
    lobe = ratio * np.sinc(np.outer(xi, ratio)) ** 2
    reach = np.minimum(extent, height * xi / np.sqrt(1.0 - xi * xi))
    flux = (lobe * reach[:, None]).mean(0) * (width / pitch) * 4.0 * np.sin(2.0 * np.pi * depth / (at * 1e-3)) ** 2
    expected = irradiance * (flux @ weights) / (np.pi * height)
    assert film["color"].mean((0, 1)) @ LUMINANCE == pytest.approx(expected @ LUMINANCE, rel=0.08)
