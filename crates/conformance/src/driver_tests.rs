//! The macro that generates tests from checks.

/// Generates tests for each driver `NAME`, which a function `drivers::NAME` returns as a
/// [`TestedDriver`](crate::TestedDriver): one of all checks, since to open a driver costs as much as many of them, and one
/// of each function in brackets, which takes the open backend.
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
