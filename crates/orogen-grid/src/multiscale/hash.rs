//! Random numbers of nodes, as functions of the seed, the level, the position and a stream.

use crate::random::{STEP, mix64};

/// Displacement of nodes: the share of a cell, around its middle, in which nodes lie.
pub const JITTER: f32 = 0.8;

/// The start value of the hashes of all nodes of a level.
#[inline(always)]
pub fn start(seed: u64, depth: usize, stream: u64) -> u64 {
    seed.wrapping_add(((depth as u64) << 8 | stream).wrapping_mul(STEP))
}

/// 64 random bits of the node at column `x` and row `y` of a level.
#[inline(always)]
pub fn node(seed: u64, depth: usize, x: i64, y: i64, stream: u64) -> u64 {
    let column = mix64(start(seed, depth, stream) ^ (x as u64).wrapping_mul(0xD6E8_FEB8_6659_FD93));
    mix64(column.wrapping_add((y as u64).wrapping_mul(0xA076_1D64_78BD_642F)))
}

/// A number from 0 (included) to 1 (excluded), from the upper 24 bits.
#[inline(always)]
pub fn unit(bits: u64) -> f32 {
    (bits >> 40) as f32 * (1.0 / 16_777_216.0)
}

/// A number from 0 (included) to 1 (excluded), from 16 of the bits; `part` is 0 to 3.
#[inline(always)]
pub fn unit16(bits: u64, part: usize) -> f32 {
    (bits >> (16 * (part & 3)) & 0xFFFF) as f32 * (1.0 / 65_536.0)
}

/// A number with a nearly normal distribution and unit variance: the sum of four uniform ones.
#[inline(always)]
pub fn normal(bits: u64) -> f32 {
    let sum = (bits & 0xFFFF) + (bits >> 16 & 0xFFFF) + (bits >> 32 & 0xFFFF) + (bits >> 48);
    (sum as f32 * (1.0 / 65_536.0) - 2.0) * 1.732_050_8
}

/// A position in a cell, from a random number from 0 to 1.
pub fn jittered(draw: f32) -> f32 {
    0.5 + JITTER * (draw - 0.5)
}
