//! Scenes drawn by real drivers. The environment that chooses a driver must stand before the
//! process starts, so each test runs its body in a child process. A missing driver is a failure.

mod harness;
mod scenes;

/// The same tests for each driver.
macro_rules! tests {
    ($($driver:ident: $choice:expr;)+) => {
        $(mod $driver {
            tests!(@ $driver, $choice,
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
                targets_beyond_the_first_are_left_alone
                written_depth_without_a_depth_attachment
                floats_are_exact_or_refused
                written_depth_is_exact_in_floats
                sizes_that_are_no_multiples
                several_scenes_live_at_once
                what_is_denied_is_not_supported
                every_built_in_case_runs
            );
            #[test]
            fn validation_is_clean() {
                let name = concat!(stringify!($driver), "::validation_is_clean");
                crate::harness::in_child(name, $choice, true, crate::scenes::validation_is_clean);
            }
        })+
    };
    (@ $driver:ident, $choice:expr, $($test:ident)+) => {
        $(#[test]
        fn $test() {
            let name = concat!(stringify!($driver), "::", stringify!($test));
            crate::harness::in_child(name, $choice, false, crate::scenes::$test);
        })+
    };
}

tests! {
    lavapipe: crate::harness::Driver::Lavapipe;
    llvmpipe: crate::harness::Driver::Gallium("llvmpipe");
    softpipe: crate::harness::Driver::Gallium("softpipe");
}
