//! Bytes that formats hold beside the rows at hand.

use orogen_grid::grid::Window;
use orogen_io::spool;

/// Bytes of all samples of a window, as a format takes that needs them all at once.
pub fn whole(window: &Window) -> u64 {
    (window.width as u64).saturating_mul(window.height as u64).saturating_mul(4)
}

/// Bytes of memory that putting `bytes` aside takes.
pub fn aside(bytes: u64) -> u64 {
    bytes.min(spool::IN_MEMORY as u64)
}
