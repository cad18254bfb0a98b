//! The size of an export.

/// The size of an export.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExportSize {
    /// The number of files in the export's folder.
    pub files: u64,
    /// The number of rows or samples in them.
    pub rows: u64,
}
