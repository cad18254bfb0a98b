//! `etalon explain`.

use crate::adapters::{Query, discover, refuse_absent};
use crate::cases::library;
use crate::failure::{Failure, UNEXPECTED};
use crate::flags::AdapterFileArguments;
use crate::output::print;
use clap::Args;
use etalon_backend::Backend;
use etalon_case::{Case, Profile};
use etalon_cpu::CpuBackend;
use etalon_frame::{Frame, LegalSet, Limits};
use etalon_reference::{Rules, Sample, explain, judge};
use std::fmt::Write;
use std::path::{Path, PathBuf};

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Id of the case
    #[arg(value_name = "CASE")]
    pub(crate) case: String,
    /// Column and row of the texel, counted from the top left corner
    #[arg(long, value_name = "X,Y", value_parser = parse_texel)]
    pub(crate) texel: [u32; 2],
    /// Draw the case on this adapter and judge its texel
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
    /// Read case files from this folder instead of the built-in ones
    #[arg(long, value_name = "DIR")]
    pub(crate) cases: Option<PathBuf>,
}

/// Explains one texel by the rules and by the yardstick; with an adapter, also judges the value that it
/// returned.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let library = library(arguments.cases.as_ref())?;
    let Some(found) = library
        .cases(Profile::Full)
        .find(|c| c.id() == arguments.case)
    else {
        return Err(Failure::usage(format!(
            "there is no case `{}`; `etalon list --profile full` lists all cases",
            arguments.case
        )));
    };
    let case = found.build().map_err(Failure::usage)?;
    let scene = case.judged_scene();
    let [x, y] = arguments.texel;
    let inside = |index: &usize| {
        let [w, h] = scene.attachments[*index].size;
        x < w && y < h
    };
    if !scene.read.iter().any(inside) {
        return Err(Failure::usage(format!(
            "texel {x},{y} lies outside every attachment that the case reads back"
        )));
    }
    let (limits, frame) = match &arguments.adapter {
        None => (CpuBackend::new("cpu").limits().clone(), None),
        Some(name) => {
            let (limits, frame) = draw(name, arguments.file.adapter_file.as_deref(), &case)?;
            (limits, Some(frame))
        }
    };
    let mut text = format!("{}\n{}\n\n", case.id, case.about);
    let mut legal_everywhere = false;
    for limits in limits.alternatives(&scene.formats()) {
        legal_everywhere |= explain_texel(&mut text, &case, &limits, [x, y], frame.as_ref());
    }
    print(&text)?;
    let wrong = frame.is_some() && !legal_everywhere && case.judged_as.is_none();
    Ok(if wrong { UNEXPECTED } else { 0 })
}

/// Appends both explanations. Returns true if the texel of the frame is legal.
fn explain_texel(
    text: &mut String,
    case: &Case,
    limits: &Limits,
    [x, y]: [u32; 2],
    frame: Option<&Frame>,
) -> bool {
    let scene = case.judged_scene();
    let mut legal = true;
    for rules in [Rules::of(limits), Rules::yardstick(limits)] {
        let set = judge(scene, limits, &rules);
        let yardstick = rules.name == "yardstick";
        let encodings: Vec<String> = set
            .images
            .iter()
            .map(|i| format!("{} {} {}", i.attachment, i.aspect, i.channels[0]))
            .collect();
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "By the rules of {} ({}):",
            rules.name,
            encodings.join(", ")
        );
        for group in &set.groups {
            if x >= group.size[0] || y >= group.size[1] {
                continue;
            }
            for sample in 0..group.samples {
                let at = Sample {
                    size: group.size,
                    samples: group.samples,
                    x,
                    y,
                    sample,
                };
                let _ = write!(text, "{}", explain(scene, limits, &rules, at));
            }
        }
        if let Some(frame) = frame {
            let fits = fits(text, &set, frame, [x, y], yardstick);
            if !yardstick {
                legal = fits;
            }
        }
        text.push('\n');
    }
    legal
}

/// Appends the values of a texel of the frame. Returns true if the set allows them.
fn fits(
    text: &mut String,
    set: &LegalSet,
    frame: &Frame,
    [x, y]: [u32; 2],
    yardstick: bool,
) -> bool {
    let mut all = true;
    let word = |allowed: bool| match (allowed, yardstick) {
        (true, _) => "allowed",
        (false, true) => "outside the yardstick",
        (false, false) => "NOT ALLOWED",
    };
    for (g, group) in set.groups.iter().enumerate() {
        if x >= group.size[0] || y >= group.size[1] {
            continue;
        }
        for sample in 0..group.samples {
            let mut orders = Vec::new();
            let mut parts = Vec::new();
            for (image, info) in frame.images.iter().zip(&set.images) {
                if info.group != g || !info.matches(image) {
                    continue;
                }
                let codes = image.sample(x, y, sample);
                let own: Vec<i64> = codes
                    .iter()
                    .zip(&info.channels)
                    .map(|(code, e)| e.order_of_code(*code))
                    .collect();
                let values: Vec<String> = own
                    .iter()
                    .zip(&info.channels)
                    .map(|(order, e)| {
                        format!(
                            "{} ({:?})",
                            e.code_of_order(*order),
                            e.value_of_order(*order)
                        )
                    })
                    .collect();
                parts.push(format!(
                    "{} {}: {}",
                    info.attachment,
                    info.aspect,
                    values.join(", ")
                ));
                orders.extend(own);
            }
            let allowed =
                orders.len() == group.channels.len() && group.sample(x, y, sample).allows(&orders);
            let word = word(allowed);
            let _ = writeln!(text, "returned: {}: {word}", parts.join("; "));
            all &= allowed;
        }
    }
    for (counter, actual) in set.counters.iter().zip(&frame.counters) {
        let allowed = counter.range.contains(*actual);
        let (legal, word) = (counter.range, word(allowed));
        let (name, kind) = (&counter.name, counter.kind.name());
        let _ = writeln!(text, "counter {name} ({kind}): {actual} of {legal}: {word}");
        all &= allowed;
    }
    all
}

fn draw(name: &str, file: Option<&Path>, case: &Case) -> Result<(Limits, Frame), Failure> {
    let adapters = discover(&Query {
        names: &[name.to_owned()],
        file,
        ..Query::default()
    })?;
    refuse_absent(std::slice::from_ref(&name.to_owned()), &adapters.absent)?;
    let Some((_, mut worker)) = adapters.ready.into_iter().next() else {
        return Err(Failure::usage(format!("adapter {name} cannot be used")));
    };
    let limits = worker.hello.limits.clone();
    if let Some(missing) = limits.missing(&case.requirements()) {
        return Err(Failure::usage(format!("{name} does not support {missing}")));
    }
    let frames = worker.draw(case).map_err(Failure::incomplete)?;
    // The scene of the case itself comes first, then its variants.
    let frame = frames.into_iter().next();
    let frame = frame.ok_or_else(|| Failure::incomplete("no frame was returned"))?;
    Ok((limits, frame))
}

fn parse_texel(text: &str) -> Result<[u32; 2], String> {
    let wrong = || "expected X,Y: two whole numbers".to_owned();
    let (x, y) = text.split_once(',').ok_or_else(wrong)?;
    let number = |t: &str| t.trim().parse().map_err(|_| wrong());
    Ok([number(x)?, number(y)?])
}
