//! Portable SIMD: a generic body is compiled once per instruction set, and the fastest one is selected at run time. All
//! instruction sets give the same bits.
//!
//! ```
//! use orogen_simd::{Body, F32Lanes, Simd, dispatch};
//!
//! /// y = a * x + y, rounded once.
//! struct Axpy<'a> {
//!     a: f32,
//!     x: &'a [f32],
//!     y: &'a mut [f32],
//! }
//!
//! impl Body for Axpy<'_> {
//!     type Output = ();
//!
//!     #[inline(always)] // so that it is compiled with the level's instructions
//!     fn run<S: Simd>(self, simd: S) {
//!         let a = simd.f32(self.a);
//!         for (x, y) in self.x.chunks(S::LANES).zip(self.y.chunks_mut(S::LANES)) {
//!             let sum = simd.load_partial(x, 0.0).mul_add(a, simd.load_partial(y, 0.0));
//!             sum.store_partial(y);
//!         }
//!     }
//! }
//!
//! let mut y = vec![1.0; 19];
//! dispatch(Axpy { a: 2.0, x: &[3.0; 19], y: &mut y });
//! assert_eq!(y, [7.0; 19]);
//! ```
//!
//! A default x86-64 build contains every level; no compiler flags are needed. Three rules keep a body fast: mark `run`
//! and every function that it calls as `#[inline(always)]` (functions that are not inlined are compiled without the
//! level's instructions), keep closures out of hot loops for the same reason, and split large bodies with
//! [`Simd::run`], which compiles a separate function *with* the instructions.
//!
//! This is the only crate of the workspace with `unsafe` code. It is sound because lane values and the tokens of the
//! hardware levels have private contents: a token can only be obtained from [`dispatch`] or from detection, and a lane
//! value only from a token.

// First, because the modules of the levels use its macros.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64", all(target_arch = "wasm32", target_feature = "simd128")))]
#[macro_use]
mod table;

mod double;
mod fma;
mod lanes;
mod level;
mod scalar;
mod stream;

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "aarch64")]
mod neon;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod simd128;
#[cfg(target_arch = "x86_64")]
mod sse2;

#[doc(hidden)]
pub use double::{Double, Pair};
pub use fma::fma;
pub use lanes::{F32Lanes, F64Lanes, MaskLanes, Simd, U32Lanes};
pub use level::{LEVEL_VARIABLE, Level, LevelError};
#[doc(hidden)]
pub use scalar::{Scalar, ScalarF32, ScalarF64, ScalarMask, ScalarU32};
#[doc(hidden)]
pub use stream::{Stream, streaming};

#[doc(hidden)]
#[cfg(target_arch = "x86_64")]
pub use avx2::Avx2;
#[doc(hidden)]
#[cfg(target_arch = "x86_64")]
pub use avx512::Avx512;
#[doc(hidden)]
#[cfg(target_arch = "aarch64")]
pub use neon::Neon;
#[doc(hidden)]
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
pub use simd128::Simd128;
#[doc(hidden)]
#[cfg(target_arch = "x86_64")]
pub use sse2::Sse2;

/// Code that is written once for all levels. Mark `run` as `#[inline(always)]`.
pub trait Body {
    /// The return type.
    type Output;

    /// The code; `simd` gives access to the lanes.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

/// The token of the scalar level.
#[inline(always)]
fn baseline() -> impl Simd {
    #[cfg(target_arch = "x86_64")]
    return Sse2::new();
    #[cfg(not(target_arch = "x86_64"))]
    Scalar::<4>
}

/// Runs `body` at the current level ([`Level::current`]).
#[inline]
pub fn dispatch<B: Body>(body: B) -> B::Output {
    match Level::current() {
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `Level::current` only returns a level whose instructions were detected.
        Level::Avx512 => unsafe { Avx512::new_unchecked() }.run(body),
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Level::Avx2 => unsafe { Avx2::new_unchecked() }.run(body),
        #[cfg(target_arch = "aarch64")]
        Level::Neon => Neon::new().run(body),
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        Level::Simd128 => Simd128::new().run(body),
        _ => baseline().run(body),
    }
}

/// Runs `body` at a given level, regardless of the current one.
///
/// # Errors
/// This machine does not support the level; the body was not run.
pub fn dispatch_at<B: Body>(level: Level, body: B) -> Result<B::Output, LevelError> {
    match level {
        Level::Scalar => Ok(baseline().run(body)),
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => Avx2::detect().map(|token| token.run(body)).ok_or(LevelError::Unavailable(level)),
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => Avx512::detect().map(|token| token.run(body)).ok_or(LevelError::Unavailable(level)),
        #[cfg(target_arch = "aarch64")]
        Level::Neon => Ok(Neon::new().run(body)),
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        Level::Simd128 => Ok(Simd128::new().run(body)),
        #[cfg(target_arch = "x86_64")]
        Level::Neon | Level::Simd128 => Err(LevelError::Unavailable(level)),
        #[cfg(not(target_arch = "x86_64"))]
        _ => Err(LevelError::Unavailable(level)),
    }
}

#[cfg(test)]
mod tests;
