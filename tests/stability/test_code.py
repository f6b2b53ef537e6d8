"""The code of every effect at once is code: no combination of effects may fail to compile for names alone.

Compiling takes long; what goes wrong between effects goes wrong when Warp reads the functions, which is what is done.
"""

from dataclasses import fields, replace

import pytest
import warp as wp
from warp._src.context import ModuleBuilder

from scratchwarp.kernels.key import KernelKey
from scratchwarp.kernels.render_device import make_kernel
from scratchwarp.lights.registry import MODELS
from scratchwarp.reflectance.responses import RESPONSES
from scratchwarp.scratches import KINDS

FLAGS = [f.name for f in fields(KernelKey) if isinstance(f.default, bool)]
EVERYTHING = KernelKey(
    lights=tuple(m.name for m in MODELS.values()),
    distributions=tuple(KINDS),
    responses=tuple(RESPONSES),
    **dict.fromkeys(FLAGS, True),
)
KEYS = {
    "everything": EVERYTHING,
    "bases": replace(
        EVERYTHING,
        distributions=(),
        responses=(),
        **{
            name: False for name in FLAGS if name.startswith(("glint", "groove", "cone", "closed", "sample", "diffuse"))
        },
    ),
}


@pytest.mark.parametrize("name", KEYS)
def test_effects_go_together(name):
    module = make_kernel(KEYS[name]).module
    options = module.resolve_options(wp.config) | {"output_arch": None}
    source = ModuleBuilder(module, options).codegen("cpu")
    assert ("table_sample" in source) == (name == "everything")
