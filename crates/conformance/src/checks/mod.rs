//! The registry of checks, by subject.
//!
//! A test runs all checks on a driver. Each check still passes, fails or is skipped under its own name.

mod chains;
mod clears;
mod counters;
mod depth;
mod drawing;
mod early_tests;
mod fetch;
mod formats;
mod integers;
mod layers;
mod limits;
mod lists;
mod load_store;
mod prepared;
mod raster;
mod resolves;
mod samples;
mod sampling;
mod shaders;
mod stencil;
mod targets;
mod uploads;

use crate::subject::{CheckResult, CheckedBackend, Missing};

/// The result of a check, which ends early if the limits deny a scene.
type CheckEnd = Result<(), Missing>;

/// A check of a driver.
pub struct DriverCheck {
    /// The check's subject and name: `chains::two_attachments_take_turns`.
    pub name: &'static str,
    body: fn(&CheckedBackend<'_>) -> CheckEnd,
}

impl DriverCheck {
    /// Draws the scenes that the limits allow, and compares them with the expected values.
    ///
    /// # Panics
    /// If the backend fails the check.
    pub fn run(&self, subject: &CheckedBackend<'_>) -> CheckResult {
        // The subject has recorded the scene that was denied.
        let _ = (self.body)(subject);
        subject.outcome()
    }
}

macro_rules! registry {
    ($($module:ident { $($check:ident)+ })+) => {
        /// Every check, in the order of a full run. Draws with two sources come last: wgpu's OpenGL does
        /// not reset their factors, and Mesa then drops draws to several targets.
        pub const CHECKS: &[DriverCheck] = &[$($(DriverCheck {
            name: concat!(stringify!($module), "::", stringify!($check)),
            body: $module::$check,
        }),+),+];
    };
}

registry! {
    limits {
        limits_are_at_least_the_required_ones formats_are_described_without_contradiction
    }
    prepared {
        a_second_submit_gives_the_same_frame prepared_scenes_do_not_disturb_each_other
        scenes_are_submitted_in_turns reading_before_drawing_is_an_error
        nothing_leaks_into_the_next_scene denials_are_named
    }
    drawing {
        a_rectangle_stays_in_its_corner columns_run_to_the_right_and_rows_down
        a_pass_without_draws_leaves_the_clear_values sizes_need_not_be_even
        faces_are_told_apart_and_culled strips_keep_their_winding
        blending_weighs_source_and_destination write_masks_keep_the_other_channels
        a_pass_tests_what_an_earlier_one_wrote passes_keep_contents
        draws_of_a_pass_have_their_own_vertices
    }
    uploads {
        texels_keep_their_places floats_are_clamped_where_they_are_drawn floats_come_back_bit_by_bit
        floats_are_cleared_and_drawn_exactly fragments_are_discarded_below_a_threshold
    }
    sampling {
        the_nearest_texel_is_taken_from_where_the_address_leads neighbours_are_averaged
        neighbours_across_the_edge_are_averaged neighbours_in_the_mirror_are_averaged
        averages_of_floats_are_floats fetches_need_no_sampler each_draw_has_its_own_sampler
    }
    depth {
        depths_start_from_their_clear depths_are_compared_with_the_stored_one
         floats_keep_any_depth
        a_draw_without_a_depth_test_neither_tests_nor_writes depth_and_stencil_may_be_read_only
        passes_that_write_take_turns_with_passes_that_do_not a_viewport_moves_depths_into_its_range
        a_range_of_depths_may_be_reversed depths_outside_are_clipped depths_outside_are_clamped
        depths_are_clamped_to_a_reversed_range a_constant_bias_counts_least_steps
        a_bias_is_held_to_its_clamp a_slope_bias_counts_the_slope bounds_reject_by_the_stored_depth
    }
    stencil {
        faces_have_masks_and_references_of_their_own faces_have_operations_of_their_own
        a_failed_depth_test_has_its_own_operation operations_follow_the_depth_test
        every_bit_is_masked_by_itself
    }
    raster {
        a_viewport_counts_from_the_top_left a_viewport_moves_depths_in_its_corner
        a_viewport_of_negative_height_turns_the_picture_over a_viewport_may_reach_outside
        a_scissor_leaves_the_texels_inside a_scissor_may_reach_outside
        discarded_primitives_draw_nothing points_cover_the_texel_they_lie_in
        lines_through_centres_cover_their_texels points_and_lines_share_a_pass lists_are_indexed
        strips_begin_again fans_turn_about_their_first_vertex polygons_may_be_drawn_as_their_edges
    }
    fetch {
        a_base_vertex_is_added_to_every_index draws_start_at_their_first_index
        draws_start_at_their_first_vertex the_last_16_bit_index_names_a_vertex
        strips_of_16_bit_indices_restart instances_have_a_color_each instances_start_at_their_first_instance
        instances_have_offsets_too
    }
    formats {
        clears_store_0_and_1 uploads_come_back values_are_uploaded_as_codes uploads_are_fetched
        draws_store_0_and_1 blendable_formats_blend srgb_codes_are_the_stored_bytes
        srgb_is_fetched_and_drawn
    }
    integers {
        integers_are_cleared_and_uploaded integers_are_drawn_over_all
        integers_are_drawn_through_the_write_mask one_sample_of_integers_is_taken
    }
    samples {
        positions_are_those_of_the_limits masks_let_their_samples_through
        averages_ignore_the_scissor single_attachments_of_a_pass_are_averaged
        averages_are_drawn_over_and_taken_again alpha_takes_all_samples_or_none_away
        alpha_counts_as_one_where_asked shaders_run_for_each_sample
        shaders_write_the_depth_of_each_sample attributes_at_centres_are_as_in_their_texel
        attributes_stay_inside_slanted_edges samples_are_drawn_one_by_one
        every_format_keeps_its_samples every_format_is_averaged
    }
    counters {
        any_samples_that_pass_are_told any_samples_of_several_passes_are_told
        samples_that_pass_are_counted each_sample_counts_by_itself invocations_are_counted
        statistics_tell_that_shaders_ran discarded_primitives_run_no_shader runs_are_counted rejected_fragments_run
        a_query_counts_what_it_encloses
        counters_of_all_kinds_go_together counters_start_from_0_at_every_submit
        forced_tests_come_before_the_shader forced_tests_ignore_the_written_depth
    }
    early_tests {
        discarded_fragments_leave_early_depths_alone discards_that_count_leave_early_depths_alone
        discarded_fragments_leave_early_stencils_alone kept_promises_change_nothing
        kept_promises_of_shaders_that_count_change_nothing promises_need_no_depth_attachment
    }
    chains {
        two_attachments_take_turns a_clear_is_read_before_the_first_draw what_was_resolved_is_read
        a_larger_attachment_is_averaged sampled_fragments_are_discarded
        invocations_of_all_passes_add_up
    }
    load_store {
        load_operations_clear_everything each_attachment_has_its_own_load_operation
        depth_and_stencil_are_loaded_apart discarded_contents_are_cleared_again
        samples_are_discarded_after_their_average
    }
    clears {
        clears_reach_their_rectangle clears_ignore_the_draws_around clears_leave_the_other_aspect
        clears_know_their_target masked_clears_keep_the_rest
    }
    resolves {
        depth_and_stencil_are_resolved_by_their_modes depths_are_averaged what_was_resolved_is_tested
    }
    layers {
        layers_are_peeled_one_by_one layers_are_peeled_from_both_ends
        weighted_layers_are_summed_and_shown
        moments_give_the_light_that_reaches_each_layer samples_are_discarded_by_thresholds
    }
    lists {
        fragments_are_listed_and_composed a_full_pool_drops_the_rest
        the_nearest_layers_are_kept_over_a_tail
    }
    shaders {
        every_shader_draws
    }
    targets {
        images_of_all_targets_agree targets_blend_and_mask_on_their_own targets_keep_apart
        targets_of_different_formats_take_one_draw logic_operations_follow_their_truth_tables
        the_second_source_is_a_factor the_second_source_weighs_one_side later_draws_have_one_source
    }
}
