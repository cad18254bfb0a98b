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
    /// For people or for programs (a JSON array, one object per adapter that can be used)
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

/// All that is known of an adapter: who it is, what it can do, and how it is reached.
#[derive(Serialize)]
struct Facts<'a> {
    #[serde(flatten)]
    record: AdapterRecord,
    #[serde(flatten)]
    origin: Option<&'a Origin>,
}

/// Lists what can be used and what cannot, why, and what would help.
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
        text.push_str("\nNot here:\n");
        for absent in &adapters.absent {
            text.push_str(&format!(
                "  {}: {}\n      {}\n",
                absent.name, absent.reason, absent.remedy
            ));
        }
    }
    if !adapters.unasked.is_empty() {
        text.push('\n');
        for unasked in &adapters.unasked {
            text.push_str(&format!(
                "Not asked for: {}: {}\n",
                unasked.name, unasked.remedy
            ));
        }
    }
    print(&text)?;
    Ok(0)
}
