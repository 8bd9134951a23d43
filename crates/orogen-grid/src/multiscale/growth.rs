//! Growth of the land between rivers, in passes: heights fall to the steady state of the law relative to the lowest
//! neighbor.

use super::distances::Distances;
use super::growth_row::{Around, Own, Row, Scale, grow};
use super::law::Law;
use super::refinement::Refinement;
use super::stencil::Extent;
use orogen_simd::{Body, Simd, dispatch};

/// Drainage area, in km^2, from which rivers have floors.
pub const FLOOR_AREA: f64 = 5.0;

/// The planes of a growing level.
pub struct Growth {
    pub height: Vec<f32>,
    pub area: Vec<f32>,
    pub receiver: Vec<f32>,
    /// Receivers that must not change (see [`super::carve::Carved::fixed`]).
    pub fixed: Vec<f32>,
    /// Distance in metres over which the floor of a river downstream continues; empty without floors.
    floor: Vec<f32>,
    next_height: Vec<f32>,
    next_floor: Vec<f32>,
    pub spare: Vec<f32>,
}

/// The distances between neighbors.
#[derive(Clone, Copy)]
pub enum Spacing<'a> {
    Irregular(&'a Distances),
    /// Nodes on the lattice, as on the finest level.
    Regular,
}

impl Growth {
    /// The nodes before growth, with floors if `floors` is set.
    pub fn new(height: Vec<f32>, area: Vec<f32>, receiver: Vec<f32>, fixed: Vec<f32>, floors: bool) -> Growth {
        let cells = height.len();
        let plane = |wanted: bool| if wanted { vec![0.0; cells] } else { Vec::new() };
        Growth {
            next_height: height.clone(),
            spare: area.clone(),
            height,
            area,
            receiver,
            fixed,
            floor: plane(floors),
            next_floor: plane(floors),
        }
    }

    /// One pass over the cells of `extent`, on level `depth`. If `least` is not empty, heights stay at or above it.
    pub fn pass(
        &mut self,
        extent: Extent,
        law: &Law,
        spacing: Spacing<'_>,
        least: &[f32],
        land: &Refinement,
        depth: usize,
    ) {
        let cell = land.cell_of(depth);
        let square_kilometres = cell * cell * 1e-6;
        let scale = Scale {
            cell: cell as f32,
            least_rise: land.least_rise(depth),
            floor_area: (square_kilometres / FLOOR_AREA) as f32,
        };
        dispatch(Pass { growth: self, extent, law, spacing, least, scale });
        std::mem::swap(&mut self.height, &mut self.next_height);
        std::mem::swap(&mut self.floor, &mut self.next_floor);
    }
}

struct Pass<'a> {
    growth: &'a mut Growth,
    extent: Extent,
    law: &'a Law,
    spacing: Spacing<'a>,
    least: &'a [f32],
    scale: Scale,
}

impl Body for Pass<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let Pass { growth, extent, law, spacing, least, scale } = self;
        let nothing: [&[f32]; 8] = [&[]; 8];
        let floors = !growth.floor.is_empty();
        let mut row = Row::default();
        for j in extent.rows() {
            let own = Own {
                height: extent.row(&growth.height, j),
                area: extent.row(&growth.area, j),
                fixed: extent.row(&growth.fixed, j),
                river: extent.row(&law.river, j),
                stable: extent.row(&law.stable, j),
                width: if floors { extent.row(&law.floor, j) } else { &[] },
                least: if least.is_empty() { &[] } else { extent.row(least, j) },
            };
            let around = Around {
                height: extent.around(&growth.height, j),
                fixed: extent.around(&growth.fixed, j),
                distance: match spacing {
                    Spacing::Irregular(distances) => distances.around(extent, j),
                    Spacing::Regular => nothing,
                },
                floor: if floors { extent.around(&growth.floor, j) } else { nothing },
            };
            let height = extent.row_mut(&mut growth.next_height, j);
            let receiver = extent.row_mut(&mut growth.receiver, j);
            let out_floor = if floors { extent.row_mut(&mut growth.next_floor, j) } else { &mut [] };
            match (spacing, floors) {
                (Spacing::Regular, _) => {
                    grow::<true, true>(&mut row, &own, &around, scale, height, receiver, out_floor)
                }
                (_, true) => grow::<true, false>(&mut row, &own, &around, scale, height, receiver, out_floor),
                (_, false) => grow::<false, false>(&mut row, &own, &around, scale, height, receiver, out_floor),
            }
        }
    }
}
