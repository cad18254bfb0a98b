//! The kinds of work that a bench times, by case.

use etalon_frame::Work;
use etalon_record::Measure;
use std::borrow::Cow;

/// A kind of work.
struct WorkKind {
    /// The name of its panel.
    name: &'static str,
    /// The unit of its work.
    measure: Measure,
    /// True if each colour format is a kind of its own.
    by_format: bool,
    /// The case files, each with the part that a case's id must have; empty for all its cases.
    files: &'static [(&'static str, &'static str)],
}

const fn kind(
    name: &'static str,
    measure: Measure,
    files: &'static [(&'static str, &'static str)],
) -> WorkKind {
    WorkKind {
        name,
        measure,
        by_format: false,
        files,
    }
}

/// The kinds in the order of their panels. A case is of the first kind that names it.
const KINDS: [WorkKind; 11] = [
    kind(
        "clear",
        Measure::Cleared,
        &[
            ("perf/clear", ""),
            ("perf/matrix/clear", ""),
            ("perf/matrix/clear-samples", ""),
            ("perf/matrix/clear-depth", ""),
            ("perf/matrix/clear-depth-stencil", ""),
        ],
    ),
    kind(
        "fill",
        Measure::Texels,
        &[
            ("perf/quad", ""),
            ("perf/matrix/fill", "blend=none"),
            ("perf/matrix/targets", ""),
        ],
    ),
    WorkKind {
        name: "blend",
        measure: Measure::Texels,
        by_format: true,
        files: &[
            ("perf/blended-layers", ""),
            ("perf/multisample-blended-layers", ""),
            ("perf/matrix/fill", ""),
            ("perf/matrix/dual-source", ""),
        ],
    },
    kind(
        "logic operations",
        Measure::Texels,
        &[("perf/matrix/logic", "")],
    ),
    kind(
        "depth",
        Measure::Texels,
        &[
            ("perf/depth-order", ""),
            ("perf/depth-only", ""),
            ("perf/matrix/depth", ""),
            ("perf/matrix/depth-export", ""),
        ],
    ),
    kind(
        "stencil",
        Measure::Texels,
        &[("perf/stencil", ""), ("perf/matrix/stencil", "")],
    ),
    kind(
        "rejection and discards",
        Measure::Texels,
        &[
            ("perf/overdraw", ""),
            ("perf/textured-discard", ""),
            ("perf/matrix/discard", ""),
            ("perf/matrix/early-rejection", ""),
        ],
    ),
    kind(
        "triangles",
        Measure::Triangles,
        &[
            ("perf/triangles-100k", ""),
            ("perf/triangles-1m", ""),
            ("perf/multisample-triangles-100k", ""),
            ("perf/multisample-triangles-1m", ""),
            ("perf/culling", ""),
            ("perf/matrix/triangles", ""),
            ("perf/matrix/cull", ""),
        ],
    ),
    kind(
        "state changes",
        Measure::Texels,
        &[("perf/state-changes", "")],
    ),
    kind("resolve", Measure::Resolved, &[("perf/matrix/resolve", "")]),
    kind(
        "read back",
        Measure::Read,
        &[("perf/read-back", ""), ("perf/matrix/read-back", "")],
    ),
];

/// The colour format of the files that have no axis for it.
const USUAL_FORMAT: &str = "rgba8unorm";

/// The kind of work of one case.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct CaseKind<'a> {
    /// The position of its panel.
    place: usize,
    /// The colour format, if it has a panel of its own.
    format: Option<&'a str>,
    /// The name of a kind that is not listed: the case's area.
    other: &'a str,
}

impl<'a> CaseKind<'a> {
    /// Returns the kind of a case. Cases outside the listed files are grouped by area, or by file in `perf/`.
    pub(super) fn of(case: &'a str) -> Self {
        let parts = || case.split('/');
        let names = |file: &str| case.strip_prefix(file).is_some_and(|r| r.starts_with('/'));
        let is_in = |(file, part): &(&str, &str)| {
            let named = case == *file || names(file);
            named && (part.is_empty() || parts().any(|p| p == *part))
        };
        let found = KINDS.iter().position(|kind| kind.files.iter().any(is_in));
        match found {
            Some(place) => Self {
                place,
                format: KINDS[place].by_format.then(|| {
                    let format = parts().find_map(|part| part.strip_prefix("format="));
                    format.unwrap_or(USUAL_FORMAT)
                }),
                other: "",
            },
            None => Self {
                place: KINDS.len(),
                format: None,
                other: match case.strip_prefix("perf/") {
                    Some(file) => file.split('/').next().unwrap_or_default(),
                    None => parts().next().unwrap_or_default(),
                },
            },
        }
    }

    /// Returns the name of the kind's panel.
    pub(super) fn name(&self) -> Cow<'a, str> {
        match (KINDS.get(self.place), self.format) {
            (Some(kind), Some(format)) => format!("{} in {format}", kind.name).into(),
            (Some(kind), None) => kind.name.into(),
            (None, _) => self.other.into(),
        }
    }

    /// Returns the unit of the kind's work.
    pub(super) fn measure(&self) -> Measure {
        KINDS.get(self.place).map_or(Measure::Texels, |k| k.measure)
    }

    /// Returns the amount of a frame's work in the kind's unit.
    pub(super) fn amount(&self, work: &Work) -> u64 {
        match self.measure() {
            Measure::Texels => work.texels,
            Measure::Triangles => work.triangles,
            Measure::Cleared => work.cleared,
            Measure::Resolved => work.resolved,
            Measure::Read => work.read,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_case_has_the_kind_of_its_file_and_axes() {
        for (case, name) in [
            ("perf/clear/size=256x256", "clear"),
            ("perf/matrix/clear-depth/layers=2", "clear"),
            ("perf/quad", "fill"),
            ("perf/matrix/fill/blend=none/format=r8unorm", "fill"),
            (
                "perf/matrix/fill/blend=over/format=r8unorm",
                "blend in r8unorm",
            ),
            ("perf/blended-layers/size=256x256", "blend in rgba8unorm"),
            ("perf/matrix/depth-export/layers=4", "depth"),
            ("perf/matrix/read-back/layers=1", "read back"),
            ("perf/state-changes/size=256x256", "state changes"),
            ("perf/cleared", "cleared"),
            ("blend/operations/a=1", "blend"),
            ("depth", "depth"),
        ] {
            assert_eq!(CaseKind::of(case).name(), name, "{case}");
        }
    }

    #[test]
    fn work_is_counted_in_the_unit_of_the_kind() {
        let work = Work {
            triangles: 1,
            texels: 2,
            cleared: 3,
            resolved: 4,
            read: 5,
            ..Work::default()
        };
        let amounts = [
            "triangles-1m",
            "quad",
            "clear",
            "matrix/resolve",
            "read-back",
        ]
        .map(|file| CaseKind::of(&format!("perf/{file}")).amount(&work));
        assert_eq!(amounts, [1, 2, 3, 4, 5]);
    }
}
