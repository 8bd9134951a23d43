//! Options of jobs, formats and layers: declared once beside what has them, checked here. Command lines, dialogs and
//! copied commands derive from the declarations.

mod given;
mod palette;
mod spec;
mod value;

pub use given::Options;
pub use palette::find_palette;
pub(crate) use spec::by_name;
pub use spec::{Choice, Component, Condition, OptionSpec, ValueKind};
