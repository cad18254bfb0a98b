//! Compares the requirements of an API's version with the capabilities that an adapter denies.

use etalon_case::Case;
use etalon_frame::{Limits, Requirement};
use etalon_record::{Denial, Reason, Record, Verdict};
use etalon_reference::rules::required::{Required, denied};

/// Fails an adapter that denies a requirement of its API's version.
pub fn note_requirement(record: &mut Record, case: &Case, limits: &Limits) {
    match denied(limits, &case.requirements()) {
        Some((needed, required)) => {
            record.verdict = Verdict::Fail;
            record.reasons = vec![Reason::Denied(denial(limits, needed, &required))];
        }
        None => {
            let reason = Reason::NotRequired(limits.api, limits.version);
            record.reasons.push(reason);
        }
    }
}

pub(crate) fn denial(limits: &Limits, needed: Requirement, required: &Required) -> Denial {
    Denial {
        needed,
        api: limits.api,
        version: limits.version,
        citation: required.citation.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_backend::Backend;
    use etalon_case::{Library, Profile};
    use etalon_cpu::CpuBackend;
    use etalon_frame::{Api, ApiVersion, TextureFormat};

    /// Returns the record of a case that requires a format, on an adapter of this version that lacks the
    /// format.
    fn lacking(format: TextureFormat, exempt: bool, major: u8, minor: u8) -> Record {
        let id = format!("capabilities/required/color-formats/format={format}");
        let library = Library::built_in();
        let found = library.cases(Profile::Full).find(|case| case.id() == id);
        let case = found.and_then(|case| case.build().ok()).expect("it builds");
        assert!(case.is_requirement());
        let mut limits = CpuBackend::new("cpu").limits().clone();
        (limits.api, limits.version) = (Api::OpenGl, ApiVersion::new(major, minor));
        limits.formats.remove(&format);
        if exempt {
            limits
                .exempt
                .extend([Requirement::Format(format), Requirement::Drawing(format)]);
        }
        let mut record = Record::new(&case.id, "gl:test", Verdict::NotSupported);
        record.reasons = vec![Reason::Missing(Requirement::Format(format))];
        note_requirement(&mut record, &case, &limits);
        record
    }

    #[test]
    fn denying_a_required_format_is_a_fail() {
        let record = lacking(TextureFormat::Rgba16Float, false, 3, 3);
        assert_eq!(record.verdict, Verdict::Fail);
        let [Reason::Denied(denial)] = &record.reasons[..] else {
            panic!("{:?}", record.reasons);
        };
        assert_eq!(
            (denial.api, denial.version),
            (Api::OpenGl, ApiVersion::new(3, 3))
        );
        assert!(denial.citation.starts_with("OpenGL 3.3: 3.8.1"));
    }

    #[test]
    fn lacking_a_format_that_is_not_required_is_not_supported() {
        for record in [
            lacking(TextureFormat::B5g6r5Unorm, false, 3, 3),
            lacking(TextureFormat::Rgba16Float, true, 4, 6),
        ] {
            assert_eq!(record.verdict, Verdict::NotSupported);
            assert!(matches!(
                record.reasons[..],
                [Reason::Missing(_), Reason::NotRequired(Api::OpenGl, _)]
            ));
        }
    }
}
