//! The size of an export.

/// The size of an export.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExportSize {
    /// Files.
    pub files: u64,
    /// Rows or samples in them.
    pub rows: u64,
}
