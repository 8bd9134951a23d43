//! Checks for cancellation: loops call a function between pieces of work, and end with its error if it returns one.

use crate::error;
use crate::progress::Progress;
use std::convert::Infallible;

/// Samples between two checks of a loop on one thread. They take well below a millisecond.
pub(crate) const UNCHECKED: usize = 1 << 14;

/// Never stops.
pub(crate) fn never() -> Result<(), Infallible> {
    Ok(())
}

/// Stops when `progress` is cancelled, and counts each call as one unit of the `expected` amount of work.
pub(crate) fn steps(progress: &Progress, expected: usize) -> impl Fn() -> error::Result<()> + Sync + '_ {
    progress.expect(expected as f64);
    || progress.step(1.0)
}

/// Calls `check` before the first item and then once every [`UNCHECKED`] items.
#[inline(always)]
pub(crate) fn now_and_then<E>(item: usize, check: &impl Fn() -> Result<(), E>) -> Result<(), E> {
    if item.is_multiple_of(UNCHECKED) { check() } else { Ok(()) }
}

/// Number of checks in a loop over `items`.
pub(crate) fn checks(items: usize) -> usize {
    items.div_ceil(UNCHECKED)
}
