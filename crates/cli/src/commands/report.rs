//! `etalon report`.

use crate::args::ReportArguments;
use crate::failure::Failure;
use crate::output::{color, print, width};
use etalon_record::Run;
use etalon_report::TableOptions;

/// Makes the reports of run folders anew, from the folders alone.
pub(crate) fn run(arguments: &ReportArguments) -> Result<u8, Failure> {
    for folder in &arguments.folders {
        let run = Run::read(folder).map_err(Failure::usage)?;
        let written = etalon_report::write(folder).map_err(Failure::usage)?;
        let options = TableOptions {
            width: width(),
            color: color(),
        };
        print(&etalon_report::table(&run, options))?;
        print(&format!("\n{}\n", written.html.display()))?;
    }
    Ok(0)
}
