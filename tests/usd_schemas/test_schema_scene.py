"""The tokens of the schema are those that the records of a scene accept."""

import pytest
from pxr import Usd

from scratchwarp.scene import layer, settings

LAYER = "scratch:layer:__INSTANCE_NAME__:"
PAIRS = [
    ("ScratchLayerAPI", LAYER + "model", layer.MODELS),
    ("ScratchLayerAPI", LAYER + "distribution", layer.DISTRIBUTIONS),
    ("ScratchLayerAPI", LAYER + "space", layer.SPACES),
    ("ScratchLayerAPI", LAYER + "material", layer.MATERIALS),
    ("ScratchLayerAPI", LAYER + "fresnelModel", layer.FRESNELS),
    ("ScratchProfile", "scratch:shape", layer.SHAPES),
    ("ScratchRenderSettingsAPI", "scratch:render:quality", settings.QUALITIES),
    ("ScratchRenderSettingsAPI", "scratch:render:integrator", settings.INTEGRATORS),
]


@pytest.mark.parametrize(("schema", "name", "accepted"), PAIRS, ids=[pair[1].rpartition(":")[2] for pair in PAIRS])
def test_tokens(schema, name, accepted):
    registry = Usd.SchemaRegistry()
    definition = registry.FindAppliedAPIPrimDefinition(schema) or registry.FindConcretePrimDefinition(schema)
    assert tuple(definition.GetAttributeDefinition(name).GetMetadata("allowedTokens")) == accepted
