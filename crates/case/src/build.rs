//! Building a case from its index in a file.

use crate::attachment::read_back;
use crate::case::{Case, ExpectedTexel};
use crate::error::{At, CaseError};
use crate::file::{CaseRef, METHOD};
use crate::random;
use crate::relation::relation;
use crate::resolve::{check_content, parse_scene};
use crate::sequence;
use crate::states;
use crate::values::{substitute, typed};
use crate::variants::{patch, read_again, variant_scene};
use crate::wire::{ExpectWire, RandomWire, SceneSource};
use etalon_methods::{Method, MethodParameter, MethodScene, MethodWire};
use etalon_scene::Scene;
use serde_json::Value;
use std::collections::BTreeMap;

impl CaseRef<'_> {
    /// Builds the case.
    ///
    /// # Errors
    /// With file, line and key, if a value is of the wrong type or a state is impossible.
    pub fn build(&self) -> Result<Case, CaseError> {
        self.try_build().map_err(|error| {
            let blamed = self.blame(error);
            blamed.locate(self.file.name(), &self.file.text)
        })
    }

    pub(crate) fn try_build(&self) -> Result<Case, At> {
        let wire = &self.file.wire;
        let values = self.values();
        if let SceneSource::Method(method) = &self.file.source {
            return self.method_case(method, &values);
        }
        if wire.parameter.is_some() {
            return Err(At::new("only methods have a parameter").key("parameter"));
        }
        let scene_value = self.scene_value(&values)?;
        let scene = parse_scene(&scene_value).map_err(|e| e.key("scene"))?;
        let again = read_again(&scene, &wire.submissions).map_err(|e| e.key("submissions"))?;
        let changed = wire
            .variants
            .iter()
            .enumerate()
            .map(|(i, variant)| {
                variant_scene(&scene_value, variant, &values)
                    .map_err(|e| e.index(i).key("variants"))
            })
            .collect::<Result<Vec<_>, At>>()?;
        let variants = [again, changed].concat();
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
            measured: self.file.is_measured(),
            method: None,
        })
    }

    /// Returns the case of a scene drawn by a method.
    pub(crate) fn method_case(
        &self,
        method: &Value,
        values: &BTreeMap<&str, &Value>,
    ) -> Result<Case, At> {
        let wire = &self.file.wire;
        let alone = [&wire.relation, &wire.expect]
            .into_iter()
            .all(Value::is_null)
            && wire.variants.is_empty()
            && wire.submissions.is_empty()
            && wire.judged_as.is_empty();
        if !alone {
            return Err(
                At::new("`method` excludes variants, relations and literal values").key("method"),
            );
        }
        let place: Vec<&str> = self.file.stem.split('/').collect();
        let ["methods", question, scene] = place[..] else {
            let message = "the path of a method's file must be methods/<question>/<scene>.json";
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
                Some(MethodParameter {
                    name: axis.clone(),
                    value,
                })
            }
        };
        let make = || -> Result<MethodScene, At> {
            let made = if let Some(model) = &self.file.model {
                model.draw(question, &name.name)
            } else {
                let wire: MethodWire = typed(&substitute(method, values)?)?;
                etalon_methods::make(&wire)
            };
            let made = made.map_err(|e| At::new(e.message).key(&e.key))?;
            check_content(&made.scene)?;
            Ok(made)
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
            measured: self.file.is_measured(),
            method: Some(Method {
                question: question.to_owned(),
                scene: scene.to_owned(),
                name: name.name.clone(),
                parameter,
                truth: made.truth,
            }),
        })
    }

    /// Returns the scene with all values substituted.
    pub(crate) fn scene_value(&self, values: &BTreeMap<&str, &Value>) -> Result<Value, At> {
        let source = &self.file.source;
        let make = || -> Result<Value, At> {
            let value = substitute(source.value(), values)?;
            match source {
                SceneSource::Random(_) => {
                    let random: RandomWire = typed(&value)?;
                    Ok(random::scene(random.flavor, random.seed))
                }
                SceneSource::States(_) => states::scene(&typed(&value)?),
                SceneSource::Sequence(_) => sequence::scene(&typed(&value)?),
                SceneSource::Scene(_) | SceneSource::Method(_) => Ok(value),
            }
        };
        let made = make().map_err(|e| e.key(source.key()))?;
        self.changed(made, values)
    }

    fn expect(
        &self,
        scene: &Scene,
        values: &BTreeMap<&str, &Value>,
    ) -> Result<Vec<ExpectedTexel>, At> {
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
                return Err(At::new("the texel is outside the attachment")
                    .key("texel")
                    .index(i));
            }
            result.push(ExpectedTexel {
                attachment,
                texel: e.texel,
                value: e.value,
            });
        }
        Ok(result)
    }
}
