//! The surfaces of a transparent scene, from which the page tells how a method came to a texel.
//!
//! A run folder doesn't hold them: they are made again from the scene's name and the axis values of a case's id. A
//! family that fixes more than its id says is not named like its scene, and so has none; the page also tells nothing
//! about texels whose truth is another one than that of these surfaces.

use super::data::{SceneSeries, Setting};
use etalon_methods::{MethodWire, Paint, Truth, make};
use serde_json::{Map, Value, json};

/// The most surfaces that the page holds of a setting.
const SURFACES: usize = 256;

/// The size, the background, and every surface in the order in which it is listed: its colour, then its corners.
pub(super) fn layers(scene: &SceneSeries<'_>, setting: &Setting<'_>) -> Option<Value> {
    let (series, point) = scene.at(setting).next()?;
    let truth = truth(scene, series.method, &point.record.case)?;
    if truth.surfaces.len() > SURFACES {
        return None;
    }
    let surface = |surface: &etalon_methods::Surface| match surface.paint {
        Paint::Flat(color) => {
            let corners = surface.corners.iter().flatten();
            let numbers = color.iter().chain(corners);
            Some(numbers.map(|v| (v * 1e6).round() / 1e6).collect())
        }
        _ => None,
    };
    let surfaces: Option<Vec<Vec<f64>>> = truth.surfaces.iter().map(surface).collect();
    Some(json!({ "size": truth.size, "background": truth.background, "surfaces": surfaces? }))
}

/// The geometry of a case of transparency.
fn truth(scene: &SceneSeries<'_>, method: &str, case: &str) -> Option<Truth> {
    if scene.question != "transparency" {
        return None;
    }
    let mut wire = Map::new();
    for (axis, value) in case.split('/').filter_map(|part| part.split_once('=')) {
        let value = serde_json::from_str(value).unwrap_or_else(|_| value.into());
        wire.insert(axis.to_owned(), value);
    }
    for (name, value) in [
        ("question", scene.question),
        ("scene", scene.name),
        ("method", method),
    ] {
        wire.insert(name.to_owned(), value.into());
    }
    let wire: MethodWire = serde_json::from_value(wire.into()).ok()?;
    Some(make(&wire).ok()?.truth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::data::Methods;
    use crate::methods::made::{Made, run};
    use std::fs;
    use std::path::Path;

    fn of(id: &str, parameter: (&'static str, f64)) -> Option<Value> {
        let run = run(&[Made::new(id).at(parameter.0, parameter.1)]);
        let methods = Methods::of(&run)?;
        let scene = methods.scenes().next()?;
        layers(scene, scene.settings().first()?)
    }

    #[test]
    fn the_surfaces_are_those_of_the_case() {
        let windows = of("transparency/windows/method=sorted", ("alpha", 0.25)).unwrap();
        assert_eq!(windows["size"], json!([128, 128]));
        assert_eq!(windows["background"], json!([0.9, 0.9, 0.85]));
        let surfaces = windows["surfaces"].as_array().unwrap();
        assert_eq!(surfaces.len(), 7);
        assert_eq!(surfaces[0][3], json!(1.0), "the opaque one is first");
        assert!(surfaces[1..].iter().all(|s| s[3] == json!(0.25)));
        let thin = of("transparency/thin-layers/method=sorted", ("layers", 4.0)).unwrap();
        let glass = thin["surfaces"].as_array().unwrap().iter();
        assert_eq!(glass.filter(|s| s[3] != json!(1.0)).count(), 4);
    }

    #[test]
    fn what_the_id_does_not_say_is_not_guessed() {
        // A family that fixes layers and alpha.
        assert_eq!(
            of("transparency/peeling/method=depth-peeling", ("k", 2.0)),
            None
        );
        assert_eq!(of("culling/box/method=back", ("size", 4.0)), None);
        assert_eq!(
            of("transparency/windows/method=sorted", ("alpha", 7.0)),
            None
        );
    }

    /// A file named like its scene says everything in its ids.
    #[test]
    fn case_files_named_like_their_scene_fix_nothing() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/methods/transparency");
        let mut named = 0;
        for file in fs::read_dir(folder).unwrap() {
            let path = file.unwrap().path();
            let case: Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
            let method = case["method"].as_object().unwrap();
            if method["scene"].as_str() != path.file_stem().unwrap().to_str() {
                continue;
            }
            named += 1;
            for (field, value) in method {
                let axis = value.as_str().and_then(|v| v.strip_prefix('$'));
                let known = ["question", "scene"].contains(&field.as_str());
                assert!(known || axis == Some(field), "{}: {field}", path.display());
            }
        }
        assert!(named >= 6, "{named}");
    }
}
