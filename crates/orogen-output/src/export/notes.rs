//! What a picture tells whoever opens it without its summary.

use orogen_io::format::levels::Levels;

/// The text chunks of a grey picture of heights: what made it, and which heights black and white are.
pub fn of_heights(cell: f64, levels: &Levels) -> Vec<(&'static str, String)> {
    let heights = match levels.is_flat() {
        true => format!("flat at {}; {cell} metres a sample", levels.low()),
        false => format!("black is {}, white is {}; {cell} metres a sample", levels.low(), levels.high()),
    };
    vec![("Software", format!("Orogen {}", env!("CARGO_PKG_VERSION"))), ("Description", heights)]
}
