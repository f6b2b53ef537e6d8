"""The camera and the window it sees."""

from dataclasses import dataclass

import numpy as np

from .checks import all_finite, freeze, in_range, one_of, put

CONFORMS = (
    "expandAperture",
    "cropAperture",
    "adjustApertureWidth",
    "adjustApertureHeight",
    "adjustPixelAspectRatio",
)


@dataclass(frozen=True, eq=False)
class Camera:
    """Looks down its -Z with +X right and +Y up.

    Attributes:
        path: prim path ("" for a camera made to frame the scene).
        transform: camera to world metres relative to ``Scene.origin``, shape [4, 4], rotation and translation only.
        horizontal_aperture, vertical_aperture, horizontal_offset, vertical_offset, focal_length: all in one unit for a
            perspective camera; the apertures and offsets in metres of world width for an orthographic one.
        projection: perspective or orthographic.
        near, far: clipping distances along -Z [m].
        lens_radius: [m], 0 for a pinhole; focus_distance: [m] along -Z.
        exposure: linear factor on radiance.
    """

    path: str
    transform: np.ndarray
    horizontal_aperture: float = 20.955
    vertical_aperture: float = 15.2908
    horizontal_offset: float = 0.0
    vertical_offset: float = 0.0
    focal_length: float = 50.0
    projection: str = "perspective"
    near: float = 0.0
    far: float = np.inf
    lens_radius: float = 0.0
    focus_distance: float = 0.0
    exposure: float = 1.0

    def __post_init__(self) -> None:
        who = self.path or "camera"
        put(self, transform=freeze(who, "transform", self.transform, (4, 4)))
        all_finite(who, self, ("far",))
        in_range(who, "far", self.far)
        one_of(who, "projection", self.projection, ("perspective", "orthographic"))
        in_range(who, "horizontalAperture", self.horizontal_aperture, 1e-12)
        in_range(who, "verticalAperture", self.vertical_aperture, 1e-12)
        if self.projection == "perspective":
            in_range(who, "focalLength", self.focal_length, 1e-12)

    def window(
        self, width: int, height: int, conform: str = "expandAperture", pixel_aspect: float = 1.0
    ) -> tuple[float, float, float, float]:
        """(left, right, bottom, top): at distance 1 for a perspective camera, in metres for an orthographic one.

        ``conform`` is UsdRender's aspectRatioConformPolicy: how the aperture gives way to the image's aspect.
        """
        one_of(self.path or "camera", "aspectRatioConformPolicy", conform, CONFORMS)
        frame = pixel_aspect * width / height
        w, h = self.horizontal_aperture, self.vertical_aperture
        wider = frame > w / h
        if conform == "adjustApertureWidth" or (conform == "expandAperture" and wider):
            w = h * frame
        elif conform == "adjustApertureHeight" or (conform == "expandAperture" and not wider):
            h = w / frame
        elif conform == "cropAperture":
            w, h = (w, w / frame) if wider else (h * frame, h)
        f = self.focal_length if self.projection == "perspective" else 1.0
        x, y = self.horizontal_offset, self.vertical_offset
        return (x - w / 2) / f, (x + w / 2) / f, (y - h / 2) / f, (y + h / 2) / f
