//! Adds cases to a file of changes until every two facts that its changes can bring about meet in a draw.
//!
//! ```text
//! etalon adapters --format json >adapters.json
//! cargo run --release -p etalon-explore --example fill_pairs -- cases/combined/states.json adapters.json ADAPTER... cpu
//! ```
//!
//! The last adapter is the rasterizer, which draws everything. Pairs are counted for each of the others alone, among
//! the built-in cases that it offers to draw. For a pair that has no such case, changes are joined that bring about its
//! facts, then those that add most other pairs. Each change must show: without it, the rasterizer draws another frame.
//! Cases that the file has stay as they are, since ids do not change. Printed are the new names of cases, and the pairs
//! that no joined changes show, with a reason.

use etalon_backend::Backend;
use etalon_case::{CaseFile, Library, Profile, build, parse_json};
use etalon_cpu::CpuBackend;
use etalon_explore::FactPairs;
use etalon_frame::{Frame, Limits};
use etalon_scene::Scene;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;

/// The greatest number of changes of a case: with more, one hides the other.
const MOST: usize = 7;

/// The least number of new pairs for which a further change is joined.
const WORTH: usize = 2;

/// An adapter, and the pairs of the cases that it draws.
struct Drawer {
    limits: Limits,
    pairs: FactPairs,
}

impl Drawer {
    fn draws(&self, scene: &Scene) -> bool {
        self.limits.missing(&scene.requirements()).is_none()
    }
}

/// Scenes by the names of the changes that they join.
struct Joiner<'a> {
    document: &'a Value,
    name: &'a str,
    rasterizer: CpuBackend,
}

impl Joiner<'_> {
    /// Returns the scene in which changes meet.
    fn scene(&self, changes: &[&str]) -> Result<Scene, String> {
        let mut document = self.document.clone();
        let name = CaseFile::name_of_changes(changes);
        document["axes"]["with"] = Value::Array(vec![Value::String(name)]);
        let listed = self.document["changes"].as_object();
        let pointers = changes
            .iter()
            .filter_map(|name| listed?.get(*name)?.as_object());
        let mut values: BTreeMap<&String, &Value> = BTreeMap::new();
        for (pointer, value) in pointers.flatten() {
            let clash = values.iter().any(|(other, known)| {
                let is_above =
                    |a: &str, b: &str| b.strip_prefix(a).is_some_and(|b| b.starts_with('/'));
                let is_same = *other == pointer && !pointer.ends_with("/-");
                is_above(other, pointer) || is_above(pointer, other) || (is_same && *known != value)
            });
            if clash {
                return Err(format!("two changes of {pointer}"));
            }
            values.insert(pointer, value);
        }
        if let (true, Some(file)) = (changes.is_empty(), document.as_object_mut()) {
            file.retain(|key, _| !["axes", "changes"].contains(&key.as_str()));
        }
        let made = build(self.name, &document).map_err(|error| error.message)?;
        Ok(made.scene)
    }

    fn frame(&mut self, scene: &Scene) -> Result<Frame, Box<dyn Error>> {
        let mut prepared = self.rasterizer.prepare(scene)?;
        prepared.submit()?;
        Ok(prepared.read_back()?)
    }

    /// Returns true if the frame is another one without the draw that changes.
    fn shows(&mut self, scene: &Scene) -> Result<bool, Box<dyn Error>> {
        let mut without = scene.clone();
        let Some(pass) = without.passes.get_mut(1) else {
            return Ok(false);
        };
        // A draw that rasterizes nothing shows nothing, and must not.
        if pass
            .draws
            .first()
            .is_none_or(|draw| draw.rasterizer_discard)
        {
            return Ok(true);
        }
        for draw in pass.draws.iter_mut().take(1) {
            draw.rasterizer_discard = true;
        }
        Ok(self.frame(scene)? != self.frame(&without)?)
    }

    /// Returns the first change without which the frame is the same, if there is one. A path or how vertices are
    /// fetched never shows, nor do changes that must not act.
    fn hidden<'c>(
        &mut self,
        changes: &[&'c str],
        silent: &[&str],
        scene: &Scene,
    ) -> Result<Option<&'c str>, Box<dyn Error>> {
        let unseen = [
            "/path/",
            "/pool",
            "/passes/1/draws/0/fetch",
            "/passes/1/draws/0/mesh",
            "/passes/1/draws/0/tessellation",
            "/passes/1/draws/0/topology",
        ];
        let frame = self.frame(scene)?;
        let is_discarded = scene.passes[1].draws[0].rasterizer_discard;
        for change in changes {
            let patch = self.document["changes"][*change].as_object();
            let is_unseen =
                |pointer: &String| unseen.iter().any(|start| pointer.starts_with(start));
            let discards = patch.is_some_and(|patch| {
                patch
                    .keys()
                    .any(|pointer| pointer.ends_with("/rasterizer_discard"))
            });
            if silent.contains(change)
                || patch
                    .is_some_and(|patch| patch.contains_key("/pool") || patch.keys().all(is_unseen))
                || (is_discarded && !discards)
            {
                continue;
            }
            let others: Vec<&str> = changes.iter().copied().filter(|c| c != change).collect();
            if let Ok(without) = self.scene(&others)
                && self.frame(&without)? == frame
            {
                return Ok(Some(change));
            }
        }
        Ok(None)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, adapters, names @ ..] = &arguments[..] else {
        return Err("usage: fill_pairs FILE ADAPTERS.json ADAPTER... cpu".into());
    };
    let text = std::fs::read_to_string(file)?;
    let document: Value = parse_json(&text)?;
    let adapters: Value = serde_json::from_str(&std::fs::read_to_string(adapters)?)?;
    let mut drawers = Vec::new();
    for name in names {
        let mut listed = adapters.as_array().into_iter().flatten();
        let adapter = listed.find(|a| a["name"] == name.as_str());
        let adapter = adapter.ok_or_else(|| format!("{name} is not listed"))?;
        drawers.push(Drawer {
            limits: serde_json::from_value(adapter["limits"].clone())?,
            pairs: FactPairs::default(),
        });
    }
    let mut any = FactPairs::default();
    let own = CaseFile::parse("combined/states.json", &text)?;
    let library = Library::built_in();
    let others = library
        .files()
        .filter(|f| !f.is_random() && f.name() != own.name());
    let others = others.flat_map(|file| file.cases(Profile::Quick));
    for case in others.chain(own.cases(Profile::Full)) {
        let Ok(case) = case.build() else { continue };
        for drawer in drawers.iter_mut().filter(|d| d.draws(&case.scene)) {
            drawer.pairs.add(&case.scene);
            any.add(&case.scene);
        }
    }
    let joiner = Joiner {
        document: &document,
        name: "combined/states",
        rasterizer: CpuBackend::new("cpu"),
    };
    // In the file's order, so that pairs of states come first.
    let changes: Vec<&str> = document["changes"]
        .as_object()
        .map_or_else(Vec::new, |c| c.keys().map(String::as_str).collect());
    let plain = joiner.scene(&[])?;
    let counted = FactPairs::default();
    let of_plain: BTreeSet<String> = counted
        .facts_of(&plain)
        .into_iter()
        .map(str::to_owned)
        .collect();
    let mut bringing: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for change in &changes {
        let Ok(scene) = joiner.scene(&[change]) else {
            continue;
        };
        for fact in counted.facts_of(&scene) {
            bringing.entry(fact.to_owned()).or_default().push(change);
        }
    }
    let is_other = |change: &&str| {
        let brought = bringing
            .iter()
            .filter(|(fact, changes)| changes.contains(change) && !of_plain.contains(*fact));
        let mut facts = brought.map(|(fact, _)| fact);
        facts.any(|fact| {
            ["color=", "depth=", "path."]
                .iter()
                .any(|start| fact.starts_with(start))
        })
    };
    let states = changes
        .iter()
        .copied()
        .filter(|change| !is_other(change))
        .collect();
    let mut filler = Filler {
        joiner,
        changes,
        states,
        bringing,
        plain: of_plain,
    };
    let missing = |pairs: &FactPairs| -> Vec<(usize, [String; 2])> {
        let mut missing: Vec<_> = pairs
            .pairs()
            .filter(|pair| pair.scenes == 0 && !pair.is_excluded)
            .map(|pair| {
                // States are the first kind.
                let order = pair.facts.iter().map(|f| f.kind as usize).sum();
                (order, pair.facts.map(|f| f.name.clone()))
            })
            .collect();
        missing.sort_by_key(|(order, _)| *order);
        missing
    };
    // A pair that nobody draws comes first, then pairs of states for each adapter.
    for (order, pair) in missing(&any) {
        if any.scenes([&pair[0], &pair[1]]) > 0 {
            continue;
        }
        let mut reasons = Vec::new();
        // The rasterizer, which draws everything, is the last resort for states and samples.
        let count = drawers.len() - usize::from(order > 1);
        for number in 0..count {
            match filler.fill(&pair, number, &drawers, &any)? {
                Ok(joined) => {
                    take(&filler.joiner.scene(&joined)?, &mut drawers, &mut any);
                    println!("{} {order}", CaseFile::name_of_changes(&joined));
                    reasons.clear();
                    break;
                }
                Err(reason) => reasons.push(reason),
            }
        }
        if let Some(reason) = reasons.first() {
            eprintln!("{} + {}: {reason}", pair[0], pair[1]);
        }
    }
    for number in 0..drawers.len() - 1 {
        for (order, pair) in missing(&drawers[number].pairs) {
            if order > 0 || drawers[number].pairs.scenes([&pair[0], &pair[1]]) > 0 {
                continue;
            }
            if let Ok(joined) = filler.fill(&pair, number, &drawers, &any)? {
                take(&filler.joiner.scene(&joined)?, &mut drawers, &mut any);
                println!("{} {}", CaseFile::name_of_changes(&joined), names[number]);
            }
        }
    }
    Ok(())
}

/// Adds the scene of a new case to the pairs of all that draw it.
fn take(scene: &Scene, drawers: &mut [Drawer], any: &mut FactPairs) {
    any.add(scene);
    for drawer in drawers.iter_mut().filter(|d| d.draws(scene)) {
        drawer.pairs.add(scene);
    }
}

/// Joins changes for pairs.
struct Filler<'a> {
    joiner: Joiner<'a>,
    changes: Vec<&'a str>,
    /// The changes that bring about neither formats nor paths.
    states: Vec<&'a str>,
    /// The changes that bring about a fact.
    bringing: BTreeMap<String, Vec<&'a str>>,
    /// The facts without a change.
    plain: BTreeSet<String>,
}

impl<'a> Filler<'a> {
    fn of(&self, fact: &str) -> Vec<Option<&'a str>> {
        let by_change = self
            .bringing
            .get(fact)
            .into_iter()
            .flatten()
            .copied()
            .map(Some);
        let without = self.plain.contains(fact).then_some(None);
        without.into_iter().chain(by_change).collect()
    }

    /// Returns the changes of a case in which a pair meets on an adapter, or the reason why there are none. Where one
    /// of the two never shows beside the other, it must not act, which the case shows.
    fn fill(
        &mut self,
        pair: &[String; 2],
        number: usize,
        drawers: &[Drawer],
        any: &FactPairs,
    ) -> Result<Result<Vec<&'a str>, String>, Box<dyn Error>> {
        let mut reason = "no change brings about both".to_owned();
        let mut silent: Option<Vec<&str>> = None;
        for a in self.of(&pair[0]) {
            for b in self.of(&pair[1]) {
                let joined: Vec<&str> = [a, b]
                    .into_iter()
                    .flatten()
                    .collect::<BTreeSet<_>>()
                    .into_iter()
                    .collect();
                let scene = match self.joiner.scene(&joined) {
                    Ok(scene) => scene,
                    Err(why) => {
                        reason = format!("{}: {why}", joined.join("+"));
                        continue;
                    }
                };
                let drawer = &drawers[number];
                if let Some(missing) = drawer.limits.missing(&scene.requirements()) {
                    reason = format!("{}: {missing:?} is not offered", joined.join("+"));
                    continue;
                }
                let met = drawer.pairs.missing_in(&scene);
                if !met
                    .iter()
                    .any(|p| p.facts.map(|f| &f.name) == [&pair[0], &pair[1]])
                {
                    reason = format!("{}: they do not meet in a draw", joined.join("+"));
                    continue;
                }
                // A counter shows a draw that writes nothing.
                let counted = [&joined[..], &["counter"]].concat();
                let (joined, scene) = match self.joiner.scene(&counted) {
                    Ok(counted_scene)
                        if !joined.contains(&"counter")
                            && drawers[number].draws(&counted_scene)
                            && !self.joiner.shows(&scene)? =>
                    {
                        (counted, counted_scene)
                    }
                    _ => (joined, scene),
                };
                if !self.joiner.shows(&scene)? {
                    reason = format!("{}: the draw changes nothing", joined.join("+"));
                    continue;
                }
                if self.joiner.hidden(&joined, &[], &scene)?.is_some() {
                    silent.get_or_insert(joined);
                    continue;
                }
                return Ok(Ok(self.extend(joined, &[], number, drawers, any)?));
            }
        }
        Ok(match silent {
            Some(joined) => Ok(self.extend(joined.clone(), &joined, number, drawers, any)?),
            None => Err(reason),
        })
    }

    /// Joins further changes, those with most new pairs first.
    fn extend(
        &mut self,
        mut joined: Vec<&'a str>,
        silent: &[&str],
        number: usize,
        drawers: &[Drawer],
        any: &FactPairs,
    ) -> Result<Vec<&'a str>, Box<dyn Error>> {
        let gain = |scene: &Scene| -> usize {
            let drawing = drawers.iter().filter(|d| d.draws(scene));
            let by_each: usize = drawing.map(|d| d.pairs.missing_in(scene).len()).sum();
            by_each + drawers.len() * any.missing_in(scene).len()
        };
        let mut gained = gain(&self.joiner.scene(&joined)?);
        // More adapters draw a case of states alone.
        let is_state = joined.iter().all(|change| self.states.contains(change));
        let mut refused: BTreeSet<&str> = BTreeSet::new();
        while joined.len() < MOST {
            let mut best: Option<(usize, &str)> = None;
            let changes = if is_state {
                &self.states
            } else {
                &self.changes
            };
            for change in changes {
                if joined.contains(change) || refused.contains(change) {
                    continue;
                }
                let more = [&joined[..], &[*change]].concat();
                let Ok(scene) = self.joiner.scene(&more) else {
                    refused.insert(change);
                    continue;
                };
                if !drawers[number].draws(&scene) {
                    refused.insert(change);
                    continue;
                }
                let with = gain(&scene);
                if with >= gained + WORTH && best.is_none_or(|(most, _)| with > most) {
                    best = Some((with, change));
                }
            }
            let Some((with, change)) = best else { break };
            let more = [&joined[..], &[change]].concat();
            let scene = self.joiner.scene(&more)?;
            if self.joiner.hidden(&more, silent, &scene)?.is_some() || !self.joiner.shows(&scene)? {
                refused.insert(change);
                continue;
            }
            joined = more;
            gained = with;
        }
        Ok(joined)
    }
}
