//! Adapters on pages: their names and their facts.

use crate::numbers::count;
use etalon_frame::{FormatSupport, Limits, TextureFormat};
use etalon_record::AdapterRecord;
use maud::{Markup, PreEscaped, html};

/// A name that may break after each of its colons.
pub(crate) fn breakable(name: &str) -> Markup {
    html! {
        @for (i, part) in name.split(':').enumerate() {
            @if i > 0 { ":" (PreEscaped("<wbr>")) }
            (part)
        }
    }
}

pub(crate) fn details(a: &AdapterRecord) -> Markup {
    let kind = if a.software { "software" } else { "hardware" };
    let l = &a.limits;
    html! {
        details {
            summary { code { (a.name) } " " small { (a.device) ", " (a.driver_text()) ", " (kind) } }
            dl.facts {
                dt { "Backend" } dd { (a.backend) }
                dt { "Device" } dd { (a.device) " (" (kind) ")" }
                dt { "Driver" } dd { (a.driver_text()) }
                dt { "API version" } dd { (a.api_version) }
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
    html! {
        div.wide { table.text {
            caption { "Texel formats" }
            thead { tr { th scope="col" { "Format" } th scope="col" { "Samples" } th scope="col" { "Depth encoding" } th scope="col" { "Read by" } } }
            tbody {
                @for format in TextureFormat::ALL { (format_row(format, limits.formats.get(&format))) }
            }
        } }
    }
}

fn format_row(format: TextureFormat, support: Option<&FormatSupport>) -> Markup {
    let join = |texts: Vec<String>, with: &str| texts.join(with);
    html! {
        tr {
            th scope="row" { (format.name()) }
            @if let Some(s) = support {
                td { (join(s.samples.iter().map(u32::to_string).collect(), ", ")) }
                td { (join(s.depth.iter().map(|d| d.to_string()).collect(), " or ")) }
                td { (format!("{:?}", s.read).to_lowercase()) }
            } @else {
                td colspan="3" { "– not supported" }
            }
        }
    }
}
