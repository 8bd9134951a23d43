//! The coordinate sets of a program that is being compiled.

use orogen_grid::grid::{FARTHEST, Window};
use orogen_ops::ids::{CoordSetId, IndexVec, NodeId, RequestId};
use orogen_ops::op::{Affine, CoordMap, Stencil};
use orogen_ops::program::Instruction;
use std::collections::HashMap;

/// Coordinate sets by their purpose; each exists once.
pub struct CoordSets {
    /// The samples around each coordinate set, on the lattice of filters.
    windows: IndexVec<CoordSetId, Window>,
    /// Where fields with a coordinate map read their source.
    entered: HashMap<(NodeId, CoordSetId), CoordSetId>,
    /// The four coordinate sets around another one, by the bits of their distance.
    surrounding: HashMap<(u64, CoordSetId), [CoordSetId; 4]>,
}

impl CoordSets {
    /// The block itself, for blocks of `window`.
    pub fn new(window: Window) -> CoordSets {
        CoordSets { windows: vec![window].into(), entered: HashMap::new(), surrounding: HashMap::new() }
    }

    /// Number of coordinate sets.
    pub fn count(&self) -> usize {
        self.windows.len()
    }

    /// The samples around a coordinate set.
    pub fn window(&self, coords: CoordSetId) -> Window {
        self.windows[coords]
    }

    /// Where a field with a coordinate map reads its source, if that coordinate set has been made.
    pub fn entered(&self, node: NodeId, from: CoordSetId) -> Option<CoordSetId> {
        self.entered.get(&(node, from)).copied()
    }

    /// Makes the coordinate set at which a field with this map reads its source.
    pub fn enter(&mut self, node: NodeId, from: CoordSetId, map: &CoordMap) -> CoordSetId {
        let around = self.windows[from];
        let to = self.windows.push(match map {
            CoordMap::Displaced { reach, .. } => {
                around.grown(((reach / around.cell).ceil() as usize).saturating_add(MARGIN))
            }
            CoordMap::Mapped { map, .. } => mapped(&around, map),
        });
        self.entered.insert((node, from), to);
        to
    }

    /// The four coordinate sets of a stencil around another one; `emit` gets the instructions of new ones.
    pub fn around(
        &mut self,
        stencil: &Stencil,
        from: CoordSetId,
        mut emit: impl FnMut(Instruction<RequestId>),
    ) -> [CoordSetId; 4] {
        let key = (stencil.step.to_bits(), from);
        if let Some(around) = self.surrounding.get(&key) {
            return *around;
        }
        let around = stencil.maps().map(|map| {
            let to = self.windows.push(mapped(&self.windows[from], &map));
            emit(Instruction::Map { from, map, to });
            to
        });
        self.surrounding.insert(key, around);
        around
    }
}

/// Samples that the interpolating cubic reads around a position.
const MARGIN: usize = 2;

/// The samples around all positions that a map leads to from a window.
fn mapped(window: &Window, map: &Affine) -> Window {
    let (right, bottom) = (window.east(window.width), window.south(window.height));
    let corners =
        [(window.east(0), window.south(0)), (right, window.south(0)), (window.east(0), bottom), (right, bottom)]
            .map(|(x, y)| map.apply(x, y));
    let span = |values: [f64; 4]| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min) / window.cell;
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max) / window.cell;
        // Positions beyond any lattice are rejected later for their memory; here they must only not overflow.
        const FAR: f64 = FARTHEST as f64;
        let start = low.floor().clamp(-FAR, FAR) as i64 - MARGIN as i64;
        let end = high.ceil().clamp(-FAR, FAR) as i64 + MARGIN as i64 + 1;
        (start, (end - start).max(0) as usize)
    };
    let (x, width) = span(corners.map(|corner| corner.0));
    let (y, height) = span(corners.map(|corner| corner.1));
    Window { x, y, width, height, cell: window.cell }
}
