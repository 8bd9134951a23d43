//! Layout of boxes and the wires between them: an order in which wires run to the right ([`forward`]), columns and the
//! order within them ([`order`]), and positions ([`layout`]).

pub mod forward;
pub mod layout;
pub mod order;
