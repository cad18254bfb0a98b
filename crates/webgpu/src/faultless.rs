//! A build without planted faults.

use crate::calls::CallList;
use etalon_backend::Fault;

/// Changes nothing, since no fault exists.
pub fn plant(_fault: Option<Fault>, _list: &mut CallList) {}
