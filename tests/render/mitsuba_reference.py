"""Images by Mitsuba 3 with the variance of every pixel, and how they are compared with ours."""

import numpy as np
import pytest

mi = pytest.importorskip("mitsuba")
mi.set_variant("scalar_rgb")
T = mi.ScalarTransform4f


def rgb(values):
    """A colour, which Mitsuba takes as it is (linear Rec.709)."""
    return {"type": "rgb", "value": np.broadcast_to(np.asarray(values, float), 3).tolist()}


def area(radiance):
    """An emitter that makes a shape shine."""
    return {"type": "area", "radiance": rgb(radiance)}


def matrix(columns):
    """A transform from a 4 x 4 matrix, column vectors."""
    return T(np.asarray(columns, float))


def film(width, height, crop=None):
    """A box-filtered film; ``crop``: (x, y, width, height) of a larger one."""
    made = {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"}}
    made |= {"component_format": "float32"}
    if crop:
        made |= dict(zip(("crop_offset_x", "crop_offset_y", "crop_width", "crop_height"), crop, strict=True))
    return made


def sensor(place, window, pixel, focal=None):
    """A camera at the 4 x 4 matrix ``place`` that looks down its -Z and sees (left, right, bottom, top).

    The window is in the plane ``focal`` away (None: orthographic), in square pixels of edge ``pixel``. Mitsuba's own
    window lies about the axis, so ours is a crop of a larger film. Its camera looks along +z with +x to the left.
    """
    left, right, bottom, top = (np.array(window) / pixel).round(9)
    half_x, half_y = max(-left, right), max(-bottom, top)
    whole = [2 * half_x, 2 * half_y, left + half_x, half_y - top, right - left, top - bottom]
    assert all(float(n).is_integer() for n in whole), whole
    width, height, *crop = (int(n) for n in whole)
    turn = matrix(place @ np.diag([-1.0, 1.0, -1.0, 1.0]))
    made = {"near_clip": 0.01, "film": film(width, height, crop)}
    if focal is None:
        return {"type": "orthographic", "to_world": turn @ T().scale([half_x * pixel, half_x * pixel, 1]), **made}
    fov = np.degrees(2 * np.arctan(half_x * pixel / focal))
    return {"type": "perspective", "fov": fov, "fov_axis": "x", "to_world": turn, **made}


def binned(image, width, height):
    """The mean over blocks of pixels, ``width`` x ``height`` of them."""
    h, w, *rest = image.shape
    return image.reshape(height, h // height, width, w // width, *rest).mean((1, 3))


def shoot(parts, sensor, spp=256, integrator=None, seed=3):
    """(image [h, w, 3], variance of the mean luminance [h, w]) of a dictionary of shapes and lights."""
    camera = {**sensor, "sampler": {"type": "multijitter", "sample_count": spp}}
    integrator = {"type": "moment", "nested": integrator or {"type": "direct"}}
    world = mi.load_dict({"type": "scene", "integrator": integrator, "sensor": camera, **parts})
    # channels: the image, then mean and second moment of X, Y, Z
    found = np.array(mi.render(world, seed=seed), float)
    names = world.integrator().aov_names()
    first = found.shape[-1] - len(names)
    mean, square = (found[..., first + names.index(name)] for name in ("nested.Y", "m2_nested.Y"))
    return found[..., :3], np.maximum(square - mean**2, 0.0) / (spp - 1)


def luminance(image):
    """Y of linear Rec.709."""
    return image @ np.array([0.2126, 0.7152, 0.0722])


def agreement(ours, theirs, variance, region):
    """(relative difference of the region's mean in the worst channel, standard deviation of that of the luminance)."""
    a = ours["color"][region].mean(0, dtype=float)
    b = theirs[region].mean(0)
    noise = np.sqrt((variance + ours["variance"])[region].sum()) / region.sum()
    return np.abs(a / b - 1).max(), noise / luminance(b)


def deviations(ours, theirs, variance, relative=5e-3):
    """Differences of the pixels' luminance beyond ``relative``, in standard deviations of both images, shape [h, w].

    A pixel's own estimate of its variance can be luckily small, so the mean over its 3 x 3 neighbours counts where that
    is larger.
    """
    both = variance + ours["variance"]
    padded = np.pad(both, 1, mode="edge")
    h, w = both.shape
    around = sum(padded[i : i + h, j : j + w] for i in range(3) for j in range(3)) / 9
    theirs = luminance(theirs)
    off = np.abs(luminance(ours["color"]) - theirs) - relative * theirs
    return off / np.sqrt(np.maximum(both, around) + 1e-16)
