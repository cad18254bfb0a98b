//! The backend over real browsers, each in a separate process: the environment chooses the driver below them.

mod drivers;
mod pages;

etalon_conformance::driver_tests! {
    chromium compatibility firefox; [drivers::offers]
}

/// WebGPU without a browser, which no package of Debian has.
mod without_browser {
    use super::drivers::{dawn, deno};
    use etalon_conformance::{in_driver, run_all};

    #[test]
    #[ignore = "needs Node's package webgpu, which ci/test --all installs"]
    fn dawn_passes_the_checks() {
        let test = concat!(module_path!(), "::dawn_passes_the_checks");
        in_driver(test, &dawn(), |backend| run_all(backend, &dawn()));
    }

    #[test]
    #[ignore = "needs Deno, which ci/test --all installs"]
    fn deno_passes_the_checks() {
        let test = concat!(module_path!(), "::deno_passes_the_checks");
        in_driver(test, &deno(), |backend| run_all(backend, &deno()));
    }
}
