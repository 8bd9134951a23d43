//! Work that is asked now and then whether to stop: loops take a function that they call between pieces of work, and
//! whose error ends them.

use crate::error;
use crate::progress::Progress;
use std::convert::Infallible;

/// Samples between two checks of a loop on one thread: well below a millisecond.
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

/// Calls `check` once in [`UNCHECKED`] items, before the first of them.
#[inline(always)]
pub(crate) fn now_and_then<E>(item: usize, check: &impl Fn() -> Result<(), E>) -> Result<(), E> {
    if item.is_multiple_of(UNCHECKED) { check() } else { Ok(()) }
}

/// Number of checks in a loop over `items`.
pub(crate) fn checks(items: usize) -> usize {
    items.div_ceil(UNCHECKED)
}
