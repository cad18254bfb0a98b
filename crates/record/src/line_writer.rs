//! Writing of `run.jsonl` and `bench.jsonl`.

use crate::error::RecordError;
use crate::output_folder::OutputFolder;
use std::fs::File;
use std::io::{BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// Writes lines to a file of a folder, and returns it to append more. The file is renamed into place, so that it
/// never has half a header.
pub(crate) fn put<L: AsRef<[u8]>>(
    out: &OutputFolder,
    name: &str,
    lines: impl IntoIterator<Item = Result<L, RecordError>>,
) -> Result<File, RecordError> {
    let placed = out.place(name, |file| {
        let mut file = BufWriter::new(file);
        for line in lines {
            file.write_all(line?.as_ref())?;
        }
        file.flush()?;
        file.get_ref().sync_data()?;
        Ok(())
    });
    placed.map(|(_, file)| file)
}

/// Opens a file to append lines after its first `whole` bytes; cuts off what follows them.
pub(crate) fn reopen(path: &Path, length: u64) -> Result<File, RecordError> {
    let mut file = File::options()
        .read(true)
        .write(true)
        .open(path)
        .map_err(RecordError::io("write", path))?;
    cut(&mut file, length).map_err(RecordError::io("write", path))?;
    Ok(file)
}

fn cut(file: &mut File, length: u64) -> std::io::Result<()> {
    file.set_len(length)?;
    file.seek(SeekFrom::Start(length.saturating_sub(1)))?;
    let mut last = [0];
    file.read_exact(&mut last)?;
    // The last line can lack its newline.
    if last != *b"\n" {
        file.write_all(b"\n")?;
    }
    Ok(())
}
