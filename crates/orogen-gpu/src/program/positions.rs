//! The positions of coordinate sets, without displacements.

use orogen_engine::device::LoweredCoords;
use orogen_engine::op::Affine;
use orogen_grid::grid::Window;
use orogen_noise::shader::lattice::Positions;

/// The positions of the columns and rows of each coordinate set over a window.
pub(crate) fn of_sets(sets: &[LoweredCoords], window: &Window) -> Vec<Positions> {
    let mut made: Vec<Positions> = Vec::with_capacity(sets.len());
    for set in sets {
        let next = match set {
            LoweredCoords::Block => Positions {
                columns: [(0..window.width).map(|i| window.east(i)).collect(), Vec::new()],
                rows: [Vec::new(), (0..window.height).map(|j| window.south(j)).collect()],
            },
            LoweredCoords::Displaced { from, .. } => made.get(*from).cloned().unwrap_or_default(),
            LoweredCoords::Mapped { from, map } => made.get(*from).map(|from| mapped(from, map)).unwrap_or_default(),
        };
        made.push(next);
    }
    made
}

fn mapped(from: &Positions, map: &Affine) -> Positions {
    let columns = turned(&from.columns, map);
    let rows = turned(&from.rows, map);
    let (mut columns, mut rows) = (columns, rows);
    for axis in 0..2 {
        // The offset is added to only one of them.
        let list = if columns[axis].is_empty() { &mut rows[axis] } else { &mut columns[axis] };
        list.iter_mut().for_each(|position| *position += map.offset[axis]);
    }
    Positions { columns, rows }
}

/// Positions under the linear part of a map.
fn turned([x, y]: &[Vec<f64>; 2], map: &Affine) -> [Vec<f64>; 2] {
    if map.is_separable() {
        let scaled = |list: &Vec<f64>| list.iter().map(|position| position * map.scale).collect();
        return [scaled(x), scaled(y)];
    }
    let [cos, sin] = map.turn;
    let count = x.len().max(y.len());
    let at = |list: &Vec<f64>, i: usize| list.get(i).copied().unwrap_or(0.0);
    [
        (0..count).map(|i| (cos * at(x, i) - sin * at(y, i)) * map.scale).collect(),
        (0..count).map(|i| (sin * at(x, i) + cos * at(y, i)) * map.scale).collect(),
    ]
}
