//! The page of `orogen compare`.

pub mod page;
pub mod panel;
pub mod row;
