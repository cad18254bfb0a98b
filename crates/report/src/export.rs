//! Files for other programs.

pub(crate) mod deqp;
pub(crate) mod junit;
pub(crate) mod markdown;
pub(crate) mod status;
