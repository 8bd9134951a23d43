//! Memory of formats in addition to the current rows.

use orogen_grid::grid::Window;
use orogen_io::spool;

/// Memory of all samples of a window, in bytes, for a format that needs them at once.
pub fn whole(window: &Window) -> u64 {
    (window.width as u64).saturating_mul(window.height as u64).saturating_mul(4)
}

/// Memory, in bytes, for spooling `bytes`.
pub fn aside(bytes: u64) -> u64 {
    bytes.min(spool::IN_MEMORY as u64)
}
