//! One Parquet file.

use crate::error::ExportError;
use parquet::basic::{Compression, GzipLevel};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use std::fs::{self, File};
use std::path::PathBuf;
use std::sync::Arc;

/// The values of one column of a row group.
pub(crate) enum Column {
    Text(Vec<ByteArray>),
    Integer(Vec<i64>),
    Flag(Vec<bool>),
    /// Numbers; `None` is null.
    Number(Vec<Option<f64>>),
}

/// A Parquet file that is being written.
pub(crate) struct ParquetTable {
    path: PathBuf,
    writer: SerializedFileWriter<File>,
}

impl ParquetTable {
    /// Creates a file and its folder. `schema` is a Parquet message.
    pub(crate) fn create(path: PathBuf, schema: &str) -> Result<Self, ExportError> {
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(ExportError::io(parent))?;
        }
        let file = File::create(&path).map_err(ExportError::io(&path))?;
        let wrong = ExportError::table(&path);
        let schema = parse_message_type(schema).map_err(&wrong)?;
        let properties = WriterProperties::builder()
            .set_compression(Compression::GZIP(GzipLevel::default()))
            .build();
        let writer = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))
            .map_err(&wrong)?;
        Ok(Self { path, writer })
    }

    /// Writes a row group.
    pub(crate) fn add(&mut self, columns: &[Column]) -> Result<(), ExportError> {
        let wrong = ExportError::table(&self.path);
        let mut group = self.writer.next_row_group().map_err(&wrong)?;
        for column in columns {
            let Some(mut to) = group.next_column().map_err(&wrong)? else {
                break;
            };
            match column {
                Column::Text(v) => to.typed::<ByteArrayType>().write_batch(v, None, None),
                Column::Integer(v) => to.typed::<Int64Type>().write_batch(v, None, None),
                Column::Flag(v) => to.typed::<BoolType>().write_batch(v, None, None),
                Column::Number(v) => {
                    let levels: Vec<i16> = v.iter().map(|n| i16::from(n.is_some())).collect();
                    let present: Vec<f64> = v.iter().flatten().copied().collect();
                    to.typed::<DoubleType>()
                        .write_batch(&present, Some(&levels), None)
                }
            }
            .map_err(&wrong)?;
            to.close().map_err(&wrong)?;
        }
        group.close().map_err(&wrong)?;
        Ok(())
    }

    /// Completes the file.
    pub(crate) fn close(self) -> Result<(), ExportError> {
        let wrong = ExportError::table(&self.path);
        self.writer.close().map_err(wrong)?;
        Ok(())
    }
}
