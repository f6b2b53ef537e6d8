"""Scene + Settings -> EffectPlan: what the scene calls for, why, and with what settings.

Files:
    choice      EffectChoice, EffectPlan, TablePlan, LayerPlan: the result
    resolve     every setting decided
    effects     the effects and how each is decided; a new effect is one line there
    knobs       the approximations that can be turned, and how they change tables and settings
    cost        about what each effect costs
    layers      the scene's layers -> sublayers and the tables they share
    theta       which theta model a table needs
    waves, wave_effects      what diffracts, and which effects that calls for; crowds: how many a sample lights
    grooves, groove_effects  what is laid out groove by groove, and its effects; nearby: where it takes over from tables
    profiles    a ScratchProfile record -> a profile to simulate
    occlusion   whether anything can cast a shadow
    make        make_plan
    far_bases   scratched materials rendered as such, where somebody asks for it
    far_field   a scratched material as one BRDF and as highlight stencils, for those who ask
"""

from .choice import EffectChoice, EffectPlan, LayerPlan, TablePlan
from .make import make_plan

__all__ = ["EffectChoice", "EffectPlan", "LayerPlan", "TablePlan", "make_plan"]
