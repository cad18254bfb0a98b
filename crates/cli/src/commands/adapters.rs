//! `etalon adapters`.

use crate::adapters::{Origin, Query, discover};
use crate::failure::Failure;
use crate::flags::{AdapterFileArguments, Format};
use crate::output::{print, print_json};
use clap::Args;
use etalon_record::AdapterRecord;
use serde::Serialize;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) file: AdapterFileArguments,
    /// Output format; JSON is an array with one object per adapter that can be used
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

/// All facts of an adapter: identity, limits and origin.
#[derive(Serialize)]
struct Facts<'a> {
    #[serde(flatten)]
    record: AdapterRecord,
    #[serde(flatten)]
    origin: Option<&'a Origin>,
}

/// Lists the usable adapters, and the others with reason and remedy.
pub(crate) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let adapters = discover(&Query {
        file: arguments.file.adapter_file.as_deref(),
        ..Query::default()
    })?;
    let ready: Vec<Facts<'_>> = adapters
        .ready
        .iter()
        .map(|(launch, worker)| Facts {
            record: worker.into(),
            origin: adapters.origins.get(&launch.adapter),
        })
        .collect();
    if arguments.format == Format::Json {
        print_json(&ready)?;
        return Ok(0);
    }
    let ready: Vec<&AdapterRecord> = ready.iter().map(|facts| &facts.record).collect();
    let mut text = String::new();
    let width = ready.iter().map(|a| a.name.len()).max().unwrap_or(0);
    for adapter in &ready {
        text.push_str(&format!(
            "{:width$}  {}; {}; {}\n",
            adapter.name,
            adapter.device,
            adapter.driver_text(),
            adapter.api_version
        ));
    }
    if !adapters.absent.is_empty() {
        text.push_str("\nUnavailable:\n");
        for absent in &adapters.absent {
            text.push_str(&format!(
                "  {}: {}\n      {}\n",
                absent.name, absent.reason, absent.remedy
            ));
        }
    }
    if !adapters.not_enabled.is_empty() {
        text.push('\n');
        for adapter in &adapters.not_enabled {
            text.push_str(&format!(
                "Not enabled: {}: {}\n",
                adapter.name, adapter.remedy
            ));
        }
    }
    print(&text)?;
    Ok(0)
}
