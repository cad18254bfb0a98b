//! A backend with a constant slow-down, to show that `etalon diff` finds it.

use etalon_backend::{AdapterInfo, Backend, BackendError, FrameTime, Prepared};
use etalon_frame::{Frame, Limits};
use etalon_scene::Scene;
use std::hint::spin_loop;
use std::time::{Duration, Instant};

/// The start of the name, before the percentage.
const PREFIX: &str = "cpu:slower=";

/// Returns the percentage by which the adapter of this name is slower: `cpu:slower=5%`.
pub(crate) fn percent(name: &str) -> Option<f64> {
    let number = name.strip_prefix(PREFIX)?.strip_suffix('%')?;
    let percent: f64 = number.parse().ok()?;
    (0.0..=1000.0).contains(&percent).then_some(percent)
}

/// A backend whose frames take a fixed percentage longer. It keeps the name of the backend inside, so that `etalon diff`
/// compares the two, and states the slow-down in the version of the driver.
pub(crate) struct Slower<B> {
    inner: B,
    info: AdapterInfo,
    percent: f64,
}

impl<B: Backend> Slower<B> {
    pub(crate) fn new(inner: B, percent: f64) -> Self {
        let mut info = inner.adapter().clone();
        info.driver_version = format!("{}, slower by {percent} %", info.driver_version);
        Self {
            inner,
            info,
            percent,
        }
    }
}

impl<B: Backend> Backend for Slower<B> {
    fn adapter(&self) -> &AdapterInfo {
        &self.info
    }

    fn limits(&self) -> &Limits {
        self.inner.limits()
    }

    fn prepare(&self, scene: &Scene) -> Result<Box<dyn Prepared + '_>, BackendError> {
        Ok(Box::new(SlowerScene {
            inner: self.inner.prepare(scene)?,
            percent: self.percent,
        }))
    }

    fn messages(&self) -> Vec<String> {
        self.inner.messages()
    }
}

struct SlowerScene<'a> {
    inner: Box<dyn Prepared + 'a>,
    percent: f64,
}

impl Prepared for SlowerScene<'_> {
    fn submit(&mut self) -> Result<FrameTime, BackendError> {
        let mut time = self.inner.submit()?;
        let due: Duration = time.wall.mul_f64(self.percent / 100.0);
        // Sleeping would overshoot by more than the duration of a short frame.
        let start = Instant::now();
        while start.elapsed() < due {
            spin_loop();
        }
        let waited = start.elapsed();
        time.cpu += waited;
        time.wall += waited;
        Ok(time)
    }

    fn read_back(&mut self) -> Result<Frame, BackendError> {
        self.inner.read_back()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_says_how_much_slower() {
        assert_eq!(percent("cpu:slower=5%"), Some(5.0));
        assert_eq!(percent("cpu:slower=0.5%"), Some(0.5));
        for other in [
            "cpu",
            "cpu:slower=5",
            "cpu:slower=%",
            "cpu:slower=-1%",
            "cpu:slower=NaN%",
            "cpu:slower=1e9%",
            "gl:slower=5%",
        ] {
            assert_eq!(percent(other), None, "{other}");
        }
    }
}
