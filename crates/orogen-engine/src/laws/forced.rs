//! SIMD levels that tests force.

use orogen_noise::{Level, LevelError};
use std::sync::{Mutex, PoisonError};

/// Runs `work` at a SIMD level, which applies to the whole process, and restores the previous level. Another thread
/// that calls this waits.
///
/// # Errors
/// This machine lacks the level.
pub fn at_level<T>(level: Level, work: impl FnOnce() -> T) -> Result<T, LevelError> {
    static FORCED: Mutex<()> = Mutex::new(());
    let _forced = FORCED.lock().unwrap_or_else(PoisonError::into_inner);
    let before = Level::current();
    Level::force(level)?;
    let made = work();
    Level::force(before)?;
    Ok(made)
}
