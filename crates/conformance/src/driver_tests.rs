//! The macro that generates tests from checks.
//!
//! A test is a subject on a driver, not a single check: opening a driver costs as much as several checks.

#[cfg(test)]
use crate::checks::CHECKS;

/// Generates a test of every subject for each driver `NAME`, which a function `drivers::NAME` returns as a
/// [`Driver`](crate::Driver), and a test of each function in brackets, which takes the open backend.
#[macro_export]
macro_rules! driver_tests {
    ($($driver:ident)+; $more:tt) => {
        $(mod $driver {
            $crate::more_tests!($driver $more);
            $crate::subject_tests!($driver: limits prepared drawing uploads sampling depth stencil raster fetch formats integers samples counters early_tests chains passes layers lists shaders targets);
        })+
    };
}

/// The tests of one driver.
#[doc(hidden)]
#[macro_export]
macro_rules! subject_tests {
    ($driver:ident: $($subject:ident)+) => {
        $(#[test]
        fn $subject() {
            let test = concat!(module_path!(), "::", stringify!($subject));
            $crate::run(test, stringify!($subject), &super::drivers::$driver());
        })+
    };
}

/// The further tests of one driver.
#[doc(hidden)]
#[macro_export]
macro_rules! more_tests {
    ($driver:ident [$($module:ident::$more:ident)*]) => {
        $(#[test]
        fn $more() {
            let test = concat!(module_path!(), "::", stringify!($more));
            $crate::in_driver(test, &super::drivers::$driver(), super::$module::$more);
        })*
    };
}

#[test]
fn every_subject_has_its_tests() {
    let text = include_str!("driver_tests.rs");
    let list = text.split("subject_tests!($driver: ").nth(1).unwrap();
    let named: Vec<_> = list.split(')').next().unwrap().split_whitespace().collect();
    let mut expected: Vec<_> = CHECKS.iter().map(|c| c.subject).collect();
    expected.dedup();
    assert_eq!(named, expected);
}
