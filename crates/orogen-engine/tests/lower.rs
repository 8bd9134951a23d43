//! How graphics cards compute the built-in ops.

use orogen_engine::lower::Lowering;
use orogen_engine::node::Node;
use orogen_engine::op::{Op, WorldParams};

#[test]
fn every_field_and_filter_says_how_a_graphics_card_computes_it() {
    let world_params = WorldParams { seed: 1, size: Some([1000.0, 1000.0]), cell: 10.0, sea_level: 0.0 };
    for node in Node::all() {
        let name = node.spec().op;
        match node.op() {
            // The engine computes these by instructions of its own.
            Op::Field(field)
                if field.terms().is_some() || field.coord_map().is_some() || field.source_cell(1.0, 1.0).is_some() => {}
            Op::Field(field) => {
                for layer in 0..node.layers().len() {
                    assert_ne!(field.lower(layer, &world_params), Lowering::Missing, "{name}");
                }
            }
            Op::Filter(filter) => assert_ne!(filter.lower(10.0, &world_params), Lowering::Missing, "{name}"),
            Op::Levelled(_) | Op::Solver(_) => {}
        }
    }
}
