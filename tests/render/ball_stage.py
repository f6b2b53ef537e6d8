"""A diffuse ball on a diffuse floor: as a stage in centimetres, and in stage units for Mitsuba."""

import numpy as np

import scratchwarp as sw

from . import scenes
from .mitsuba_reference import T, binned, rgb, sensor, shoot

BALL, FLOOR = (0.7, 0.5, 0.3), (0.4, 0.6, 0.8)
STAGE = """#usda 1.0
(
    metersPerUnit = 0.01
    upAxis = "Y"
    METADATA
)
def Sphere "ball" (prepend apiSchemas = ["MaterialBindingAPI"])
{
    double radius = 1
    double3 xformOp:translate = (0.2, 1, -0.3)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    rel material:binding = </warm>
}
def Mesh "floor" (prepend apiSchemas = ["MaterialBindingAPI"])
{
    uniform token subdivisionScheme = "none"
    point3f[] points = [(-4, 0, 4), (4, 0, 4), (4, 0, -4), (-4, 0, -4)]
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    rel material:binding = </cool>
}
def Camera "camera"
{
    float focalLength = 35
    double3 xformOp:translate = (1, 4, 8)
    double3 xformOp:rotateXYZ = (-25, 10, 0)
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ"]
    CAMERA
}
"""
MATERIAL = """
def Material "{name}"
{{
    token outputs:scratchwarp:surface.connect = </{name}/node.outputs:surface>
    def Shader "node"
    {{
        uniform token info:id = "ScratchSurface"
        token inputs:base = "diffuse"
        color3f inputs:color = {color}
        token outputs:surface
    }}
}}
"""


def turned(x, y=0.0, z=0.0):
    """USD's rotateXYZ in degrees as a matrix for column vectors."""
    made = np.eye(3)
    for axis, degrees in enumerate((x, y, z)):
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        i, j = (axis + 1) % 3, (axis + 2) % 3
        turn = np.eye(3)
        turn[i, i] = turn[j, j] = c
        turn[i, j], turn[j, i] = -s, s
        made = turn @ made
    return made


def placed(translate=(0, 0, 0), rotate=(0, 0, 0), scale=(1, 1, 1)):
    """(xformOps as USD text, the same as a matrix for column vectors)."""
    text = f"""
    double3 xformOp:translate = {tuple(translate)}
    double3 xformOp:rotateXYZ = {tuple(rotate)}
    double3 xformOp:scale = {tuple(scale)}
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ", "xformOp:scale"]"""
    m = np.eye(4)
    m[:3, :3] = turned(*rotate) @ np.diag(scale)
    m[:3, 3] = translate
    return text, m


APERTURE = """float horizontalAperture = 20
    float verticalAperture = 15
"""


def pair(
    folder, text, light, window, pixel, size, camera=APERTURE, metadata="", focal=35, lens=None, spp=1024, bounces=0
):
    """(our film, Mitsuba's image and variance) of the ball under one light.

    Args:
        text: more of the stage; camera: more of the camera; metadata: of the stage. light: Mitsuba's light.
        window: what the image shows (left, right, bottom, top), ``focal`` away; pixel: Mitsuba's, to be binned.
        size: of the image; lens: Mitsuba's (aperture radius, focus distance). bounces: between surfaces.
    """
    materials = "".join(MATERIAL.format(name=n, color=c) for n, c in (("warm", BALL), ("cool", FLOOR)))
    file = folder / "stage.usda"
    file.write_text(STAGE.replace("CAMERA", camera).replace("METADATA", metadata) + materials + text)
    world = sw.read(file)
    assert not world.warnings
    traced = {"integrator": "path", "max_depth": 1 + bounces} if bounces else {}
    ours = scenes.shoot(world, width=size[0], height=size[1], spp=spp, **traced)
    assert ours.stats["invalid_samples"] == 0
    ball = {"type": "sphere", "center": [0.2, 1, -0.3], "radius": 1}
    floor = {"type": "rectangle", "to_world": T().rotate([1, 0, 0], -90).scale([4, 4, 1])}
    parts = {
        "ball": ball | {"bsdf": {"type": "diffuse", "reflectance": rgb(BALL)}},
        "floor": floor | {"bsdf": {"type": "diffuse", "reflectance": rgb(FLOOR)}},
        "light": light,
    }
    view = np.eye(4)
    view[:3, :3], view[:3, 3] = turned(-25, 10), (1, 4, 8)
    made = sensor(view, window, pixel, focal)
    if lens:
        made |= {"type": "thinlens", "aperture_radius": lens[0], "focus_distance": lens[1]}
    pixels = made["film"]["crop_width"] * made["film"]["crop_height"]
    share = pixels // (size[0] * size[1])
    integrator = {"type": "path", "max_depth": 2 + bounces, "rr_depth": 1000} if bounces else None
    image, variance = shoot(parts, made, max(spp // share, 4), integrator)
    return ours, binned(image, *size), binned(variance, *size) / share
