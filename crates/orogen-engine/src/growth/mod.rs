//! A terrain after each of the steps that eroded it, from one run of them.

pub(crate) mod draft;
pub mod frame_spool;
pub mod run;
