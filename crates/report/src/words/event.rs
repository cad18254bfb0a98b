//! Events of stories in words: a place, an operation, and its inputs and outcome.

use super::subject::{list, scene_name, side_name};
use super::value::{codes_list, range, values_list};
use etalon_frame::{
    Aspect, BlendedChannel, Contents, Coverage, DepthTest, Effect, Event, Origin, Rejection,
    ResolveChoice, Step, ToldLine,
};

/// Returns an event in words.
pub(super) fn event_line(event: &Event) -> ToldLine {
    let place_name = place(&event.origin);
    ToldLine {
        at: match &event.scene {
            Some(scene) => format!("{}: {place_name}", scene_name(scene)),
            None => place_name,
        },
        operation: event.operation().name().to_owned(),
        detail: detail_of(event),
        citation: event.citation.clone(),
    }
}

/// Returns the name of a draw, with its pass if there are several.
pub(super) fn draw_name(pass: usize, draw: usize, several_passes: bool) -> String {
    if several_passes {
        format!("draw {draw} of pass {pass}")
    } else {
        format!("draw {draw}")
    }
}

/// Returns where in its scene an event happens, in words.
fn place(origin: &Origin) -> String {
    match origin {
        Origin::Attachment(name) => format!("attachment {name}"),
        Origin::Pass(pass) => format!("pass {pass}"),
        Origin::Load(pass) => format!("pass {pass}, load operation"),
        Origin::BeforeDraw { pass, draw } => format!("pass {pass}, before draw {draw}"),
        Origin::PassEnd(pass) => format!("pass {pass}, at the end"),
        Origin::AfterPass(pass) => format!("after pass {pass}"),
        Origin::Draw { pass, draw, .. } => format!("pass {pass}, draw {draw}"),
        Origin::Fragment {
            pass,
            draw,
            primitive,
            world,
        } => {
            let world = world_name(*world);
            format!("pass {pass}, draw {draw}, primitive {primitive}{world}")
        }
        Origin::End { world } => format!("at the end{}", world_name(*world)),
        Origin::Sides(sides) => {
            let [first, second] = sides.each_ref().map(side_name);
            format!("{first} and {second}")
        }
    }
}

fn world_name(world: Option<[usize; 2]>) -> String {
    world.map_or_else(String::new, |[number, count]| {
        format!(", world {number} of {count}")
    })
}

/// Returns the inputs and the outcome of an event. One arm per operation.
pub(super) fn detail_of(event: &Event) -> String {
    let certain = !matches!(event.effect, Effect::MayReject(_));
    match &event.step {
        Step::OtherAttachments {
            size: [width, height],
            samples,
        } => {
            let samples = match samples {
                1 => String::new(),
                n => format!(" with {n} samples"),
            };
            format!("others: of {width} by {height} texels{samples}")
        }
        Step::Upload(contents) => aspects(contents),
        Step::Clear(contents) => match (&event.origin, contents.as_slice()) {
            (Origin::Attachment(_), _) => aspects(contents),
            (_, [value]) => format!(
                "{} holds {} {}",
                value.attachment,
                value.aspect,
                codes_list(&value.codes)
            ),
            _ => holds(contents),
        },
        Step::ClearElsewhere => "the texel lies outside its rectangle".to_owned(),
        Step::StoreDiscard(target) => format!(
            "{} of {} is undefined until all of it is cleared",
            target.aspect, target.attachment
        ),
        Step::Resolve {
            from,
            to,
            by,
            samples,
            results,
        } => {
            let joined = |codes: &[Vec<_>], between| {
                let texts: Vec<String> = codes.iter().map(|c| codes_list(c)).collect();
                texts.join(between)
            };
            let results = joined(results, " or ");
            let how = match by {
                ResolveChoice::First => format!("the first of the samples: {results}"),
                ResolveChoice::Any => format!("one of the samples: {results}"),
                ResolveChoice::Average => {
                    format!("of samples ({}) gives {results}", joined(samples, "; "))
                }
            };
            format!("{from} into {to}, {how}")
        }
        Step::ResolveDepthStencil {
            from,
            to,
            mode,
            result,
            aspect,
        } => {
            let result = codes_list(&[*result]);
            format!("{from} into {to}, {aspect} by {mode}: {result}")
        }
        Step::RasterizerDiscard => "primitives are discarded before rasterization".to_owned(),
        Step::Scissor(rect) => {
            let rect = rect.map(|v| v.to_string()).join(",");
            format!("outside its scissor rectangle [{rect}]")
        }
        Step::Primitives { count, viewport } => primitives(event, *count, *viewport),
        Step::Clipping => {
            let plane = match event.effect.rejection() {
                Some(Rejection::Viewport) => "an edge of the viewport",
                Some(Rejection::NearFar) => "the near or far plane",
                _ => "where a clip distance is 0",
            };
            format!("too near {plane} to tell: two worlds, clipped away at the sample or not")
        }
        Step::Coverage(coverage) => coverage_text(*coverage),
        Step::World(contents) => holds(contents),
        Step::Culling { front, mode } => {
            let face = face(*front);
            format!("a {face}, and the cull mode is {mode}")
        }
        Step::SampleCoverage {
            share,
            inverted,
            sample,
        } => {
            let name = if *inverted { "inverted share" } else { "share" };
            let verb = if certain { "leaves" } else { "may leave" };
            format!("the {name} {share} {verb} sample {sample} out")
        }
        Step::Shade {
            front,
            shader,
            color,
            texels,
        } => {
            let face = face(*front);
            let Some(shader) = shader else {
                return format!("{face}, without a fragment shader");
            };
            let texels = texels
                .iter()
                .map(|(name, texel)| format!(" from texel ({}) of {name}", values_list(texel)));
            let texels: String = texels.collect();
            format!("{face}, {shader} gives ({}){texels}", values_list(color))
        }
        Step::Discard {
            value,
            limit,
            strict,
        } => {
            let relation = if *strict { "above" } else { "at least" };
            let [value, limit] = [value, limit].map(range);
            if certain {
                format!("{value} is not {relation} {limit}")
            } else {
                format!("{value} may or may not be {relation} {limit}: two worlds")
            }
        }
        Step::InputMask { set, possible } if set == possible => {
            format!("the shader reads the mask {set:#x}")
        }
        Step::InputMask { set, possible } => {
            format!("the shader reads a mask with {set:#x} and perhaps more of {possible:#x}")
        }
        Step::ShaderMask { bits } => {
            let bits = bits.low;
            if certain {
                format!("the mask {bits} leaves it out")
            } else {
                format!("the mask {bits} may or may not keep the sample: two worlds")
            }
        }
        Step::SampleMask { mask } => format!("the sample mask {mask:#x} leaves it out"),
        Step::AlphaToCoverage { alpha } => {
            let alpha = range(alpha);
            if certain {
                format!("alpha {alpha} keeps no sample")
            } else {
                format!("alpha {alpha} may or may not keep the sample: two worlds")
            }
        }
        Step::LostAfterEarlyTests => "the fragment is lost after its tests".to_owned(),
        Step::DepthBounds { stored, low, high } => {
            let word = match event.effect {
                Effect::Rejects(_) => "outside",
                Effect::MayReject(_) => "perhaps inside",
                _ => "inside",
            };
            let [stored, low, high] = [stored, low, high].map(range);
            format!("stored {stored} is {word} {low} to {high}")
        }
        Step::StencilTest {
            reference,
            exported,
            compare,
            stored,
            read_mask,
            depth_fails,
        } => {
            let exported = if *exported { "exported " } else { "" };
            let outcome = match (&event.effect, depth_fails) {
                (Effect::Rejects(_), _) => "fails",
                (_, true) => "passes, depth fails",
                (_, false) => "passes",
            };
            format!(
                "{exported}reference {reference} {compare} stored {stored} under read mask {read_mask:#04x} {outcome}"
            )
        }
        Step::StencilUpdate {
            operation,
            write_mask,
            before,
            after,
        } => format!("{operation} under write mask {write_mask:#04x}: {before} becomes {after}"),
        Step::DepthTest(test) => depth_test(test, &event.effect),
        Step::StoreDepth { depth, codes } => {
            format!("{} as {}", range(depth), codes_list(&[*codes]))
        }
        Step::KeepDepth { tested } => {
            if *tested {
                "depth writes are off".to_owned()
            } else {
                "without a depth test, nothing is written".to_owned()
            }
        }
        Step::AdvancedBlend {
            operation,
            src,
            dst,
            result,
        } => {
            let [src, dst, result] = [src, dst, result].map(|v| values_list(v));
            format!("{operation} of [{src}] onto [{dst}] = [{result}]")
        }
        Step::Blend(channels) => {
            let channels = channels.iter().enumerate().map(|(c, channel)| {
                let name = Aspect::Color.channel(c);
                format!("{name}: {}", blended(channel))
            });
            channels.collect::<Vec<_>>().join("; ")
        }
        Step::Logic { operation, stored } => {
            format!("{operation} onto {}", codes_list(&stored.codes))
        }
        Step::StoreColor {
            contents,
            write_mask,
        } => {
            let mask = write_mask.map(|mask| format!(" (write mask {mask:#x})"));
            format!(
                "{} holds {}{}",
                contents.attachment,
                codes_list(&contents.codes),
                mask.unwrap_or_default()
            )
        }
        Step::KeepColor {
            contents,
            write_mask,
        } => format!(
            "write mask {write_mask:#x}: {} still holds {}",
            contents.attachment,
            codes_list(&contents.codes)
        ),
        Step::StencilExport {
            written,
            reference,
            draw,
        } => {
            let lost = if i32::from(*reference) == *written {
                String::new()
            } else {
                format!(", whose lowest 8 bits are {reference}")
            };
            format!("the shader writes {written}{lost}, in place of the draw's {draw}")
        }
        Step::LateStencilExport { draw } => {
            format!("forced tests come before the shader: the draw's {draw} counts")
        }
        Step::GiveUp { worlds } => format!("{worlds} worlds: the sample is open"),
        Step::ReadBack {
            attachment,
            contents,
            depth_by_shader,
        } => {
            let how = if *depth_by_shader {
                ", its depth read by a shader"
            } else {
                ""
            };
            format!("{attachment} holds {}{how}", aspects(contents))
        }
        Step::Relation(name) => name.clone(),
    }
}

/// Returns the predicate of a draw that a rejection ends, from the details of its event.
pub(super) fn rejection_predicate(rejection: Rejection, detail: &str) -> String {
    match rejection {
        Rejection::RasterizerDiscard => "is discarded before rasterization".to_owned(),
        Rejection::Coverage => "does not cover it".to_owned(),
        Rejection::Viewport | Rejection::Scissor => format!("is {detail}"),
        Rejection::NearFar | Rejection::ClipDistance => format!("is clipped there: {detail}"),
        Rejection::CullDistance => "has a cull distance below 0 at all vertices".to_owned(),
        Rejection::Culling => format!("is culled: {detail}"),
        Rejection::SampleCoverage => format!("loses it to sample coverage: {detail}"),
        Rejection::SampleMask => format!("is masked: {detail}"),
        Rejection::Discard => format!("is discarded by its shader: {detail}"),
        Rejection::ShaderMask => format!("is masked by its shader: {detail}"),
        Rejection::AlphaToCoverage => format!("loses it to alpha to coverage: {detail}"),
        Rejection::DepthBounds => format!("fails its depth bounds test: {detail}"),
        Rejection::Stencil => format!("fails its stencil test: {detail}"),
        Rejection::Depth => format!("fails its depth test: {detail}"),
    }
}

fn face(front: bool) -> &'static str {
    if front { "front face" } else { "back face" }
}

/// Returns the contents of one attachment: `1, 0, 0, 1`, or `depth 0.5, stencil 3`.
fn aspects(contents: &[Contents]) -> String {
    let aspect = |contents: &Contents| {
        let codes = codes_list(&contents.codes);
        match contents.aspect {
            Aspect::Color => codes,
            other => format!("{} {codes}", other.name()),
        }
    };
    contents.iter().map(aspect).collect::<Vec<_>>().join(", ")
}

/// Returns the contents of several attachments: `color holds 1, 0, 0, 1; depth holds depth 0.5`.
fn holds(contents: &[Contents]) -> String {
    let attachments = contents.chunk_by(|a, b| a.attachment == b.attachment);
    let texts =
        attachments.map(|group| format!("{} holds {}", group[0].attachment, aspects(group)));
    texts.collect::<Vec<_>>().join("; ")
}

fn blended(channel: &BlendedChannel) -> String {
    format!(
        "{} × {} {} {} × {} = {}",
        range(&channel.src),
        channel.src_factor,
        channel.operation,
        range(&channel.dst),
        channel.dst_factor,
        range(&channel.result)
    )
}

fn depth_test(test: &DepthTest, effect: &Effect) -> String {
    match test {
        DepthTest::Same { compare } => {
            let passes = effect.is_none();
            format!("the same depth {compare} itself is {passes}")
        }
        DepthTest::Compared {
            compare,
            incoming,
            stored,
        } => {
            let outcome = match effect {
                Effect::Rejects(_) => "is false",
                Effect::MayReject(_) => "may be true or false: two worlds",
                _ => "is true",
            };
            let [incoming, stored] = [incoming, stored].map(range);
            format!("{incoming} {compare} stored {stored} {outcome}")
        }
    }
}

fn coverage_text(coverage: Coverage) -> String {
    match coverage {
        Coverage::Outside => "it does not cover the sample".to_owned(),
        Coverage::OutsideOneWay => {
            "with one of its possible facings, it does not cover the sample".to_owned()
        }
        Coverage::Times { least: 0, most: 1 } => {
            "it may or may not cover the sample: two worlds".to_owned()
        }
        Coverage::Times { least, most } => {
            format!("it may cover the sample {least} to {most} times: a world for each")
        }
        Coverage::NoArea => "it has no area".to_owned(),
        Coverage::PerhapsNoArea => {
            "snapping may leave it without area: it covers nothing in one world".to_owned()
        }
        Coverage::NotTopLeft { edge } => {
            format!("the sample lies on edge {edge}, neither a top nor a left one")
        }
        Coverage::Edge {
            edge,
            covers: Some(true),
            ..
        } => format!(
            "edge {edge} is shared, and its other primitive did not cover the sample in this world: this one does"
        ),
        Coverage::Edge {
            edge,
            covers: Some(false),
            ..
        } => format!(
            "edge {edge} is shared, and its other primitive covered the sample in this world: this one does not"
        ),
        Coverage::Edge {
            edge, exact: true, ..
        } => {
            format!(
                "the sample lies on edge {edge}: two worlds, covered (followed here) and not covered"
            )
        }
        Coverage::Edge { edge, .. } => format!(
            "the sample is within the snapping distance of edge {edge}: two worlds, covered (followed here) and not covered"
        ),
    }
}

/// Returns a sentence about primitives that do not reach a sample. The event's origin numbers them.
fn primitives(event: &Event, count: usize, viewport: Option<[f32; 4]>) -> String {
    let Origin::Draw { primitives, .. } = &event.origin else {
        return String::new();
    };
    let who = match (primitives.as_slice(), count) {
        ([_], 1) => "the primitive".to_owned(),
        ([number], _) => format!("primitive {number}"),
        ([_, _], 2) => "both primitives".to_owned(),
        (several, count) if several.len() == count => format!("all {count} primitives"),
        (several, _) => format!("primitives {}", ranges(several)),
    };
    let [lie, cover] = match primitives.len() {
        1 => ["lies", "does not cover"],
        _ => ["lie", "do not cover"],
    };
    match event.effect.rejection() {
        Some(Rejection::Viewport) => {
            let rect = viewport
                .unwrap_or_default()
                .map(|v| v.to_string())
                .join(",");
            let is_complete = primitives.len() == count;
            let who = if is_complete {
                String::new()
            } else {
                format!(" with {who}")
            };
            format!("outside its viewport [{rect}]{who}")
        }
        Some(Rejection::NearFar) => format!("{who} {lie} beyond the near or far plane"),
        Some(Rejection::ClipDistance) => format!("{who} {lie} behind a clip distance"),
        _ => format!("{who} {cover} the sample"),
    }
}

/// Returns increasing numbers as ranges: `0 to 4, 6 and 9`. Long lists are cut short.
fn ranges(numbers: &[u32]) -> String {
    const SHOWN: usize = 6;
    let ranges: Vec<&[u32]> = numbers.chunk_by(|a, b| a + 1 == *b).collect();
    let more: usize = ranges.iter().skip(SHOWN).map(|r| r.len()).sum();
    let mut texts: Vec<String> = ranges
        .iter()
        .take(SHOWN)
        .map(|range| match range {
            [number] => number.to_string(),
            [first, second] => format!("{first}, {second}"),
            several => format!("{} to {}", several[0], several[several.len() - 1]),
        })
        .collect();
    if more > 0 {
        texts.push(format!("{more} more"));
    }
    list(&texts, "and")
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::ValueRange;

    fn detail(step: Step, effect: Effect) -> String {
        let origin = Origin::Draw {
            pass: 0,
            draw: 2,
            primitives: (0..1000).collect(),
        };
        event_line(&Event {
            scene: None,
            origin,
            step,
            effect,
            citation: None,
        })
        .detail
    }

    #[test]
    fn many_primitives_are_named_in_few_words() {
        assert_eq!(ranges(&[3]), "3");
        assert_eq!(ranges(&[0, 1, 2, 4, 5, 9]), "0 to 2, 4, 5 and 9");
        let thousand: Vec<u32> = (0..1000).filter(|n| *n != 7).collect();
        assert_eq!(ranges(&thousand), "0 to 6 and 8 to 999");
        let even: Vec<u32> = (0..1000).step_by(2).collect();
        assert_eq!(ranges(&even), "0, 2, 4, 6, 8, 10 and 494 more");
        let step = |count| Step::Primitives {
            count,
            viewport: None,
        };
        let outside = Effect::Rejects(Rejection::Coverage);
        assert_eq!(
            detail(step(1001), outside),
            "primitives 0 to 999 do not cover the sample"
        );
        let beyond = Effect::Rejects(Rejection::NearFar);
        assert_eq!(
            detail(step(1000), beyond),
            "all 1000 primitives lie beyond the near or far plane"
        );
    }

    #[test]
    fn tests_have_their_inputs_and_outcome() {
        let exact = |value| ValueRange {
            low: value,
            high: value,
        };
        let depth = || {
            Step::DepthTest(DepthTest::Compared {
                compare: "less".to_owned(),
                incoming: exact(0.5),
                stored: exact(0.25),
            })
        };
        let fails = Effect::Rejects(Rejection::Depth);
        assert_eq!(detail(depth(), fails), "0.5 less stored 0.25 is false");
        assert_eq!(
            detail(depth(), Effect::None),
            "0.5 less stored 0.25 is true"
        );
        let stencil = |exported| Step::StencilTest {
            reference: 44,
            exported,
            compare: "greater".to_owned(),
            stored: 5,
            read_mask: 0xff,
            depth_fails: false,
        };
        assert_eq!(
            detail(stencil(true), Effect::None),
            "exported reference 44 greater stored 5 under read mask 0xff passes"
        );
        assert_eq!(
            detail(stencil(false), Effect::Rejects(Rejection::Stencil)),
            "reference 44 greater stored 5 under read mask 0xff fails"
        );
        let export = Step::StencilExport {
            written: 300,
            reference: 44,
            draw: 9,
        };
        assert_eq!(
            detail(export, Effect::None),
            "the shader writes 300, whose lowest 8 bits are 44, in place of the draw's 9"
        );
        assert_eq!(
            detail(Step::LateStencilExport { draw: 9 }, Effect::None),
            "forced tests come before the shader: the draw's 9 counts"
        );
    }
}
