//! Planted bugs: the proof that the suite can fail.
//!
//! A [`Mutant`] is a small, named mutation of the rasterizer: of what it believes it was asked
//! ([`Plant::Scene`], [`Plant::Sticky`]), of one step of its arithmetic ([`Plant::Steps`]), or of
//! what it hands back ([`Plant::Frame`]). Each must change the frame of some built-in case, which a
//! test holds, and `etalon mutants` tells which cases see it.
//!
//! Adding one takes a call of [`List::add`] in the file of its class.

mod backend;
mod bias;
mod blend;
mod clear;
mod cull;
mod depth;
mod early;
mod formats;
mod geometry;
mod hooks;
mod invariance;
mod logic;
mod mask;
mod multisample;
mod plant;
mod readback;
mod scissor;
mod stencil;
mod sticky;
mod tables;
mod targets;
mod texture;
mod topology;

pub use backend::MutantBackend;

use plant::Plant;
use std::sync::LazyLock;

/// Where a bug comes from when no driver is known to have shipped it.
const CONFUSION: &str = "neighbour confusion";
/// Bugs that suites with thresholds do not see.
const SMALL: &str = "a small error, which suites with thresholds miss";

/// One planted bug.
#[derive(Debug)]
pub struct Mutant {
    /// The stable name, its class first: `depth/write-ignored`.
    pub name: String,
    /// What it does, in one sentence.
    pub about: String,
    /// The driver that shipped it once, or what kind of confusion it is.
    pub source: &'static str,
    /// The area whose cases alone must catch it.
    pub area: &'static str,
    /// Why nothing may be said against it, with the clause; `None` where it must be caught.
    pub legal: Option<&'static str>,
    plant: Plant,
}

/// Every planted bug, class by class.
pub fn mutants() -> &'static [Mutant] {
    static ALL: LazyLock<Vec<Mutant>> = LazyLock::new(|| {
        let mut list = List::default();
        depth::add(&mut list);
        bias::add(&mut list);
        stencil::add(&mut list);
        blend::add(&mut list);
        mask::add(&mut list);
        formats::add(&mut list);
        targets::add(&mut list);
        logic::add(&mut list);
        cull::add(&mut list);
        topology::add(&mut list);
        multisample::add(&mut list);
        scissor::add(&mut list);
        clear::add(&mut list);
        geometry::add(&mut list);
        early::add(&mut list);
        texture::add(&mut list);
        invariance::add(&mut list);
        readback::add(&mut list);
        sticky::add(&mut list);
        list.mutants
    });
    &ALL
}

/// A mutant in a table: its name, what it does, and the bug.
type Row<B> = (&'static str, &'static str, B);

/// The registry while it is filled.
#[derive(Debug, Default)]
struct List {
    class: &'static str,
    area: &'static str,
    mutants: Vec<Mutant>,
}

impl List {
    /// What follows belongs to this class and is caught by this area.
    fn class(&mut self, class: &'static str, area: &'static str) {
        self.class = class;
        self.area = area;
    }

    /// Adds a mutant of the present class.
    fn add(
        &mut self,
        name: &str,
        source: &'static str,
        about: impl Into<String>,
        plant: Plant,
    ) -> &mut Mutant {
        let at = self.mutants.len();
        self.mutants.push(Mutant {
            name: format!("{}/{name}", self.class),
            about: about.into(),
            source,
            area: self.area,
            legal: None,
            plant,
        });
        &mut self.mutants[at]
    }

    /// Adds the mutants of a table, all of one source and planted in the same way.
    fn rows<B: Copy>(&mut self, source: &'static str, plant: fn(B) -> Plant, rows: &[Row<B>]) {
        for (name, about, bug) in rows {
            self.add(name, source, *about, plant(*bug));
        }
    }
}

impl Mutant {
    /// Says why nothing may be said against it.
    fn legal(&mut self, why: &'static str) {
        self.legal = Some(why);
    }
}

#[cfg(test)]
mod tests;
