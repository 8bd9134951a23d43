//! The list of derived layers.

use super::appended::{Appended, AppendedNode};
use super::layer::{Derived, Made};
use super::{
    albedo, aspect, curvature, drainage, geomorphons, height_above_drainage, hillshade, insolation, normal, occlusion,
    position, roughness, ruggedness, slope, soil_depth, splat, viewshed, wetness,
};
use crate::options::{OptionSpec, Options, by_name};
use orogen_engine::recipe::document::Recipe;
use orogen_engine::recipe::network::OwnNetwork;
use orogen_engine::world::HEIGHT;
use orogen_grid::error::{Error, ErrorKind, Result};

static ALL: [&Derived; 27] = [
    &slope::LAYER,
    &aspect::LAYER,
    &curvature::LAYER,
    &hillshade::LAYER,
    &normal::LAYER,
    &occlusion::LAYER,
    &splat::LAYER,
    &albedo::LAYER,
    &roughness::LAYER,
    &ruggedness::LAYER,
    &position::POSITION,
    &position::CLASS,
    &geomorphons::LAYER,
    &drainage::FILLED,
    &drainage::AREA,
    &drainage::DIRECTION,
    &drainage::STRAHLER,
    &drainage::WATERSHED,
    &wetness::WETNESS,
    &wetness::STREAM_POWER,
    &wetness::LS_FACTOR,
    &height_above_drainage::HEIGHT_ABOVE,
    &height_above_drainage::FLOW_DISTANCE,
    &height_above_drainage::STREAM_DISTANCE,
    &soil_depth::LAYER,
    &insolation::LAYER,
    &viewshed::LAYER,
];

/// All derived layers.
#[must_use]
pub fn all() -> &'static [&'static Derived] {
    &ALL
}

/// The derived layer with this name.
#[must_use]
pub fn named(name: &str) -> Option<&'static Derived> {
    ALL.into_iter().find(|derived| derived.name == name)
}

/// All options of all layers, by name, each with the layers that have it.
#[must_use]
pub fn options() -> Vec<(&'static OptionSpec, Vec<&'static str>)> {
    by_name(ALL.iter().map(|derived| (derived.name, (derived.options)())))
}

/// The layer of a prepared recipe whose finite samples are counted for `layer`: the layer itself, except for some
/// derived layers.
pub(crate) fn counted(recipe: &Recipe, layer: &str) -> String {
    let counts_heights = named(layer).is_some_and(|derived| match &derived.made {
        Made::Nodes(nodes) => nodes.counts_heights,
        Made::Channels(_) => false,
    });
    // A layer of the recipe with the same name is not the derived layer.
    let appended = AppendedNode::of(layer).layer(layer);
    let is_derived = recipe.output_inputs().iter().any(|(name, input)| name == layer && *input == appended);
    // Inside the world extrapolated heights equal the heights, and they are computed anyway.
    match (counts_heights && is_derived, recipe.world.size) {
        (true, Some(_)) => AppendedNode::of("extrapolate-1").name_of("value"),
        (true, None) => HEIGHT.into(),
        (false, _) => layer.into(),
    }
}

/// Appends to a recipe the nodes that a derived layer needs; call it before the world is opened. A layer made by nodes
/// becomes an output with the layer's name, so that it can be read like any layer of the recipe. Nothing changes if the
/// recipe has a layer with this name, or if there is no such derived layer.
///
/// # Errors
/// If an option does not belong to the layer or is invalid, or if the layer needs a bounded world and this one is
/// unbounded.
pub fn prepare(recipe: &mut Recipe, layer: &str, options: &Options) -> Result<()> {
    let has = recipe.outputs().any(|name| name == layer) || recipe.nodes().iter().any(|named| named.name == layer);
    let derived = if has { None } else { named(layer) };
    check(layer, derived.map_or(&[], |derived| (derived.options)()), options)?;
    let (Some(derived), bounded) = (derived, recipe.world.size.is_some()) else { return Ok(()) };
    let has_network = OwnNetwork::of(recipe).is_some();
    let Some(mut to) = Appended::new(recipe, options) else { return Ok(()) };
    match &derived.made {
        Made::Channels(channels) => (channels.prepare)(&mut to),
        Made::Nodes(nodes) if nodes.bounded && !bounded && !(nodes.network && has_network) => {
            let own = match nodes.network {
                true => ", or the outputs `flow` and `receiver` of a node like `continents`",
                false => "",
            };
            let message = format!("the layer {layer} needs a bounded world; set `size` in [world]{own}");
            return Err(Error::new(ErrorKind::Request, message));
        }
        Made::Nodes(nodes) => {
            let shown = (nodes.append)(&mut to)?;
            recipe.output(layer, shown);
        }
    }
    Ok(())
}

/// Checks that a layer has all given options.
///
/// # Errors
/// If it does not have one of them: the message names the layers that do.
pub(crate) fn check(layer: &str, known: &[OptionSpec], options: &Options) -> Result<()> {
    match options.names().find(|name| !known.iter().any(|spec| spec.name == *name)) {
        None => Ok(()),
        Some(name) => {
            let has = |other: &&&Derived| (other.options)().iter().any(|spec| spec.name == name);
            let layers: Vec<&str> = ALL.iter().filter(has).map(|other| other.name).collect();
            let message = format!("--{name} does not apply to the layer {layer}; it applies to: {}", layers.join(", "));
            Err(Error::new(ErrorKind::Request, message))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_an_option_is_the_same_wherever_it_is_known() {
        for (n, derived) in ALL.iter().enumerate() {
            assert!(ALL[..n].iter().all(|other| other.name != derived.name), "{}", derived.name);
            for spec in (derived.options)() {
                assert!(options().iter().any(|(known, _)| *known == spec), "{} of {}", spec.name, derived.name);
            }
        }
    }

    #[test]
    fn every_palette_is_there() {
        for derived in ALL.iter().filter(|derived| !derived.palette.is_empty()) {
            assert!(orogen_io::palette::named::find(derived.palette).is_some(), "{}", derived.palette);
        }
    }
}
