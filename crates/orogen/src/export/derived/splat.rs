//! What covers the ground.

use super::layer::{Derived, Nature};
use crate::analysis::curvature::{Curvature, curvature};
use crate::analysis::ground_cover::{Cover, Ground, LAYERS, SNOW_LINE};
use crate::analysis::slope::degrees;
use crate::grid::Grid;

/// The layer.
pub static LAYER: Derived = Derived {
    name: "splat",
    about: "weights of grass, scree, rock, snow, sand and river bed: a splat map",
    unit: "",
    nature: Nature::Weights,
    channels: &LAYERS,
    flow: true,
    reach: |_| 1,
    make: |around, window| {
        let heights = around.bordered(window);
        let (slopes, curvatures) = (degrees(&heights), curvature(&heights, Curvature::Total));
        let cover = Cover::new(SNOW_LINE);
        let mut weights = vec![Grid::filled(*window, 0.0); LAYERS.len()];
        for j in 0..window.height {
            for i in 0..window.width {
                let above_sea = (f64::from(heights.get(i + 1, j + 1)) - around.sea_level) as f32;
                let flow = around.flow.map_or(0.0, |flow| {
                    let there = flow.window();
                    flow.get((window.x + i as i64 - there.x) as usize, (window.y + j as i64 - there.y) as usize)
                });
                let ground = Ground { slope: slopes.get(i, j), above_sea, curvature: curvatures.get(i, j), flow };
                for (grid, weight) in weights.iter_mut().zip(cover.weights(&ground)) {
                    grid.row_mut(j)[i] = weight;
                }
            }
        }
        weights
    },
};
