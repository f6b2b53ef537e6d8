"""Small stages written as text, and read."""

import numpy as np
import pytest

from scratchwarp import stage

HEADER = '#usda 1.0\n(\n    metersPerUnit = {metres}\n    upAxis = "{up}"\n{more}\n)\n'


@pytest.fixture
def write(tmp_path):
    """``write(text, metres=1, up="Y", more="", name="stage.usda")`` -> path of a stage: a header, and that text.

    USD wants line breaks about a closing brace; the writer sees to it.
    """

    def writer(text, metres=1, up="Y", more="", name="stage.usda"):
        path = tmp_path / name
        path.write_text(HEADER.format(metres=metres, up=up, more=more) + text.replace("}", "\n}\n"))
        return path

    return writer


@pytest.fixture
def read(write):
    """``read(text, metres=, up=, more=, **keywords of stage.read)`` -> Scene."""

    def reader(text, metres=1, up="Y", more="", **options):
        return stage.read(write(text, metres, up, more), **options)

    return reader


@pytest.fixture
def said():
    """``said(scene, word, ...)``: the one warning that has all these words."""

    def finder(scene, *words):
        found = [w for w in scene.warnings if all(str(word) in w for word in words)]
        assert len(found) == 1, f"{words} in {scene.warnings}"
        return found[0]

    return finder


@pytest.fixture
def world_points():
    """``world_points(scene, instance)``: corners of its triangles in world metres, shape [m, 3, 3]."""

    def placer(scene, index):
        instance = scene.instances[index]
        mesh = scene.meshes[instance.mesh]
        corners = mesh.points[mesh.triangles]
        return corners @ instance.transform[:3, :3].T + instance.transform[:3, 3] + np.asarray(scene.origin)

    return placer
