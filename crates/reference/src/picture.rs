//! Whole pictures. Every sample is in a *state*: the set of its possible worlds, shared by all samples with
//! the same set. A draw maps a state and a signature to another state, which is computed once, for the first
//! sample that needs it. The cost depends mostly on the number of different things that happen to texels, and
//! little on the number of texels.

use crate::notes::Notes;
use crate::sample::{Sample, SampleShape};
use crate::signature::SampleKey;
use crate::states::{OPEN, StateNumber, States};
use crate::strokes::{PassStrokes, Strokes, Tracer, runs};
use crate::texels::Lattice;
use crate::walk::{Hit, Walk, in_scissor, resolved};
use crate::world::{SampleContents, World, Worlds};
use etalon_scene::{AttachmentContents, Scene};
use rustc_hash::FxHashMap;
use smallvec::SmallVec;
use std::collections::BTreeSet;

/// Outcomes of single draws, by state, draw and signature.
#[derive(Debug, Default)]
struct DrawOutcomes {
    by_words: FxHashMap<SmallVec<[u64; 6]>, StateNumber>,
    key: SmallVec<[u64; 6]>,
    /// For each draw, the number of outcomes that were looked up and the number found.
    asked: Vec<[u32; 2]>,
}

impl DrawOutcomes {
    /// Returns true if outcomes of a draw recur often enough to keep them. If every sample has its own
    /// signature, as with interpolated depths or a shader that reads its position, a cache costs more than it
    /// saves.
    fn pays(&self, draw: u32) -> bool {
        const TRIED: u32 = 512;
        let [asked, found] = self.asked.get(draw as usize).copied().unwrap_or_default();
        asked < TRIED || found >= asked / 16
    }

    /// Notes whether an outcome was known.
    fn note(&mut self, draw: u32, found: bool) {
        let needed = self.asked.len().max(draw as usize + 1);
        self.asked.resize(needed, [0; 2]);
        let [asked, known] = &mut self.asked[draw as usize];
        *asked += 1;
        *known += u32::from(found);
    }
}

impl Walk<'_> {
    /// Walks the pictures of some shapes through all passes; [`Walk::earlier`] then answers for every judged
    /// sample. `strokes` are the kept strokes of each pass.
    pub(crate) fn paint(&self, shapes: &[SampleShape], strokes: &[Option<PassStrokes>]) {
        {
            let mut pictures = self.pictures.borrow_mut();
            for shape in shapes {
                pictures.shapes.push(*shape);
                let samples = self.first_states(*shape, &mut pictures.states);
                pictures.samples.push(samples);
            }
        }
        for p in 0..self.scene.passes.len() {
            self.paint_pass(p, strokes.get(p).and_then(Option::as_ref));
            self.paint_resolves(p);
        }
    }

    /// Returns the states before the first pass.
    fn first_states(&self, (size, samples): SampleShape, states: &mut States) -> Vec<StateNumber> {
        let count = size[0] as usize * size[1] as usize * samples as usize;
        let lattice = self.texels.lattice(size);
        let attachments = || self.scene.attachments.iter().enumerate();
        // Textures that no pass draws to are not part of the state.
        let held = held(self.scene, (size, samples));
        let uploaded = attachments().filter(|(index, _)| held[*index]);
        let uploaded: Vec<(usize, usize)> = uploaded
            .filter(|(_, a)| matches!(a.contents, AttachmentContents::Texels(_)))
            .map(|(index, a)| (index, a.format.color_channels().len()))
            .collect();
        let sample_at = |x: u32, y: u32| Sample {
            size,
            samples,
            x,
            y,
            sample: 0,
        };
        let alone = |at: Sample| -> Option<Worlds> {
            let cells = attachments().map(|(index, _)| {
                if held[index] {
                    self.first_contents(index, [at.x as usize, at.y as usize])
                } else {
                    SampleContents::default()
                }
            });
            let mut worlds: Worlds = SmallVec::new();
            worlds.push(World {
                cells: cells.collect(),
                ..World::default()
            });
            Some(worlds)
        };
        if uploaded.is_empty() {
            let state = states.number(alone(sample_at(0, 0)));
            if lattice == Lattice::ALL {
                return vec![state; count];
            }
            let mut picture = vec![OPEN; count];
            for_each_judged(lattice, size, |x, y| {
                let start = sample_at(x, y).place();
                picture[start..start + samples as usize].fill(state);
            });
            return picture;
        }
        let mut picture = vec![OPEN; count];
        let mut known: FxHashMap<SmallVec<[u32; 8]>, StateNumber> = FxHashMap::default();
        let mut key: SmallVec<[u32; 8]> = SmallVec::new();
        for_each_judged(lattice, size, |x, y| {
            key.clear();
            let texel = y as usize * size[0] as usize + x as usize;
            for (index, channels) in &uploaded {
                if let AttachmentContents::Texels(codes) = &self.scene.attachments[*index].contents
                {
                    key.extend_from_slice(&codes[texel * channels..(texel + 1) * channels]);
                }
            }
            let state = match known.get(&key) {
                Some(state) => *state,
                None => {
                    let state = states.number(alone(sample_at(x, y)));
                    known.insert(key.clone(), state);
                    state
                }
            };
            let start = sample_at(x, y).place();
            picture[start..start + samples as usize].fill(state);
        });
        picture
    }

    fn paint_pass(&self, p: usize, strokes: Option<&PassStrokes>) {
        let pass = &self.scene.passes[p];
        let shape = (self.scene.pass_size(pass), self.scene.pass_samples(pass));
        let Some(index) = self.pictures.borrow().shape(shape) else {
            return;
        };
        // Draws with textures can see the picture before the pass.
        let is_seen = pass.draws.iter().any(|draw| !draw.textures.is_empty());
        let mut picture = if is_seen {
            self.pictures.borrow().samples[index].clone()
        } else {
            std::mem::take(&mut self.pictures.borrow_mut().samples[index])
        };
        if !pass.cleared().is_empty() {
            self.each_state(&mut picture, |worlds| {
                self.load(p, worlds, &mut Notes(None));
            });
        }
        let tracer = strokes.is_none().then(|| Tracer::new(self, p));
        for (run, draws) in runs(pass).enumerate() {
            if !draws.is_empty() {
                let mut brush = Brush {
                    walk: self,
                    pass: p,
                    picture: &mut picture,
                    known: DrawOutcomes::default(),
                };
                match (&tracer, strokes) {
                    (Some(tracer), _) => tracer.trace(draws.clone(), &mut brush),
                    (None, Some(strokes)) => strokes[run].repeat(&mut brush),
                    (None, None) => {}
                }
            }
            self.paint_clears((p, draws.end), shape, &mut picture);
        }
        self.paint_open_draws(p, shape, &mut picture);
        if pass
            .draws
            .iter()
            .any(|d| d.multisample.sample_coverage.is_some())
        {
            self.each_state(&mut picture, |worlds| self.end_pass(worlds));
        }
        self.pictures.borrow_mut().samples[index] = picture;
    }

    /// Makes the samples of draws with unknown vertices open. Such draws can cover any texel, even one that
    /// no known primitive touches.
    fn paint_open_draws(
        &self,
        p: usize,
        (size, samples): SampleShape,
        picture: &mut [StateNumber],
    ) {
        let draws = self.scene.passes[p].draws.iter();
        for (draw, texts) in draws.zip(&self.open_texts[p]) {
            if !texts.vertices || draw.rasterizer_discard {
                continue;
            }
            for_each_judged(self.texels.lattice(size), size, |x, y| {
                let at = Sample {
                    size,
                    samples,
                    x,
                    y,
                    sample: 0,
                };
                if in_scissor(draw, at) {
                    picture[at.place()..at.place() + samples as usize].fill(OPEN);
                }
            });
        }
    }

    /// Executes the clear commands before a draw, or at the end of the pass.
    fn paint_clears(
        &self,
        (p, draw): (usize, usize),
        (size, samples): SampleShape,
        picture: &mut [StateNumber],
    ) {
        let clears = self.scene.passes[p].clears_before(draw);
        if clears.is_empty() {
            return;
        }
        let clear = |at: Sample, worlds: &mut Worlds| {
            self.clear((p, draw), at, worlds, &mut Notes(None));
        };
        if clears.iter().all(|clear| clear.rect.is_none()) {
            let anywhere = Sample {
                size,
                samples,
                x: 0,
                y: 0,
                sample: 0,
            };
            self.each_state(picture, |worlds| clear(anywhere, worlds));
            return;
        }
        // The same clears contain all texels of a row between two columns.
        let sides = clears.iter().filter_map(|clear| clear.rect);
        let sides = sides.flat_map(|[left, _, width, _]| [left, left.saturating_add(width)]);
        let columns: BTreeSet<u32> = sides.chain([0, u32::MAX]).map(|x| x.min(size[0])).collect();
        let columns = Vec::from_iter(columns);
        let mut known: FxHashMap<(StateNumber, SmallVec<[bool; 8]>), StateNumber> =
            FxHashMap::default();
        for y in 0..size[1] {
            for part in columns.windows(2) {
                let [at, end] = [part[0], part[1]].map(|x| Sample {
                    size,
                    samples,
                    x,
                    y,
                    sample: 0,
                });
                let inside = |rect: Option<[u32; 4]>| {
                    rect.is_none_or(|[left, top, w, h]| {
                        at.x >= left && y >= top && at.x - left < w && y - top < h
                    })
                };
                let inside: SmallVec<[bool; 8]> = clears.iter().map(|c| inside(c.rect)).collect();
                if !inside.contains(&true) {
                    continue;
                }
                for run in picture[at.place()..end.place()].chunk_by_mut(|a, b| a == b) {
                    let before = run[0];
                    let after = known.entry((before, inside.clone()));
                    run.fill(
                        *after.or_insert_with(|| self.changed(before, |worlds| clear(at, worlds))),
                    );
                }
            }
        }
    }

    /// Changes the worlds of all samples in the same way.
    fn each_state(&self, picture: &mut [StateNumber], change: impl Fn(&mut Worlds)) {
        let mut known: FxHashMap<StateNumber, StateNumber> = FxHashMap::default();
        for run in picture.chunk_by_mut(|a, b| a == b) {
            let before = run[0];
            let after = known.entry(before);
            run.fill(*after.or_insert_with(|| self.changed(before, &change)));
        }
    }

    /// Returns a state after a change of its worlds.
    fn changed(&self, state: StateNumber, change: impl Fn(&mut Worlds)) -> StateNumber {
        let worlds = self.pictures.borrow().states.worlds(state).cloned();
        let changed = worlds.map(|worlds| {
            let mut worlds = Worlds::clone(&worlds);
            change(&mut worlds);
            worlds
        });
        self.pictures.borrow_mut().states.number(changed)
    }

    fn paint_resolves(&self, p: usize) {
        let pass = &self.scene.passes[p];
        let mut shapes: Vec<SampleShape> = Vec::new();
        for target in pass.resolve_targets() {
            let attachment = &self.scene.attachments[target];
            let shape = (attachment.size, attachment.samples);
            if !shapes.contains(&shape) && self.pictures.borrow().shape(shape).is_some() {
                shapes.push(shape);
            }
        }
        for shape in shapes {
            self.paint_resolves_into(p, shape);
        }
    }

    /// Resolves into the attachments of one shape.
    fn paint_resolves_into(&self, p: usize, (size, samples): SampleShape) {
        let pass = &self.scene.passes[p];
        let source_samples = self.scene.pass_samples(pass);
        let mut picture = self.pictures.borrow().of_shape((size, samples)).to_vec();
        let mut known: FxHashMap<SmallVec<[StateNumber; 9]>, StateNumber> = FxHashMap::default();
        for_each_judged(self.texels.lattice(size), size, |x, y| {
            let at = Sample {
                size,
                samples,
                x,
                y,
                sample: 0,
            };
            let place = at.place();
            if picture[place] == OPEN {
                return;
            }
            let sources = (0..source_samples).map(|sample| Sample {
                samples: source_samples,
                sample,
                ..at
            });
            let mut key: SmallVec<[StateNumber; 9]> = SmallVec::new();
            key.push(picture[place]);
            key.extend(sources.map(|source| self.pictures.borrow().state(source)));
            picture[place] = match known.get(&key) {
                Some(state) => *state,
                None => {
                    let before = self
                        .pictures
                        .borrow()
                        .states
                        .worlds(picture[place])
                        .cloned();
                    let after = before.and_then(|worlds| {
                        let mut worlds = Worlds::clone(&worlds);
                        for (source, target) in self.resolves_into(p, at) {
                            let outcomes =
                                self.resolve(source, target, at, p + 1, &mut Notes(None))?;
                            worlds = resolved(&worlds, target, &outcomes)?;
                        }
                        self.resolve_depth_stencil(p, at, &mut worlds, &mut Notes(None))?;
                        Some(worlds)
                    });
                    let state = self.pictures.borrow_mut().states.number(after);
                    known.insert(key, state);
                    state
                }
            };
        });
        let mut pictures = self.pictures.borrow_mut();
        if let Some(shape) = pictures.shape((size, samples)) {
            pictures.samples[shape] = picture;
        }
    }
}

/// Returns for each attachment whether it has a shape and is drawn to or read back.
fn held(scene: &Scene, (size, samples): SampleShape) -> Vec<bool> {
    let mut held = vec![false; scene.attachments.len()];
    for index in drawn_or_read(scene) {
        let attachment = &scene.attachments[index];
        held[index] = (attachment.size, attachment.samples) == (size, samples);
    }
    held
}

/// Returns the attachments that a scene draws to, clears, resolves to or reads back.
fn drawn_or_read(scene: &Scene) -> impl Iterator<Item = usize> {
    let of_passes = scene.passes.iter().flat_map(|pass| {
        let attachments = pass.color.iter().chain(&pass.depth_stencil).copied();
        attachments.chain(pass.resolve_targets())
    });
    scene.read.iter().copied().chain(of_passes)
}

/// Returns the shapes of all attachments that a scene draws to or reads back.
pub(crate) fn shapes(scene: &Scene) -> Vec<SampleShape> {
    let shape = |index: usize| {
        (
            scene.attachments[index].size,
            scene.attachments[index].samples,
        )
    };
    let shapes: BTreeSet<SampleShape> = drawn_or_read(scene).map(shape).collect();
    shapes.into_iter().collect()
}

/// Calls `found` with every judged texel, row by row.
fn for_each_judged(lattice: Lattice, [width, height]: [u32; 2], mut found: impl FnMut(u32, u32)) {
    for y in 0..height {
        let mut next = 0;
        while let Some(x) = lattice.first(next, y)
            && x < width
        {
            found(x, y);
            next = x + 1;
        }
    }
}

/// The draws of one pass, applied to a picture.
struct Brush<'b, 'a> {
    walk: &'b Walk<'a>,
    pass: usize,
    picture: &'b mut [StateNumber],
    known: DrawOutcomes,
}

impl Strokes for Brush<'_, '_> {
    fn names_inputs(&self, draw: u32) -> bool {
        self.known.pays(draw)
    }

    fn stroke(&mut self, first: Sample, end: u32, signature: &SampleKey) {
        if signature.varies {
            for x in first.x..end {
                self.texel(Sample { x, ..first }, signature);
            }
            return;
        }
        let step = first.samples as usize;
        let mut x = first.x;
        while x < end {
            let at = Sample { x, ..first };
            let before = self.picture[at.place()];
            self.texel(at, signature);
            // Texels in the same state end in the same state.
            let run = &mut self.picture[at.place()..];
            let after = run[0];
            let rest = run
                .iter_mut()
                .step_by(step)
                .take((end - x) as usize)
                .skip(1);
            let same = rest.take_while(|state| **state == before);
            x += 1 + same.map(|state| *state = after).count() as u32;
        }
    }
}

impl Brush<'_, '_> {
    /// Draws over one sample.
    fn texel(&mut self, at: Sample, signature: &SampleKey) {
        let place = at.place();
        let mut state = self.picture[place];
        for (i, part) in signature.parts.iter().enumerate() {
            if state == OPEN {
                break;
            }
            if !self.known.pays(part.draw) {
                state = self.draw(at, state, part.draw, signature.hits_of(i));
                continue;
            }
            let known = &mut self.known;
            known.key.clear();
            known
                .key
                .push(u64::from(state) | u64::from(part.draw) << 32);
            known.key.extend_from_slice(signature.words_of(i));
            let found = known.by_words.get(&known.key).copied();
            known.note(part.draw, found.is_some());
            state = match found {
                Some(state) => state,
                None => {
                    let key = known.key.clone();
                    let after = self.draw(at, state, part.draw, signature.hits_of(i));
                    self.known.by_words.insert(key, after);
                    after
                }
            };
        }
        self.picture[place] = state;
    }

    /// Returns the state of a sample after one draw, with the primitives of the draw that cover the sample.
    fn draw(&self, at: Sample, before: StateNumber, draw: u32, hits: &[(u32, Hit)]) -> StateNumber {
        let primitives = self.walk.setups[self.pass].primitives_of(draw as usize);
        let hits = hits
            .iter()
            .map(|(i, hit)| (&primitives[*i as usize], Ok(*hit)));
        let Some(worlds) = self.walk.pictures.borrow().states.worlds(before).cloned() else {
            return OPEN;
        };
        let draw = (self.pass, draw as usize);
        let after = self.walk.draw(at, draw, hits, &worlds, &mut Notes(None));
        if after.as_ref() == Some(&*worlds) {
            return before;
        }
        self.walk.pictures.borrow_mut().states.number(after)
    }
}
