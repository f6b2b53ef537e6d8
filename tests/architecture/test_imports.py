"""Imports go upward through the rooms, and each foreign library has its door."""

import subprocess
import sys

import pytest

from .house import ROOMS, modules

# Foreign library -> rooms that may import it, with the reason for each room that is not the library's own door.
DOORS = {
    "pxr": {
        "stage": "the door: stages are read here",
        "usd_schemas": "registers the schemas and generates their files",
        "pipelines": "scripts that write stages",
    },
    "OpenImageIO": {"image": "the door: image files are read and written here"},
    "pyvista": {"viewers": "the door: windows are opened here"},
    "vtk": {"viewers": "pyvista's own library"},
    "trame": {"viewers": "shows pyvista in a browser"},
    "matplotlib": {"viewers": "plots of profiles and tables", "study": "plots of error against time"},
    "scipy": {
        "study": "only the extra installs it",
        "reflectance": "refines fitted models; where the extra is missing, the direct fit remains",
    },
    "skimage": {"study": "only the extra installs it"},
    "flip_evaluator": {"study": "only the extra installs it"},
    "mitsuba": {"pipelines": "the BSDF that exported scenes bring along"},
    "drjit": {"pipelines": "Mitsuba's own arrays"},
    "MaterialX": {"pipelines": "the exported document"},
    "distributed": {"render": "the farm"},
    "rich": {"render": "the progress bar"},
    "jinja2": {"usd_schemas": "usdGenSchema needs it"},
}

# Rooms that know no kernels.
WITHOUT_WARP = ("usd_schemas", "scene", "stage", "image", "lazy", "whole", "frames", "pipelines", "arguments")

# (importer, imported): reason. Imports that go down the list of rooms.
DOWNWARD: dict[tuple[str, str], str] = {}


def test_every_module_is_in_a_room():
    strange = {m.room for m in modules()} - set(ROOMS) - {""}
    assert not strange, f"rooms that the house does not have: {sorted(strange)}"


def test_imports_go_upward():
    wrong = []
    for module in modules():
        for name, line in module.imports():
            parts = name.split(".")
            if parts[0] != "scratchwarp" or not module.room:
                continue
            room = parts[1] if len(parts) > 1 else ""
            if room == "__version__":
                continue
            if room not in ROOMS:
                # The package itself reaches every room.
                allowed = ROOMS.index(module.room) >= ROOMS.index("pipelines")
            else:
                allowed = ROOMS.index(room) <= ROOMS.index(module.room)
            if not allowed and (module.name, name) not in DOWNWARD:
                wrong.append(f"{module.path}:{line} imports {name}")
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("library", DOORS)
def test_foreign_library_enters_by_its_door(library):
    wrong = [
        f"{module.path}:{line}"
        for module in modules()
        for name, line in module.imports()
        if name.split(".")[0] == library and module.room not in DOORS[library]
    ]
    assert not wrong, "\n".join(wrong)


def test_rooms_without_kernels():
    wrong = [m.path for m in modules() if m.room in WITHOUT_WARP and any(n.startswith("warp") for n, _ in m.imports())]
    assert not wrong


def test_import_scratchwarp_is_light():
    """In a fresh interpreter, for one that ran other tests has everything loaded."""
    code = "import sys, scratchwarp, scratchwarp.cli; print(*{name.split('.')[0] for name in sys.modules})"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert not {"pxr", "warp", "pyvista", "vtk", "OpenImageIO", "rich", "numpy"} & set(loaded)


@pytest.mark.parametrize(
    "first", ["pass", "import scratchwarp.render.progress as p", "from scratchwarp.render import Film"]
)
def test_the_room_that_renders_can_be_called(first):
    """Whatever was imported before, ``scratchwarp.render`` is the room, and can be called."""
    code = f"{first}; import scratchwarp as sw; print(callable(sw.render), sw.render.Film.__name__)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["True", "Film"]
