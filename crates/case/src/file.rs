//! One case file: parsing, the product of its axes, and the cases it stands for.

use crate::draw::write_mask;
use crate::error::{At, CaseError};
use crate::pairwise::{self, Cover};
use crate::random;
use crate::relation::Relation;
use crate::resolve;
use crate::scene::Scene;
use crate::wire::{
    AxisValue, ExpectWire, FileWire, QuickWire, RandomWire, RelationWire, SceneWire, VariantWire,
};
use etalon_frame::Requirement;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// The most cases that one file may stand for.
const MAX_CASES: usize = 1 << 20;

/// How much of each file's product of axes is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Profile {
    /// Of files that say `"quick": "pairwise"` so many cases that every two values of every two axes
    /// meet, of those that say `"quick": { "each": 2 }` so many that every value stands in two; of
    /// all others everything.
    #[default]
    Quick,
    /// Everything.
    Full,
}

/// A parsed case file.
#[derive(Clone, Debug)]
pub struct CaseFile {
    name: String,
    stem: String,
    text: String,
    wire: FileWire,
    count: usize,
}

/// One case of a file, by its place in the product of the axes.
#[derive(Clone, Copy, Debug)]
pub struct CaseRef<'a> {
    file: &'a CaseFile,
    index: usize,
}

/// One fully expanded unit of work.
#[derive(Clone, Debug)]
pub struct Case {
    /// The stable id.
    pub id: String,
    /// What the case proves.
    pub about: String,
    /// The clauses that bind.
    pub spec: Vec<String>,
    /// What adapters draw.
    pub scene: Scene,
    /// Selftests: the scene that the judge believes was drawn; a Fail is due.
    pub judged_as: Option<Scene>,
    /// The scene with changes, each drawn too.
    pub variants: Vec<Variant>,
    /// What the frames of scene and variants have to do with each other.
    pub relation: Option<Relation>,
    /// Literal values that must come back.
    pub expect: Vec<Expect>,
}

/// A scene with changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// Its name in records.
    pub name: String,
    /// What adapters draw.
    pub scene: Scene,
}

/// One literal colour that must come back.
#[derive(Clone, Debug, PartialEq)]
pub struct Expect {
    /// Index into the scene's attachments.
    pub attachment: usize,
    /// Column and row.
    pub texel: [u32; 2],
    /// The values, channel by channel.
    pub value: Vec<f64>,
}

impl Case {
    /// The scene that the judge looks at.
    pub fn judged_scene(&self) -> &Scene {
        self.judged_as.as_ref().unwrap_or(&self.scene)
    }

    /// Everything that adapters draw for the case: the scene, then its variants.
    pub fn scenes(&self) -> impl Iterator<Item = &Scene> {
        let variants = self.variants.iter().map(|v| &v.scene);
        std::iter::once(&self.scene).chain(variants)
    }

    /// How many scenes are drawn.
    pub fn scene_count(&self) -> usize {
        1 + self.variants.len()
    }

    /// What the case needs of an adapter, without repetition, in ascending order.
    pub fn requirements(&self) -> Vec<Requirement> {
        let all: BTreeSet<_> = self.scenes().flat_map(Scene::requirements).collect();
        all.into_iter().collect()
    }

    /// The first part of the id.
    pub fn area(&self) -> &str {
        self.id.split('/').next().unwrap_or_default()
    }
}

impl CaseFile {
    /// Parses a case file. `name` is the path below the cases folder, with `.json`.
    ///
    /// # Errors
    /// With file, line and key, when the text is not JSON, a key is unknown or an axis is unusable.
    /// Scenes are checked by [`CaseRef::build`].
    pub fn parse(name: &str, text: &str) -> Result<Self, CaseError> {
        let fail = |at: At| at.locate(name, text);
        let value: Value = serde_json::from_str(text).map_err(|e| CaseError {
            file: name.to_owned(),
            line: e.line(),
            key: String::new(),
            message: format!("not valid JSON: {e}"),
        })?;
        let wire: FileWire = typed(&value).map_err(fail)?;
        let stem = name.strip_suffix(".json").unwrap_or(name).to_owned();
        if !stem.split('/').all(is_word) {
            return Err(fail(At::new(
                "the file's path becomes part of ids: letters, digits, '-', '_' and '.' only",
            )));
        }
        let mut count = 1_usize;
        for (axis, values) in &wire.axes {
            let values: &[AxisValue] = values;
            let bad = |message: &str| fail(At::new(message).key(axis).key("axes"));
            if !is_word(axis) {
                return Err(bad(
                    "an axis's name is made of letters, digits, '-', '_' and '.'",
                ));
            }
            if values.is_empty() {
                return Err(bad("an axis needs a value"));
            }
            for (i, value) in values.iter().enumerate() {
                let bad = |message: String| fail(At::new(message).index(i).key(axis).key("axes"));
                if !is_word(&value.name) {
                    return Err(bad(format!(
                        "`{}` would stand in ids: letters, digits, '-', '_', '+' and '.' only; give it a name",
                        value.name
                    )));
                }
                if values[..i].iter().any(|v| v.name == value.name) {
                    return Err(bad(format!("`{}` is named twice", value.name)));
                }
            }
            count = count
                .checked_mul(values.len())
                .filter(|n| *n <= MAX_CASES)
                .ok_or_else(|| bad("the product of the axes is too large"))?;
        }
        for (name, derived) in &wire.derived {
            if wire.axes.contains_key(name) {
                return Err(fail(
                    At::new("an axis has this name already")
                        .key(name)
                        .key("derived"),
                ));
            }
            if !wire.axes.contains_key(&derived.axis) {
                return Err(fail(
                    At::new(format!("there is no axis `{}`", derived.axis))
                        .key("axis")
                        .key(name)
                        .key("derived"),
                ));
            }
        }
        Ok(Self {
            name: name.to_owned(),
            stem,
            text: text.to_owned(),
            wire,
            count,
        })
    }

    /// The file's path below the cases folder.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The cases of a profile, the last axis (in alphabetical order) varying fastest.
    pub fn cases(&self, profile: Profile) -> impl Iterator<Item = CaseRef<'_>> {
        let indices: Vec<usize> = match (profile, self.wire.quick) {
            (Profile::Quick, Some(QuickWire::Pairwise)) => self.covering(Cover::Pairs),
            (Profile::Quick, Some(QuickWire::Each(n))) => self.covering(Cover::Each(n.get())),
            (Profile::Quick, Some(QuickWire::First(n))) => (0..self.count.min(n.get())).collect(),
            _ => (0..self.count).collect(),
        };
        let one = move |index| CaseRef { file: self, index };
        indices.into_iter().map(one)
    }

    /// Places in the product of a covering array's rows, ascending.
    fn covering(&self, cover: Cover) -> Vec<usize> {
        let lengths: Vec<usize> = self.wire.axes.values().map(|axis| axis.len()).collect();
        let index = |row: &Vec<usize>| {
            let axes = row.iter().zip(&lengths);
            axes.fold(0, |index, (at, length)| index * length + at)
        };
        let mut all: Vec<usize> = pairwise::rows(&lengths, cover).iter().map(index).collect();
        all.sort_unstable();
        all
    }

    fn positions(&self, mut index: usize) -> BTreeMap<&str, usize> {
        let mut positions = BTreeMap::new();
        for (axis, values) in self.wire.axes.iter().rev() {
            positions.insert(axis.as_str(), index % values.len());
            index /= values.len();
        }
        positions
    }
}

impl CaseRef<'_> {
    /// The stable id: the file's path and each axis with its value, in alphabetical order.
    pub fn id(&self) -> String {
        let mut id = self.file.stem.clone();
        for (axis, at) in self.file.positions(self.index) {
            id.push('/');
            id.push_str(axis);
            id.push('=');
            id.push_str(&self.file.wire.axes[axis][at].name);
        }
        id
    }

    /// Builds the case.
    ///
    /// # Errors
    /// With file, line and key, when a value is of the wrong type or a state is impossible.
    pub fn build(&self) -> Result<Case, CaseError> {
        self.try_build()
            .map_err(|at| at.locate(&self.file.name, &self.file.text))
    }

    fn try_build(&self) -> Result<Case, At> {
        let wire = &self.file.wire;
        let values = self.values();
        let scene_value = self.scene_value(&values)?;
        let scene = parse_scene(&scene_value).map_err(|e| e.key("scene"))?;
        let variants = wire
            .variants
            .iter()
            .enumerate()
            .map(|(i, variant)| {
                variant_scene(&scene_value, variant, &values)
                    .map_err(|e| e.index(i).key("variants"))
            })
            .collect::<Result<Vec<_>, At>>()?;
        let relation =
            relation(&wire.relation, &values, &scene, &variants).map_err(|e| e.key("relation"))?;
        let judged_as = if wire.judged_as.is_empty() {
            None
        } else {
            let mut judged = scene_value;
            patch(&mut judged, &wire.judged_as, &values).map_err(|e| e.key("judged_as"))?;
            Some(parse_scene(&judged).map_err(|e| e.key("judged_as"))?)
        };
        let expect = self.expect(&scene, &values).map_err(|e| e.key("expect"))?;
        Ok(Case {
            id: self.id(),
            about: wire.about.clone(),
            spec: wire.spec.clone(),
            scene,
            judged_as,
            variants,
            relation,
            expect,
        })
    }

    /// The scene with all values in their places.
    fn scene_value(&self, values: &BTreeMap<&str, &Value>) -> Result<Value, At> {
        let wire = &self.file.wire;
        match (wire.scene.is_null(), wire.random.is_null()) {
            (false, true) => substitute(&wire.scene, values).map_err(|e| e.key("scene")),
            (true, false) => {
                let made = || -> Result<Value, At> {
                    let random: RandomWire = typed(&substitute(&wire.random, values)?)?;
                    Ok(random::scene(random.flavor, random.seed))
                };
                made().map_err(|e| e.key("random"))
            }
            (false, false) => Err(At::new("`random` stands instead of `scene`").key("random")),
            (true, true) => Err(At::new("a case file needs a scene").key("scene")),
        }
    }

    fn expect(&self, scene: &Scene, values: &BTreeMap<&str, &Value>) -> Result<Vec<Expect>, At> {
        let wire = &self.file.wire;
        if wire.expect.is_null() {
            return Ok(Vec::new());
        }
        let value = substitute(&wire.expect, values)?;
        let list: Vec<ExpectWire> = typed(&value)?;
        let mut result = Vec::new();
        for (i, e) in list.into_iter().enumerate() {
            let attachment =
                read_back(scene, &e.attachment).map_err(|e| e.key("attachment").index(i))?;
            let target = &scene.attachments[attachment];
            let channels = target.format.color_channels().len();
            if channels == 0 || e.value.len() != channels {
                return Err(
                    At::new(format!("{} has {channels} colour channels", target.format))
                        .key("value")
                        .index(i),
                );
            }
            if e.texel[0] >= target.size[0] || e.texel[1] >= target.size[1] {
                return Err(At::new("the texel lies outside").key("texel").index(i));
            }
            result.push(Expect {
                attachment,
                texel: e.texel,
                value: e.value,
            });
        }
        Ok(result)
    }

    fn values(&self) -> BTreeMap<&str, &Value> {
        let wire = &self.file.wire;
        let positions = self.file.positions(self.index);
        let mut values: BTreeMap<&str, &Value> = positions
            .iter()
            .map(|(axis, at)| (*axis, &wire.axes[*axis][*at].value))
            .collect();
        for (name, derived) in &wire.derived {
            let list = &wire.axes[&derived.axis];
            let at = (positions[derived.axis.as_str()] + derived.shift) % list.len();
            values.insert(name, &list[at].value);
        }
        values
    }
}

/// The value of a scene at a JSON pointer.
fn value_at<'v>(scene: &'v mut Value, pointer: &str) -> Result<&'v mut Value, At> {
    let missing = || At::new("the scene has no value at this JSON pointer");
    scene.pointer_mut(pointer).ok_or_else(missing)
}

/// Changes a scene: JSON pointers and what stands there instead.
fn patch(
    scene: &mut Value,
    changes: &BTreeMap<String, Value>,
    values: &BTreeMap<&str, &Value>,
) -> Result<(), At> {
    for (pointer, value) in changes {
        let mut change = || -> Result<(), At> {
            let target = value_at(scene, pointer)?;
            *target = substitute(value, values)?;
            Ok(())
        };
        change().map_err(|e| e.key(pointer))?;
    }
    Ok(())
}

/// The attachment of a name that is read back.
fn read_back(scene: &Scene, name: &str) -> Result<usize, At> {
    let mut read = scene.read.iter().copied();
    read.find(|index| scene.attachments[*index].name == name)
        .ok_or_else(|| At::new(format!("`{name}` is not read back")))
}

/// The scene with a variant's changes.
fn variant_scene(
    scene: &Value,
    wire: &VariantWire,
    values: &BTreeMap<&str, &Value>,
) -> Result<Variant, At> {
    let mut changed = scene.clone();
    patch(&mut changed, &wire.patch, values).map_err(|e| e.key("patch"))?;
    for (pointer, order) in &wire.permute {
        let mut permute = || -> Result<(), At> {
            let items = value_at(&mut changed, pointer)?
                .as_array_mut()
                .ok_or_else(|| At::new("this is no list"))?;
            let mut seen = order.clone();
            seen.sort_unstable();
            if !seen.into_iter().eq(0..items.len()) {
                return Err(At::new(format!(
                    "an order names each of the {} items once, from 0",
                    items.len()
                )));
            }
            *items = order.iter().map(|i| items[*i].clone()).collect();
            Ok(())
        };
        permute().map_err(|e| e.key(pointer).key("permute"))?;
    }
    Ok(Variant {
        name: wire.name.clone(),
        scene: parse_scene(&changed)?,
    })
}

/// What the frames have to do with each other, checked against the scenes.
fn relation(
    value: &Value,
    values: &BTreeMap<&str, &Value>,
    scene: &Scene,
    variants: &[Variant],
) -> Result<Option<Relation>, At> {
    if value.is_null() {
        return match variants {
            [] => Ok(None),
            _ => Err(At::new(
                "variants need a relation, or nothing is asserted of them",
            )),
        };
    }
    let wire: RelationWire = typed(&substitute(value, values)?)?;
    let mut attachments = Vec::new();
    for (i, name) in wire.attachments.iter().enumerate() {
        let index = read_back(scene, name).map_err(|e| e.index(i).key("attachments"))?;
        attachments.push(index);
    }
    let key = |index: &usize| {
        let a = &scene.attachments[*index];
        (a.format, a.size, a.samples)
    };
    if attachments
        .windows(2)
        .any(|pair| key(&pair[0]) != key(&pair[1]))
    {
        let message = "the attachments differ in format, size or samples";
        return Err(At::new(message).key("attachments"));
    }
    if attachments.len() < 2 && variants.is_empty() {
        return Err(At::new("a relation needs variants or two attachments"));
    }
    let shape = |scene: &Scene| -> Vec<_> {
        let read = scene.read.iter().map(|i| &scene.attachments[*i]);
        read.map(|a| (a.name.clone(), a.format, a.size, a.samples))
            .collect()
    };
    if let Some(other) = variants.iter().find(|v| shape(&v.scene) != shape(scene)) {
        return Err(At::new(format!(
            "variant `{}` reads other images back than the scene",
            other.name
        )));
    }
    Ok(Some(Relation {
        invariance: wire.same,
        within: wire.within,
        channels: write_mask(&wire.channels).map_err(|e| e.key("channels"))?,
        offset: wire.offset,
        attachments,
    }))
}

fn is_word(text: &str) -> bool {
    !text.is_empty()
        && text
            .bytes()
            .all(|b| b.is_ascii_alphanumeric() || b"-_.+".contains(&b))
}

fn typed<T: DeserializeOwned>(value: &Value) -> Result<T, At> {
    serde_path_to_error::deserialize(value).map_err(At::from_typed)
}

fn parse_scene(value: &Value) -> Result<Scene, At> {
    resolve::scene(&typed::<SceneWire>(value)?)
}

/// Replaces every string `"$name"` by the value of that name.
fn substitute(value: &Value, values: &BTreeMap<&str, &Value>) -> Result<Value, At> {
    Ok(match value {
        Value::String(text) => match text.strip_prefix('$') {
            None => value.clone(),
            Some(name) => match values.get(name) {
                Some(found) => (*found).clone(),
                None => {
                    let known: Vec<&str> = values.keys().copied().collect();
                    return Err(At::new(format!(
                        "there is no axis or derived value `{name}`; there are: {}",
                        known.join(", ")
                    )));
                }
            },
        },
        Value::Array(list) => Value::Array(
            list.iter()
                .enumerate()
                .map(|(i, v)| substitute(v, values).map_err(|e| e.index(i)))
                .collect::<Result<_, _>>()?,
        ),
        Value::Object(map) => Value::Object(
            map.iter()
                .map(|(k, v)| {
                    let v = substitute(v, values).map_err(|e| e.key(k))?;
                    Ok((k.clone(), v))
                })
                .collect::<Result<_, At>>()?,
        ),
        Value::Null | Value::Bool(_) | Value::Number(_) => value.clone(),
    })
}
