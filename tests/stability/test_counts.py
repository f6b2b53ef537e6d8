"""More grooves than there is room for, on several surfaces: counted and refused before they are laid out."""

from dataclasses import replace

import pytest

import scratchwarp as sw
from scratchwarp.kernels import geometry, grooves, kernel_key

from .effect_cases import SUN, scratched, world


def packed(scene):
    plan = sw.make_plan(scene, sw.Settings(width=8, height=8, spp=1))
    shape = geometry.pack(scene, True, False, {}, "cpu")
    return grooves.pack(scene, plan, kernel_key(scene, plan), shape)


@pytest.mark.parametrize("distribution", ["linear", "crosshatch", "concentric", "spiral"])
def test_grooves_far_wider_than_they_are_apart(distribution):
    """Nothing is left of them: refused by the plan, where 24 in one place are not."""
    sizes = {"model": "groove", "distribution": distribution, "width": 4000.0}
    with pytest.raises(ValueError, match=r"/mat layer .* width 4000 every 20 \(pitch\) lie over one another"):
        sw.make_plan(world(scratched(pitch=20.0, **sizes), [SUN]), sw.Settings(width=8, height=8))
    assert sw.make_plan(world(scratched(pitch=340.0, **sizes), [SUN]), sw.Settings(width=8, height=8)).on("grooves")


def test_grooves_of_all_surfaces_count_together(monkeypatch):
    """The first takes most of what there is room for; the second is told how much of it is left."""
    one = scratched(model="groove", distribution="random", coverage=0.3)
    other = replace(one, path="/other", layers=tuple(replace(x, prim="/other", seed=7) for x in one.layers))
    scene = world(one, [SUN], right=other)
    both, alone = (packed(x).numbers["groove_paths"] for x in (scene, world(one, [SUN])))
    assert both > alone
    monkeypatch.setattr(grooves, "MOST_PATHS", both - 1)
    with pytest.raises(ValueError, match=rf"/other layer .* grooves, more than {both - 1 - alone}; set its model"):
        packed(scene)
