//! How much memory may be used, shared by all that use it.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::error::{Error, ErrorKind, Result};
use crate::words::bytes;

/// A limit on bytes of memory. Whoever holds memory for longer than one request [reserves](Budget::reserve) it, and everybody else gets what is
/// [left](Budget::left). Clones share one limit.
///
/// ```
/// use orogen::budget::Budget;
///
/// let budget = Budget::of(100 << 20);
/// let picture = budget.reserve(60 << 20)?;
/// assert_eq!(budget.left(), Some(40 << 20));
/// assert!(budget.afford(50 << 20).is_err());
/// drop(picture);
/// assert!(budget.afford(50 << 20).is_ok());
/// # Ok::<(), orogen::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Budget {
    limit: Option<u64>,
    reserved: Arc<AtomicU64>,
}

impl Budget {
    /// A limit in bytes; `None` for no limit.
    pub fn of(limit: impl Into<Option<u64>>) -> Budget {
        Budget { limit: limit.into(), reserved: Arc::default() }
    }

    /// The limit in bytes.
    pub fn limit(&self) -> Option<u64> {
        self.limit
    }

    /// Bytes that are not reserved; `None` if there is no limit.
    pub fn left(&self) -> Option<u64> {
        self.limit.map(|limit| limit.saturating_sub(self.reserved.load(Ordering::Relaxed)))
    }

    /// Refuses work that needs more bytes than are left.
    ///
    /// # Errors
    /// With what is needed in all and what is allowed.
    pub fn afford(&self, needed: u64) -> Result<()> {
        match self.left() {
            Some(left) if needed > left => {
                Err(self.refusal("this", needed, "ask for fewer samples at once, or allow more"))
            }
            _ => Ok(()),
        }
    }

    /// Holds so many bytes for as long as the result lives.
    ///
    /// # Errors
    /// As [`Budget::afford`].
    pub fn reserve(&self, bytes: u64) -> Result<Reservation> {
        self.afford(bytes)?;
        Ok(self.charge(bytes))
    }

    /// Counts bytes that are held whatever the limit is, such as the program's own.
    pub fn charge(&self, bytes: u64) -> Reservation {
        self.reserved.fetch_add(bytes, Ordering::Relaxed);
        Reservation { reserved: Arc::clone(&self.reserved), bytes }
    }

    /// The error of work that needs `needed` bytes beside those that are reserved: what needs them, and what to do instead.
    pub fn refusal(&self, what: &str, needed: u64, instead: &str) -> Error {
        let all = needed.saturating_add(self.reserved.load(Ordering::Relaxed));
        let limit = self.limit.unwrap_or(u64::MAX);
        let message = format!("{what} needs up to {} of memory and {} is allowed: {instead}", bytes(all), bytes(limit));
        Error::new(ErrorKind::Memory, message)
    }
}

/// Bytes that are held, until this is dropped.
#[derive(Debug)]
pub struct Reservation {
    reserved: Arc<AtomicU64>,
    bytes: u64,
}

impl Reservation {
    /// Bytes that are held.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Holds them for as long as the program runs.
    pub fn keep(self) {
        std::mem::forget(self);
    }
}

impl Drop for Reservation {
    fn drop(&mut self) {
        self.reserved.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_reserved_is_not_left_to_anybody() {
        let budget = Budget::of(1000);
        let other = budget.clone();
        let held = budget.reserve(700).unwrap();
        assert_eq!((held.bytes(), other.left()), (700, Some(300)));
        let error = other.reserve(301).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Memory);
        assert!(error.to_string().contains("1001 bytes of memory and 1000 bytes is allowed"), "{error}");
        // What is there anyway may exceed the limit; then nothing more fits.
        other.charge(500).keep();
        assert_eq!(budget.left(), Some(0));
        drop(held);
        assert_eq!(budget.left(), Some(500));
    }

    #[test]
    fn without_a_limit_all_fits() {
        let budget = Budget::default();
        let held = budget.reserve(u64::MAX / 2).unwrap();
        assert_eq!((budget.left(), budget.limit()), (None, None));
        assert!(budget.afford(u64::MAX).is_ok());
        drop(held);
    }
}
