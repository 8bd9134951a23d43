//! The layers of drained land.

use super::drained::Drained;
use crate::declare::Spec;
use crate::op::Context;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::rivers::Channel;
use orogen_grid::multiscale::drawn_ridges::DrawnRidges;
use orogen_grid::multiscale::level::{Level, direction};
use orogen_grid::multiscale::refinement::Refinement;

/// The wanted layers of a level over a window.
///
/// # Errors
/// If the level covers too little, or the work was cancelled.
pub fn layers_of(
    land: &Drained,
    ridges: Option<&DrawnRidges>,
    mut level: Level,
    spec: &Spec,
    window: &Window,
    out: &mut [Option<Grid>],
    context: &Context,
) -> Result<()> {
    let (Drained { refinement, stream, .. }, progress) = (land, context.progress);
    let (share, sea_level) = (land.share(level.depth), land.sea_level(context.world_params));
    level.window = refinement.nodes_at(level.depth, &level.window);
    let wanted = spec.layers.iter().zip(out).filter_map(|(layer, out)| Some((layer.name, out.as_mut()?)));
    let (of_nodes, of_samples): (Vec<_>, Vec<_>) = wanted.partition(|(name, _)| name.starts_with("node_"));
    for (name, out) in of_nodes {
        nodes_of(refinement, &level, window, name, out)?;
    }
    if of_samples.is_empty() {
        return Ok(());
    }
    let channel = land.channel();
    let mut made = refinement.surface_at(share, &level, window, progress)?;
    if let Some(ridges) = ridges {
        ridges.raise(refinement, &level, share, window, &mut made);
    }
    refinement.cut_rivers(&level, &mut made, *stream, &channel, progress)?;
    let [height, flow, water, lake] =
        [&made.height, &made.flow, &made.water_level, &made.lake_depth].map(|grid| grid.data());
    let above_the_sea = |height: f32| if sea_level == 0.0 { height } else { height + sea_level };
    let size = |q: usize, of: fn(&Channel, f64) -> f64| {
        let area = f64::from(flow[q]);
        if area >= *stream && water[q].is_nan() { of(&channel, channel.discharge(area)) as f32 } else { 0.0 }
    };
    for (name, out) in of_samples {
        match name {
            "height" => fill(out, |q| above_the_sea(height[q])),
            "flow" => fill(out, |q| flow[q]),
            "lake" => fill(out, |q| lake[q]),
            "surface" => fill(out, |q| above_the_sea(if water[q].is_nan() { height[q] } else { water[q] })),
            "receiver" => fill(out, |q| f32::from(direction(made.receiver.data()[q]))),
            "width" => fill(out, |q| size(q, Channel::width_of)),
            "depth" => fill(out, |q| size(q, Channel::depth_of)),
            "floodplain" => *out = refinement.floodplain(share, &level, &made, *stream, &channel, progress)?,
            "sediment" => *out = refinement.sediment(share, &level, &made, progress)?,
            _ => return Err(unknown(name)),
        }
    }
    Ok(())
}

/// The error for a layer that is declared but not implemented here.
fn unknown(layer: &str) -> Error {
    Error::new(ErrorKind::Internal, format!("drained land has no layer `{layer}`"))
}

/// Sets each sample of a layer to a value by its index.
fn fill(out: &mut Grid, value: impl Fn(usize) -> f32) {
    out.data_mut().iter_mut().enumerate().for_each(|(q, sample)| *sample = value(q));
}

/// A layer of the nodes of a level's cells.
fn nodes_of(refinement: &Refinement, level: &Level, window: &Window, name: &str, out: &mut Grid) -> Result<()> {
    let cell = refinement.cell_of(level.depth);
    // The nodes of the finest level of valleys are at the samples; the cells of detail levels start at their samples.
    let first = if level.depth > refinement.levels { 0.0 } else { -0.5 * refinement.cell };
    let metres = |share: f32| (f64::from(share) * cell + first) as f32;
    let value: &dyn Fn(usize) -> f32 = match name {
        "node_height" => &|node| level.height[node],
        "node_flow" => &|node| level.area[node] * (cell * cell) as f32,
        "node_receiver" => &|node| f32::from(level.receiver[node]),
        "node_east" => &|node| metres(level.east[node]),
        "node_south" => &|node| metres(level.south[node]),
        _ => return Err(unknown(name)),
    };
    let nodes = refinement.nodes_at(level.depth, window);
    let (left, top) = ((nodes.x - level.window.x) as usize, (nodes.y - level.window.y) as usize);
    for j in 0..out.height() {
        let first = (top + j) * level.window.width + left;
        out.row_mut(j).iter_mut().enumerate().for_each(|(i, sample)| *sample = value(first + i));
    }
    Ok(())
}

/// Samples of a level beyond a window that the wanted layers read.
#[must_use]
pub fn surface_halo(refinement: &Refinement, level: usize, spec: &Spec, wanted: &[bool]) -> usize {
    let layers = spec.layers.iter().zip(wanted).filter(|(_, wanted)| **wanted);
    let reaches = layers.map(|(layer, _)| match layer.name {
        "floodplain" => refinement.floods_reach(level),
        "sediment" => refinement.sediment_reach(level),
        _ => 0,
    });
    reaches.fold(Refinement::SURFACE_REACH.max(refinement.rivers_reach(level)), usize::max)
}
