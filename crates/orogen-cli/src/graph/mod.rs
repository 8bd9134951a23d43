//! A recipe's graph as a drawing: boxes and wires ([`diagram`]), their order ([`order`]) and positions ([`layout`]), as
//! a scene ([`draw`]) and as Graphviz source ([`dot`]).

pub mod diagram;
pub mod dot;
pub mod draw;
pub mod layout;
pub mod order;
