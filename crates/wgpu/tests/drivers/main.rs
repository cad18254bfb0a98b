//! The backend over real drivers, each in a separate process: the environment chooses the driver before it is
//! loaded.

mod capabilities;
mod drivers;
mod library;

etalon_conformance::driver_tests! {
    lavapipe llvmpipe softpipe; [capabilities::offers library::sample]
}
