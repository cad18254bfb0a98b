//! Cases that cannot be drawn only because an adapter denies what its API's version requires.

use crate::requirement::{denial, note_requirement};
use etalon_case::{Case, Library};
use etalon_frame::{Limits, Requirement};
use etalon_record::{AdapterRecord, Expectations, Expected, Reason, Record, Verdict};
use etalon_reference::rules::required::{denied, only_denied};
use std::mem::discriminant;
use std::sync::LazyLock;

/// The built-in cases that draw what some version of an API requires, with their requirements.
static REQUIRED: LazyLock<Vec<(Case, Vec<Requirement>)>> = LazyLock::new(|| {
    let cases = Library::built_in().cases_that_begin(Case::REQUIREMENTS);
    let built = cases.filter_map(|case| case.build().ok());
    built
        .map(|case| {
            let requirements = case.requirements();
            (case, requirements)
        })
        .collect()
});

/// Returns the records of the cases of `capabilities/required` that an adapter fails without being drawn on, because it
/// denies what its API's version requires. Cases that the expectations skip are not checked.
pub fn denials(adapter: &AdapterRecord, expectations: &Expectations) -> Vec<Record> {
    let limits = &adapter.limits;
    let denying = REQUIRED.iter().filter(|(_, requirements)| {
        limits.missing(requirements).is_some() && denied(limits, requirements).is_some()
    });
    let checked = denying.filter(|(case, _)| expectations.skips(adapter, &case.id).is_none());
    let records = checked.map(|(case, _)| {
        let mut record = Record::new(&case.id, &adapter.info.name, Verdict::NotSupported);
        note_requirement(&mut record, case, limits);
        record.expect(expectations, adapter);
        record
    });
    records.collect()
}

/// Makes an unsupported case `Blocked` if the adapter lacks nothing for it but what its API's version requires.
///
/// The record names the cases of `capabilities/required` that fail for the same reason, whether they are
/// selected or not. If these failures are expected, so is the record. If the expectations skip one of them,
/// it was not checked, and the case stays unsupported.
pub(crate) fn note_denial(
    record: &mut Record,
    case: &Case,
    adapter: &AdapterRecord,
    expectations: &Expectations,
) {
    let limits = &adapter.limits;
    let missing = only_denied(limits, &case.requirements());
    let Some((needed, required)) = missing.first() else {
        return;
    };
    let mut failing: Vec<Option<&Case>> = Vec::new();
    for (needed, row) in &missing {
        let case = first_denied(limits, *needed, row.citation);
        if !failing
            .iter()
            .any(|other| other.map(|c| &c.id) == case.map(|c| &c.id))
        {
            failing.push(case);
        }
    }
    let skipped = |case: &&Case| expectations.skips(adapter, &case.id).is_some();
    if failing.iter().flatten().any(skipped) {
        return;
    }
    record.verdict = Verdict::Blocked;
    record.reasons = vec![Reason::BlockedByDenial(denial(limits, *needed, required))];
    record.blocked_by = failing.iter().flatten().map(|c| c.id.clone()).collect();
    let reasons = failing.iter().map(|failing| {
        let case = (*failing)?;
        let mut failed = Record::new(&case.id, &adapter.info.name, Verdict::NotSupported);
        note_requirement(&mut failed, case, limits);
        failed.expect(expectations, adapter);
        Some(format!("{}: {}", case.id, failed.expected?.reason))
    });
    let reasons: Option<Vec<String>> = reasons.collect();
    record.expected = reasons.map(|reasons| Expected {
        reason: reasons.join("; "),
    });
}

/// Returns the case of `capabilities/required` that fails on an adapter because it denies this requirement, or
/// else a case with a requirement of the same kind and section. Of several, it is the case that lacks and
/// needs least.
fn first_denied(limits: &Limits, needed: Requirement, citation: &str) -> Option<&'static Case> {
    let lacking = |requirements: &[Requirement]| {
        let missing = requirements
            .iter()
            .filter(|r| limits.missing(&[**r]).is_some());
        missing.count()
    };
    let denials = REQUIRED.iter().filter_map(|(case, requirements)| {
        limits.missing(requirements)?;
        let (other, row) = denied(limits, requirements)?;
        let alike = discriminant(&other) == discriminant(&needed) && row.citation == citation;
        let distance = (other != needed, lacking(requirements), requirements.len());
        alike.then_some((distance, case))
    });
    let nearest = denials.min_by_key(|(distance, _)| *distance);
    nearest.map(|(_, case)| case)
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_backend::Backend;
    use etalon_cpu::CpuBackend;
    use etalon_frame::{AdapterInfo, Api, ApiVersion, Feature};
    use std::path::Path;

    /// Returns an adapter of OpenGL 3.3 with one sample.
    fn adapter() -> AdapterRecord {
        let mut limits = CpuBackend::new("cpu").limits().clone();
        (limits.api, limits.version) = (Api::OpenGl, ApiVersion::new(3, 3));
        for support in limits.formats.values_mut() {
            support.samples.retain(|n| *n == 1);
        }
        AdapterRecord {
            info: AdapterInfo {
                name: "gl:test".to_owned(),
                backend: "gl".to_owned(),
                software: true,
                ..AdapterInfo::default()
            },
            release: None,
            limits,
        }
    }

    fn noted(id: &str, adapter: &AdapterRecord, expectations: &str) -> Record {
        let mut cases = Library::built_in().cases_that_begin(id);
        let case = cases
            .next()
            .and_then(|case| case.build().ok())
            .expect("a case");
        let expectations = Expectations::parse(expectations, Path::new("e.json"));
        let mut record = Record::new(&case.id, &adapter.info.name, Verdict::NotSupported);
        note_denial(
            &mut record,
            &case,
            adapter,
            &expectations.expect("they parse"),
        );
        record
    }

    fn entry(verdict: &str) -> String {
        format!(
            r#"[{{ "adapter": "*", "driver": "*", "case": "capabilities/required/samples/*",
                "verdict": "{verdict}", "reason": "one sample", "evidence": "none" }}]"#
        )
    }

    #[test]
    fn requirements_of_a_version_are_checked_without_drawing() {
        let none = Expectations::default();
        let denying = denials(&adapter(), &none);
        assert!(!denying.is_empty());
        assert!(
            denying
                .iter()
                .all(|r| r.verdict == Verdict::Fail && r.unexpected())
        );
        let ids: Vec<&str> = denying.iter().map(|r| r.case.as_str()).collect();
        assert!(
            ids.contains(&"capabilities/required/samples/format=rgba8unorm"),
            "{ids:?}"
        );
        let all = |verdict| entry(verdict).replace("samples/*", "*");
        let known = Expectations::parse(&all("fail"), Path::new("e.json")).expect("they parse");
        let known = denials(&adapter(), &known);
        assert_eq!(known.len(), denying.len());
        assert!(known.iter().all(|r| r.expected.is_some()));
        let skipped = Expectations::parse(&all("skipped"), Path::new("e.json"));
        assert_eq!(denials(&adapter(), &skipped.expect("they parse")), []);
        let mut whole = adapter();
        whole.limits = CpuBackend::new("cpu").limits().clone();
        assert_eq!(denials(&whole, &none), []);
    }

    const FOUR: &str = "multisample/mask/mask=first/samples=4";

    #[test]
    fn a_case_that_lacks_only_what_is_required_is_blocked() {
        let record = noted(FOUR, &adapter(), "");
        assert_eq!(record.verdict, Verdict::Blocked);
        assert_eq!(
            record.blocked_by,
            ["capabilities/required/samples/format=rgba8unorm"]
        );
        assert_eq!(record.expected, None);
        let [Reason::BlockedByDenial(denial)] = &record.reasons[..] else {
            panic!("{:?}", record.reasons);
        };
        assert!(matches!(denial.needed, Requirement::Samples(_, 4)));
        assert_eq!(denial.version, ApiVersion::new(3, 3));
    }

    #[test]
    fn a_known_denial_excuses_what_it_blocks() {
        let record = noted(FOUR, &adapter(), &entry("fail"));
        assert_eq!(record.verdict, Verdict::Blocked);
        let reason = record.expected.map(|e| e.reason);
        let by = "capabilities/required/samples/format=rgba8unorm: one sample";
        assert_eq!(reason.as_deref(), Some(by));
        // What is skipped is not checked.
        let record = noted(FOUR, &adapter(), &entry("skipped"));
        assert_eq!(record.verdict, Verdict::NotSupported);
    }

    #[test]
    fn a_case_that_lacks_something_else_is_not_supported() {
        let mut exempt = adapter();
        let formats: Vec<_> = exempt.limits.formats.keys().copied().collect();
        let samples = formats.into_iter().map(|f| Requirement::Samples(f, 4));
        exempt.limits.exempt.extend(samples);
        assert_eq!(noted(FOUR, &exempt, "").verdict, Verdict::NotSupported);
        // OpenGL 3.3 has no sample shading.
        let mut less = adapter();
        less.limits.features.remove(&Feature::SampleShading);
        let record = noted("multisample/sample-index/mask=all/samples=4", &less, "");
        assert_eq!(record.verdict, Verdict::NotSupported);
    }
}
