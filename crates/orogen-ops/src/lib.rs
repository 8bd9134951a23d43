//! The ops of Orogen: what a node of a recipe can compute, and how ops are declared.
//!
//! - [`field`], [`filter`], [`solver`], [`levelled`]: the ops by their locality, one per file.
//! - [`declare`], [`op!`], [`choice!`]: inputs, parameters and layers, declared once.
//! - [`mod@op`]: what an op computes from; [`node`]: one of all built-in ops.
//! - [`program`] and its [`interpreter`]: fused fields over a block of samples.
//! - [`expression`]: formulas of recipes.
//! - [`large`]: water over areas larger than memory; [`budget`]: a shared limit of memory.
//!
//! An op knows its inputs and nothing of the recipe or the plan that it is part of; those are in the crate
//! `orogen-engine`, which holds this one.
#![forbid(unsafe_code)]

#[macro_use]
pub mod declare;

pub mod budget;
mod coord_map;
pub mod expression;
pub mod field;
pub mod filter;
#[doc(hidden)]
pub mod ids;
mod inputs;
#[doc(hidden)]
pub mod interpreter;
#[doc(hidden)]
pub mod large;
pub mod layer;
pub mod levelled;
#[doc(hidden)]
pub mod lower;
pub mod node;
#[doc(hidden)]
pub mod noise_field;
mod number;
pub mod op;
#[doc(hidden)]
pub mod pool;
#[doc(hidden)]
pub mod program;
pub mod registered;
pub mod solver;
pub mod value;
