//! Scenes drawn by real drivers. The environment that chooses a driver must stand before the
//! process starts, so each test runs its body in a child process. A missing driver is a failure.

mod capabilities;
mod chains;
mod counting;
mod harness;
mod layers;
mod samples;
mod sampling;
mod scenes;
mod shaders;
mod whole;

/// The same tests for each driver.
macro_rules! tests {
    ($($driver:ident: $choice:expr;)+) => {
        $(mod $driver {
            tests!(@ scenes $driver, $choice,
                a_rectangle_lands_where_it_belongs
                columns_of_flat_colors
                depth_formats_store_what_is_written
                depth_test_passes_and_fails
                depth_starts_from_its_clear
                stencil_differs_between_faces
                stencil_without_depth
                faces_and_culling
                uploads_keep_their_orientation
                blending_from_the_textbook
                blend_constant_and_its_alpha
                write_masks
                passes_keep_contents
                written_depth_without_a_depth_attachment
                floats_are_exact_or_refused
                written_depth_is_exact_in_floats
                sizes_that_are_no_multiples
                several_scenes_live_at_once
                what_is_denied_is_not_supported
            );
            tests!(@ whole $driver, $choice,
                every_built_in_case_runs
            );
            tests!(@ capabilities $driver, $choice,
                what_is_offered
                two_sources
                targets_blend_apart
                formats_keep_their_codes
                a_viewport_in_a_corner
                a_viewport_that_reaches_outside
                a_scissor_of_one_texel
                depth_bias_and_its_clamp
                depth_is_clamped
                strips_begin_again
                lists_leave_out_what_is_not_whole
                points_and_lines
                edges_of_a_triangle
                depth_that_is_only_read
            );
            tests!(@ samples $driver, $choice,
                samples_are_truthful
                a_mask_lets_samples_through
                every_format_has_its_samples
                the_shader_knows_its_sample
                samples_are_averaged
                alpha_takes_samples_away
                a_point_inside_the_primitive
                each_sample_writes_its_depth
            );
            tests!(@ counting $driver, $choice,
                any_sample_that_passes
                samples_are_not_counted
                runs_are_counted
                shader_invocations
                three_counters_of_one_draw
                tests_before_the_shader
                promised_depths
            );
            tests!(@ sampling $driver, $choice,
                the_nearest_texel
                an_average_of_texels
                fragments_are_discarded
                integers_are_stored
            );
            tests!(@ chains $driver, $choice,
                two_attachments_take_turns
                a_clear_is_read_before_the_first_draw
                what_was_resolved_is_read
                a_larger_attachment_is_averaged
                sampled_fragments_are_discarded
                invocations_of_all_passes_add_up
            );
            tests!(@ layers $driver, $choice,
                layers_are_peeled_one_by_one
                layers_are_peeled_from_both_ends
                weighted_layers_are_summed_and_shown
                samples_are_discarded_by_thresholds
            );
            tests!(@ shaders $driver, $choice,
                every_shader_draws
            );
            #[test]
            fn validation_is_clean() {
                let name = concat!(stringify!($driver), "::validation_is_clean");
                crate::harness::in_child(name, $choice, true, crate::whole::validation_is_clean);
            }
        })+
    };
    (@ $module:ident $driver:ident, $choice:expr, $($test:ident)+) => {
        $(#[test]
        fn $test() {
            let name = concat!(stringify!($driver), "::", stringify!($test));
            crate::harness::in_child(name, $choice, false, crate::$module::$test);
        })+
    };
}

tests! {
    lavapipe: crate::harness::Driver::Lavapipe;
    llvmpipe: crate::harness::Driver::Gallium("llvmpipe");
    softpipe: crate::harness::Driver::Gallium("softpipe");
}
