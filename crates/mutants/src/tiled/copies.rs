//! Resolves, fetches, counts and reads of large pictures.

use super::super::hooks::fetch;
use super::super::list::{CONFUSION, List};
use super::super::memory::Area;
use super::super::plant::{Plant, moved, stored};
use super::clears::spoil;
use etalon_cpu::steps::Moment;
use etalon_frame::{Aspect, CounterKind};

/// Leaves an area of resolved attachments wrong, given their size.
fn unresolved(area: impl Fn([usize; 2]) -> Option<Area> + Clone + Send + Sync + 'static) -> Plant {
    stored(move |moment, scene, stored| {
        let Moment::End { pass } = moment else { return };
        for target in scene.passes[pass].resolve.iter().flatten() {
            let surface = &mut stored.surfaces[*target];
            if let Some(area) = area([surface.width, surface.height]) {
                spoil(surface, &scene.attachments[*target], Aspect::Color, area);
            }
        }
    })
}

pub(super) fn add(list: &mut List) {
    for n in [16, 64] {
        list.add(
            &format!("resolve-leaves-second-tile-of-{n}"),
            CONFUSION,
            format!("The second tile of {n}×{n} in the first row is not resolved."),
            unresolved(move |[width, _]| (width > n).then_some([n, 0, n * 2, n])),
        );
    }
    list.add(
        "resolve-leaves-last-odd-row",
        CONFUSION,
        "The last row of an odd height is not resolved.",
        unresolved(|[width, height]| (height % 2 == 1).then_some([0, height - 1, width, height])),
    );
    list.add(
        "resolve-only-first-64",
        CONFUSION,
        "Only the first 64 columns are resolved.",
        unresolved(|[width, height]| (width > 64).then_some([64, 0, width, height])),
    );
    for (name, n) in [("6", 64), ("8", 256)] {
        list.add(
            &format!("fetch-in-{name}-bits"),
            CONFUSION,
            format!("Texels are fetched at coordinates modulo {n}."),
            fetch(move |[x, y], _| [x % n, y % n]),
        );
    }
    list.add(
        "count-in-16-bits",
        CONFUSION,
        "Counts of samples run over at 65,536.",
        Plant::Frame(Box::new(|scene, frame| {
            for (counter, count) in scene.counters.iter().zip(&mut frame.counters) {
                if counter.kind == CounterKind::SamplesPassed {
                    *count %= 1 << 16;
                }
            }
        })),
    );
    for (name, aspect) in [
        ("color", Aspect::Color),
        ("depth", Aspect::Depth),
        ("stencil", Aspect::Stencil),
    ] {
        list.add(
            &format!("{name}-read-at-pitch-of-64"),
            CONFUSION,
            format!("Rows of {name} are read at a pitch of whole blocks of 64 texels."),
            moved(aspect, |[x, y], [width, height]| {
                let at = y * width.next_multiple_of(64) + x;
                let at = at % (width * height);
                [at % width, at / width]
            }),
        );
    }
}
