//! The elementary functions that Orogen computes terrain with. **Internal to Orogen: there is no promise of
//! stability.**
//!
//! The sources are those of [libm] 0.2.16 of the Rust project (part of compiler-builtins), itself a port of musl's,
//! which come from FreeBSD's msun and others; `LICENSE.txt` has all notices. Orogen carries its own copy because
//! another version of libm could change bits of terrain, and because a program that depends on Orogen must be free to
//! use any version for itself.
//!
//! What was changed, without a change of any bit:
//!
//! - Only the functions in use are here, and there is no code of a single architecture. `sqrt`, `floor` and `abs` are
//!   the standard library's, which are exact by IEEE 754. No function needs a fused multiply-add.
//! - Arrays are indexed with checks.
//! - Nothing is computed only to raise a flag of the floating-point environment, which Rust does not have.
//! - Tables and branches for more than 53 bits are left out.
//!
//! Sign and payload of a NaN are not defined, as in Rust itself. `tests/upstream.rs` compares all other bits with the
//! original.
//!
//! [libm]: https://crates.io/crates/libm
#![forbid(unsafe_code)]
#![allow(
    clippy::approx_constant,
    clippy::assign_op_pattern,
    clippy::collapsible_if,
    clippy::eq_op,
    clippy::excessive_precision,
    clippy::explicit_counter_loop,
    clippy::int_plus_one,
    clippy::needless_late_init,
    clippy::needless_range_loop,
    clippy::needless_return,
    clippy::zero_divided_by_zero,
    reason = "the code stays comparable with the original, line by line"
)]

mod acos;
mod acosf;
mod asin;
mod asinf;
mod atan;
mod atan2;
mod atan2f;
mod atanf;
mod cbrtf;
mod cos;
mod cosf;
mod exp;
mod exp2f;
mod expf;
mod expm1;
mod expm1f;
mod expo2;
mod hypot;
mod hypotf;
mod k_cos;
mod k_cosf;
mod k_sin;
mod k_sinf;
mod k_tan;
mod k_tanf;
mod log;
mod log10;
mod log10f;
mod log2;
mod log2f;
mod logf;
mod pow;
mod powf;
mod rem_pio2;
mod rem_pio2_large;
mod rem_pio2f;
mod scalbn;
mod sin;
mod sincos;
mod sincosf;
mod sinf;
mod sinh;
mod tan;
mod tanf;
mod tanh;
mod tanhf;

pub use acos::acos;
pub use acosf::acosf;
pub use asin::asin;
pub use asinf::asinf;
pub use atan::atan;
pub use atan2::atan2;
pub use atan2f::atan2f;
pub use atanf::atanf;
pub use cbrtf::cbrtf;
pub use cos::cos;
pub use cosf::cosf;
pub use exp::exp;
pub use exp2f::exp2f;
pub use expf::expf;
pub use expm1::expm1;
pub use hypot::hypot;
pub use hypotf::hypotf;
pub use log::log;
pub use log2::log2;
pub use log2f::log2f;
pub use log10::log10;
pub use log10f::log10f;
pub use logf::logf;
pub use pow::pow;
pub use powf::powf;
pub use sin::sin;
pub use sincos::sincos;
pub use sincosf::sincosf;
pub use sinf::sinf;
pub use sinh::sinh;
pub use tan::tan;
pub use tanf::tanf;
pub use tanh::tanh;
pub use tanhf::tanhf;

use expm1f::expm1f;
use expo2::expo2;
use k_cos::k_cos;
use k_cosf::k_cosf;
use k_sin::k_sin;
use k_sinf::k_sinf;
use k_tan::k_tan;
use k_tanf::k_tanf;
use rem_pio2::rem_pio2;
use rem_pio2f::rem_pio2f;
use scalbn::{scalbn, scalbnf};

/// The square root of `x` (f64).
#[inline]
#[must_use]
pub fn sqrt(x: f64) -> f64 {
    x.sqrt()
}

#[inline]
fn get_high_word(x: f64) -> u32 {
    (x.to_bits() >> 32) as u32
}

#[inline]
fn get_low_word(x: f64) -> u32 {
    x.to_bits() as u32
}

#[inline]
fn with_set_high_word(f: f64, hi: u32) -> f64 {
    let mut tmp = f.to_bits();
    tmp &= 0x00000000_ffffffff;
    tmp |= (hi as u64) << 32;
    f64::from_bits(tmp)
}

#[inline]
fn with_set_low_word(f: f64, lo: u32) -> f64 {
    let mut tmp = f.to_bits();
    tmp &= 0xffffffff_00000000;
    tmp |= lo as u64;
    f64::from_bits(tmp)
}

#[inline]
fn combine_words(hi: u32, lo: u32) -> f64 {
    f64::from_bits(((hi as u64) << 32) | lo as u64)
}
