//! Expectations: known bad verdicts with their explanation, looked up by adapter and case.

use crate::adapter::AdapterRecord;
use crate::driver_version::version_of;
use crate::expected_symptom::SymptomParts;
use crate::known::{Entry, Known};
use crate::verdict::Verdict;
use etalon_glob::{Glob, GlobIndex};
use semver::VersionReq;
use std::sync::{Arc, OnceLock};

/// Expectations with their compiled globs.
#[derive(Clone, Debug, Default)]
pub struct Expectations {
    all: Vec<Arc<Known>>,
    globs: Vec<Arc<EntryGlobs>>,
    /// The globs over case ids, made when the first case is looked up. Expectations that are all about one
    /// adapter share it with those they were chosen from.
    index: Arc<OnceLock<GlobIndex>>,
    /// The name of the only adapter that the expectations are about, if they were chosen for it.
    only: Option<String>,
    /// Expectations whose last day is before this day, as `2027-01-31`, have expired; if not set, none
    /// have.
    today: Option<String>,
}

/// The compiled globs of an expectation, in the order in which it names them.
#[derive(Clone, Debug)]
pub(crate) struct EntryGlobs {
    pub(crate) adapters: Vec<Glob>,
    pub(crate) driver: Glob,
    pub(crate) device: Option<Glob>,
    pub(crate) version: Option<VersionReq>,
    pub(crate) processor: Option<Glob>,
    /// False if the machine has another processor, or if the run lacks a label.
    pub(crate) applies: bool,
    pub(crate) cases: Vec<Glob>,
    pub(crate) needs: Vec<Glob>,
}

/// Returns true if a glob matches or is absent.
fn matches_if_given(glob: Option<&Glob>, text: &str) -> bool {
    glob.is_none_or(|glob| glob.is_match(text))
}

impl EntryGlobs {
    fn match_adapter(&self, adapter: &AdapterRecord) -> bool {
        let named = |name: &str| self.adapters.iter().any(|g| g.is_match(name));
        self.applies
            && (named(&adapter.info.name) || named(adapter.without_release()))
            && self.driver.is_match(&adapter.driver_text())
            && matches_if_given(self.device.as_ref(), &adapter.info.device)
            && self.version.as_ref().is_none_or(|range| {
                version_of(adapter).is_some_and(|version| range.matches(&version))
            })
    }

    fn match_case(&self, case: &str) -> bool {
        self.cases.iter().any(|glob| glob.is_match(case))
    }

    fn are_needs_met(&self, draws: &[Vec<String>]) -> bool {
        let has = |facts: &Vec<String>, need: &Glob| facts.iter().any(|fact| need.is_match(fact));
        let mut draws = draws.iter();
        self.needs.is_empty() || draws.any(|facts| self.needs.iter().all(|need| has(facts, need)))
    }
}

/// The relation of a verdict to the expectations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expectation<'a> {
    /// No expectation names the case.
    None,
    /// The verdict is excused.
    Agrees(&'a Known),
    /// The verdict is better than expected, so the expectation can be removed.
    Better(&'a Known),
    /// The verdict was excused until the expectation expired.
    Expired(&'a Known),
    /// The verdict is the expected one, but the symptom is another.
    Differs(&'a Known),
}

impl Expectations {
    /// Appends an expectation.
    pub(crate) fn push(&mut self, known: Known, globs: EntryGlobs) {
        self.all.push(Arc::new(known));
        self.globs.push(Arc::new(globs));
        self.index = Arc::default();
    }

    /// Returns the expectations that apply to an adapter.
    #[must_use]
    pub fn about(&self, adapter: &AdapterRecord) -> Self {
        let entries = self.all.iter().zip(&self.globs);
        let about = entries.filter(|(_, globs)| globs.match_adapter(adapter));
        let (all, globs): (Vec<_>, Vec<_>) = about.map(|(k, g)| (k.clone(), g.clone())).unzip();
        let index = if all.len() == self.all.len() {
            self.index.clone()
        } else {
            Arc::default()
        };
        Self {
            all,
            globs,
            index,
            only: Some(adapter.info.name.clone()),
            today: self.today.clone(),
        }
    }

    /// Sets the day, written as `2027-01-31`, on which expectations are checked for expiry.
    #[must_use]
    pub fn on(self, today: &str) -> Self {
        Self {
            today: Some(today.to_owned()),
            ..self
        }
    }

    /// Restricts the expectations to a run with these labels, as `key=value`, on a machine with this
    /// processor.
    #[must_use]
    pub fn of_run(mut self, processor: &str, labels: &[String]) -> Self {
        for (known, globs) in self.all.iter().zip(&mut self.globs) {
            let applies = matches_if_given(globs.processor.as_ref(), processor)
                && known.labels.iter().all(|label| labels.contains(label));
            if globs.applies != applies {
                Arc::make_mut(globs).applies = applies;
            }
        }
        self
    }

    /// Appends the expectations of `others`.
    #[must_use]
    pub fn and(mut self, others: Self) -> Self {
        self.all.extend(others.all);
        self.globs.extend(others.globs);
        self.index = Arc::default();
        self.only = None;
        self
    }

    /// Returns true if an expectation applies to this machine and run.
    pub(crate) fn applies(&self, number: usize) -> bool {
        self.globs.get(number).is_some_and(|globs| globs.applies)
    }

    /// Returns the expectation that prevents drawing a case on an adapter, if any.
    pub fn skips(&self, adapter: &AdapterRecord, case: &str) -> Option<&Known> {
        self.matching(adapter, case)
            .find(|known| known.verdict == Verdict::Skipped && !self.expired(known))
    }

    /// Returns true if an expectation has expired.
    pub fn expired(&self, known: &Known) -> bool {
        match (&self.today, &known.expires) {
            // Dates in this form sort chronologically.
            (Some(today), Some(last)) => today > last,
            _ => false,
        }
    }

    fn matching<'e, 'a>(
        &'e self,
        adapter: &'a AdapterRecord,
        case: &'a str,
    ) -> impl Iterator<Item = &'e Known> + use<'e, 'a> {
        self.numbers(adapter, case).map(|number| &*self.all[number])
    }

    /// Returns the numbers of the expectations that name a case on an adapter.
    pub fn numbers<'e, 'a>(
        &'e self,
        adapter: &'a AdapterRecord,
        case: &'a str,
    ) -> impl Iterator<Item = usize> + use<'e, 'a> {
        let is_only = self.only.as_ref() == Some(&adapter.info.name);
        let named = self.naming(case).into_iter();
        named.filter(move |number| is_only || self.globs[*number].match_adapter(adapter))
    }

    /// Returns the numbers of the expectations that name a case, on any adapter.
    pub(crate) fn naming(&self, case: &str) -> Vec<usize> {
        let index = self.index.get_or_init(|| {
            let mut index = GlobIndex::default();
            for (number, globs) in self.globs.iter().enumerate() {
                for glob in &globs.cases {
                    index.add(number, glob);
                }
            }
            index
        });
        index.matches(case)
    }

    /// Returns the globs over case ids of an expectation.
    pub(crate) fn case_globs(&self, number: usize) -> &[Glob] {
        self.globs.get(number).map_or(&[], |globs| &globs.cases)
    }

    /// Returns true if an expectation names a case, on any adapter.
    pub fn names(&self, number: usize, case: &str) -> bool {
        self.globs.get(number).is_some_and(|g| g.match_case(case))
    }

    /// Returns true if a scene has what the bug of an expectation needs. `draws` are the facts of each draw.
    pub fn are_needs_met(&self, number: usize, draws: &[Vec<String>]) -> bool {
        let globs = self.globs.get(number);
        globs.is_some_and(|g| g.are_needs_met(draws))
    }

    /// Returns true if an expectation applies to an adapter.
    pub(crate) fn is_about(&self, number: usize, adapter: &AdapterRecord) -> bool {
        let globs = self.globs.get(number);
        globs.is_some_and(|g| g.match_adapter(adapter))
    }

    /// Returns true if an expectation excuses a record. Its cases and adapters are not checked.
    pub(crate) fn excuses(&self, number: usize, record: SymptomParts<'_>) -> bool {
        self.all
            .get(number)
            .is_some_and(|k| k.excuses_record(record))
    }

    /// Returns the expectations that have not expired and name a bad verdict of a case on an adapter.
    pub fn bad<'e, 'a>(
        &'e self,
        adapter: &'a AdapterRecord,
        case: &'a str,
    ) -> impl Iterator<Item = &'e Known> + use<'e, 'a> {
        self.matching(adapter, case)
            .filter(|known| known.verdict.is_bad() && !self.expired(known))
    }

    /// Returns the first expectation of [`Expectations::bad`].
    pub fn first_bad(&self, adapter: &AdapterRecord, case: &str) -> Option<&Known> {
        self.bad(adapter, case).next()
    }

    /// Returns all expectations, in the order of their files.
    pub fn all(&self) -> &[Arc<Known>] {
        &self.all
    }

    /// Returns the entries that come from lists.
    pub fn entries(&self) -> Vec<Entry> {
        self.all.iter().filter_map(|known| known.entry()).collect()
    }

    /// Looks up a verdict, whatever its symptom. An expectation that agrees takes precedence over one that
    /// names another verdict; otherwise the first one counts.
    pub fn look_up(
        &self,
        adapter: &AdapterRecord,
        case: &str,
        verdict: Verdict,
    ) -> Expectation<'_> {
        self.find(adapter, case, verdict, |known| known.excuses(verdict))
    }

    /// Looks up a record, like [`Expectations::look_up`], but also compares its symptom.
    pub fn look_up_record(
        &self,
        adapter: &AdapterRecord,
        case: &str,
        record: SymptomParts<'_>,
    ) -> Expectation<'_> {
        let agrees = |known: &Known| known.excuses_record(record);
        self.find(adapter, case, record.verdict, agrees)
    }

    fn find(
        &self,
        adapter: &AdapterRecord,
        case: &str,
        verdict: Verdict,
        agrees: impl Fn(&Known) -> bool,
    ) -> Expectation<'_> {
        let matching: Vec<&Known> = self.matching(adapter, case).collect();
        let entries = || matching.iter().copied();
        if let Some(known) = entries().find(|k| agrees(k) && !self.expired(k)) {
            return Expectation::Agrees(known);
        }
        if let Some(known) = entries().find(|k| agrees(k)) {
            return Expectation::Expired(known);
        }
        if let Some(known) = entries().find(|k| k.excuses(verdict) && !self.expired(k)) {
            return Expectation::Differs(known);
        }
        // A case that is no longer supported has not become better, and a flaky case can pass.
        let good =
            !verdict.is_bad() && !matches!(verdict, Verdict::NotSupported | Verdict::Skipped);
        let bad = |k: &&Known| k.verdict.is_bad() && k.verdict != Verdict::Flaky;
        match entries().find(bad) {
            Some(known) if good => Expectation::Better(known),
            _ => Expectation::None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adapter::Release;
    use etalon_frame::{AdapterInfo, Api, Limits};
    use std::path::Path;

    fn adapter(name: &str, driver: &str, version: &str) -> AdapterRecord {
        AdapterRecord {
            info: AdapterInfo {
                name: name.to_owned(),
                backend: "gl".to_owned(),
                driver: driver.to_owned(),
                driver_version: version.to_owned(),
                software: true,
                ..AdapterInfo::default()
            },
            release: None,
            limits: Limits {
                sub_pixel_bits: 4,
                max_size: 2048,
                max_color_attachments: 8,
                ..Limits::nothing(Api::OpenGl)
            },
        }
    }

    const TEXT: &str = r#"{ "entries": [
        { "adapter": "gl:*", "driver": "Mesa 25.*", "case": "blend/*/format=rgba8unorm",
          "verdict": "fail", "reason": "saturate is wrong", "evidence": "mesa#1" },
        { "adapter": "*", "driver": "*", "case": "depth/*",
          "verdict": "timeout", "reason": "slow", "evidence": "log" }
    ] }"#;

    #[test]
    fn a_star_also_matches_slashes_and_all_globs_must_match() {
        let e = Expectations::parse(TEXT, Path::new("e.json")).unwrap();
        let soft = adapter("gl:softpipe", "Mesa", "25.0.7");
        let case = "blend/factors/dst=zero/format=rgba8unorm";
        let agrees = |a: &AdapterRecord, c: &str| {
            matches!(e.look_up(a, c, Verdict::Fail), Expectation::Agrees(_))
        };
        assert!(agrees(&soft, case));
        assert!(!agrees(&adapter("vulkan:x", "Mesa", "25.0.7"), case));
        assert!(!agrees(&adapter("gl:x", "Mesa", "24.1"), case));
        assert!(!agrees(&soft, "blend/factors/format=rgba16float"));
        assert_eq!(
            e.look_up(&soft, case, Verdict::Crash),
            Expectation::None,
            "another bad verdict is news"
        );
        assert!(matches!(
            e.look_up(&soft, case, Verdict::Pass),
            Expectation::Better(_)
        ));
        assert_eq!(
            e.look_up(&soft, case, Verdict::NotSupported),
            Expectation::None
        );
    }

    fn one(more: &str, verdict: &str) -> Expectations {
        let text = format!(
            r#"{{ "entries": [ {{ "adapter": "*", "driver": "*", "case": "a/*", "verdict": "{verdict}",
                "reason": "r", "evidence": "e"{more} }} ] }}"#
        );
        Expectations::parse(&text, Path::new("e.json")).unwrap()
    }

    #[test]
    fn a_range_of_versions_holds_the_driver_s() {
        let range = one(r#", "version": ">=22.3, <25.1""#, "fail");
        let found = |version: &str| {
            let adapter = adapter("gl:x", "Mesa", version);
            range.look_up(&adapter, "a/b", Verdict::Fail) != Expectation::None
        };
        assert!(found("Mesa 22.3.6"));
        assert!(found("4.5 (Core Profile) Mesa 25.0.7-2"));
        assert!(!found("Mesa 25.1.0"));
        assert!(!found("Mesa 22.2"));
        assert!(!found("unknown"));
        // The description's version counts, even if the driver reports none or another one.
        let described = |version: &str| {
            let mut adapter = adapter("vulkan:x", "SwiftShader", "Mesa 22.3.6");
            adapter.release = Some(Release {
                line: "swiftshader".to_owned(),
                version: version.to_owned(),
            });
            range.look_up(&adapter, "a/b", Verdict::Fail) != Expectation::None
        };
        let release = adapter("gl:x@25.0", "Mesa", "Mesa 25.0.7");
        let plain = Expectations::parse(
            &TEXT.replace("gl:*", "gl:x").replace("Mesa 25.*", "Mesa *"),
            Path::new("e.json"),
        )
        .unwrap();
        let case = "blend/factors/format=rgba8unorm";
        let agrees = plain.look_up(&release, case, Verdict::Fail);
        assert!(matches!(agrees, Expectation::Agrees(_)), "{agrees:?}");
        assert!(described("23") && described("22.3.0.1"));
        assert!(!described("26"));
    }

    #[test]
    fn a_device_is_a_condition() {
        let software = one(r#", "device": "a software rasterizer*""#, "fail");
        let found = |device: &str| {
            let mut adapter = adapter("webgpu:firefox", "Firefox", "153.0");
            device.clone_into(&mut adapter.info.device);
            software.look_up(&adapter, "a/b", Verdict::Fail) != Expectation::None
        };
        assert!(found("a software rasterizer without a name"));
        assert!(!found("a device without a name"));
    }

    #[test]
    fn an_entry_that_expired_excuses_nothing() {
        let adapter = adapter("gl:x", "Mesa", "25");
        let dated = one(
            r#", "expires": "2027-01-31", "link": "https://bug""#,
            "fail",
        );
        let on = |day: &str| {
            dated
                .clone()
                .on(day)
                .look_up(&adapter, "a/b", Verdict::Fail)
                == Expectation::Agrees(&dated.all()[0])
        };
        assert!(on("2027-01-31") && !on("2027-02-01"));
        let late = dated.clone().on("2028-01-01");
        assert!(matches!(
            late.look_up(&adapter, "a/b", Verdict::Fail),
            Expectation::Expired(_)
        ));
        let skip = one(r#", "expires": "2027-01-31""#, "skipped");
        assert!(skip.skips(&adapter, "a/b").is_some());
        assert!(skip.skips(&adapter, "b/b").is_none());
        assert!(skip.on("2027-02-01").skips(&adapter, "a/b").is_none());
    }

    #[test]
    fn findings_about_an_adapter_have_names_and_are_found_by_case() {
        let finding = |adapter: &str, case: &str| {
            format!(
                r#"{{ "title": "t", "adapters": ["{adapter}"], "driver": "*", "cases": ["{case}"],
                    "grade": "proven", "clause": "c", "evidence": "e" }}"#
            )
        };
        let texts = [("gl:x", "a/*"), ("gl:y", "a/b"), ("gl:*", "a/b")].map(|(a, c)| finding(a, c));
        let files = ["f/one.json", "f/two.json", "f/three.json"];
        let files: Vec<(&str, &str)> = files.into_iter().zip(texts.iter().map(|t| &**t)).collect();
        let adapter = adapter("gl:x", "Mesa", "25");
        let about = Expectations::of_findings(&files).unwrap().about(&adapter);
        let names =
            |case: &str| -> Vec<String> { about.bad(&adapter, case).map(Known::name).collect() };
        assert_eq!(about.all().len(), 2);
        assert_eq!(names("a/b"), ["one", "three"]);
        assert_eq!(names("a/c"), ["one"]);
        assert_eq!(one("", "fail").all()[0].name(), "e.json: entry 1");
    }

    #[test]
    fn a_flake_may_do_anything_but_is_no_improvement() {
        let adapter = adapter("gl:x", "Mesa", "25");
        let flaky = one("", "flaky");
        for verdict in [Verdict::Flaky, Verdict::Fail, Verdict::Crash] {
            let found = flaky.look_up(&adapter, "a/b", verdict);
            assert!(matches!(found, Expectation::Agrees(_)), "{verdict}");
        }
        assert_eq!(
            flaky.look_up(&adapter, "a/b", Verdict::Pass),
            Expectation::None
        );
    }

    #[test]
    fn an_entry_excuses_its_verdict_and_a_finding_also_weaker_violations() {
        let adapter = adapter("gl:x", "Mesa", "25");
        let finding = |verdict: &str| {
            let text = format!(
                r#"{{ "title": "t", "adapters": ["gl:y", "gl:x"], "driver": "*", "cases": ["b", "a/*"],
                    "verdict": "{verdict}", "grade": "proven", "clause": "c", "evidence": "e" }}"#
            );
            Expectations::parse(&text, Path::new("f.json")).unwrap()
        };
        let agrees = |e: &Expectations, verdict| {
            matches!(e.look_up(&adapter, "a/b", verdict), Expectation::Agrees(_))
        };
        use Verdict::{Blocked, Crash, Disputed, Fail, RequiredByCts};
        let graded = [Fail, RequiredByCts, Disputed, Blocked, Crash];
        for (i, verdict) in graded.into_iter().enumerate() {
            let entry = one("", verdict.name());
            let finding = finding(verdict.name());
            for (j, other) in graded.into_iter().enumerate() {
                assert_eq!(agrees(&entry, other), i == j, "{verdict} {other}");
                let weaker = i <= j && j < 3;
                assert_eq!(
                    agrees(&finding, other),
                    i == j || weaker,
                    "{verdict} {other}"
                );
            }
        }
    }
}
