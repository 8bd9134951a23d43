//! Watersheds of chosen outlets.

use crate::export::contour_options;
use crate::export::features::ground::{HIGHEST, LOWEST, MEAN, area, heights};
use crate::export::features::layer::{Maker, Style, VectorLayer};
use crate::export::features::options::{FeatureOptions, RIVER_AREA};
use crate::export::features::outlets::{OUTLET, OUTLETS, Outlet, Outlets, SNAP};
use crate::export::features::source::FeatureSource;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrography::outlines::outlines;
use orogen_grid::hydrography::pour_points::{LabelStats, PourPoints, Snapped, nearest_stream};
use orogen_grid::hydrography::water::Cover;
use orogen_grid::progress::Progress;
use orogen_io::format::features::{Feature, FeatureLayer, Field, FieldType, Geometry, GeometryType, Value};
use std::borrow::Cow;

/// The layer.
pub static LAYER: VectorLayer = VectorLayer {
    name: "watershed",
    about: "watershed of each chosen outlet (--outlet, --outlets): all land that drains to it; of nested ones, the outer includes the inner",
    options: &[OUTLET.name, OUTLETS.name, SNAP.name, RIVER_AREA.name, contour_options::SMOOTH.name],
    style: Style { stroke: "#b0413e", width: 1.2, by: None, fill: "none" },
    make: Maker::Ground(make),
};

const FIELDS: &[Field] = &[
    Field { name: "id", kind: FieldType::Integer, about: "number of the outlet, from 1" },
    Field { name: "name", kind: FieldType::Text, about: "name of the outlet" },
    Field { name: "area", kind: FieldType::Real, about: "area of its samples in the window, m^2" },
    Field {
        name: "drainage_area",
        kind: FieldType::Real,
        about: "drainage area at the outlet, also beyond the window, m^2",
    },
    Field { name: "outlet_x", kind: FieldType::Real, about: "easting of the outlet on the stream" },
    Field { name: "outlet_y", kind: FieldType::Real, about: "northing of the outlet on the stream" },
    Field { name: "moved", kind: FieldType::Real, about: "distance from the given position, m" },
    Field { name: "downstream", kind: FieldType::Integer, about: "id of the next outlet downstream" },
    Field {
        name: "at_border",
        kind: FieldType::Boolean,
        about: "whether it reaches the border of the window or land without heights, beyond which more land may drain to it",
    },
    LOWEST,
    HIGHEST,
    MEAN,
];

/// Default distance to the stream, in samples.
const SNAP_SAMPLES: f64 = 5.0;

fn make(ground: &FeatureSource, options: &FeatureOptions, progress: &Progress) -> Result<FeatureLayer> {
    let Some(outlets) = &options.outlets else {
        let message = "the layer watershed needs --outlet E,N or --outlets FILE; the layer watersheds has those of all river mouths";
        return Err(Error::new(ErrorKind::Request, message));
    };
    let snapped = outlets.all.iter().map(|outlet| snap(ground, options, outlets, outlet, progress));
    let snapped: Vec<Snapped> = snapped.collect::<Result<_>>()?;
    let nodes: Vec<usize> = snapped.iter().map(|snapped| snapped.node).collect();
    let found = PourPoints::of(&ground.water, &nodes, progress)?;
    let window = ground.requested;
    let [columns, rows] = ground.nearest_lines();
    let (labels, parts) = found.sampled(&ground.water, nodes.len(), &columns, &rows);
    let labels = Grid::from_data(Window { cell: 1.0, ..window }, labels)
        .ok_or_else(|| Error::new(ErrorKind::Internal, "a sample has no label"))?;
    let [_, cut] = options.rounds();
    let mut features = Vec::with_capacity(nodes.len());
    for (k, upstream) in found.upstream().iter().enumerate() {
        progress.check()?;
        let all = upstream.iter().fold(LabelStats::EMPTY, |all, label| all.join(&parts[*label as usize]));
        let (outlet, snapped) = (&outlets.all[k], &snapped[k]);
        let [east, north] = outlets.coordinates(ground.place(ground.water.node_place(snapped.node)));
        let mut values = vec![
            Value::Integer(k as i64 + 1),
            outlet.name.clone().map_or(Value::Null, |name| Value::Text(Cow::Owned(name))),
            area(&all.ground, window.cell),
            Value::Real(ground.water.drained(snapped.node) * ground.cell() * ground.cell()),
            Value::Real(east),
            Value::Real(north),
            Value::Real(snapped.moved * ground.cell()),
            Value::id(found.downstream[k].map(|next| next + 1)),
            Value::Boolean(all.at_border),
        ];
        values.extend(heights(&all.ground));
        features.push(Feature {
            geometry: Geometry::MultiPolygon(polygon(&labels, upstream, &all, (cut, window.cell))),
            values,
        });
    }
    Ok(FeatureLayer {
        name: LAYER.name,
        about: LAYER.about,
        geometry: GeometryType::MultiPolygon,
        fields: FIELDS,
        features,
    })
}

/// The node of an outlet: the node of its sample, or of the nearest stream.
fn snap(
    ground: &FeatureSource,
    options: &FeatureOptions,
    outlets: &Outlets,
    outlet: &Outlet,
    progress: &Progress,
) -> Result<Snapped> {
    let (water, frame, window) = (&ground.water, &ground.frame, &ground.requested);
    let [column, row] = [0, 1].map(|axis| (outlet.at[axis] / window.cell - [window.x, window.y][axis] as f64).round());
    let is_inside = (0.0..window.width as f64).contains(&column) && (0.0..window.height as f64).contains(&row);
    if !is_inside {
        return Err(outlets.outside(outlet, window));
    }
    let sample = ground.nearest(column as usize, row as usize);
    let beside = match water.cover(sample) {
        Cover::Land | Cover::Lake(_) => None,
        Cover::Sea => Some("is in the sea"),
        _ => Some("is where there are no heights"),
    };
    let at = ground.sample_at(outlet.at);
    let radius = outlets.snap.map_or(SNAP_SAMPLES, |snap| snap / ground.cell());
    if radius == 0.0 {
        if let Some(beside) = beside {
            return Err(outlet.refused(&format!("{beside}; give a place on land, or a larger --snap")));
        }
        let node = water.nearest_node(sample);
        let [x, y] = water.node_place(node);
        return Ok(Snapped { node, moved: libm::hypot(x - at[0], y - at[1]) });
    }
    let [spring, _] = options.fewest(ground.cell());
    let inside = |[i, j]: [usize; 2]| frame.columns.contains(&i) && frame.rows.contains(&j);
    let nearest = |radius: f64| nearest_stream(water, at, f64::from(spring), radius, inside, progress);
    match nearest(radius)? {
        Some(snapped) => Ok(snapped),
        None => {
            let next = nearest(f64::INFINITY)?.map(|snapped| snapped.moved * ground.cell());
            let (area, fewest) = options.river;
            let least = area.max(f64::from(fewest) * ground.cell() * ground.cell());
            Err(outlet.far(beside, least, radius * ground.cell(), next))
        }
    }
}

/// The squares of the samples of these labels, as polygons in metres.
fn polygon(
    labels: &Grid<u32>,
    upstream: &[u32],
    all: &LabelStats,
    (cut, cell): (usize, f64),
) -> Vec<Vec<Vec<[f64; 2]>>> {
    if all.ground.count == 0 {
        return Vec::new();
    }
    let window = labels.window();
    // Grown by a sample within the window, because a corner of the grid is not cut.
    let span = |[first, last]: [usize; 2], count: usize| (first.saturating_sub(1), (last + 2).min(count));
    let ((left, right), (top, bottom)) = (span(all.columns, window.width), span(all.rows, window.height));
    let part = Window {
        x: window.x + left as i64,
        y: window.y + top as i64,
        width: right - left,
        height: bottom - top,
        cell: 1.0,
    };
    let mut is_upstream = vec![false; upstream.iter().max().map_or(0, |last| *last as usize + 1)];
    upstream.iter().for_each(|label| is_upstream[*label as usize] = true);
    let mut mask = Grid::filled(part, 0u32);
    for j in top..bottom {
        let row = labels.row(j)[left..right].iter();
        for (to, label) in mask.row_mut(j - top).iter_mut().zip(row) {
            *to = u32::from(is_upstream.get(*label as usize).copied().unwrap_or(false));
        }
    }
    let mut parts = outlines(&mask, 1, cut).swap_remove(0);
    parts.iter_mut().flatten().flatten().for_each(|at| *at = at.map(|at| at * cell));
    parts
}
