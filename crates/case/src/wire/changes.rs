//! The names of a file's changes, and the axis that joins them.

use super::file::FileWire;
use crate::error::At;
use crate::values::is_word;

/// The axis whose values are names of changes, joined by [`AND`].
pub(crate) const WITH: &str = "with";

/// Joins the names of a case's changes.
pub(crate) const AND: char = '+';

/// Checks that the names in the axis of changes and the changes fit together.
pub(crate) fn check(wire: &FileWire) -> Result<(), At> {
    if wire.changes.is_empty() {
        return Ok(());
    }
    if let Some(name) = wire
        .changes
        .keys()
        .find(|name| !is_word(name) || name.contains(AND))
    {
        let message = "a change's name consists of letters, digits, '-', '_' and '.'";
        return Err(At::new(message).key(name).key("changes"));
    }
    let Some(axis) = wire.axes.get(WITH) else {
        let message = format!("changes need the axis `{WITH}`, whose values name those of a case");
        return Err(At::new(message).key("changes"));
    };
    for (i, value) in axis.iter().enumerate() {
        let unknown = names(&value.name).find(|name| !wire.changes.contains_key(*name));
        if let Some(unknown) = unknown {
            let message = format!("there is no change `{unknown}`");
            return Err(At::new(message).index(i).key(WITH).key("axes"));
        }
    }
    Ok(())
}

/// Returns the names of changes that a value of the axis joins.
pub(crate) fn names(value: &str) -> impl Iterator<Item = &str> {
    value.split(AND)
}
