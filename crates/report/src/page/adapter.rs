//! Adapters on pages: their names and their facts.

use crate::numbers::count;
use crate::table::{Cell, Table};
use etalon_frame::{AdapterName, Limits, TextureFormat};
use etalon_record::{AbsentAdapter, AdapterRecord};
use maud::{Markup, PreEscaped, html};

/// Returns a name with an optional line break after each colon.
pub(crate) fn breakable(name: &str) -> Markup {
    html! {
        @for (i, part) in AdapterName::new(name).parts().enumerate() {
            @if i > 0 { ":" (PreEscaped("<wbr>")) }
            (part)
        }
    }
}

/// Returns a table cell with an adapter's name.
pub(crate) fn adapter(name: &str) -> Cell {
    Cell::from(name).on_page(breakable(name))
}

/// Returns the adapters of a recording, and the remedies for absent ones.
pub(crate) fn section(adapters: &[AdapterRecord], absent: &[AbsentAdapter]) -> Markup {
    html! {
        section id="adapters" {
            h2 { "Adapters" }
            @if adapters.is_empty() { p { "None." } }
            @for adapter in adapters { (details(adapter)) }
            @if !absent.is_empty() {
                h3 { "Absent" }
                (absent_table().page(absent))
            }
        }
    }
}

fn absent_table<'a>() -> Table<'a, &'a AbsentAdapter> {
    Table::new("text")
        .spoken("Adapters that are absent")
        .head("Adapter", |absent: &&AbsentAdapter| &*absent.name)
        .text("Reason", |absent| &*absent.reason)
        .text("Remedy", |absent| &*absent.remedy)
}

fn details(a: &AdapterRecord) -> Markup {
    let kind = if a.info.software {
        "software"
    } else {
        "hardware"
    };
    let l = &a.limits;
    html! {
        details {
            summary { code { (a.info.name) } " " small { (a.info.device) ", " (a.driver_text()) ", " (kind) } }
            dl.facts {
                dt { "Backend" } dd { (a.info.backend) }
                dt { "Device" } dd { (a.info.device) " (" (kind) ")" }
                dt { "Driver" } dd { (a.driver_text()) }
                dt { "API version" } dd { (a.info.api_version) }
                dt { "Rules" } dd { (l.api.name()) }
                dt { "Sub-pixel bits" } dd { (l.sub_pixel_bits) }
                dt { "Largest attachment" } dd { (l.max_size) " texels a side" }
                dt { "Features" } dd {
                    @if l.features.is_empty() { "none" }
                    @for (i, feature) in l.features.iter().enumerate() {
                        @if i > 0 { ", " } (feature.name())
                    }
                }
                @for (samples, positions) in &l.sample_positions {
                    dt { (count(u64::from(*samples), "sample")) }
                    dd {
                        @for [x, y] in positions { "(" (x) ", " (y) ") " }
                        "in 1/256 texel"
                    }
                }
            }
            (formats(l))
        }
    }
}

fn formats(limits: &Limits) -> Markup {
    let support = |format: &TextureFormat| limits.formats.get(format);
    let list = |names: Vec<String>, with: &str| names.join(with);
    Table::<TextureFormat>::new("text")
        .caption("Texel formats")
        .head("Format", |format| format.name())
        .text("Samples", move |format| match support(format) {
            Some(s) => list(s.samples.iter().map(u32::to_string).collect(), ", "),
            None => "– not supported".to_owned(),
        })
        .text("Depth encoding", move |format| {
            let depth = support(format).map(|s| s.depth.iter());
            list(
                depth.into_iter().flatten().map(|d| d.to_string()).collect(),
                " or ",
            )
        })
        .text("Read by", move |format| {
            support(format).map_or_else(String::new, |s| format!("{:?}", s.read).to_lowercase())
        })
        .page(TextureFormat::ALL)
}
