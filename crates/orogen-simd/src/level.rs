//! SIMD levels, which are detected once, or forced for tests and bug reports.

use std::fmt;
use std::sync::atomic::{AtomicU8, Ordering};

/// A set of instructions for which a body is compiled. Every level gives the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Level {
    /// No instructions beyond the target's baseline: 4 lanes, in SSE2 registers on x86-64, in arrays elsewhere.
    Scalar,
    /// WebAssembly's 128-bit vectors: 4 lanes. Available in modules that are compiled with them.
    Simd128,
    /// ARM's 128-bit vectors: 4 lanes. Available on every aarch64 target.
    Neon,
    /// x86-64 with AVX2 and FMA (since 2013): 8 lanes.
    Avx2,
    /// x86-64 with AVX-512 F, BW, DQ and VL (servers since 2017): 16 lanes.
    Avx512,
}

/// The environment variable that forces a level for the whole process: `scalar`, `simd128`, `neon`, `avx2` or `avx512`.
pub const LEVEL_VARIABLE: &str = "OROGEN_SIMD";

/// The reason why a level cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LevelError {
    /// No level has this name.
    Unknown(String),
    /// The level exists, but this processor or this build does not support it.
    Unavailable(Level),
}

impl fmt::Display for LevelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = |levels: &[Level]| levels.iter().map(|level| level.name()).collect::<Vec<_>>().join(", ");
        match self {
            LevelError::Unknown(name) => {
                write!(f, "no SIMD level is called `{name}`; the levels are {}", names(&Level::ALL))
            }
            LevelError::Unavailable(level) => write!(
                f,
                "the SIMD level `{level}` is not available on this machine; available: {}",
                names(&Level::available())
            ),
        }
    }
}

impl std::error::Error for LevelError {}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for Level {
    type Err = LevelError;

    fn from_str(name: &str) -> Result<Level, LevelError> {
        let wanted = name.trim().to_ascii_lowercase();
        Level::ALL.into_iter().find(|level| level.name() == wanted).ok_or_else(|| LevelError::Unknown(name.to_owned()))
    }
}

/// The current level, as its index in [`Level::ALL`] plus one; 0 until it is first read. Only available levels are
/// stored, which makes [`crate::dispatch`] sound.
static CURRENT: AtomicU8 = AtomicU8::new(0);

impl Level {
    /// All levels, slowest first.
    pub const ALL: [Level; 5] = [Level::Scalar, Level::Simd128, Level::Neon, Level::Avx2, Level::Avx512];

    /// The name of the level, as in [`LEVEL_VARIABLE`].
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Level::Scalar => "scalar",
            Level::Simd128 => "simd128",
            Level::Neon => "neon",
            Level::Avx2 => "avx2",
            Level::Avx512 => "avx512",
        }
    }

    /// Number of f32 per register.
    #[must_use]
    pub const fn lanes(self) -> usize {
        match self {
            Level::Scalar | Level::Simd128 | Level::Neon => 4,
            Level::Avx2 => 8,
            Level::Avx512 => 16,
        }
    }

    /// Whether this processor and this build support the level.
    #[must_use]
    pub fn is_available(self) -> bool {
        match self {
            Level::Scalar => true,
            Level::Simd128 => cfg!(all(target_arch = "wasm32", target_feature = "simd128")),
            Level::Neon => cfg!(target_arch = "aarch64"),
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => crate::avx2::Avx2::detect().is_some(),
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => crate::avx512::Avx512::detect().is_some(),
            #[cfg(not(target_arch = "x86_64"))]
            Level::Avx2 | Level::Avx512 => false,
        }
    }

    /// The levels that this machine supports, slowest first. The scalar level is always included.
    #[must_use]
    pub fn available() -> Vec<Level> {
        Level::ALL.into_iter().filter(|level| level.is_available()).collect()
    }

    /// The fastest level that this machine supports. Ignores the environment variable.
    #[must_use]
    pub fn detect() -> Level {
        Level::ALL.into_iter().rev().find(|level| level.is_available()).unwrap_or(Level::Scalar)
    }

    /// The level that [`LEVEL_VARIABLE`] requests; `None` if it is not set.
    ///
    /// # Errors
    /// The variable contains an unknown level, or one that this machine does not support.
    pub fn environment() -> Result<Option<Level>, LevelError> {
        let Some(name) = std::env::var_os(LEVEL_VARIABLE).filter(|name| !name.is_empty()) else {
            return Ok(None);
        };
        let level: Level = name.to_string_lossy().parse()?;
        if level.is_available() { Ok(Some(level)) } else { Err(LevelError::Unavailable(level)) }
    }

    /// The level that [`crate::dispatch`] uses: the last one set with [`Level::force`], otherwise the one of the
    /// environment variable, otherwise the fastest. An invalid variable is ignored here; [`Level::environment`] reports
    /// it.
    #[inline]
    #[must_use]
    pub fn current() -> Level {
        match CURRENT.load(Ordering::Relaxed) {
            0 => Level::first(),
            number => Level::ALL[usize::from(number - 1) % Level::ALL.len()],
        }
    }

    #[cold]
    fn first() -> Level {
        let level = Level::environment().ok().flatten().unwrap_or_else(Level::detect);
        // If another thread has forced a level in the meantime, that level is used.
        match CURRENT.compare_exchange(0, level.number(), Ordering::Relaxed, Ordering::Relaxed) {
            Ok(_) => level,
            Err(number) => Level::ALL[usize::from(number - 1) % Level::ALL.len()],
        }
    }

    /// Makes all later calls of [`crate::dispatch`] in the process use `level`. The results have the same bits; only
    /// the speed changes.
    ///
    /// # Errors
    /// This machine does not support the level; the current level does not change.
    pub fn force(level: Level) -> Result<(), LevelError> {
        if !level.is_available() {
            return Err(LevelError::Unavailable(level));
        }
        CURRENT.store(level.number(), Ordering::Relaxed);
        Ok(())
    }

    const fn number(self) -> u8 {
        match self {
            Level::Scalar => 1,
            Level::Simd128 => 2,
            Level::Neon => 3,
            Level::Avx2 => 4,
            Level::Avx512 => 5,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_both_ways() {
        for level in Level::ALL {
            assert_eq!(level.name().parse(), Ok(level));
            assert_eq!(Level::ALL[usize::from(level.number()) - 1], level);
        }
        assert_eq!(" AVX2 ".parse(), Ok(Level::Avx2));
        assert_eq!("sse9".parse::<Level>(), Err(LevelError::Unknown("sse9".into())));
        assert!(LevelError::Unknown("sse9".into()).to_string().contains("scalar, simd128, neon, avx2, avx512"));
    }

    #[test]
    fn forcing_keeps_to_what_is_there() {
        assert!(Level::available().contains(&Level::Scalar));
        assert!(Level::current().is_available());
        for level in Level::ALL {
            let before = Level::current();
            match Level::force(level) {
                Ok(()) => assert_eq!(Level::current(), level),
                Err(error) => {
                    assert_eq!(error, LevelError::Unavailable(level));
                    assert_eq!(Level::current(), before);
                }
            }
        }
        assert_eq!(Level::force(Level::detect()), Ok(()));
    }
}
