//! One case file: parsing, the product of its axes, and the cases it stands for.

use crate::error::{At, CaseError};
use crate::pairwise::{self, Cover};
use crate::random;
use crate::relation::Relation;
use crate::resolve;
use crate::states;
use crate::variants::{patch, read_back, relation, variant_scene};
use crate::wire::{AxisValue, ExpectWire, FileWire, QuickWire, RandomWire, SceneWire};
use etalon_frame::Requirement;
use etalon_methods::{Method, MethodScene, MethodWire, Parameter};
use etalon_scene::Scene;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// The most cases that one file may stand for.
const MAX_CASES: usize = 1 << 20;

/// The axis of the methods.
const METHOD: &str = "method";

/// How much of each file's product of axes is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Profile {
    /// Of files that say `"quick": "pairwise"` so many cases that every two values of every two axes
    /// meet, of those that say `"quick": { "each": 2 }` so many that every value stands in two, of those
    /// that say `"quick": { "where": … }` the cases with these values; of all others everything.
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
    /// What a method case asks; its distance from the truth is measured.
    pub method: Option<Method>,
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
            let Some(axis) = wire.axes.get(&derived.axis) else {
                return Err(fail(
                    At::new(format!("there is no axis `{}`", derived.axis))
                        .key("axis")
                        .key(name)
                        .key("derived"),
                ));
            };
            let values = derived.values.as_ref();
            if values.is_some_and(|list| list.len() != axis.len()) {
                return Err(fail(
                    At::new(format!("axis `{}` has {} values", derived.axis, axis.len()))
                        .key("values")
                        .key(name)
                        .key("derived"),
                ));
            }
        }
        if let Some(QuickWire::Where(due)) = &wire.quick {
            for (axis, name) in due {
                let values = wire.axes.get(axis).map_or(&[][..], |axis| axis);
                if !values.iter().any(|v| v.name == *name) {
                    return Err(fail(
                        At::new(format!("no axis `{axis}` has a value `{name}`"))
                            .key(axis)
                            .key("where")
                            .key("quick"),
                    ));
                }
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

    /// Whether the cases draw by methods.
    fn is_method(&self) -> bool {
        !self.wire.method.is_null()
    }

    /// The file's path below the cases folder.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The cases of a profile, the last axis (in alphabetical order) varying fastest.
    pub fn cases(&self, profile: Profile) -> impl Iterator<Item = CaseRef<'_>> {
        let indices: Vec<usize> = match (profile, &self.wire.quick) {
            (Profile::Quick, Some(QuickWire::Pairwise)) => self.covering(Cover::Pairs),
            (Profile::Quick, Some(QuickWire::Each(n))) => self.covering(Cover::Each(n.get())),
            (Profile::Quick, Some(QuickWire::First(n))) => (0..self.count.min(n.get())).collect(),
            (Profile::Quick, Some(QuickWire::Where(due))) => (0..self.count)
                .filter(|index| {
                    let at = self.positions(*index);
                    let is = |(axis, name): (&String, &String)| {
                        self.wire.axes[axis][at[axis.as_str()]].name == *name
                    };
                    due.iter().all(is)
                })
                .collect(),
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
    /// The stable id: the file's path and each axis with its value, in alphabetical order, but the
    /// method of a method case first.
    pub fn id(&self) -> String {
        let mut id = self.file.stem.clone();
        let mut axes: Vec<(&str, usize)> = self.file.positions(self.index).into_iter().collect();
        if self.file.is_method() {
            axes.sort_by_key(|(axis, _)| *axis != METHOD);
        }
        for (axis, at) in axes {
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
        if self.file.is_method() {
            return self.method_case(&values);
        }
        if wire.parameter.is_some() {
            return Err(At::new("only methods have a parameter").key("parameter"));
        }
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
            method: None,
        })
    }

    /// A scene drawn by a method.
    fn method_case(&self, values: &BTreeMap<&str, &Value>) -> Result<Case, At> {
        let wire = &self.file.wire;
        let others = [
            &wire.scene,
            &wire.random,
            &wire.states,
            &wire.relation,
            &wire.expect,
        ];
        let alone = others.into_iter().all(Value::is_null)
            && wire.variants.is_empty()
            && wire.judged_as.is_empty();
        if !alone {
            return Err(
                At::new("`method` stands alone, without a scene or relations").key("method"),
            );
        }
        let place: Vec<&str> = self.file.stem.split('/').collect();
        let ["methods", question, scene] = place[..] else {
            let message = "a method's file is methods/<question>/<scene>.json";
            return Err(At::new(message).key("method"));
        };
        let positions = self.file.positions(self.index);
        let named = |axis: &str| Some(&self.file.wire.axes[axis][*positions.get(axis)?]);
        let name = named(METHOD).ok_or_else(|| At::new("there is no axis `method`").key("axes"))?;
        let parameter = match &wire.parameter {
            None => None,
            Some(axis) => {
                let number = || named(axis)?.value.as_f64();
                let value = number().ok_or_else(|| {
                    At::new(format!("there is no axis `{axis}` with numbers")).key("parameter")
                })?;
                Some(Parameter {
                    name: axis.clone(),
                    value,
                })
            }
        };
        let make = || -> Result<MethodScene, At> {
            let wire: MethodWire = typed(&substitute(&wire.method, values)?)?;
            etalon_methods::make(&wire).map_err(|e| At::new(e.message).key(&e.key))
        };
        let made = make().map_err(|e| e.key("method"))?;
        Ok(Case {
            id: self.id(),
            about: wire.about.clone(),
            spec: wire.spec.clone(),
            scene: made.scene,
            judged_as: None,
            variants: Vec::new(),
            relation: None,
            expect: Vec::new(),
            method: Some(Method {
                question: question.to_owned(),
                scene: scene.to_owned(),
                name: name.name.clone(),
                parameter,
                truth: made.truth,
            }),
        })
    }

    /// The scene with all values in their places.
    fn scene_value(&self, values: &BTreeMap<&str, &Value>) -> Result<Value, At> {
        let wire = &self.file.wire;
        match (
            wire.scene.is_null(),
            wire.random.is_null(),
            wire.states.is_null(),
        ) {
            (false, true, true) => substitute(&wire.scene, values).map_err(|e| e.key("scene")),
            (true, true, false) => {
                let made = || states::scene(&typed(&substitute(&wire.states, values)?)?);
                made().map_err(|e| e.key("states"))
            }
            (true, false, true) => {
                let made = || -> Result<Value, At> {
                    let random: RandomWire = typed(&substitute(&wire.random, values)?)?;
                    Ok(random::scene(random.flavor, random.seed))
                };
                made().map_err(|e| e.key("random"))
            }
            (true, true, true) => Err(At::new("a case file needs a scene").key("scene")),
            (_, false, _) => Err(At::new("`random` stands instead of `scene`").key("random")),
            _ => Err(At::new("`states` stands instead of `scene`").key("states")),
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
            let given = derived.values.as_ref().and_then(|values| values.get(at));
            values.insert(name, given.unwrap_or(&list[at].value));
        }
        values
    }
}

fn is_word(text: &str) -> bool {
    !text.is_empty()
        && text
            .bytes()
            .all(|b| b.is_ascii_alphanumeric() || b"-_.+".contains(&b))
}

pub(crate) fn typed<T: DeserializeOwned>(value: &Value) -> Result<T, At> {
    serde_path_to_error::deserialize(value).map_err(At::from_typed)
}

pub(crate) fn parse_scene(value: &Value) -> Result<Scene, At> {
    resolve::scene(&typed::<SceneWire>(value)?)
}

/// Replaces every string `"$name"` by the value of that name.
pub(crate) fn substitute(value: &Value, values: &BTreeMap<&str, &Value>) -> Result<Value, At> {
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
