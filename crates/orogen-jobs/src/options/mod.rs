//! Options of jobs, formats and layers. They are declared once, next to their owners, and checked here. Command lines,
//! dialogs and copied commands are derived from the declarations.

mod given;
mod palette;
mod spec;
mod value;
mod word;

pub use given::Options;
pub use palette::find_palette;
pub(crate) use spec::by_name;
#[doc(hidden)]
pub use spec::{Choice, Component, Condition};
pub use spec::{OptionSpec, ValueKind};
pub use word::quoted;
