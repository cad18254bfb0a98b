//! The backend on Mesa's software drivers, each context in a separate process: the environment chooses the
//! driver before libEGL is loaded.

mod capabilities;
mod drivers;
mod library;

etalon_conformance::driver_tests! {
    llvmpipe llvmpipe_es softpipe softpipe_es virgl virgl_es zink zink_es;
    [capabilities::offers library::sample]
}
