"""Every preset makes a picture, worn, and some of them new and used, by one kernel: what lies groove by groove, or
diffracts, is shown by tables here, and planned as it is."""

import numpy as np

import scratchwarp as sw
from scratchwarp.kernels import kernel_key
from scratchwarp.pipelines import looks
from scratchwarp.pipelines.contact_sheet import sessions
from scratchwarp.pipelines.put_on import put_on

PRESETS = looks.presets()
PATTERNS = ("worley", "linear", "concentric", "spiral", "variation")
THREE = ("car-paint", "vinyl", "worn-brass")
EFFECTS = dict.fromkeys((f"scratches.{name}" for name in PATTERNS), True)
EFFECTS |= dict.fromkeys(("diffraction", "grooves", "highlights"), False)


def test_every_preset_renders(asset):
    """Finite and lit by its scratches; three of them otherwise when new or used; nothing is warned about."""
    knobs = {"tables.resolution": 16, "tables.bounces": 1, "tables.rays": 256}
    how = {"width": 24, "spp": 4, "integrator": "direct", "knobs": knobs, "filter": "box"}
    keys, seen = set(), {}
    for name, path in PRESETS.items():
        out = asset.with_name(f"{name}.usda")
        put_on(asset, out, looks.read_preset(path), "steel", surface=True)
        for wear, session in sessions(out, "wear"):
            if wear != "worn" and name not in THREE:
                continue
            scene = sw.read(out, session_layer=session)
            plan = sw.make_plan(scene, sw.Settings(**how, effects=EFFECTS))
            keys.add(kernel_key(scene, plan))
            film = sw.render(scene, plan)
            whole = sw.make_plan(scene, sw.Settings(**how))
            assert scene.warnings + plan.warnings + whole.warnings + film.warnings == (), (name, wear)
            assert np.isfinite(film["color"]).all(), (name, wear)
            assert wear != "worn" or film["scratches"].max() > 0.0, name
            seen[name, wear] = film["color"]
    assert len(keys) == 1
    for name in THREE:
        assert len({seen[name, wear].tobytes() for wear in looks.WEAR}) == 3, name
    assert len({seen[name, "worn"].tobytes() for name in PRESETS}) == len(PRESETS)
