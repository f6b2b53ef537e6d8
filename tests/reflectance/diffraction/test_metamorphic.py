"""What must stay, or change by a known factor, whatever the scratch, the light and the view: one property each."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from scratchwarp import diffraction

from .brute_force import big_m, depth_power, unit
from .light_cases import polygons

PolygonLight, SphereLight, Scratch = diffraction.PolygonLight, diffraction.SphereLight, diffraction.Scratch
radiance = diffraction.radiance
FEW = settings(max_examples=20, deadline=None)
SAME = {"rtol": 1e-6, "atol": 1e-13}

widths = st.floats(0.8, 6.0)
depths = st.floats(0.0, 6.0)
waves = st.floats(400.0, 750.0)
turns = st.floats(-7.0, 7.0)
seeds = st.integers(0, 10**6)
offsets = st.floats(-90.0, 90.0)


def _scene(seed, azimuth):
    """A polygon ``[k, 3]`` and a sphere about the same direction, and a view for which both lie near the line."""
    rng = np.random.default_rng(seed)
    corners = polygons(1, rng.choice([0.01, 0.1, 0.6]), int(rng.integers(3, 8)), seed=seed, star=rng.uniform(0.4, 1))[0]
    axis = unit(corners.mean(axis=0))
    c, s = np.cos(azimuth), np.sin(azimuth)
    u = rng.normal(0.0, 2e-3) - (axis[0] * c + axis[1] * s)
    v = rng.uniform(-0.7, 0.7) * np.sqrt(max(1.0 - u * u, 0.0))
    wo = unit(np.array([u * c - v * s, u * s + v * c, np.sqrt(max(1.0 - u * u - v * v, 1e-3))]))
    return corners, SphereLight(axis, rng.choice([0.003, 0.05, 0.7])), wo


def _both(corners, ball, wo, s, wavelength, **options):
    return np.array([radiance(light, wo, s, wavelength, **options) for light in (PolygonLight(corners), ball)])


@FEW
@given(seeds, widths, depths, turns, waves, st.floats(1e-6, 1e6))
def test_light_and_distance_scale_together(seed, width, depth, azimuth, wave, scale):
    corners, ball, wo = _scene(seed, azimuth)
    s = Scratch(width, depth, azimuth)
    far = SphereLight(ball.center * scale, ball.radius * scale)
    np.testing.assert_allclose(_both(corners * scale, far, wo, s, wave), _both(corners, ball, wo, s, wave), **SAME)


@FEW
@given(seeds, widths, depths, turns, waves, st.floats(0.2, 5.0))
def test_wavelength_width_depth_and_coherence_radius_scale_together(seed, width, depth, azimuth, wave, scale):
    scene = _scene(seed, azimuth)
    scaled = Scratch(width * scale, depth * scale, azimuth, 12.0 * scale, 60.0 * scale)
    np.testing.assert_allclose(
        _both(*scene, scaled, wave * scale), _both(*scene, Scratch(width, depth, azimuth, 12.0), wave), **SAME
    )


@FEW
@given(seeds, widths, depths, turns, waves, turns)
def test_everything_turned_about_the_normal(seed, width, depth, azimuth, wave, turn):
    corners, ball, wo = _scene(seed, azimuth)
    c, s = np.cos(turn), np.sin(turn)
    by = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    turned = _both(
        corners @ by, SphereLight(ball.center @ by, ball.radius), wo @ by, Scratch(width, depth, azimuth + turn), wave
    )
    np.testing.assert_allclose(
        turned, _both(corners, ball, wo, Scratch(width, depth, azimuth), wave), rtol=1e-5, atol=1e-12
    )


@FEW
@given(seeds, widths, depths, turns, waves)
def test_a_scratch_has_no_direction(seed, width, depth, azimuth, wave):
    scene = _scene(seed, azimuth)
    back = Scratch(width, depth, azimuth + np.pi)
    np.testing.assert_allclose(
        _both(*scene, back, wave), _both(*scene, Scratch(width, depth, azimuth), wave), rtol=1e-5, atol=1e-12
    )


@FEW
@given(seeds, widths, depths, turns, waves)
def test_a_polygon_is_the_sum_of_its_triangles(seed, width, depth, azimuth, wave):
    corners, _, wo = _scene(seed, azimuth)
    s, inside = Scratch(width, depth, azimuth), corners.mean(axis=0)
    # drawn in by at least 0.4 every second corner, all is seen from the middle
    fan = np.stack([np.stack([inside, a, b]) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)])
    whole = radiance(PolygonLight(corners), wo, s, wave, slices=32)
    np.testing.assert_allclose(radiance(PolygonLight(fan), wo, s, wave, slices=32).sum(), whole, rtol=1e-5, atol=1e-11)


@FEW
@given(seeds, widths, depths, turns, waves)
def test_winding_does_not_matter(seed, width, depth, azimuth, wave):
    corners, _, wo = _scene(seed, azimuth)
    s = Scratch(width, depth, azimuth)
    values = [radiance(PolygonLight(v), wo, s, wave) for v in (corners, corners[::-1], np.roll(corners, 1, axis=0))]
    np.testing.assert_allclose(values, values[0], **SAME)


@FEW
@given(seeds, widths, depths, turns, waves, st.floats(20.0, 300.0))
def test_the_mean_over_a_footprint_knows_no_coherence_radius(seed, width, depth, azimuth, wave, sigma):
    # L = (W l / A_P) |D|^2 dM / pi: the integral over offsets of the closed form is the same for every sigma
    scene = _scene(seed, azimuth)
    offset = np.linspace(-7.0, 7.0, 281)
    one, other = (
        np.trapezoid(
            _both(*scene, Scratch(width, depth, azimuth, offset * r, r), wave, method="closed-form"), offset * r
        )
        for r in (60.0, sigma)
    )
    np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-14)


@FEW
@given(seeds, widths, depths, turns, waves)
def test_light_from_everywhere_gives_the_whole_lobe(seed, width, depth, azimuth, wave):
    wo = unit(np.random.default_rng(seed).normal(size=3) * [1, 1, 0] + [0, 0, 0.8])
    c, s = np.cos(azimuth), np.sin(azimuth)
    along, across = wo[0] * c + wo[1] * s, wo[1] * c - wo[0] * s
    half, k = np.sqrt(1.0 - along**2), 2e3 * np.pi * width / wave
    lobe = (big_m(k * (across + half)) - big_m(k * (across - half))) / np.pi
    expected = width / (np.sqrt(np.pi) * 60.0) * depth_power(depth, wave) * lobe
    for light in (SphereLight([0.0, 0.0, 0.0], 1.0), SphereLight([0.0, 0.0, 0.3], 1.0)):
        value = radiance(light, wo, Scratch(width, depth, azimuth), wave, method="closed-form")
        np.testing.assert_allclose(value, expected, rtol=1e-8, atol=1e-15)


@FEW
@given(seeds, widths, turns, waves, st.integers(0, 20))
def test_depths_of_whole_half_waves_are_invisible(seed, width, azimuth, wave, n):
    scene = _scene(seed, azimuth)
    values = _both(*scene, Scratch(width, n * wave / 2e3, azimuth), wave)
    assert values.max() <= 1e-20  # 4 sin^2 of the rounding of n whole turns


@FEW
@given(seeds, widths, depths, turns, waves, st.floats(-3.0, 3.0))
def test_distance_across_is_a_gaussian(seed, width, depth, azimuth, wave, x):
    scene = _scene(seed, azimuth)
    aside = _both(*scene, Scratch(width, depth, azimuth, 60.0 * x), wave)
    np.testing.assert_allclose(aside, np.exp(-x * x) * _both(*scene, Scratch(width, depth, azimuth), wave), **SAME)


@FEW
@given(seeds, widths, depths, turns, waves, offsets, st.sampled_from(["small-angle", "angle-dependent"]))
def test_reciprocity(seed, width, depth, azimuth, wave, offset, phase):
    _, ball, wo = _scene(seed, azimuth)
    s = Scratch(width, depth, azimuth, offset, ends=(-50.0, 80.0))
    there, back = diffraction.brdf(ball.center, wo, s, wave, phase), diffraction.brdf(wo, ball.center, s, wave, phase)
    np.testing.assert_allclose(there, back, rtol=1e-9, atol=1e-300)
    pair = [s, Scratch(1.0, 0.4, azimuth + 0.01, offset + 9.0)]
    there, back = (diffraction.brdf_coherent(*w, pair, wave, phase) for w in ((ball.center, wo), (wo, ball.center)))
    np.testing.assert_allclose(there, back, rtol=1e-9, atol=1e-18)


@FEW
@given(seeds, widths, depths, turns, waves, st.integers(1, 6), st.sampled_from(["small-angle", "angle-dependent"]))
def test_radiance_is_never_negative(seed, width, depth, azimuth, wave, slices, phase):
    scene = _scene(seed, azimuth)
    values = _both(*scene, Scratch(width, depth, azimuth), wave, slices=slices, phase=phase)
    assert np.all(values >= 0.0) and np.all(np.isfinite(values))


@FEW
@given(seeds, widths, depths, turns, waves, st.floats(1.0, 3.0))
def test_more_light_is_never_less(seed, width, depth, azimuth, wave, grow):
    corners, ball, wo = _scene(seed, azimuth)
    s, middle = Scratch(width, depth, azimuth), corners.mean(axis=0)
    larger = middle + grow * (corners - middle)
    bigger = SphereLight(ball.center, min(grow * ball.radius, 0.99))
    less, more = (_both(*scene, s, wave, slices=24) for scene in ((corners, ball, wo), (larger, bigger, wo)))
    assert np.all(more >= less * (1.0 - 1e-4) - 1e-13)
    # the closed form, too: M grows
    less, more = (_both(*scene, s, wave, method="closed-form") for scene in ((corners, ball, wo), (larger, bigger, wo)))
    assert np.all(more >= less * (1.0 - 1e-9) - 1e-15)


@FEW
@given(widths, st.floats(0.01, 6.0), turns, waves, st.integers(1, 15))
def test_zeros_where_the_width_is_whole_waves(width, depth, azimuth, wave, n):
    xi2 = n * wave / (1e3 * width)
    if xi2 >= 1.999:
        return
    v = xi2 / 2.0
    c, s = np.cos(azimuth), np.sin(azimuth)
    w = np.array([-v * s, v * c, np.sqrt(1.0 - v * v)])
    peak = 2.0 * (width / wave * 1e3) ** 2 * 4.0
    assert diffraction.brdf(w, w, Scratch(width, depth, azimuth), wave) <= 1e-22 * peak
