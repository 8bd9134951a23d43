//! A shared limit of memory.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crate::pool::HAS_THREADS;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_grid::words::bytes_apart;

/// Memory of a window with this many bytes per sample; `u64::MAX` on overflow.
pub(crate) fn memory(window: &Window, bytes_per_sample: u64) -> u64 {
    (window.width as u64).saturating_mul(window.height as u64).saturating_mul(bytes_per_sample)
}

const UNITS: [(&str, u64); 14] = [
    ("", 1),
    ("b", 1),
    ("k", 1 << 10),
    ("kib", 1 << 10),
    ("kb", 1000),
    ("m", 1 << 20),
    ("mib", 1 << 20),
    ("mb", 1_000_000),
    ("g", 1 << 30),
    ("gib", 1 << 30),
    ("gb", 1_000_000_000),
    ("t", 1 << 40),
    ("tib", 1 << 40),
    ("tb", 1_000_000_000_000),
];

/// The number of bytes that a text stands for: a number with or without a unit, such as `512MiB`, `2G` (GiB) or
/// `1.5GB`.
///
/// # Errors
/// What the text must be.
pub fn bytes(text: &str) -> std::result::Result<u64, String> {
    let text = text.trim();
    let digits = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let unit = text[digits..].trim().to_lowercase();
    let unit = UNITS.iter().find(|(name, _)| *name == unit);
    let (Ok(number), Some((_, unit))) = (text[..digits].parse::<f64>(), unit) else {
        return Err("it must be a number of bytes, such as 512MiB, 2GiB or 1.5GB".into());
    };
    match number * *unit as f64 {
        bytes if bytes >= 1.0 && bytes < u64::MAX as f64 => Ok(bytes as u64),
        bytes if bytes < 1.0 => Err("it must be at least 1 byte".into()),
        _ => Err("it must be less than 16384 PiB".into()),
    }
}

/// A memory limit in bytes. Clones share one limit.
///
/// Two kinds of memory count towards it: memory that a caller *holds* for any time ([`Budget::reserve`]), and memory
/// that *requests* need while they run ([`Budget::admit`]). Together they never exceed the limit. A request that does
/// not fit now, but would after others have ended, waits for them.
///
/// ```
/// use orogen_ops::budget::Budget;
///
/// let budget = Budget::of(100 << 20);
/// let picture = budget.reserve(60 << 20)?;
/// assert_eq!(budget.left(), Some(40 << 20));
/// assert!(budget.afford(50 << 20).is_err());
/// drop(picture);
/// assert!(budget.afford(50 << 20).is_ok());
/// # Ok::<(), orogen_grid::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Budget {
    limit: Option<u64>,
    shared: Arc<Shared>,
}

#[derive(Debug, Default)]
struct Shared {
    account: Mutex<Account>,
    /// Notified when bytes are released.
    freed: Condvar,
}

/// Bytes in use.
#[derive(Debug, Default, Clone, Copy)]
struct Account {
    /// Held by callers.
    held: u64,
    /// Needed by requests that run.
    running: u64,
    /// The maximum of both together so far.
    peak: u64,
}

impl Shared {
    /// The account is consistent whenever the lock is free, even after a panic.
    fn lock(&self) -> MutexGuard<'_, Account> {
        self.account.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Interval at which a request that waits for memory checks for cancellation.
const PATIENCE: Duration = Duration::from_millis(20);

impl Budget {
    /// A limit in bytes; `None` for no limit.
    pub fn of(limit: impl Into<Option<u64>>) -> Budget {
        Budget { limit: limit.into(), shared: Arc::default() }
    }

    /// The limit in bytes.
    #[must_use]
    pub fn limit(&self) -> Option<u64> {
        self.limit
    }

    /// Bytes that no caller holds, so that a request may use them. `None` if there is no limit.
    #[must_use]
    pub fn left(&self) -> Option<u64> {
        self.limit.map(|limit| limit.saturating_sub(self.shared.lock().held))
    }

    /// Bytes that are neither held nor needed by running requests. `None` if there is no limit.
    #[must_use]
    pub fn unused(&self) -> Option<u64> {
        let account = *self.shared.lock();
        self.limit.map(|limit| limit.saturating_sub(account.held).saturating_sub(account.running))
    }

    /// The maximum of held and needed bytes together so far.
    #[must_use]
    pub fn peak(&self) -> u64 {
        self.shared.lock().peak
    }

    /// Checks that work with this need of memory fits.
    ///
    /// # Errors
    /// If it does not; the message has the total need and the limit.
    pub fn afford(&self, needed: u64) -> Result<()> {
        match self.left() {
            Some(left) if needed > left => {
                Err(self.refusal("this", needed, "use fewer samples, or raise the memory limit"))
            }
            _ => Ok(()),
        }
    }

    /// Holds this many bytes until the result is dropped. If they would fit without the running requests, waits for
    /// those requests to end.
    ///
    /// # Errors
    /// The errors of [`Budget::afford`].
    pub fn reserve(&self, bytes: u64) -> Result<Reservation> {
        self.take(bytes, Kind::Held, &Progress::none())
    }

    /// Reserves the bytes that a request needs while it runs, until the result is dropped. If they would fit without
    /// other requests, waits for those requests to end. On a thread of a pool it fails instead, because waiting could
    /// block the awaited request itself.
    ///
    /// # Errors
    /// The errors of [`Budget::afford`], and [`ErrorKind::Cancelled`] if `progress` is cancelled during the wait.
    pub fn admit(&self, bytes: u64, progress: &Progress) -> Result<Reservation> {
        self.take(bytes, Kind::Running, progress)
    }

    /// Counts bytes that are held regardless of the limit, such as the program's own memory.
    pub fn charge(&self, bytes: u64) -> Reservation {
        self.add(&mut self.shared.lock(), bytes, Kind::Held)
    }

    fn take(&self, bytes: u64, kind: Kind, progress: &Progress) -> Result<Reservation> {
        let mut account = self.shared.lock();
        let Some(limit) = self.limit else { return Ok(self.add(&mut account, bytes, kind)) };
        loop {
            if account.held.saturating_add(account.running).saturating_add(bytes) <= limit {
                return Ok(self.add(&mut account, bytes, kind));
            }
            let fits_alone = account.held.saturating_add(bytes) <= limit;
            if !fits_alone || !HAS_THREADS || rayon::current_thread_index().is_some() {
                let others = if fits_alone { account.running } else { 0 };
                drop(account);
                let instead = match others {
                    0 => "ask for fewer samples at once, or allow more",
                    _ => "wait for the other requests to end, or allow more",
                };
                return Err(self.refusal("this", bytes.saturating_add(others), instead));
            }
            progress.check()?;
            let waited = self.shared.freed.wait_timeout(account, PATIENCE).unwrap_or_else(PoisonError::into_inner);
            account = waited.0;
        }
    }

    fn add(&self, account: &mut Account, bytes: u64, kind: Kind) -> Reservation {
        let counted = kind.of(account);
        *counted = counted.saturating_add(bytes);
        account.peak = account.peak.max(account.held.saturating_add(account.running));
        Reservation { shared: Arc::clone(&self.shared), bytes, kind }
    }

    /// The error for work that needs `needed` bytes in addition to the held ones. `what` describes the work, and
    /// `instead` is advice for the user.
    #[must_use]
    pub fn refusal(&self, what: &str, needed: u64, instead: &str) -> Error {
        let all = needed.saturating_add(self.shared.lock().held);
        let limit = self.limit.unwrap_or(u64::MAX);
        let [all, limit] = bytes_apart(all, limit);
        let message = format!("{what} needs up to {all} of memory, and {limit} is allowed; {instead}");
        Error::new(ErrorKind::Memory, message)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Held,
    Running,
}

impl Kind {
    fn of(self, account: &mut Account) -> &mut u64 {
        match self {
            Kind::Held => &mut account.held,
            Kind::Running => &mut account.running,
        }
    }
}

/// Bytes that count towards a [`Budget`] until this is dropped.
#[derive(Debug)]
#[must_use = "the bytes are given back when this is dropped"]
pub struct Reservation {
    shared: Arc<Shared>,
    bytes: u64,
    kind: Kind,
}

impl Reservation {
    /// The number of bytes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Holds them until the program ends.
    pub fn keep(self) {
        std::mem::forget(self);
    }
}

impl Drop for Reservation {
    fn drop(&mut self) {
        let mut account = self.shared.lock();
        let counted = self.kind.of(&mut account);
        *counted = counted.saturating_sub(self.bytes);
        drop(account);
        self.shared.freed.notify_all();
    }
}
#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_no_option_because_several_have_such_values() {
        for (text, expect) in [
            ("0", "it must be at least 1 byte"),
            ("5 parsecs", "it must be a number of bytes, such as 512MiB, 2GiB or 1.5GB"),
            ("99999999TiB", "it must be less than 16384 PiB"),
        ] {
            assert_eq!(bytes(text), Err(expect.to_string()));
        }
    }

    #[test]
    fn texts_are_numbers_of_bytes() {
        for (text, expect) in [
            ("512MiB", Some(512 << 20)),
            ("2GiB", Some(2 << 30)),
            ("2 gib", Some(2 << 30)),
            ("2G", Some(2 << 30)),
            ("1.5GB", Some(1_500_000_000)),
            ("123456", Some(123_456)),
            ("0", None),
            ("-1GiB", None),
            ("1.5.5GB", None),
            ("GiB", None),
            ("5 parsecs", None),
            ("99999999TiB", None),
            ("nan", None),
        ] {
            assert_eq!(bytes(text).ok(), expect, "{text}");
        }
    }

    #[test]
    fn what_is_reserved_is_not_left_to_anybody() {
        let budget = Budget::of(1000);
        let other = budget.clone();
        let held = budget.reserve(700).unwrap();
        assert_eq!((held.bytes(), other.left()), (700, Some(300)));
        let error = other.reserve(301).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Memory);
        assert!(error.to_string().contains("1001 bytes of memory, and 1000 bytes is allowed"), "{error}");
        // Memory in use may exceed the limit; then no request fits.
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

    #[test]
    fn a_request_waits_for_the_others_and_never_shares_their_bytes() {
        let budget = Budget::of(1000);
        let picture = budget.reserve(200).unwrap();
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    for _ in 0..20 {
                        let running = budget.admit(300, &Progress::none()).unwrap();
                        std::thread::yield_now();
                        assert!(budget.unused().unwrap() <= 500);
                        drop(running);
                    }
                });
            }
        });
        assert!((500..=800).contains(&budget.peak()), "{}", budget.peak());
        assert_eq!(budget.left(), Some(800), "what ran is given back");
        assert!(budget.admit(801, &Progress::none()).is_err(), "no wait makes room for it");
        drop(picture);
    }

    #[test]
    fn waiting_ends_when_it_is_cancelled() {
        let budget = Budget::of(1000);
        let running = budget.admit(900, &Progress::none()).unwrap();
        let progress = Progress::none();
        progress.cancel();
        assert_eq!(budget.admit(200, &progress).unwrap_err().kind(), ErrorKind::Cancelled);
        drop(running);
        assert!(budget.admit(200, &Progress::none()).is_ok());
    }

    #[test]
    fn threads_of_a_pool_do_not_wait() {
        let budget = Budget::of(900);
        let _running = budget.admit(800, &Progress::none()).unwrap();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let error = pool.install(|| budget.admit(200, &Progress::none()).unwrap_err());
        assert_eq!(error.kind(), ErrorKind::Memory);
        assert!(error.to_string().contains("1000 bytes") && error.to_string().contains("other requests"), "{error}");
    }
}
