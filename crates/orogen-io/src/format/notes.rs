//! Metadata of pictures.

use super::levels::Levels;

/// The program and its version.
pub const SOFTWARE: &str = concat!("Orogen ", env!("CARGO_PKG_VERSION"));

/// The text chunks of a grayscale picture of heights: the software, and the heights of black and white.
#[must_use]
pub fn of_heights(cell: f64, levels: &Levels) -> Vec<(&'static str, String)> {
    let heights = match levels.is_flat() {
        true => format!("flat at {}; {cell} metres a sample", levels.low()),
        false => format!("black is {}, white is {}; {cell} metres a sample", levels.low(), levels.high()),
    };
    vec![("Software", SOFTWARE.to_string()), ("Description", heights)]
}
