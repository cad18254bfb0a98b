//! The errors and panics of wgpu as backend errors.

use etalon_backend::BackendError;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The errors that a device raised and that no check has taken yet.
///
/// A handler of uncaptured errors has two advantages over error scopes: it costs nothing per call, and it
/// also gets errors outside of scopes, where wgpu would panic.
#[derive(Clone, Default)]
pub(crate) struct Errors {
    raised: Arc<Mutex<Vec<wgpu::Error>>>,
    lost: Arc<Mutex<Option<String>>>,
}

impl Errors {
    /// Registers handlers on a device.
    pub(crate) fn of(device: &wgpu::Device) -> Self {
        let errors = Self::default();
        let raised = Arc::clone(&errors.raised);
        device.on_uncaptured_error(Arc::new(move |error| locked(&raised).push(error)));
        let lost = Arc::clone(&errors.lost);
        device.set_device_lost_callback(move |reason, message| {
            // The other possible reason is that this program dropped the device.
            if matches!(reason, wgpu::DeviceLostReason::Unknown) {
                *locked(&lost) = Some(message);
            }
        });
        errors
    }

    /// Returns the first error since the last call. `what` describes the operation since then.
    pub(crate) fn check(&self, what: &str) -> Result<(), BackendError> {
        match self.first()? {
            None => Ok(()),
            Some(error) => Err(backend_error(what, error)),
        }
    }

    /// Like [`Errors::check`], after creating a shader module: every error is the shader's, unless memory ran
    /// out.
    pub(crate) fn check_shader(&self, shader: &str) -> Result<(), BackendError> {
        match self.first()? {
            None => Ok(()),
            Some(error @ wgpu::Error::OutOfMemory { .. }) => Err(backend_error(shader, error)),
            Some(error) => Err(shader_error(shader, &error)),
        }
    }

    /// Like [`Errors::check`], after creating a pipeline: an internal error is the shader's, because the
    /// driver compiles it now.
    pub(crate) fn check_pipeline(&self, shader: &str) -> Result<(), BackendError> {
        match self.first()? {
            None => Ok(()),
            Some(error @ wgpu::Error::Internal { .. }) => Err(shader_error(shader, &error)),
            Some(error) => Err(backend_error(&format!("a pipeline of {shader}"), error)),
        }
    }

    /// Takes the first error, which caused the others. A lost device takes precedence.
    fn first(&self) -> Result<Option<wgpu::Error>, BackendError> {
        if let Some(message) = &*locked(&self.lost) {
            return Err(BackendError::lost(message));
        }
        let mut raised = locked(&self.raised);
        let first = (!raised.is_empty()).then(|| raised.swap_remove(0));
        raised.clear();
        Ok(first)
    }

    /// Discards all errors.
    pub(crate) fn forget(&self) {
        locked(&self.raised).clear();
    }

    /// Runs `action` and returns its first error. A panic is an error too: wgpu panics if a driver refuses an
    /// operation that cannot fail in WebGPU, such as waiting.
    pub(crate) fn guard<T>(
        &self,
        what: &str,
        action: impl FnOnce() -> Result<T, BackendError>,
    ) -> Result<T, BackendError> {
        let result =
            catch_unwind(AssertUnwindSafe(action)).unwrap_or_else(|panic| Err(panicked(&*panic)));
        // Raised errors come first, since they caused the result. A shader error already took the errors
        // raised with it.
        self.check(what)?;
        result
    }
}

fn backend_error(what: &str, error: wgpu::Error) -> BackendError {
    match error {
        wgpu::Error::OutOfMemory { source } => BackendError::refused(what, chain(&*source)),
        wgpu::Error::Validation { ref source, .. } => {
            let failed = BackendError::internal_of(what, error.to_string());
            match variant(&**source) {
                Some(code) => failed.with_code(code),
                None => failed,
            }
        }
        other => BackendError::internal_of(what, other.to_string()),
    }
}

/// Returns the name of the innermost error's variant, from its debug form: wgpu has no error codes.
fn variant(error: &(dyn std::error::Error + 'static)) -> Option<String> {
    let innermost = std::iter::successors(Some(error), |error| error.source()).last()?;
    let form = format!("{innermost:?}");
    let end = form
        .find(|c: char| !c.is_alphanumeric())
        .unwrap_or(form.len());
    (end > 0).then(|| form[..end].to_owned())
}

fn shader_error(shader: &str, error: &wgpu::Error) -> BackendError {
    BackendError::shader(shader, error.to_string())
}

pub(crate) fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn panicked(panic: &(dyn Any + Send)) -> BackendError {
    let text = panic
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| panic.downcast_ref::<&str>().copied());
    BackendError::internal_of("wgpu panicked", text.unwrap_or("without a message"))
}

fn chain(error: &(dyn std::error::Error + 'static)) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(error) = source {
        text.push_str(": ");
        text.push_str(&error.to_string());
        source = error.source();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::ErrorKind;

    fn raise(errors: &Errors, error: wgpu::Error) {
        locked(&errors.raised).push(error);
    }

    fn internal() -> wgpu::Error {
        wgpu::Error::Internal {
            source: "no".into(),
            description: "the compiler says no".to_owned(),
        }
    }

    #[test]
    fn the_first_error_is_returned_and_the_rest_discarded() {
        let errors = Errors::default();
        raise(
            &errors,
            wgpu::Error::OutOfMemory {
                source: "full".into(),
            },
        );
        raise(&errors, internal());
        let expected = BackendError::refused("drawing", "full");
        assert_eq!(errors.check("drawing"), Err(expected));
        assert_eq!(errors.check("drawing"), Ok(()));
        let invalid = || wgpu::Error::Validation {
            source: Box::new(std::fmt::Error),
            description: "3 bytes are missing".to_owned(),
        };
        raise(&errors, invalid());
        let expected = BackendError::internal_of("drawing", invalid().to_string());
        assert_eq!(errors.check("drawing"), Err(expected.with_code("Error")));
        raise(&errors, internal());
        let shader = errors.check_pipeline("flat_color");
        let expected = ErrorKind::Shader("flat_color".to_owned());
        assert!(matches!(shader, Err(BackendError::Failed { kind, .. }) if kind == expected));
    }

    #[test]
    fn a_panic_is_an_error_and_a_lost_device_comes_first() {
        let errors = Errors::default();
        let result: Result<(), _> = errors.guard("waiting", || panic!("no fence"));
        let expected = BackendError::internal_of("wgpu panicked", "no fence");
        assert_eq!(result, Err(expected));
        let result = errors.guard("waiting", || {
            *locked(&errors.lost) = Some("gone".to_owned());
            raise(&errors, internal());
            Ok(())
        });
        assert_eq!(result, Err(BackendError::lost("gone")));
    }
}
