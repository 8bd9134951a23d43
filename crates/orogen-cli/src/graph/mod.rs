//! A recipe's graph as a drawing: boxes and wires ([`diagram`]), where they stand ([`layout`], after [`order`]), and the same as a scene
//! ([`draw`]) and as a text for Graphviz ([`dot`]).

pub mod diagram;
pub mod dot;
pub mod draw;
pub mod layout;
pub mod order;
