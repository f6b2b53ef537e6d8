"""The USD schemas of scratchwarp, codeless: plain files that any USD 26.8 or later can load.

Files:
    schema.usda                the source: classes, attributes, units, ranges, documentation
    generate.py                makes the generated files from it; ``--check`` says whether they are stale
    plugInfo.json              leads USD to scratchSchema/resources
    scratchSchema/resources/   the generated files, and shaderDefs.usda, the shading node ScratchSurface

Importing this module does not import pxr, so that a host program can ask for the path before its own pxr loads::

    from scratchwarp import usd_schemas
    usd_schemas.set_environment()    # before pxr is imported: nothing can go wrong
    usd_schemas.register()           # in a process where pxr is loaded, before the first stage is opened
"""

import os
from collections.abc import MutableMapping
from pathlib import Path

PLUGIN_NAME = "scratchSchema"
SCHEMAS = (
    "ScratchProfile",
    "ScratchLayerAPI",
    "ScratchWaveAPI",
    "ScratchCurvesAPI",
    "ScratchMeasuredAPI",
    "ScratchRenderSettingsAPI",
)


def plugin_path() -> Path:
    """The folder to put on PXR_PLUGINPATH_NAME, or to hand to ``Plug.Registry().RegisterPlugins``."""
    return Path(__file__).resolve().parent


def shader_definitions() -> Path:
    """The file that defines the shading node ScratchSurface."""
    return plugin_path() / PLUGIN_NAME / "resources" / "shaderDefs.usda"


def set_environment(environ: MutableMapping[str, str] | None = None) -> None:
    """Put the plugin folder first on PXR_PLUGINPATH_NAME, once; call it before pxr is imported.

    ``environ`` is the mapping to change, the environment of this process unless given: pass a copy to prepare the
    environment of a child process (usdview, a farm worker).
    """
    target = os.environ if environ is None else environ
    paths = [path for path in target.get("PXR_PLUGINPATH_NAME", "").split(os.pathsep) if path]
    here = str(plugin_path())
    if here not in paths:
        target["PXR_PLUGINPATH_NAME"] = os.pathsep.join([here, *paths])


def register() -> None:
    """Make the schemas known to the USD of this process; calling it again does nothing.

    Raises:
        RuntimeError: USD built its schema registry earlier, without these schemas. It does so when the first stage with
            a typed prim is opened, and cannot be told later: every scratch attribute would silently be ignored.
    """
    from pxr import Plug, Usd

    if Plug.Registry().GetPluginWithName(PLUGIN_NAME) is None:
        Plug.Registry().RegisterPlugins(plugin_path().as_posix())
    registry = Usd.SchemaRegistry()
    missing = [
        name
        for name in SCHEMAS
        if registry.FindAppliedAPIPrimDefinition(name) is None and registry.FindConcretePrimDefinition(name) is None
    ]
    if missing:
        raise RuntimeError(
            f"too late to register scratchwarp's USD schemas ({', '.join(missing)}): a stage was opened in this "
            "process before, and USD reads schemas only once. Import scratchwarp.stage (or call "
            "scratchwarp.usd_schemas.register()) before the first stage is opened, or start the process with "
            f"PXR_PLUGINPATH_NAME={plugin_path()}"
        )


def register_shaders() -> None:
    """Make the node ScratchSurface known to USD's shader registry; calling it again does nothing."""
    from pxr import Sdr, Usd, UsdShade

    if Sdr.Registry().GetShaderNodeByIdentifier("ScratchSurface"):
        return
    path = str(shader_definitions())
    stage = Usd.Stage.Open(path)
    for prim in stage.GetPseudoRoot().GetChildren():
        for result in UsdShade.ShaderDefUtils.GetDiscoveryResults(UsdShade.Shader(prim), path):
            Sdr.Registry().AddDiscoveryResult(result)
