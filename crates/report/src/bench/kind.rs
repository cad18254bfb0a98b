//! Software and hardware adapters, which never share a ranking.

use etalon_record::AdapterRecord;

/// Both kinds, as the value of [`software`] and in words.
pub(crate) const KINDS: [(bool, &str); 2] = [(true, "Software"), (false, "Hardware")];

/// True if the adapter draws with the processor. An adapter that no header names counts as hardware,
/// which is compared without the ruler.
pub(crate) fn software(adapter: Option<&AdapterRecord>) -> bool {
    adapter.is_some_and(|a| a.software)
}
