//! Loops whose items are distributed to threads: those of the rayon pool in which the caller runs, or of the global
//! pool.
//!
//! Tasks take items from a sequential iterator, in batches that become smaller towards the end. The only call of rayon
//! is in a function that is not generic, which keeps the compile time of each loop short. With one thread, all items
//! are processed in order on the calling thread.

use std::cmp::Ordering;
use std::sync::atomic::{self, AtomicUsize};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Number of samples in one piece of work, for work on single samples.
pub const SAMPLES: usize = 1 << 14;

/// Number of threads that share the work of a loop.
#[must_use]
pub fn threads() -> usize {
    rayon::current_num_threads()
}

/// Calls `work` once for each item, in no particular order.
pub fn for_each<I>(items: I, work: impl Fn(I::Item) + Sync)
where
    I: IntoIterator<Item: Send, IntoIter: Send>,
{
    for_each_init(items, || (), |(), item| work(item));
}

/// Like [`for_each`], with a state: each task creates one with `init` and passes it to all its items in turn.
pub fn for_each_init<I, S>(items: I, init: impl Fn() -> S + Sync, work: impl Fn(&mut S, I::Item) + Sync)
where
    I: IntoIterator<Item: Send, IntoIter: Send>,
{
    let mut items = items.into_iter();
    share(items.size_hint(), &NO_END, &mut || items.next(), &|next| {
        let mut scratch = init();
        while let Some((_, item)) = next() {
            work(&mut scratch, item);
        }
    });
}

/// Calls `work` for each item until one fails. Items before the first failure are always processed; later items are not
/// begun once the failure is known.
///
/// # Errors
/// The error of the first item that fails, independent of the number of threads.
pub fn try_for_each<I, E: Send>(items: I, work: impl Fn(I::Item) -> Result<(), E> + Sync) -> Result<(), E>
where
    I: IntoIterator<Item: Send, IntoIter: Send>,
{
    try_for_each_init(items, || (), |(), item| work(item))
}

/// Like [`try_for_each`], with a state: each task creates one with `init` and passes it to all its items in turn.
///
/// # Errors
/// The error of the first item that fails, independent of the number of threads.
pub fn try_for_each_init<I, S, E: Send>(
    items: I,
    init: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, I::Item) -> Result<(), E> + Sync,
) -> Result<(), E>
where
    I: IntoIterator<Item: Send, IntoIter: Send>,
{
    let mut items = items.into_iter();
    let first = FirstError::none();
    share(items.size_hint(), &first.index, &mut || items.next(), &|next| {
        let mut scratch = init();
        while let Some((index, item)) = next() {
            if let Err(error) = work(&mut scratch, item) {
                first.or(index, error);
            }
        }
    });
    first.result()
}

/// The results of all items, in the order of the items.
pub fn map<I, R: Send>(items: I, work: impl Fn(I::Item) -> R + Sync) -> Vec<R>
where
    I: IntoIterator<Item: Send, IntoIter: ExactSizeIterator + Send>,
{
    let items = items.into_iter();
    let mut results = slots(items.len());
    for_each(items.zip(&mut results), |(item, result)| *result = Some(work(item)));
    filled(results)
}

/// The results of all items, in the order of the items, or the first error (see [`try_for_each`]).
///
/// # Errors
/// The error of the first item that fails, independent of the number of threads.
pub fn try_map<I, R: Send, E: Send>(items: I, work: impl Fn(I::Item) -> Result<R, E> + Sync) -> Result<Vec<R>, E>
where
    I: IntoIterator<Item: Send, IntoIter: ExactSizeIterator + Send>,
{
    let items = items.into_iter();
    let mut results = slots(items.len());
    try_for_each(items.zip(&mut results), |(item, result)| {
        *result = Some(work(item)?);
        Ok(())
    })?;
    Ok(filled(results))
}

/// The values of `of` at 0 .. `count`, computed in pieces of [`SAMPLES`].
pub fn samples<R: Copy + Default + Send>(count: usize, of: impl Fn(usize) -> R + Sync) -> Vec<R> {
    let mut samples = vec![R::default(); count];
    for_each(samples.chunks_mut(SAMPLES).enumerate(), |(piece, samples)| {
        (piece * SAMPLES..).zip(samples).for_each(|(at, sample)| *sample = of(at));
    });
    samples
}

/// Sorts `items`; equal items keep their order.
pub fn sort_by<T: Send>(items: &mut [T], compare: impl Fn(&T, &T) -> Ordering + Sync) {
    let part = items.len().div_ceil(threads()).max(SAMPLES);
    for_each(items.chunks_mut(part), |part| part.sort_by(&compare));
    // The standard library's sort detects sorted parts, so that it only merges them.
    items.sort_by(compare);
}

/// Empty places for `count` results.
fn slots<R>(count: usize) -> Vec<Option<R>> {
    let mut slots = Vec::new();
    slots.resize_with(count, || None);
    slots
}

/// The results, taken out of their places.
fn filled<R>(slots: Vec<Option<R>>) -> Vec<R> {
    let mut results = Vec::with_capacity(slots.len());
    for result in slots.into_iter().flatten() {
        results.push(result);
    }
    results
}

/// The error of the first item that has failed.
struct FirstError<E> {
    /// The index of the item.
    index: AtomicUsize,
    error: Mutex<Option<E>>,
}

impl<E> FirstError<E> {
    fn none() -> FirstError<E> {
        FirstError { index: AtomicUsize::new(usize::MAX), error: Mutex::new(None) }
    }

    /// Keeps the error of item `index` if no earlier item has failed.
    fn or(&self, index: usize, error: E) {
        let mut kept = lock(&self.error);
        if self.index.fetch_min(index, atomic::Ordering::Relaxed) > index {
            *kept = Some(error);
        }
    }

    fn result(self) -> Result<(), E> {
        self.error.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
    }
}

/// The end of a loop without errors: no index reaches it.
static NO_END: AtomicUsize = AtomicUsize::new(usize::MAX);

/// A task of a loop. It receives a function that returns the next item with its index, or `None` when no items are
/// left. A task is started only if there is an item.
type Task<'a, T> = &'a (dyn Fn(&mut dyn FnMut() -> Option<(usize, T)>) + Sync);

/// Runs `task` on all threads that are free, and hands out to them all items of `next` whose index is below `end`.
/// `next` has `least` to `most` items.
fn share<T: Send>(
    (least, most): (usize, Option<usize>),
    end: &AtomicUsize,
    next: &mut (dyn FnMut() -> Option<T> + Send),
    task: Task<'_, T>,
) {
    let most = most.unwrap_or(usize::MAX);
    let tasks = if most <= 1 { most } else { threads().min(most) };
    let items = Mutex::new(Items { next: Some(next), taken: 0, left: least });
    on_threads(tasks, &|| {
        let Batch { first, items: mut batch } = lock(&items).batch(tasks);
        let mut index = first;
        if batch.len() > 0 {
            task(&mut || {
                if batch.len() == 0 {
                    Batch { first: index, items: batch } = lock(&items).batch(tasks);
                }
                let this = index;
                index += 1;
                if this < end.load(atomic::Ordering::Relaxed) { batch.next().map(|item| (this, item)) } else { None }
            });
        }
    });
}

/// Maximum number of items in a batch. In larger batches, one task could get most of the slow items.
const LARGEST: usize = 16;

/// Consecutive items.
struct Batch<T> {
    /// The index of the first item.
    first: usize,
    /// The items that are not processed yet.
    items: std::vec::IntoIter<T>,
}

/// The items that no task has taken yet.
struct Items<'a, T> {
    /// Returns the next item; `None` after the last one.
    next: Option<&'a mut (dyn FnMut() -> Option<T> + Send)>,
    /// Number of items that were taken.
    taken: usize,
    /// Lower bound of the number of items that are left.
    left: usize,
}

impl<T> Items<'_, T> {
    /// Takes the next batch. Batches are large while many items are left, so that tasks rarely wait for each other, and
    /// have a single item at the end, so that all tasks end at about the same time.
    fn batch(&mut self, tasks: usize) -> Batch<T> {
        let count = (self.left / (4 * tasks)).clamp(1, LARGEST);
        let mut batch = Vec::with_capacity(count);
        while batch.len() < count
            && let Some(next) = &mut self.next
        {
            match next() {
                Some(item) => batch.push(item),
                None => self.next = None,
            }
        }
        let first = self.taken;
        self.taken += batch.len();
        self.left = self.left.saturating_sub(batch.len());
        Batch { first, items: batch.into_iter() }
    }
}

/// Calls `work` on at most `tasks` threads, as many as become free before the work is done. Returns when all calls have
/// returned.
fn on_threads(tasks: usize, work: &(dyn Fn() + Sync)) {
    match tasks {
        0 => {}
        1 => work(),
        _ => {
            let half = tasks / 2;
            rayon::join(|| on_threads(tasks - half, work), || on_threads(half, work));
        }
    }
}

/// Locks a value that is never left half changed by a panic.
fn lock<T>(value: &Mutex<T>) -> MutexGuard<'_, T> {
    value.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests;
