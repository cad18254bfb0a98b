//! A synthetic run of methods with plausible numbers.

use super::{adapter, header};
use etalon_frame::{Accuracy, Api, Aspect, Distance, SizedDistance};
use etalon_record::{
    Clock, Cost, Estimate, Measured, Parameter, Record, RunWriter, Seconds, SizedFrame, Times,
    Verdict,
};
use std::path::Path;

/// The name, whether the device is the processor, and its slowness factor.
const ADAPTERS: [(&str, bool, f64); 4] = [
    ("cpu", true, 1.0),
    ("vulkan:lavapipe", true, 1.7),
    ("gl:llvmpipe", true, 1.9),
    ("vulkan:example-8000", false, 0.05),
];

/// Name, cost, error at the parameter's middle, how the error grows with the parameter, passes.
type Shape = (&'static str, f64, f64, f64, u32);

const TRANSPARENCY: [Shape; 13] = [
    ("unsorted", 1.0, 0.06, 1.0, 1),
    ("sorted", 1.05, 0.0011, 0.0, 1),
    ("sorted-triangles", 1.1, 0.0011, 0.0, 1),
    ("depth-write-off", 1.0, 0.05, 1.0, 1),
    ("alpha-test", 0.8, 0.2, 0.5, 1),
    ("alpha-to-coverage", 1.9, 0.04, 0.3, 1),
    ("stochastic", 6.0, 0.03, 0.4, 9),
    ("depth-peeling", 7.0, 0.0, 0.0, 8),
    ("dual-depth-peeling", 5.0, 0.0012, 0.0, 6),
    ("weighted-blended", 1.8, 0.008, 2.2, 2),
    ("linked-lists", 2.1, 0.0009, 0.0, 2),
    ("moment-based", 2.6, 0.0021, 1.4, 3),
    ("front-to-back", 1.3, 0.0014, 0.1, 2),
];

const EDGES: [Shape; 6] = [
    ("none", 1.0, 0.09, 0.2, 1),
    ("msaa-4", 1.6, 0.03, 0.2, 1),
    ("msaa-8", 2.2, 0.02, 0.2, 1),
    ("supersampling-2x2", 3.9, 0.028, 0.2, 2),
    ("supersampling-4x4", 15.0, 0.009, 0.2, 2),
    ("coverage-to-alpha", 1.2, 0.012, 0.6, 1),
];

pub(crate) fn write(folder: &Path) -> usize {
    let mut adapters = Vec::new();
    for (name, software, _) in ADAPTERS {
        let mut a = adapter(name, Api::Vulkan);
        a.info.software = software;
        adapters.push(a);
    }
    let mut records = Vec::new();
    for (name, _, slow) in ADAPTERS {
        for scene in ["windows", "intersecting-panes"] {
            for shape in &TRANSPARENCY {
                for alpha in [0.1, 0.3, 0.5, 0.7, 0.9] {
                    let id = format!("transparency/{scene}");
                    records.push(record(
                        &id,
                        shape,
                        name,
                        slow,
                        ("alpha", alpha, alpha / 0.5),
                    ));
                }
            }
        }
        for shape in &EDGES {
            for angle in [5.0, 20.0, 45.0, 70.0] {
                let id = "anti-aliasing/half-planes";
                records.push(record(
                    id,
                    shape,
                    name,
                    slow,
                    ("angle", angle, angle / 45.0),
                ));
            }
        }
    }
    let cases = records.len() / ADAPTERS.len();
    let mut writer = RunWriter::create(folder, &header(cases as u64, adapters)).unwrap();
    records.iter().for_each(|r| writer.append(r).unwrap());
    records.len()
}

fn record(
    scene: &str,
    (method, cost, error, growth, passes): &Shape,
    adapter: &str,
    slow: f64,
    (parameter, value, relative): (&str, f64, f64),
) -> Record {
    let (question, name) = scene.split_once('/').unwrap();
    let id = format!("methods/{scene}/method={method}/{parameter}={value}");
    let rmse = error * relative.powf(*growth * 2.0);
    let wobble = 1.0 + 0.1 * ((id.len() * 7 + adapter.len() * 3) as f64).sin();
    let wall = 0.0007 * cost * slow * wobble;
    let verdict = if *method == "sorted" {
        Verdict::Pass
    } else {
        Verdict::Measured
    };
    let mut r = Record::new(id, adapter, verdict);
    r.seconds = Seconds {
        draw: wall * 9.0,
        judge: 0.001,
    };
    r.accuracy.push(Accuracy {
        channels: 65536,
        mean: 0.11 * slow,
        max: 2.0,
        ..Accuracy::none(Aspect::Color, Some(etalon_frame::ChannelEncoding::Unorm(8)))
    });
    r.measured = Some(Measured {
        question: question.to_owned(),
        scene: name.to_owned(),
        method: (*method).to_owned(),
        parameter: Some(Parameter {
            name: parameter.to_owned(),
            value,
        }),
        distance: Distance {
            rmse,
            max: (rmse * 6.0).min(1.0),
            flip: rmse * 1.3,
            wrong: (rmse * 9.0).min(1.0),
            truth_error: 0.0,
        },
        time: Some(Times {
            samples: 31,
            wall,
            cpu: wall * 0.1,
            gpu: (slow < 1.0).then_some(wall * 0.8),
            interval: Some([wall * 0.9, wall * 1.2]),
        }),
        sizes: vec![SizedFrame {
            size: [1280, 720],
            time: Some(Times {
                samples: 15,
                wall: wall * 40.0,
                cpu: wall * 0.1,
                gpu: None,
                interval: Some([wall * 39.0, wall * 41.0]),
            }),
            distance: Some(SizedDistance {
                texels: 7540,
                rmse: rmse * 0.9,
                max: (rmse * 5.0).min(1.0),
            }),
            reason: None,
        }],
        cost: Some(Cost {
            clock: Clock::Wall,
            fixed: Estimate {
                median: wall * 0.5,
                interval: Some([wall * 0.4, wall * 0.6]),
            },
            per_megapixel: Estimate {
                median: wall * 43.0,
                interval: Some([wall * 42.0, wall * 44.0]),
            },
            deviation: None,
        }),
        passes: *passes,
        draws: passes * 6,
        fragments: Some((16384.0 * cost.round()) as u64),
        bytes: 65536 * u64::from(*passes),
        picture: None,
        truth_picture: None,
    });
    r
}
