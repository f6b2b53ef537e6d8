"""``EffectPlan.explain``: the plan as text."""

import pytest

import scratchwarp as sw
from scratchwarp.lights import MODELS
from scratchwarp.plan import EffectChoice, EffectPlan
from scratchwarp.plan.cost.shares import LIGHT, SET
from scratchwarp.scene import Material
from scratchwarp.scratches import KINDS

from ..render import scenes as S


def lines(plan):
    return plan.explain().splitlines()


def test_one_line_for_each_effect_in_order():
    plan = sw.make_plan(S.scene([S.sphere(8, 16)], [S.scratched()], [S.dome()]))
    head, rule, *rows = lines(plan)
    assert head.split() == ["effect", "state", "share", "why"] and set(rule) == {"-", " "}
    assert [row.split()[0] for row in rows[: len(plan.effects)]] == list(plan.effects)
    for row, (name, choice) in zip(rows, plan.effects.items(), strict=False):
        assert row.split()[1] == ("on" if choice.enabled else "off"), name
        assert choice.reason in row


def test_a_forced_effect_is_marked_and_the_mark_explained():
    world = S.scene([S.sphere(8, 16)], [Material("/mat")], [S.dome()])
    forced = lines(sw.make_plan(world, sw.Settings(effects={"lens": True, "lights.dome": False})))
    assert [row.split()[:2] for row in forced if "!" in row][:2] == [["lights.dome", "off!"], ["lens", "on!"]]
    assert any(row.startswith("! forced") for row in forced)
    assert not any(row.startswith("!") for row in lines(sw.make_plan(world)))


def test_prims_are_named_three_at_most():
    def row(count):
        choice = EffectChoice(True, "because", tuple(f"/p{i}" for i in range(count)))
        return lines(EffectPlan({"effect": choice}, sw.Settings(), (1, 1), (0, 1, 0, 1)))[2]

    assert row(0).endswith("because")
    assert row(3).endswith("because  [/p0, /p1, /p2]")
    assert row(4).endswith("because  [/p0, /p1, /p2, ...]")


def test_numbers_and_warnings_follow():
    plan = sw.make_plan(
        S.scene([S.sphere(8, 16)], [S.scratched()], [S.dome()]),
        sw.Settings(width=64, spp=3, max_error=0.02, quality="preview", knobs={"tables.resolution": 256}),
    )
    text = plan.explain()
    assert "quality: preview, 16 samples unless others are asked for; of " in text
    assert "image: 64 x 64 pixels" in text and "3 samples each" in text
    assert "memory: 1.6 MB of tables; 0 segments" in text  # a mirror of 256 x 256 cells, 24 bytes each
    assert f"geometry: {len(S.sphere(8, 16).triangles)} triangles in 1 instances" in text
    assert "error: samples grow from 3 until relMSE is estimated below 0.02" in text


def test_shares_are_those_of_effects_that_are_on_and_leave_room_for_the_rest():
    plan = sw.make_plan(S.scene([S.sphere(8, 16), S.plane()], [S.scratched()], [S.dome()]))
    shares = {name: choice.share for name, choice in plan.effects.items()}
    assert all(share == 0.0 for name, share in shares.items() if not plan.on(name))
    assert shares["scratches.worley"] > 0.0 and shares["shadows"] > 0.0
    assert 0.0 < sum(shares.values()) < 1.0


@pytest.mark.parametrize(("costs", "names"), [(LIGHT, [m.name for m in MODELS.values()]), (SET, list(KINDS))])
def test_every_light_and_every_distribution_has_a_cost(costs, names):
    assert set(costs) == set(names)
