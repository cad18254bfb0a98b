//! `etalon adapters`.

use crate::discovery::discover;
use crate::failure::Failure;
use crate::flags::{AdapterFileArguments, OutputFormat};
use crate::output::{print, print_json};
use clap::Args;
use etalon_adapters::{Origin, Query};
use etalon_frame::Api;
use etalon_record::{AbsentAdapter, AdapterRecord};
use etalon_report::api_name;
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Show what each unavailable adapter needs
    #[arg(long)]
    pub(crate) remedies: bool,
    /// Output format; JSON is an array with one object per adapter that can be used
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// All facts of an adapter: identity, limits and origin.
#[derive(Serialize)]
struct AdapterFacts<'a> {
    #[serde(flatten)]
    record: AdapterRecord,
    #[serde(flatten)]
    origin: Option<&'a Origin>,
}

/// Lists the usable adapters, and the others with their reason and, on request, their remedy.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let adapters = discover(&Query {
        file: arguments.file.adapter_file.as_deref(),
        ..Query::default()
    })?;
    let ready: Vec<AdapterFacts<'_>> = adapters
        .ready
        .iter()
        .map(|(launch, worker)| AdapterFacts {
            record: worker.into(),
            origin: adapters.origins.get(&launch.adapter),
        })
        .collect();
    if arguments.format == OutputFormat::Json {
        print_json(&ready)?;
        return Ok(0);
    }
    let ready: Vec<&AdapterRecord> = ready.iter().map(|facts| &facts.record).collect();
    let lists = [
        usable(&ready),
        others("Unavailable", &adapters.absent, arguments.remedies),
        others("Not enabled", &adapters.not_enabled, arguments.remedies),
    ];
    let hidden = adapters.absent.len() + adapters.not_enabled.len() > 0 && !arguments.remedies;
    let hint =
        hidden.then(|| "etalon adapters --remedies shows what each of them needs\n".to_owned());
    let parts: Vec<String> = lists
        .into_iter()
        .chain(hint)
        .filter(|part| !part.is_empty())
        .collect();
    print(&parts.join("\n"))?;
    Ok(0)
}

/// Returns the usable adapters in columns, by the API whose rules judge them.
fn usable(adapters: &[&AdapterRecord]) -> String {
    let widest = |text: fn(&AdapterRecord) -> String| {
        let widths = adapters.iter().map(|adapter| text(adapter).chars().count());
        widths.max().unwrap_or(0)
    };
    let name = widest(|adapter| adapter.info.name.clone());
    let device = widest(|adapter| adapter.info.device.clone());
    let driver = widest(AdapterRecord::driver_text);
    let mut groups: BTreeMap<Api, String> = BTreeMap::new();
    for adapter in adapters {
        let api = adapter.limits.api;
        let group = groups
            .entry(api)
            .or_insert_with(|| format!("By the rules of {}\n", api_name(api)));
        *group += &format!(
            "  {:name$}  {:device$}  {:driver$}  {}\n",
            adapter.info.name,
            adapter.info.device,
            adapter.driver_text(),
            adapter.info.api_version
        );
    }
    groups.into_values().collect::<Vec<_>>().join("\n")
}

/// Adapters that cannot be used, with reasons and, on request, remedies.
fn others(title: &str, adapters: &[AbsentAdapter], remedies: bool) -> String {
    let mut text = String::new();
    for adapter in adapters {
        let AbsentAdapter {
            name,
            reason,
            remedy,
        } = adapter;
        text += &format!("  {name}: {reason}\n");
        if remedies {
            text += &format!("      {remedy}\n");
        }
    }
    if adapters.is_empty() {
        String::new()
    } else {
        format!("{title}\n{text}")
    }
}
