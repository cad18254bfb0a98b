//! The comparison of the values read back with the permitted ones, as C.

use crate::c;
use crate::due::Due;
use crate::error::BundleError;
use crate::table::{self, BitOrder};
use etalon_backend::Recording;
use std::fmt::Write;

/// The types and functions for the table of expected values, as C.
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
    double sign = order < 0 ? -1 : 1, size = fabs(order), infinity = c->order == SINGLE ? 0x7F800000 : 0x7C00;
    uint32_t code = size < 0x7F800000 ? (uint32_t)size : 0x7F800000;
    float value;
    if ((c->order == SINGLE || c->order == HALF) && size > infinity && !isinf(size))
        return NAN;
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

/// Returns the function that checks the values that were read.
pub(crate) fn check(recording: &Recording, expected: &Due) -> Result<String, BundleError> {
    let mut text = String::new();
    if !expected.texels.is_empty() {
        text.push_str(TYPES);
    }
    let mut texels = String::new();
    for (number, texel) in table::texels(recording, expected)?.iter().enumerate() {
        let _ = write!(
            text,
            "\nstatic const struct channel channels_{number}[] = {{\n"
        );
        for channel in &texel.channels {
            let _ = writeln!(
                text,
                "    {{ {}, memory_{} + {}, {}, {}, {}, {} }},",
                c::string(&channel.name),
                channel.output,
                channel.at,
                channel.bit,
                channel.bits,
                order(channel.order),
                channel.width,
            );
        }
        let _ = write!(
            text,
            "}};\nstatic const struct range allowed_{number}[] = {{\n"
        );
        for outcome in &texel.allowed {
            let range = |[least, most]: &[f64; 2]| {
                format!("{{ {}, {} }}", c::double(*least), c::double(*most))
            };
            let ranges: Vec<String> = outcome.iter().map(range).collect();
            let _ = writeln!(text, "    {},", ranges.join(", "));
        }
        text.push_str("};\n");
        let _ = writeln!(
            texels,
            "        {{ {}, {}, {}, channels_{number}, allowed_{number} }},",
            c::string(&texel.place),
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
    for counter in &expected.counters {
        text.push_str(&counted(recording, counter)?);
    }
    text.push_str("    printf(\"right\\n\");\n    return 0;\n}\n");
    Ok(text)
}

fn order(order: BitOrder) -> &'static str {
    match order {
        BitOrder::Unsigned => "UNSIGNED",
        BitOrder::Signed => "SIGNED",
        BitOrder::Half => "HALF",
        BitOrder::Single => "SINGLE",
        BitOrder::Value => "VALUE",
        BitOrder::Widened => "WIDENED",
    }
}

/// Returns the statements that check a counter.
fn counted(
    recording: &Recording,
    expected: &crate::due::DueCounter,
) -> Result<String, BundleError> {
    let counter = table::counter(recording, expected)?;
    let mut text = String::from("    {\n        uint64_t count = 0, part;\n");
    for part in &counter.parts {
        let _ = write!(
            text,
            "        part = 0;\n        memcpy(&part, memory_{} + {}, {});\n",
            part.output, part.offset, part.bytes,
        );
        text.push_str(if counter.any {
            "        count |= part != 0;\n"
        } else {
            "        count += part;\n"
        });
    }
    let above = match expected.range.high {
        Some(most) => format!(" || count > {most}u"),
        None => String::new(),
    };
    let _ = write!(
        text,
        "        if (count < {}u{above}) {{\n            printf(\"counter %s is %llu (must be %s)\\n\", {}, (unsigned long \
         long)count, {});\n            return BUG;\n        }}\n    }}\n",
        expected.range.low,
        c::string(&expected.name),
        c::string(&expected.range.to_string()),
    );
    Ok(text)
}
