//! The ops of Orogen, which the nodes of recipes compute, and the declaration of ops.
//!
//! - [`field`], [`filter`], [`solver`], [`levelled`]: the ops by their locality, one per file.
//! - [`declare`], [`op!`], [`choice!`]: inputs, parameters and layers, declared once.
//! - [`mod@op`]: the traits of ops and their arguments; [`node`]: a node of a recipe, with any op.
//! - [`program`] and its [`interpreter`]: fused fields over a block of samples.
//! - [`expression`]: formulas of recipes.
//! - [`large`]: water over areas larger than memory; [`budget`]: a shared limit of memory.
//!
//! An op knows its inputs, but not the recipe and the plan that it is part of. These are in the crate `orogen-engine`,
//! which re-exports this one.
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
