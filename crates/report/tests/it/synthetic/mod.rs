//! A made-up run of a believable shape, for tests and for looking at.

pub(crate) mod large;
pub(crate) mod methods;

use etalon_frame::{
    AdapterInfo, Api, Aspect, Band, ChannelEncoding, ChannelMismatch, CodeInterval, Codes,
    Contents, DepthTest, Effect, Event, Feature, FormatSupport, Limits, Origin, ReadPath,
    Rejection, Requirement, Step, Story, TextureFormat, ValueRange, WrongTexel,
};
use etalon_record::{
    AbsentAdapter, AdapterRecord, Assertion, Expected, FORMAT, FrameFile, FrameImage, Header,
    LossKind, Machine, ProcessEnd, Provenance, Reason, Record, RunWriter, Seconds, Settings,
    Verdict,
};
use std::path::Path;

pub(crate) const ADAPTERS: [(&str, Api); 8] = [
    ("cpu", Api::Vulkan),
    ("gl:llvmpipe", Api::OpenGl),
    ("gl:es:softpipe", Api::OpenGlEs),
    ("gl:softpipe", Api::OpenGl),
    ("vulkan:lavapipe", Api::Vulkan),
    ("vulkan:swiftshader", Api::Vulkan),
    ("wgpu:gl:llvmpipe", Api::WebGpu),
    ("wgpu:vulkan:lavapipe", Api::WebGpu),
];

/// Topics with their axes: name, values per axis.
const TOPICS: [(&str, &[(&str, usize)]); 9] = [
    (
        "depth/compare",
        &[("compare", 8), ("format", 3), ("write", 2)],
    ),
    ("depth/bias", &[("bias", 7), ("format", 3), ("slope", 4)]),
    (
        "stencil/operations",
        &[("compare", 8), ("depth-fail", 8), ("pass", 4)],
    ),
    ("stencil/masks", &[("read", 6), ("write", 6)]),
    (
        "blend/factors",
        &[("dst", 13), ("operation", 4), ("src", 14)],
    ),
    ("cull/faces", &[("cull", 4), ("front", 2), ("topology", 5)]),
    ("multisample/resolve", &[("format", 4), ("mask", 16)]),
    ("early-z/discard", &[("compare", 8), ("shader", 6)]),
    ("selftest/wrong-expectation", &[("bug", 12)]),
];

pub(crate) fn adapter(name: &str, api: Api) -> AdapterRecord {
    let depth = |encodings: &[ChannelEncoding]| FormatSupport {
        samples: vec![1, 4],
        blendable: true,
        depth: encodings.to_vec(),
        read: ReadPath::Copy,
    };
    AdapterRecord {
        info: AdapterInfo {
            name: name.to_owned(),
            backend: name.split(':').next().unwrap_or_default().to_owned(),
            device: format!("{name} (LLVM 19.1.7, 256 bits)"),
            driver: "Mesa".to_owned(),
            driver_version: "25.0.7".to_owned(),
            api_version: "1.4.305".to_owned(),
            software: true,
            ..AdapterInfo::default()
        },
        release: None,
        limits: Limits {
            sub_pixel_bits: 8,
            max_size: 16384,
            max_color_attachments: 8,
            formats: [
                (TextureFormat::Rgba8Unorm, depth(&[])),
                (
                    TextureFormat::Depth24Plus,
                    depth(&[ChannelEncoding::Unorm(24), ChannelEncoding::Float32]),
                ),
            ]
            .into(),
            features: [Feature::FrontAndBackCulling].into(),
            sample_positions: [(4, vec![[96, 32], [224, 96], [32, 160], [160, 224]])].into(),
            ..Limits::nothing(api)
        },
    }
}

pub(crate) fn header(cases: u64, adapters: Vec<AdapterRecord>) -> Header {
    Header {
        format: FORMAT,
        provenance: Provenance {
            etalon: "0.1.0".to_owned(),
            commit: Some("0123abc".to_owned()),
            machine: Machine {
                os: "Debian GNU/Linux 13, Linux 6.12".to_owned(),
                cpu: "Example CPU at 2.1 GHz".to_owned(),
                cores: 4,
            },
            started: "2026-01-02T03:04:05Z".to_owned(),
            command: ["etalon", "run", "--profile", "full"]
                .map(str::to_owned)
                .to_vec(),
        },
        cases,
        settings: Settings::default(),
        adapters,
        absent: vec![AbsentAdapter {
            name: "vulkan:radv".to_owned(),
            reason: "no device".to_owned(),
            remedy: "run on a machine with an AMD GPU".to_owned(),
        }],
    }
}

/// Ids of all cases, in order.
pub(crate) fn cases() -> Vec<String> {
    let mut ids = Vec::new();
    for (topic, axes) in TOPICS {
        let mut here = vec![topic.to_owned()];
        for (axis, n) in axes {
            let values = |id: &String| {
                (0..*n)
                    .map(|v| format!("{id}/{axis}=value-{v}"))
                    .collect::<Vec<_>>()
            };
            here = here.iter().flat_map(values).collect();
        }
        ids.append(&mut here);
    }
    ids
}

/// Writes the run on eight adapters, with frames for wrong records. Returns the number of records.
pub(crate) fn write(folder: &Path, repeats: usize) -> usize {
    write_on(folder, &repeated(repeats), &ADAPTERS)
}

/// Repeats the cases this many times, with their own ids.
pub(crate) fn repeated(repeats: usize) -> Vec<String> {
    let mut ids = cases();
    for repeat in 1..repeats {
        ids.extend(
            cases()
                .iter()
                .map(|id| id.replacen('/', &format!("/r{repeat}-"), 1)),
        );
    }
    ids
}

/// Writes the run of these cases on these adapters.
pub(crate) fn write_on(folder: &Path, ids: &[String], on: &[(&str, Api)]) -> usize {
    let adapters: Vec<_> = on.iter().map(|(n, a)| adapter(n, *a)).collect();
    let mut writer = RunWriter::create(folder, &header(ids.len() as u64, adapters)).unwrap();
    let mut n = 0;
    for (c, id) in ids.iter().enumerate() {
        for (a, (name, _)) in on.iter().enumerate() {
            let verdict = verdict(id, c, a);
            let record = record(&writer, id, name, verdict, (c * 31 + a * 7) as u32);
            writer.append(&record).unwrap();
            n += 1;
        }
    }
    n
}

fn verdict(id: &str, c: usize, a: usize) -> Verdict {
    if id.starts_with("selftest") {
        return if a == 5 && c.is_multiple_of(7) {
            Verdict::Pass
        } else {
            Verdict::Fail
        };
    }
    match (a, c % 97) {
        (3, _) if id.starts_with("blend") && id.contains("src=value-10") => Verdict::Fail,
        (2, _) if id.starts_with("multisample") => Verdict::NotSupported,
        (6, _) if id.starts_with("cull") && c.is_multiple_of(5) => Verdict::Fail,
        (5, 13) => Verdict::Crash,
        (5, 14) => Verdict::Timeout,
        (1, 15) => Verdict::Flaky,
        (1, 16) if c > 400 => Verdict::DeviceLost,
        (7, 17) if c > 400 => Verdict::ResourceError,
        (7, 18) if c > 400 => Verdict::InternalError,
        (4, 19) => Verdict::Measured,
        (0, 20) if c > 800 => Verdict::Open,
        (5, n) if id.starts_with("depth/bias") && n % 4 == 0 => Verdict::Fail,
        (1..=5, n) if id.starts_with("blend") && n % 3 == 0 => Verdict::Imprecise,
        _ => Verdict::Pass,
    }
}

/// One record with everything its verdict calls for.
pub(crate) fn record(
    writer: &RunWriter,
    id: &str,
    adapter: &str,
    verdict: Verdict,
    seed: u32,
) -> Record {
    let mut r = Record::new(id, adapter, verdict);
    r.seconds = Seconds {
        draw: 0.011,
        judge: 0.002,
    };
    r.due_fail = id.starts_with("selftest");
    if id.starts_with("depth/bias") && verdict == Verdict::Fail {
        r.expected = Some(Expected {
            reason: "bias is not scaled by the exponent, bug 1234".to_owned(),
        });
    }
    match verdict {
        Verdict::NotSupported => {
            let missing = Requirement::Samples(TextureFormat::Rgba8Unorm, 4);
            r.reasons = vec![Reason::Missing(missing)];
        }
        Verdict::Crash => {
            r.process = Some(ProcessEnd {
                signal: Some(6),
                stderr: "LLVM ERROR: out of registers\nAborted".to_owned(),
                seconds: 0.4,
                ..ProcessEnd::default()
            });
        }
        Verdict::Flaky => {
            r.repeats = vec![Verdict::Pass, Verdict::Fail, Verdict::Pass];
        }
        Verdict::Timeout => {
            r.process = Some(ProcessEnd {
                kind: LossKind::Timeout,
                limit: Some(20.0),
                seconds: 20.0,
                ..ProcessEnd::default()
            });
        }
        Verdict::DeviceLost => {
            r.reasons = vec![Reason::Text("VK_ERROR_DEVICE_LOST".to_owned())];
        }
        _ => {}
    }
    if !verdict.is_judged() {
        return r;
    }
    r.texels.total = 512;
    let aspects = if id.starts_with("depth") {
        &[Aspect::Color, Aspect::Depth][..]
    } else {
        &[Aspect::Color]
    };
    for aspect in aspects {
        let loose = u64::from(adapter.starts_with("gl:es"));
        r.assertions.push(Assertion {
            aspect: *aspect,
            channels: 1024,
            asserted: 1000 - 40 * loose,
            exact: 900,
            codes: 1000 + 150 * (loose + 1),
            yardstick_exact: 980,
            yardstick_codes: 1030,
            yardstick_asserted: 1000,
        });
    }
    let band = match verdict {
        Verdict::Fail => Band::Fail,
        Verdict::RequiredByCts => Band::RequiredByCts,
        Verdict::Disputed => Band::Disputed,
        Verdict::Imprecise => Band::Imprecise,
        _ => return r,
    };
    let frame = frame(id, adapter, band, seed);
    r.wrong = wrong_texels(&frame, band);
    match band {
        Band::Imprecise => r.texels.imprecise = r.wrong.len() as u64,
        _ => r.texels.wrong = r.wrong.len() as u64,
    }
    r.story = Some(story());
    r.frame = Some(writer.frames().write_frame(&frame).unwrap());
    r
}

fn story() -> Story {
    let event = |origin, step, effect, citation: Option<&str>| Event {
        scene: None,
        origin,
        step,
        effect,
        citation: citation.map(str::to_owned),
    };
    let fragment = || Origin::Fragment {
        pass: 0,
        draw: 1,
        primitive: 0,
        world: None,
    };
    let black = || {
        let zero = CodeInterval::exact(0);
        Contents {
            attachment: "color".to_owned(),
            aspect: Aspect::Color,
            codes: Codes::of_channels(&[ChannelEncoding::Unorm(8); 4], [zero; 4]),
        }
    };
    let exact = |value| ValueRange {
        low: value,
        high: value,
    };
    let test = Step::DepthTest(DepthTest::Compared {
        compare: "less".to_owned(),
        incoming: exact(0.5),
        stored: exact(0.25),
    });
    Story {
        events: vec![
            event(
                Origin::Load(0),
                Step::Clear(vec![black()]),
                Effect::None,
                None,
            ),
            event(
                fragment(),
                Step::Culling {
                    front: true,
                    mode: "none".to_owned(),
                },
                Effect::None,
                Some("Vulkan: Basic Polygon Rasterization"),
            ),
            event(
                fragment(),
                test,
                Effect::Rejects(Rejection::Depth),
                Some("OpenGL 4.6: 17.3.4"),
            ),
            event(
                Origin::End { world: None },
                Step::ReadBack {
                    attachment: "color".to_owned(),
                    contents: vec![black()],
                    depth_by_shader: false,
                },
                Effect::None,
                None,
            ),
        ],
        ..Story::default()
    }
}

/// A smooth field with noise in a corner, 16×16, colour or depth.
fn frame(id: &str, adapter: &str, band: Band, seed: u32) -> FrameFile {
    let hash = |i: u32| (i ^ seed).wrapping_mul(0x9e37_79b1) >> 24;
    let image = |aspect: Aspect, attachment: &str, channels: Vec<ChannelEncoding>, samples: u32| {
        let n = channels.len() as u32;
        let mut image = FrameImage {
            attachment: attachment.to_owned(),
            aspect,
            size: [16, 16],
            samples,
            low: Vec::new(),
            high: Vec::new(),
            actual: Vec::new(),
            wrong: Vec::new(),
            channels,
        };
        for i in 0..256 * samples {
            let (x, y) = (i / samples % 16, i / samples / 16);
            let off = x > 9 && y < 5 && hash(i) > 90;
            image.wrong.push(match (off, band) {
                (false, _) => FrameImage::FINE,
                (true, Band::Imprecise) => FrameImage::IMPRECISE,
                (true, _) => FrameImage::FAIL,
            });
            for c in 0..n {
                let encoding = image.channels[c as usize];
                let most = encoding.max_order().min(0x3f80_0000) as u32;
                let share = u64::from([x * 16, y * 16, 128, hash(i)][c as usize % 4]);
                let low = (u64::from(most) * share / 255) as u32;
                let high = (low + u32::from(band == Band::Imprecise) * 2).min(most);
                image.low.push(low);
                image.high.push(high);
                image.actual.push(match (off, band) {
                    (true, band) if band != Band::Imprecise => hash(i + c) * (most / 255),
                    _ => high,
                });
            }
        }
        image
    };
    let mut images = vec![image(
        Aspect::Color,
        "color",
        vec![ChannelEncoding::Unorm(8); 4],
        if id.starts_with("multisample") { 4 } else { 1 },
    )];
    if id.starts_with("depth") {
        images.push(image(
            Aspect::Depth,
            "depth",
            vec![ChannelEncoding::Float32],
            1,
        ));
    }
    if id.starts_with("stencil") {
        images.push(image(
            Aspect::Stencil,
            "depth",
            vec![ChannelEncoding::Uint(8)],
            1,
        ));
    }
    FrameFile {
        case: id.to_owned(),
        adapter: adapter.to_owned(),
        about: "Each compare function against a stored depth that is nearer, equal and farther."
            .to_owned(),
        spec: vec![
            "Vulkan: Depth Comparison".to_owned(),
            "OpenGL 4.6: 17.3.4".to_owned(),
        ],
        images,
    }
}

fn wrong_texels(frame: &FrameFile, band: Band) -> Vec<WrongTexel> {
    let image = frame.images.last().unwrap();
    let n = image.channels.len();
    let wrong = image
        .wrong
        .iter()
        .enumerate()
        .filter(|(_, w)| **w != FrameImage::FINE);
    wrong
        .take(64)
        .map(|(i, _)| WrongTexel {
            x: i as u32 / image.samples % 16,
            y: i as u32 / image.samples / 16,
            sample: i as u32 % image.samples,
            band,
            channels: (0..n)
                .filter(|c| image.actual[i * n + c] != image.low[i * n + c])
                .map(|c| ChannelMismatch {
                    attachment: image.attachment.clone(),
                    aspect: image.aspect,
                    channel: c as u8,
                    encoding: image.channels[c],
                    low: image.low[i * n + c],
                    // An imprecise texel's bounds are the yardstick's.
                    high: match band {
                        Band::Imprecise => image.low[i * n + c],
                        _ => image.high[i * n + c],
                    },
                    actual: image.actual[i * n + c],
                })
                .collect(),
        })
        .collect()
}
