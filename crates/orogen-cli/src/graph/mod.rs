//! A recipe's graph as a drawing: boxes and wires ([`diagram`]), as a scene ([`draw`]) and as Graphviz source
//! ([`dot`]).

pub mod diagram;
pub mod dot;
pub mod draw;
