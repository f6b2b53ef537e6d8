"""When the schemas are registered: in time, too late, by the environment; without importing pxr."""

import os
import subprocess
import sys

from scratchwarp import usd_schemas


def run(code, **environ):
    """Run ``code`` in a fresh interpreter that finds the modules this one does."""
    path = os.pathsep.join(entry for entry in sys.path if entry)
    environ = {**os.environ, "PYTHONPATH": path, "PXR_PLUGINPATH_NAME": "", **environ}
    return subprocess.run([sys.executable, "-c", code], env=environ, capture_output=True, text=True)


def test_import_does_not_load_pxr():
    done = run("import sys, scratchwarp.usd_schemas as s; s.set_environment(); print('pxr' in sys.modules)")
    assert done.stdout.strip() == "False", done.stderr


def test_in_time_works_and_again_is_harmless():
    done = run(
        "from pxr import Usd; from scratchwarp import usd_schemas as s; s.register(); s.register();"
        "stage = Usd.Stage.CreateInMemory(); prim = stage.DefinePrim('/M', 'Material');"
        "print(prim.ApplyAPI('ScratchLayerAPI', 'fine'), prim.GetAttribute('scratch:layer:fine:width').Get())"
    )
    assert done.stdout.strip() == "True 10.0", done.stderr


def test_too_late_fails_loudly():
    done = run(
        "from pxr import Usd; stage = Usd.Stage.CreateInMemory(); stage.DefinePrim('/M', 'Material');"
        "from scratchwarp import usd_schemas; usd_schemas.register()"
    )
    assert done.returncode != 0
    assert "RuntimeError: too late to register" in done.stderr and "PXR_PLUGINPATH_NAME" in done.stderr


def test_too_late_stays_loud():
    """A second call must not pass just because the plugin is known by then."""
    done = run(
        "from pxr import Usd; Usd.SchemaRegistry(); from scratchwarp import usd_schemas as s\n"
        "for _ in range(2):\n"
        "    try: s.register(); print('silent')\n"
        "    except RuntimeError: print('loud')"
    )
    assert done.stdout.split() == ["loud", "loud"], done.stderr


def test_environment_makes_the_order_irrelevant():
    done = run(
        "from pxr import Usd; Usd.SchemaRegistry(); from scratchwarp import usd_schemas as s; s.register(); print(1)",
        PXR_PLUGINPATH_NAME=str(usd_schemas.plugin_path()),
    )
    assert done.stdout.strip() == "1", done.stderr


def test_set_environment_puts_the_path_first_once():
    environ = {"PXR_PLUGINPATH_NAME": "/other"}
    usd_schemas.set_environment(environ)
    usd_schemas.set_environment(environ)
    assert environ["PXR_PLUGINPATH_NAME"].split(os.pathsep) == [str(usd_schemas.plugin_path()), "/other"]
