"""A small scene made by hand: a square metre with layers, a camera above it, one light of each kind."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from scratchwarp.scene import (
    Camera,
    Curves,
    CylinderLight,
    DiskLight,
    DistantLight,
    DomeLight,
    Instance,
    Layer,
    Material,
    Mesh,
    Profile,
    RectLight,
    Scene,
    Settings,
    SphereLight,
)
from scratchwarp.stage import LiveStage
from scratchwarp.viewers.looking import Looking

from .look_stage import STAGE

WHITE = np.ones(3)


def square() -> Mesh:
    """[-1, 1]^2 in z = 0 with uv from 0 to 1, seen from +z."""
    points = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], float)
    triangles = np.array([[0, 1, 2], [0, 2, 3]])
    return Mesh("/square", points, triangles, uvs={"st": (points[:, :2] / 2 + 0.5)[triangles]})


@pytest.fixture
def make_scene() -> Callable[..., Scene]:
    """``make_scene(layers, curves=(), transform=identity)``: the square under these layers."""

    def make(layers: tuple[Layer, ...], curves: tuple[Curves, ...] = (), transform: Any = None) -> Scene:
        placed = Instance("/square", 0, np.eye(4) if transform is None else transform, (0,))
        eye = np.eye(4)
        eye[2, 3] = 4.0
        lights = (
            SphereLight(path="/a", radiance=WHITE, center=np.array([1.0, 0, 1]), radius=0.1),
            RectLight(
                path="/b", radiance=WHITE, center=np.array([0.0, 0, 2]), ex=np.array([0.2, 0, 0]),
                ey=np.array([0, 0.2, 0]), normal=np.array([0, 0, -1.0]),
            ),
            DiskLight(
                path="/c", radiance=WHITE, center=np.array([0.0, 1, 2]), ex=np.array([0.2, 0, 0]),
                ey=np.array([0, 0.2, 0]), normal=np.array([0, 0, -1.0]),
            ),
            CylinderLight(
                path="/d", radiance=WHITE, center=np.array([-1.0, 0, 1]), axis=np.array([0, 0.3, 0]), radius=0.05
            ),
            DistantLight(path="/e", radiance=WHITE, direction=np.array([0, 0, -1.0])),
            DomeLight(path="/f", radiance=WHITE),
        )  # fmt: skip
        materials = (Material("/mtl", layers=layers),)
        return Scene("hand.usda", (square(),), (placed,), materials, lights, Camera("", eye), curves=curves)

    return make


@pytest.fixture
def make_layer() -> Callable[..., Layer]:
    """``make_layer(name, **fields)``: a layer with a V groove."""

    def make(name: str = "fine", **fields: Any) -> Layer:
        return Layer(name, "/mtl", Profile("/mtl/cut"), **fields)

    return make


@pytest.fixture(scope="session")
def server(tmp_path_factory):
    """The viewer for browsers on a free port, one for all tests: what they change they put back."""
    pytest.importorskip("trame")
    from scratchwarp.viewers.web.server import WebView

    folder = tmp_path_factory.mktemp("web")
    (folder / "ball.usda").write_text(STAGE)
    (folder / "secret.txt").write_text("secret")
    live = LiveStage(folder / "ball.usda")
    with (
        Looking(live, Settings(width=64, spp=3, threads=2)) as looking,
        WebView(looking, folder / "look.usda") as served,
    ):
        looking.finished(180)
        yield served
