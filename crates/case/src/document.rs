//! Cases as documents: the contents of a case file without axes, with every value substituted.
//!
//! A document is plain JSON, in the format of a case file: it is written as it is and read like any case
//! file. Meshes keep their descriptions, so that people can still read a changed scene.

use crate::case::Case;
use crate::error::{At, CaseError};
use crate::file::{CaseFile, CaseRef, Profile};
use crate::scene_json::scene_json;
use crate::values::substitute;
use crate::wire::SceneSource;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

impl CaseRef<'_> {
    /// Returns the case as the JSON of a case file with only this case: axes, seeds and sequences are
    /// replaced by the scene that they produce.
    ///
    /// # Errors
    /// With file, line and key, if the case cannot be built, or a method's scene cannot be written.
    pub fn document(&self) -> Result<Value, CaseError> {
        self.try_document()
            .map_err(|error| error.locate(self.file.name(), &self.file.text))
    }

    fn try_document(&self) -> Result<Value, At> {
        let wire = &self.file.wire;
        let values = self.values();
        let mut document = Map::new();
        document.insert("about".to_owned(), json!(wire.about));
        document.insert("spec".to_owned(), json!(wire.spec));
        if let SceneSource::Method(method) = &self.file.source {
            let scene = self.method_case(method, &values)?.scene;
            let scene = scene_json(&scene).map_err(|e| At::new(e).key("method"))?;
            document.insert("scene".to_owned(), scene);
            return Ok(Value::Object(document));
        }
        document.insert("scene".to_owned(), self.scene_value(&values)?);
        let filled = |changes: &BTreeMap<String, Value>| -> Result<Value, At> {
            let each = changes.iter();
            let each = each.map(|(pointer, v)| Ok((pointer.clone(), substitute(v, &values)?)));
            Ok(Value::Object(each.collect::<Result<_, At>>()?))
        };
        if !wire.variants.is_empty() {
            let mut variants = Vec::new();
            for variant in &wire.variants {
                let mut object = json!({ "name": variant.name });
                if !variant.patch.is_empty() {
                    object["patch"] = filled(&variant.patch)?;
                }
                if !variant.permute.is_empty() {
                    object["permute"] = json!(variant.permute);
                }
                variants.push(object);
            }
            document.insert("variants".to_owned(), Value::Array(variants));
        }
        if !wire.submissions.is_empty() {
            document.insert("submissions".to_owned(), json!(wire.submissions));
        }
        for (key, value) in [("relation", &wire.relation), ("expect", &wire.expect)] {
            if !value.is_null() {
                document.insert(key.to_owned(), substitute(value, &values)?);
            }
        }
        if !wire.judged_as.is_empty() {
            document.insert("judged_as".to_owned(), filled(&wire.judged_as)?);
        }
        Ok(Value::Object(document))
    }
}

/// Builds the case of a document. `id` is its id, which is also the path of its file below the cases folder,
/// without `.json`.
///
/// # Errors
/// As from [`CaseFile::parse`] and [`CaseRef::build`]; the document must have exactly one case.
pub fn build(id: &str, document: &Value) -> Result<Case, CaseError> {
    let name = format!("{id}.json");
    let file = CaseFile::parse(&name, &document.to_string())?;
    let mut cases = file.cases(Profile::Full);
    match (cases.next(), cases.next()) {
        (Some(case), None) => case.build(),
        _ => Err(CaseError {
            file: name,
            line: 0,
            key: "axes".to_owned(),
            message: "a document must have exactly one case".to_owned(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Library;
    use etalon_scene::Scene;

    /// Returns the scene with its attachments in ascending order of their names, as in a case file.
    fn sorted(scene: &Scene) -> Scene {
        let mut order: Vec<usize> = (0..scene.attachments.len()).collect();
        order.sort_by_key(|i| &scene.attachments[*i].name);
        let moved = |index: &mut usize| {
            *index = order.iter().position(|i| i == index).expect("in range");
        };
        let mut sorted = scene.clone();
        sorted.attachments = order
            .iter()
            .map(|i| scene.attachments[*i].clone())
            .collect();
        sorted.read.iter_mut().for_each(moved);
        for pass in &mut sorted.passes {
            pass.color.iter_mut().for_each(moved);
            pass.resolve.iter_mut().flatten().for_each(moved);
            pass.depth_stencil.iter_mut().for_each(moved);
            let resolve = pass.depth_stencil_resolve.iter_mut();
            resolve.map(|r| &mut r.to).for_each(moved);
            let draws = pass.draws.iter_mut();
            draws.flat_map(|d| &mut d.textures).for_each(moved);
        }
        sorted
    }

    #[test]
    fn every_built_in_case_is_written_and_read_without_loss() {
        let library = Library::built_in();
        let everything = std::env::var_os("ETALON_TESTS").is_some_and(|v| v == "all");
        let (mut scenes, mut left_out) = (0, 0);
        // Few axes have a multiple of 7 values.
        let step = if everything { 1 } else { 7 };
        for reference in library.cases(Profile::Full).step_by(step) {
            let case = reference.build().expect("built-in cases build");
            // Large scenes take long and would test nothing more.
            let draws = || case.scene.passes.iter().flat_map(|p| &p.draws);
            let vertices: usize = draws().map(|d| d.mesh.vertices.len()).sum();
            if case.scene.bytes() > 1 << 14 || vertices > 500 {
                continue;
            }
            let read =
                |scene: Value| build("t", &json!({ "about": "", "spec": [], "scene": scene }));
            match scene_json(&case.scene).map(read) {
                Ok(Ok(read)) => {
                    assert_eq!(read.scene, sorted(&case.scene), "{}", case.id);
                    scenes += 1;
                }
                // Some methods use states that case files cannot express.
                Ok(Err(error)) => assert!(case.method.is_some(), "{}: {error}", case.id),
                // Codes with equal values cannot be distinguished.
                Err(_) => left_out += 1,
            }
            if case.method.is_some() {
                continue;
            }
            let document = reference.document().expect("it is written");
            let read = build("t", &document).expect("it is a case file");
            assert_eq!(read.scene, case.scene, "{}", case.id);
            assert_eq!(read.judged_as, case.judged_as, "{}", case.id);
            assert_eq!(read.variants, case.variants, "{}", case.id);
            assert_eq!(read.relation, case.relation, "{}", case.id);
            assert_eq!(read.expect, case.expect, "{}", case.id);
        }
        assert!(scenes > 50 * left_out, "{scenes} and not {left_out}");
    }

    #[test]
    fn a_document_holds_one_case() {
        let document = json!({ "about": "", "spec": [], "axes": { "a": [1, 2] }, "scene": {} });
        assert_eq!(build("t", &document).expect_err("two").key, "axes");
    }
}
