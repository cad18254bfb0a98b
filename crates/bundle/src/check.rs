//! The comparison of what came back with what is allowed, as C.

use crate::c;
use crate::due::{Due, DueChannel, DueTexel};
use crate::error::BundleError;
use etalon_backend::{Form, Recording};
use etalon_frame::ChannelEncoding;
use std::fmt::Write;

/// How a number is put in order.
const TYPES: &str = r#"
/* How the bits of a channel are compared: as a number, a signed number, a float of 16 bits (by its sign and magnitude),
 * a float of 32 bits, or a byte that a shorter code was widened to. */
enum order { UNSIGNED, SIGNED, HALF, SINGLE, VALUE, WIDENED };

struct channel {
    const char *name;
    const unsigned char *texel;
    unsigned bit, bits;
    enum order order;
    unsigned width;
};

struct range {
    double least, most;
};

struct texel {
    const char *place;
    unsigned channels, outcomes;
    const struct channel *channel;
    const struct range *allowed;
};

static double value_of(const struct channel *c)
{
    uint64_t word = 0;
    uint32_t code, sign;
    float value;
    memcpy(&word, c->texel + c->bit / 8, (c->bit % 8 + c->bits + 7) / 8);
    code = (uint32_t)(word >> c->bit % 8) & (0xFFFFFFFFu >> (32 - c->bits));
    sign = 1u << (c->width - 1);
    switch (c->order) {
    case SIGNED:
        return (code & sign) ? (double)code - 2.0 * sign : code;
    case HALF:
    case SINGLE:
        return (code & sign) ? -(double)(code - sign) : code;
    case VALUE:
        memcpy(&value, &code, sizeof value);
        return value;
    case WIDENED:
        return (code * ((1u << c->width) - 1) + 127) / 255;
    default:
        return code;
    }
}

static int is_allowed(const struct texel *t, const struct range *outcome)
{
    unsigned i;
    for (i = 0; i < t->channels; i++) {
        double value = value_of(&t->channel[i]);
        if (!(value >= outcome[i].least && value <= outcome[i].most))
            return 0;
    }
    return 1;
}

static int is_right(const struct texel *t)
{
    unsigned i;
    for (i = 0; i < t->outcomes; i++)
        if (is_allowed(t, t->allowed + i * t->channels))
            return 1;
    return 0;
}

/* The number that a place in the order stands for. */
static double shown(const struct channel *c, double order)
{
    double sign = order < 0 ? -1 : 1, size = fabs(order);
    uint32_t code = size < 0x7F800000 ? (uint32_t)size : 0x7F800000;
    float value;
    if (c->order == SINGLE) {
        memcpy(&value, &code, sizeof value);
        return sign * (double)value;
    }
    if (c->order == HALF && size < 0x7C00)
        return sign * (code < 0x400 ? ldexp(code, -24) : ldexp(code % 0x400 + 0x400, (int)(code / 0x400) - 25));
    return c->order == HALF ? sign * INFINITY : order;
}

static void tell(const struct texel *t)
{
    unsigned i;
    printf("%s is wrong:", t->place);
    for (i = 0; i < t->channels; i++) {
        const struct channel *c = &t->channel[i];
        double value = value_of(c);
        double least = t->allowed[i].least, most = t->allowed[i].most;
        if (t->outcomes == 1 && value >= least && value <= most)
            continue;
        printf(" %s %.9g", c->name, shown(c, value));
        if (t->outcomes != 1)
            continue;
        if (least == most)
            printf(" (must be %.9g)", shown(c, least));
        else if (isinf(most))
            printf(" (must be at least %.9g)", shown(c, least));
        else if (isinf(least))
            printf(" (must be at most %.9g)", shown(c, most));
        else
            printf(" (must be %.9g to %.9g)", shown(c, least), shown(c, most));
    }
    printf("\n");
}
"#;

/// Returns the function that checks what was read.
pub(crate) fn check(recording: &Recording, due: &Due) -> Result<String, BundleError> {
    let mut text = String::new();
    if !due.texels.is_empty() {
        text.push_str(TYPES);
    }
    let mut texels = String::new();
    for (number, texel) in due.texels.iter().enumerate() {
        let _ = write!(
            text,
            "\nstatic const struct channel channels_{number}[] = {{\n"
        );
        for channel in &texel.channels {
            text.push_str(&place(recording, texel, channel)?);
        }
        let _ = write!(
            text,
            "}};\nstatic const struct range allowed_{number}[] = {{\n"
        );
        for outcome in &texel.allowed {
            let ranges: Vec<String> = outcome
                .iter()
                .zip(&texel.channels)
                .map(|(range, channel)| {
                    let [least, most] = bounds(*range, channel.encoding, form(recording, channel));
                    format!("{{ {}, {} }}", c::double(least), c::double(most))
                })
                .collect();
            let _ = writeln!(text, "    {},", ranges.join(", "));
        }
        text.push_str("};\n");
        let at = match texel.sample {
            0 => format!("texel {},{}", texel.x, texel.y),
            sample => format!("sample {sample} of texel {},{}", texel.x, texel.y),
        };
        let _ = writeln!(
            texels,
            "        {{ {}, {}, {}, channels_{number}, allowed_{number} }},",
            c::string(&at),
            texel.channels.len(),
            texel.allowed.len(),
        );
    }
    text.push_str("\nstatic int check_values(void)\n{\n");
    if !texels.is_empty() {
        let _ = write!(
            text,
            "    static const struct texel all[] = {{\n{texels}    }};\n    unsigned i;\n    for (i = 0; i < sizeof all / sizeof *all; \
             i++)\n        if (!is_right(&all[i])) {{\n            tell(&all[i]);\n            return BUG;\n        }}\n"
        );
    }
    for counter in &due.counters {
        text.push_str(&counted(recording, counter)?);
    }
    text.push_str("    printf(\"right\\n\");\n    return 0;\n}\n");
    Ok(text)
}

fn unread(channel: &DueChannel) -> BundleError {
    BundleError::Unread(channel.name())
}

/// Returns the form in which a channel came back.
fn form(recording: &Recording, channel: &DueChannel) -> Form {
    let image = recording
        .images
        .iter()
        .find(|i| i.attachment == channel.attachment && i.aspect == channel.aspect);
    image
        .and_then(|i| i.planes.first())
        .map_or(Form::Code, |plane| plane.form)
}

/// Returns the row of a channel in the table.
fn place(
    recording: &Recording,
    texel: &DueTexel,
    channel: &DueChannel,
) -> Result<String, BundleError> {
    let of = |i: &&etalon_backend::RecordedImage| {
        i.attachment == channel.attachment && i.aspect == channel.aspect
    };
    let image = recording
        .images
        .iter()
        .find(of)
        .ok_or_else(|| unread(channel))?;
    let plane = image
        .planes
        .get(texel.sample as usize)
        .ok_or_else(|| unread(channel))?;
    let [bit, bits] = plane
        .channels
        .get(channel.channel)
        .ok_or_else(|| unread(channel))?;
    let at = (u64::from(texel.y) * u64::from(image.size[0]) + u64::from(texel.x))
        * u64::from(plane.texel);
    let (order, width) = match (plane.form, channel.encoding) {
        (Form::Float | Form::Fraction, _) => ("VALUE", 32),
        (Form::Byte, encoding) => match width(encoding) {
            8 => ("UNSIGNED", 8),
            width => ("WIDENED", width),
        },
        (Form::Code, ChannelEncoding::Snorm(bits)) => ("SIGNED", u32::from(bits)),
        (Form::Code, ChannelEncoding::Float16) => ("HALF", 16),
        (Form::Code, ChannelEncoding::Float32) => ("SINGLE", 32),
        (Form::Code, encoding) => ("UNSIGNED", width(encoding)),
    };
    Ok(format!(
        "    {{ {}, memory_{} + {at}, {bit}, {bits}, {order}, {width} }},\n",
        c::string(&channel.name()),
        plane.output,
    ))
}

/// Returns the width of a code in bits.
fn width(encoding: ChannelEncoding) -> u32 {
    match encoding {
        ChannelEncoding::Unorm(bits)
        | ChannelEncoding::Snorm(bits)
        | ChannelEncoding::Uint(bits) => u32::from(bits),
        ChannelEncoding::Srgb8 => 8,
        ChannelEncoding::Float16 => 16,
        ChannelEncoding::Float32 => 32,
        ChannelEncoding::Ufloat(mantissa) => u32::from(mantissa) + 5,
    }
}

/// Returns the bounds of a range of orders, as the numbers that the program compares. Of a value that came back as a
/// float the bounds lie half way to the next code.
fn bounds([least, most]: [i64; 2], encoding: ChannelEncoding, form: Form) -> [f64; 2] {
    let encoding = match (form, encoding) {
        (Form::Fraction, ChannelEncoding::Srgb8) => ChannelEncoding::Unorm(8),
        _ => encoding,
    };
    if !matches!(form, Form::Float | Form::Fraction) {
        return [least as f64, most as f64];
    }
    let value = |order: i64| encoding.value_of_order(order);
    if encoding == ChannelEncoding::Float32 {
        return [value(least), value(most)];
    }
    let below = match least > encoding.min_order() {
        true => (value(least - 1) + value(least)) / 2.0,
        false => f64::NEG_INFINITY,
    };
    let above = match most < encoding.max_order() {
        true => (value(most) + value(most + 1)) / 2.0,
        false => f64::INFINITY,
    };
    [below, above]
}

/// Returns the statements that check a counter.
fn counted(recording: &Recording, due: &crate::due::DueCounter) -> Result<String, BundleError> {
    let missing = || BundleError::Unread(format!("counter {}", due.name));
    let counter = recording
        .counters
        .get(due.index)
        .filter(|c| !c.parts.is_empty());
    let counter = counter.ok_or_else(missing)?;
    let mut text = String::from("    {\n        uint64_t count = 0, part;\n");
    for part in &counter.parts {
        let _ = write!(
            text,
            "        part = 0;\n        memcpy(&part, memory_{} + {}, {});\n",
            part.output, part.offset, part.bytes,
        );
        text.push_str(match counter.any {
            true => "        count |= part != 0;\n",
            false => "        count += part;\n",
        });
    }
    let above = match due.most {
        Some(most) => format!(" || count > {most}u"),
        None => String::new(),
    };
    let allowed = match due.most {
        Some(most) if most == due.least => format!("{most}"),
        Some(most) => format!("{} to {most}", due.least),
        None => format!("at least {}", due.least),
    };
    let _ = write!(
        text,
        "        if (count < {}u{above}) {{\n            printf(\"counter %s is %llu (must be %s)\\n\", {}, (unsigned long \
         long)count, {});\n            return BUG;\n        }}\n    }}\n",
        due.least,
        c::string(&due.name),
        c::string(&allowed),
    );
    Ok(text)
}
