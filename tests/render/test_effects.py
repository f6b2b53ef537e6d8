"""An effect that is off is neither compiled, simulated nor launched, and one that nothing calls for changes no bit.

That lets the other tests of this folder share kernels that hold the code of everything.
"""

import ast
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import warp as wp

import scratchwarp as sw
from scratchwarp.kernels import kernel_key
from scratchwarp.kernels.render_device import make_kernel
from scratchwarp.pipelines.author_demo import author
from scratchwarp.scene import Material, PreviewSurface, RectLight

from . import scenes

PACKAGE = Path(sw.__file__).parent
LAMP = RectLight(
    path="/lamp", radiance=(9, 7, 5), center=(2, 2, -3), ex=(0.5, 0, -0.5), ey=(0, 0.7, 0), normal=(-0.8, 0, -0.6)
)
ROUGH = PreviewSurface(diffuse_color=(0.6, 0.4, 0.3), roughness=0.4, clearcoat=0.5, clearcoat_roughness=0.2)


def plain():
    return scenes.scene([scenes.sphere()], [Material("/mat", ROUGH)], [LAMP, scenes.dome(0.5)])


def compiled_source(world, effects):
    """The C++ that was compiled to render ``world``; renders it."""
    settings = sw.Settings(width=16, height=16, spp=1, filter="box", effects=effects)
    plan = sw.make_plan(world, settings)
    sw.render(world, plan)
    module = make_kernel(kernel_key(world, plan)).module
    files = Path(wp.config.kernel_cache_dir).glob(f"wp_{module.name}_*/*.cpp")
    return max(files, key=lambda f: f.stat().st_mtime).read_text()


def device_functions(*files):
    """Names of the Warp functions defined in files of the package, nested ones included."""
    names = set()
    for file in files:
        for node in ast.walk(ast.parse((PACKAGE / file).read_text())):
            if isinstance(node, ast.FunctionDef) and any("wp.func" in ast.unparse(d) for d in node.decorator_list):
                names.add(node.name)
    return names


def called(source):
    """Names of the functions that a source defines."""
    return {name.split("__locals__")[-1] for name in re.findall(r"\b(\w+?)_\d+\(", source)}


# what only an effect that a plain scene lacks brings along
SCRATCHES = ("scratches/worley_device.py", "scratches/lines_device.py", "scratches/layer_device.py")
SCRATCHES += ("reflectance/profile_table_device.py", "kernels/layers_device.py")
RESPONSES = [
    f.relative_to(PACKAGE)
    for folder in ("responses", "mdf", "stencils", "measured")
    for f in (PACKAGE / "reflectance" / folder).glob("*_device.py")
]
MARKS = {
    "lens": "lens_point",
    "base.opacity": "opacity_at",
    "base.textures": "read_texture",
    "base.displayColor": "interpolate_color",
    "base.direction": "interpolate_tangent",
    "base.measured": "measured_base",
    "base.emission": "emission_at",
    "lights.sphere": "sample_sphere",
    "lights.disk": "sample_disk",
    "lights.cylinder": "sample_cylinder",
    "lights.distant": "sample_distant",
    "lights.mesh": "sample_mesh",
}


def test_the_plain_kernel_holds_no_scratch_code():
    without = called(compiled_source(plain(), {}))
    everything = called(compiled_source(plain(), scenes.EVERYTHING))
    of_scratches = device_functions(*SCRATCHES)
    assert {"table_value", "cone_direction", "worley", "concentric", "band_coverage", "gather"} <= of_scratches
    assert not of_scratches & without
    responses = device_functions(*RESPONSES)
    assert {"facets_eval", "normal_response_place", "stencil_eval", "lobe_sample", "half_pdf"} <= responses
    assert not responses & without, responses & without
    assert not responses & everything, responses & everything
    assert not {"cone_span", "span_rect", "span_dome", "span_cap"} & without
    assert len(of_scratches & everything) > 10 and "span_rect" in everything
    for effect, mark in MARKS.items():
        assert mark not in without, effect
        assert mark in everything, effect
    assert {"sample_rect", "sample_dome", "preview_surface"} <= without


@pytest.mark.parametrize("authored", [False, True])
def test_explain_says_so(tmp_path, authored):
    world = sw.read(author(tmp_path, 0.1, ["plain"])[0]) if authored else plain()
    plan = sw.make_plan(world)
    lines = {line.split()[0]: line.split()[1] for line in plan.explain().splitlines() if line.strip()}
    scratch = [n for n in plan.effects if n.startswith("scratches")] + ["diffraction", "grooves"]
    assert len(scratch) >= 10 and all(lines[name] == "off" for name in scratch)
    assert lines["base.preview"] == "on" and "on" in (lines["lights.rect"], lines["lights.dome"])
    assert plan.tables == ()


def test_nothing_is_simulated_or_launched_in_vain():
    film = scenes.shoot(plain(), {}, spp=40, tile=16)
    # four tiles, 40 samples in two launches
    assert film.stats["kernels_launched"] == 8 and film.stats["tables_simulated"] == 0
    assert film.stats["kernels_compiled"] <= 1
    again = scenes.shoot(plain(), {}, spp=40, tile=16)
    assert again.stats["kernels_compiled"] == 0
    layered = replace(plain(), materials=(scenes.scratched(),))
    assert scenes.shoot(layered).stats["tables_simulated"] == 1
    assert scenes.shoot(layered, {"scratches": False}).stats["tables_simulated"] == 0


@pytest.mark.parametrize("material", ["plain", "scratched"])
def test_code_that_nothing_calls_for_changes_no_bit(material):
    """Among it are shadow rays on a convex body: none may hit the surface that it leaves."""
    world = plain()
    if material == "scratched":
        layered = scenes.scratched(ROUGH, width=30000.0, depth=9000.0, length=3e5, fresnel="exact")
        world = replace(world, materials=(layered,))
    # integrals along cones are estimated otherwise where something may cast a shadow
    lean, full = scenes.shoot(world, {"lights.closedForm": False}), scenes.shoot(world)
    assert (lean["scratches"].max() > 0.05) == (material == "scratched") and lean["base"].max() > 0.1
    for name in lean:
        np.testing.assert_array_equal(full[name], lean[name], err_msg=name)


def test_scratches_change_only_what_they_lie_on():
    placed = [scenes.place(0, 0, (-1.1, 0, -6), "/one"), scenes.place(0, 1, (1.1, 0, -6), "/other")]
    materials = (scenes.scratched(ROUGH, coverage=0.6), Material("/plain", ROUGH))
    ball = scenes.sphere()
    world = scenes.scene([ball], materials, [LAMP, scenes.dome(0.5)], placed, scenes.camera(30.0))
    on = scenes.shoot(world)
    off = scenes.shoot(replace(world, materials=(Material("/mat", ROUGH), materials[1])))
    right = np.arange(32) > 16
    assert (on["primId"][:, right] == 1).sum() > 50
    np.testing.assert_array_equal(on["color"][:, right], off["color"][:, right])
    assert (on["color"] != off["color"]).any(-1)[on["primId"] == 0].mean() > 0.9
    assert off["scratches"].max() == 0.0
    for name in ("alpha", "depth", "normal", "albedo", "P", "primId"):
        np.testing.assert_array_equal(on[name], off[name], err_msg=name)
    np.testing.assert_allclose(on["emission"], off["emission"], atol=1e-6)  # a difference of sums


def test_forced_off_is_as_if_never_authored():
    bare = plain()
    layered = replace(bare, materials=(scenes.scratched(ROUGH, coverage=0.6),))
    off, never = scenes.shoot(layered, {"scratches": False}), scenes.shoot(bare, {})
    for name in off:
        np.testing.assert_array_equal(off[name], never[name], err_msg=name)


def test_shadows_change_only_what_is_shadowed():
    placed = [scenes.place(0, 0, (0, 0, -6), "/ball"), scenes.place(1, 0, (0, 0, -7.5), "/wall")]
    world = scenes.scene([scenes.sphere(), scenes.plane(4.0)], [Material("/mat", ROUGH)], [LAMP], placed)
    on = scenes.shoot(world, spp=64)
    off = scenes.shoot(replace(world, lights=(replace(LAMP, shadow=False),)), spp=64)
    same = (on["color"] == off["color"]).all(-1)
    assert 0.2 < same.mean() < 0.98
    for name in ("alpha", "depth", "normal", "albedo", "P", "primId"):
        np.testing.assert_array_equal(on[name], off[name], err_msg=name)
