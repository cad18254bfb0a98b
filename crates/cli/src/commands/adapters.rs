//! `etalon adapters`.

use crate::adapters::discover;
use crate::args::{AdaptersArguments, Format};
use crate::failure::Failure;
use crate::output::{print, print_json};
use etalon_record::AdapterRecord;

/// Lists what can be used and what cannot, why, and what would help.
pub(crate) fn run(arguments: &AdaptersArguments) -> Result<u8, Failure> {
    let adapters = discover(&[])?;
    let ready: Vec<AdapterRecord> = adapters.ready.iter().map(|(_, w)| w.into()).collect();
    if arguments.format == Format::Json {
        print_json(&ready)?;
        return Ok(0);
    }
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
    print(&text)?;
    Ok(0)
}
