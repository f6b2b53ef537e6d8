"""Where each hard case is tested: case -> tests, as ``path::function`` below ``tests``. ``test_index`` sees to it that
they exist and that ``docs/stability.md`` has the same table, which ``python -m tests.stability.index`` prints."""

_DIFFRACTION = "reflectance/diffraction"
_GROOVES = "reflectance/grooves"
_HARD = "render/test_hard_cases.py"
_HERE = "stability"

GEOMETRIC = {
    "vertical walls": (f"{_GROOVES}/test_visibility.py::test_box_is_seen_and_lit_where_both_reach",),
    "phi at a right angle, 1 / cos in grazing bins": ("profiles/test_simulate.py::test_grazing_bins_conserve_energy",),
    "a ray through a vertex": ("profiles/test_tracer.py::test_rays_through_vertices_are_kept",),
    "concave cusps, a whispering gallery": (
        "profiles/test_tracer.py::test_whispering_gallery_is_followed",
        "profiles/test_simulate.py::test_deep_box_reports_what_it_loses",
    ),
    "no epsilon against self-intersection": ("profiles/test_tracer.py::test_size_does_not_matter",),
    "float32 against float64 paths": (
        "profiles/test_tracer.py::test_paths_agree_with_float64_brute_force",
        "profiles/test_tracer.py::test_random_outlines_agree_with_brute_force",
    ),
    "zero depth, zero width": (
        "profiles/test_simulate.py::test_flat_profile_is_the_anti_diagonal",
        "profiles/test_profile.py::test_impossible_outlines_are_refused",
    ),
    "theta at a right angle": ("profiles/test_theta.py::test_slices_at_the_ends_are_exact",),
    "gamma of nothing and of dips": ("profiles/test_theta.py::test_exponent_is_safe_and_flagged_where_there_is_none",),
    "duplicated points": (
        "profiles/test_tracer.py::test_duplicated_points_change_nothing",
        f"{_GROOVES}/test_visibility.py::test_doubled_vertices_and_flat_ground",
    ),
    "bulges and overhangs": (
        "profiles/test_simulate.py::test_undercut_bulging_profile_against_brute_force",
        f"{_GROOVES}/test_visibility.py::test_rays_see_the_same",
    ),
    "deltas on bin edges": ("profiles/test_simulate.py::test_deltas_on_bin_edges_are_shared",),
    "coplanar pieces and T-junctions": (
        f"{_GROOVES}/test_footprints.py::test_hard_cases_lose_nothing_and_are_continuous",
    ),
    "deformation at its centre and rim": (
        "reflectance/mdf/test_density.py::test_hard_cases_are_finite",
        f"{_HERE}/test_terms.py::test_stable",
    ),
    "the square-root deformation off its disk": (
        "reflectance/mdf/test_density.py::test_square_root_loses_energy_and_leaves_the_disk",
    ),
    "stencils at their poles, b and alpha that explode at grazing angles": (
        "reflectance/stencils/test_evaluate.py::test_hard_cases_are_finite",
        "reflectance/stencils/test_evaluate.py::test_furnace",
    ),
}
WAVES = {
    "1 sinc at 0, M at 0": (
        f"{_DIFFRACTION}/test_float32.py::test_sinc_at_zero_below_every_normal_number_and_at_whole_cycles",
        f"{_DIFFRACTION}/test_terms.py::test_hard_arguments",
    ),
    "2 depths of nearly whole turns; (1 - cos x) / x": (
        f"{_DIFFRACTION}/test_float32.py::test_depths_of_nearly_whole_turns_and_of_many",
        f"{_DIFFRACTION}/test_reflection.py::test_hard_values",
    ),
    "3 phases of 100 rad": (f"{_DIFFRACTION}/test_reflection.py::test_hard_values",),
    "4 far along the Gaussian": (f"{_DIFFRACTION}/test_reflection.py::test_hard_values",),
    "5 ends of a scratch": (
        f"{_DIFFRACTION}/test_reflection.py::test_tail_of_an_end",
        f"{_DIFFRACTION}/test_terms.py::test_ends_where_the_naive_product_is_zero_times_infinity",
    ),
    "6 short intervals": (f"{_DIFFRACTION}/test_float32.py::test_integrals_from_zero_and_of_short_intervals",),
    "7 zeros far out; Eq. 29 of large arguments, tanh of 100": (
        f"{_DIFFRACTION}/test_metamorphic.py::test_zeros_where_the_width_is_whole_waves",
        f"{_DIFFRACTION}/test_float32.py::test_the_printed_integral_stays_finite",
    ),
    "8 tangent lights, bounds that the printed equations miss, B = 0": (
        f"{_HERE}/test_waves.py::test_lights_straight_across",
        f"{_DIFFRACTION}/test_light_geometry.py::test_bounds_that_the_printed_equations_miss",
        f"{_DIFFRACTION}/test_float32.py::test_small_and_tangent_caps",
    ),
    "9 small lights": (f"{_DIFFRACTION}/test_float32.py::test_small_lights_everywhere",),
    "10 offsets of micrometres in world coordinates": (
        "render/test_invariance.py::test_moved_and_scaled",
        f"{_HERE}/test_scenes.py::test_scaled_scenes_look_the_same",
    ),
    "11 beyond the horizon": (
        f"{_DIFFRACTION}/test_reflection.py::test_horizon",
        f"{_DIFFRACTION}/test_float32.py::test_lights_along_the_scratch_and_slices_beyond_the_sphere",
    ),
    "12, 13, 14 footprints": (
        f"{_DIFFRACTION}/test_ellipse.py::test_hard_values",
        f"{_DIFFRACTION}/test_ellipse.py::test_points_and_lines_for_footprints",
    ),
    "15 the printed integral": (f"{_DIFFRACTION}/test_terms.py::test_equation_29_is_as_bad_as_known",),
    "16 lights around, below, along, on the line, degenerate": (
        f"{_DIFFRACTION}/test_light_geometry.py::test_what_cannot_be_seen_gives_nothing",
        f"{_DIFFRACTION}/test_light_geometry.py::test_lights_around_the_point_and_touching_it",
        f"{_DIFFRACTION}/test_light_geometry.py::test_corners_and_edges_exactly_on_the_line",
        f"{_DIFFRACTION}/test_light_geometry.py::test_slivers_and_disks",
    ),
}
_META = f"{_DIFFRACTION}/test_metamorphic.py"
METAMORPHIC = {
    "light and distance scaled": (f"{_META}::test_light_and_distance_scale_together",),
    "wavelength, width, depth and coherence radius scaled": (
        f"{_META}::test_wavelength_width_depth_and_coherence_radius_scale_together",
    ),
    "turned; half a turn of the scratch": (
        f"{_META}::test_everything_turned_about_the_normal",
        f"{_META}::test_a_scratch_has_no_direction",
    ),
    "polygons cut, wound the other way": (
        f"{_META}::test_a_polygon_is_the_sum_of_its_triangles",
        f"{_META}::test_winding_does_not_matter",
    ),
    "means that know no coherence radius": (f"{_META}::test_the_mean_over_a_footprint_knows_no_coherence_radius",),
    "light from everywhere": (f"{_META}::test_light_from_everywhere_gives_the_whole_lobe",),
    "depths of half waves, widths of whole ones": (
        f"{_META}::test_depths_of_whole_half_waves_are_invisible",
        f"{_META}::test_zeros_where_the_width_is_whole_waves",
    ),
    "a Gaussian across": (f"{_META}::test_distance_across_is_a_gaussian",),
    "reciprocity": (f"{_META}::test_reciprocity", f"{_GROOVES}/test_bounces.py::test_bounces_are_reciprocal"),
    "never negative, never less of more light": (
        f"{_META}::test_radiance_is_never_negative",
        f"{_META}::test_more_light_is_never_less",
    ),
}
SCENES = {
    "position of the scene": (
        "render/test_invariance.py::test_moved_and_scaled",
        f"{_HERE}/test_energy.py::test_far_from_the_origin",
    ),
    "scale of the scene, 1e-6 to 1e6": (
        f"{_HARD}::test_scenes_of_any_size",
        f"{_HERE}/test_scenes.py::test_scaled_scenes_look_the_same",
        f"{_HERE}/test_energy.py::test_bodies",
        f"{_DIFFRACTION}/test_light_geometry.py::test_sizes_from_atoms_to_stars",
    ),
    "needle triangles": (
        f"{_HERE}/test_scenes.py::test_needles_look_like_the_triangles_they_cut",
        f"{_HERE}/test_energy.py::test_bodies",
    ),
    "degenerate triangles": (
        f"{_HARD}::test_faces_without_area",
        f"{_HERE}/test_energy.py::test_bodies",
        "kernels/test_geometry.py::test_a_triangle_without_area_makes_no_nan",
    ),
    "coincident surfaces": (
        f"{_HERE}/test_scenes.py::test_coincident_surfaces_look_like_one",
        f"{_HERE}/test_energy.py::test_bodies",
    ),
    "mirrored and sheared transforms": (
        f"{_HERE}/test_scenes.py::test_placed_is_as_if_modelled_so",
        f"{_HERE}/test_energy.py::test_bodies",
    ),
    "singular transforms": (
        f"{_HARD}::test_squashed_instances",
        f"{_HERE}/test_energy.py::test_bodies",
        f"{_HERE}/test_bad_stages.py::test_transforms_over_time",
    ),
    "zero and huge widths, depths, densities": (
        f"{_HARD}::test_extreme_layers",
        f"{_HERE}/test_energy.py::test_layers",
        f"{_HERE}/test_energy.py::test_waves",
        f"{_HERE}/test_waves.py::test_any_size_and_wavelength",
    ),
    "zero and huge wavelengths": (
        f"{_HERE}/test_waves.py::test_any_size_and_wavelength",
        f"{_HERE}/test_waves.py::test_no_wavelength_is_said",
        f"{_HERE}/test_energy.py::test_waves",
    ),
    "lights at the horizon, of zero and of huge size, inside and around": (
        f"{_HARD}::test_lights_that_touch",
        f"{_HERE}/test_scenes.py::test_no_more_light_than_a_sky_of_it",
        "lights/test_light_hard_cases.py::test_everything_is_finite",
    ),
    "grazing views": (f"{_HARD}::test_grazing_views", f"{_HERE}/test_energy.py::test_bodies"),
    "back-facing views": (
        f"{_HARD}::test_camera_inside",
        f"{_HERE}/test_scenes.py::test_normals_that_face_elsewhere",
        f"{_HERE}/test_energy.py::test_bodies",
    ),
    "seams and poles of uv": (
        f"{_HERE}/test_scenes.py::test_poles_and_seams_of_a_mapping_neither_shine_nor_are_dark",
        f"{_HARD}::test_degenerate_mappings",
        f"{_HERE}/test_energy.py::test_bodies",
    ),
    "NaN and infinity in arrays": (
        f"{_HERE}/test_bad_numbers.py::test_records_refuse_what_is_no_number",
        f"{_HERE}/test_bad_numbers.py::test_functions_refuse_what_is_no_number",
        f"{_HERE}/test_bad_stages.py::test_any_number_may_be_none",
    ),
    "time samples with singular matrices": (
        f"{_HERE}/test_bad_stages.py::test_transforms_over_time",
        f"{_HERE}/test_energy.py::test_matrices_over_time",
    ),
    "no energy above 1": (
        "render/test_furnace.py::test_mirrors_vanish",
        "render/test_furnace.py::test_rough_surfaces_never_gain_energy",
        f"{_DIFFRACTION}/test_lighting.py::test_furnace",
        f"{_GROOVES}/test_bounces.py::test_white_furnaces",
    ),
    "grooves of any size, shape, place and view": (
        f"{_HERE}/test_late_effects.py::test_grooves_of_any_size_look_the_same",
        f"{_HERE}/test_late_effects.py::test_grooves_placed_are_as_if_modelled_so",
        f"{_HERE}/test_late_effects.py::test_grooves_of_any_shape_under_a_sky",
        f"{_HERE}/test_late_effects.py::test_lights_at_and_below_the_horizon_of_grooves",
        f"{_HERE}/test_late_effects.py::test_grazing_and_back_facing_views_of_grooves",
        "render/test_groove_hard_cases.py::test_finite_and_continuous",
        "render/test_groove_glass.py::test_nothing_is_lost_or_gained",
        "render/test_groove_handover.py::test_a_zoom_shows_no_switch",
    ),
    "grooved glass: an index of 1, grazing angles, slabs, either way through it, any size": (
        f"{_HERE}/test_glass.py::test_an_index_of_one_is_not_there",
        f"{_HERE}/test_glass.py::test_nor_is_it_at_grazing_angles",
        f"{_HERE}/test_glass.py::test_a_slab_reflects_and_passes_what_the_sum_of_its_echoes_says",
        f"{_HERE}/test_glass.py::test_a_facet_lets_through_as_much_either_way",
        f"{_HERE}/test_glass.py::test_a_grooved_surface_lets_through_as_much_either_way",
        f"{_HERE}/test_glass.py::test_scenes_of_any_size_look_the_same",
        "render/test_groove_glass.py::test_nothing_is_lost_or_gained",
    ),
    "grooves that are tables far away: any size, place and distance": (
        f"{_HERE}/test_handover.py::test_scaled_with_the_camera",
        f"{_HERE}/test_handover.py::test_moved_with_the_camera",
        f"{_HERE}/test_handover.py::test_the_plan_sees_the_same_size",
        f"{_HERE}/test_handover.py::test_farther_off_they_are_laid_out_no_more_often",
    ),
    "scratches that interfere in one place, of any size": (
        f"{_HERE}/test_late_effects.py::test_scratches_in_the_same_place_interfere",
        f"{_HERE}/test_late_effects.py::test_pairs_of_any_size_and_light",
        "render/test_diffraction_pairs.py::test_never_negative",
    ),
    "more scratches than there is room or time for": (
        f"{_HERE}/test_counts.py::test_grooves_of_all_surfaces_count_together",
        "scratches/test_segments.py::test_too_many_pieces_are_said",
        "reflectance/grooves/test_repeats.py::test_more_than_there_is_room_for",
        "render/test_diffraction_crowds.py::test_those_drawn_are_on_average_all",
    ),
    "scratches thousands of wavelengths wide": ("kernels/test_glint_across.py::test_the_mean_of_fringes",),
    "files that claim more than they hold": (
        "scene/test_archive.py::test_more_than_is_there",
        "scene/test_archive.py::test_more_than_there_is_memory_for",
    ),
    "stages damaged at random": (
        f"{_HERE}/test_fuzz.py::test_damaged_stages",
        f"{_HERE}/test_fuzz.py::test_a_stage_that_never_ends_is_a_failure",
    ),
}
HARD_CASES = {**GEOMETRIC, **WAVES, **METAMORPHIC, **SCENES}
"""Every hard case -> its tests."""


def rows() -> list[str]:
    """The table of the documentation, a row a case."""
    return [f"| {case} | {', '.join(f'`{test}`' for test in tests)} |" for case, tests in HARD_CASES.items()]


if __name__ == "__main__":
    print("\n".join(rows()))
