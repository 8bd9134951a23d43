//! Noise for graphics cards: functions of WGSL, and the numbers that they read.

pub mod function;
pub mod lattice;
mod noise;
pub mod phacelle;
