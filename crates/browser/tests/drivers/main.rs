//! The backend over real browsers, each in a separate process: the environment chooses the driver below them.

mod drivers;
mod pages;

etalon_conformance::driver_tests! {
    chromium compatibility firefox; [drivers::offers]
}
