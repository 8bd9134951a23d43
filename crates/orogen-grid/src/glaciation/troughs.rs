//! Troughs: the lower envelope of cross-sections along the lines of glaciers.

use super::Glaciation;
use super::beds::Beds;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::parallel;
use crate::progress::Progress;

/// How far a wall reaches from the line, in half widths.
pub const RIM: f32 = 1.6;

/// Height of the wall over the bed at the half width, in half widths.
const STEEPNESS: f32 = 0.6;
/// Share of the half width that is flat.
const FLAT: f32 = 0.2;
/// The same for cirques.
const CIRQUE_STEEPNESS: f32 = 0.75;
const CIRQUE_FLAT: f32 = 0.3;

/// Greatest reach in samples: at very small cells troughs are narrower than their width says.
const MAX_REACH: f64 = 320.0;

/// Greatest distance of a line from its sample, in samples.
const ASIDE: usize = 3;

/// Reach of a trough of some half width, in samples.
pub fn reach(half: f64, cell: f64) -> usize {
    (f64::from(RIM) * half / cell).ceil().min(MAX_REACH) as usize + ASIDE + 1
}

/// The troughs over a window.
pub struct Troughs {
    /// Height of the floor or wall in metres; infinite where there is no trough.
    pub height: Grid,
    /// Distance from the floor, in half widths without it: 0 on floors, 1 at the half width.
    pub across: Grid,
    /// Half of the width of the trough in metres.
    pub half: Grid,
}

/// The cross-section of a node.
struct Section {
    /// Column and row of the node.
    column: usize,
    row: usize,
    /// Position of the line beside the node, in samples. It is not relative to the window, so that it is rounded in the
    /// same way in every window.
    aside: [f32; 2],
    bed: f32,
    half: f32,
    flat: f32,
    steepness: f32,
    reach: usize,
}

impl Section {
    fn new(beds: &Beds, node: usize, width: usize, cell: f64, max_reach: usize) -> Section {
        let (column, row) = (beds.sample[node] % width, beds.sample[node] / width);
        let (half, cirque) = (beds.half[node], beds.cirque[node]);
        let (half, flat, steepness) =
            if cirque > half { (cirque, CIRQUE_FLAT, CIRQUE_STEEPNESS) } else { (half, FLAT, STEEPNESS) };
        let aside = beds.aside[node];
        let reach = reach(f64::from(half), cell).min(max_reach);
        Section { column, row, aside, bed: beds.bed[node], half, flat: flat * half, steepness, reach }
    }
}

/// The lower envelope of the cross-sections of all nodes.
pub fn carved(glaciation: &Glaciation, beds: &Beds, window: &Window, progress: &Progress) -> Result<Troughs> {
    let (width, cell) = (window.width, window.cell);
    let max_reach = glaciation.trough_reach(cell);
    // Nodes are in the order of rows, so those that reach a row are a range of them.
    let section = |node| Section::new(beds, node, width, cell, max_reach);
    let sections: Vec<Section> = (0..beds.len()).map(section).collect();
    let [mut height, mut across, mut half] = [f32::INFINITY, 9.0, 0.0].map(|value| Grid::filled(*window, value));
    let rows = height.data_mut().chunks_mut(width.max(1)).zip(across.data_mut().chunks_mut(width.max(1)));
    let rows = rows.zip(half.data_mut().chunks_mut(width.max(1))).enumerate();
    parallel::try_for_each(rows, |(j, ((height, across), half))| {
        progress.check()?;
        let first = sections.partition_point(|section| section.row + max_reach < j);
        let near = sections[first..].iter().take_while(|section| section.row <= j + max_reach);
        for section in near.filter(|section| section.row.abs_diff(j) <= section.reach) {
            let (column, reach) = (section.column, section.reach);
            let south = j as f32 - section.row as f32 - section.aside[1];
            for i in column.saturating_sub(reach)..(column + reach + 1).min(width) {
                let east = i as f32 - section.column as f32 - section.aside[0];
                let distance = (east * east + south * south).sqrt() * cell as f32;
                let y = (distance - section.flat).max(0.0) / (section.half - section.flat);
                if y <= RIM {
                    let wall = section.bed + section.steepness * section.half * y * y.sqrt();
                    if wall < height[i] || wall == height[i] && y < across[i] {
                        (height[i], across[i], half[i]) = (wall, y, section.half);
                    }
                }
            }
        }
        Ok(())
    })?;
    Ok(Troughs { height, across, half })
}
