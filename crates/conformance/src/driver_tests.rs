//! The macro that generates tests from checks.

/// Generates tests for each named driver.
///
/// A function `drivers::NAME` returns the driver as a [`TestedDriver`](crate::TestedDriver). Each driver gets a test
/// `checks`, which opens it once and runs all checks, and a test for each function in brackets, which gets the open
/// backend:
///
/// ```ignore
/// driver_tests! { lavapipe llvmpipe; [library::sample] }
/// ```
#[macro_export]
macro_rules! driver_tests {
    ($($driver:ident)+; $more:tt) => {
        $(mod $driver {
            $crate::more_tests!($driver $more);

            #[test]
            fn checks() {
                let test = concat!(module_path!(), "::checks");
                let driver = super::drivers::$driver();
                $crate::in_driver(test, &driver, |backend| $crate::run_all(backend, &driver));
            }
        })+
    };
}

/// Generates the tests in brackets for one driver.
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
