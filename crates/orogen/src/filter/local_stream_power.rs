//! Rivers cut and lay down, by what neighbours know of each other.

use crate::erosion::local_stream_power::{AREA, HEIGHT, LocalStreamPower as Law, RADIUS, SEDIMENT};
use crate::erosion::planes::Planes;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::op::{Context, Filter};

op! {
    /// The stream power law without end of the world: valleys and gullies cut by running water, with sediment laid down, by a finite halo.
    ///
    /// dh/dt = U - K A^m S^n + G Q / A, after Schott et al. (2023) and, for the sediment, Yuan et al. (2019). In each iteration all cells look
    /// at the one before: drainage areas A and sediment Q come from higher neighbours, shared by the fourth power of their slopes; S is the upwind gradient,
    /// so there are no grooves along the grid. Steps are stable however long; no cell is cut below its lowest neighbour. Soil creeps as in `stream-power`.
    ///
    /// Water comes a cell farther an iteration: rivers from beyond are unknown unless `flow` tells of them (`drainage.flow` or `stream-power.flow` of a coarser
    /// solution). So it is for detail: the solver `stream-power` shapes the land, this filter cuts gullies into it at any cell. Sediment's mass is
    /// kept only nearly, as it comes an iteration late. Each iteration looks two cells far, and the window is made with so much more on each
    /// side. What comes out depends on the cell. About 4 ns a sample and iteration.
    pub struct LocalStreamPower = "local-stream-power", filter, revision 1;
    inputs {
        /// The heights to begin with.
        source: required,
        /// Drainage areas to begin with, in m^2; a cell's own if left out.
        flow: optional,
    }
    params {
        /// How long it goes on.
        years: f64 = 1e5, unit "yr", range 0.0 to 1e9;
        /// In how many iterations.
        iterations: u32 = 50, range 1.0 to 10000.0;
        /// K: how easily water cuts, for m = 0.45 from 1e-6 (granite) to 5e-5 (mudstone).
        erodibility: f64 = 2e-5, unit "m^(1-2m)/yr", range 0.0 to 1.0;
        /// m: how much more a larger stream cuts.
        area_exponent: f64 = 0.45, range 0.0 to 2.0;
        /// n: how much more a steeper stream cuts.
        slope_exponent: f64 = 1.0, range 0.2 to 5.0;
        /// U: how fast the land rises.
        uplift: f64 = 0.0, unit "mm/yr", range 0.0 to 100.0;
        /// G: how much of what a stream carries it lays down again. 0 lays down nothing, 1 is common in nature.
        deposition: f64 = 0.5, range 0.0 to 100.0;
        /// How fast soil creeps: widens the gullies. At most what is stable, a fifth of a cell's square an iteration.
        creep: f64 = 0.005, unit "m^2/yr", range 0.0 to 100.0;
        /// Whether the ground at or below sea level stays as it is.
        sea: bool = true;
    }
    layers {
        /// The heights in the end.
        height: height, unit "m";
        /// The drainage areas that are known of.
        flow: flow, unit "m^2";
        /// The sediment that leaves a cell.
        sediment: flow, unit "m^3/yr";
    }
}

impl Filter for LocalStreamPower {
    fn halo(&self, _: f64) -> usize {
        RADIUS * self.iterations as usize
    }

    fn scratch(&self, window: &Window) -> u64 {
        // Three planes before and after some iterations, and bands of them.
        36 * window.grown(self.halo(window.cell)).len() as u64
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn apply(
        &self,
        inputs: &[Option<&Grid>],
        window: &Window,
        out: &mut [Option<Grid>],
        context: &Context,
    ) -> Result<()> {
        let [Some(source), flow] = inputs else { return Ok(()) };
        if window.is_empty() {
            return Ok(());
        }
        let own = (window.cell * window.cell) as f32;
        let mut planes = Planes::new(source.width(), source.height());
        for j in 0..source.height() {
            let [heights, areas, _] = planes.row_mut(j);
            heights.copy_from_slice(source.row(j));
            match flow {
                Some(flow) => areas.iter_mut().zip(flow.row(j)).for_each(|(area, flow)| *area = flow.max(own)),
                None => areas.fill(own),
            }
        }
        let done = self.law(window.cell, context).run(planes, self.iterations as usize, context.progress)?;
        for (layer, plane) in out.iter_mut().zip([HEIGHT, AREA, SEDIMENT]) {
            if let Some(layer) = layer {
                *layer = done.grid(plane, *window);
            }
        }
        Ok(())
    }

    fn cost(&self, _: f64) -> f64 {
        4.0 * f64::from(self.iterations)
    }
}

impl LocalStreamPower {
    fn law(&self, cell: f64, context: &Context) -> Law {
        Law {
            cell,
            years: self.years / f64::from(self.iterations.max(1)),
            erodibility: self.erodibility,
            area_exponent: self.area_exponent,
            slope_exponent: self.slope_exponent,
            uplift: self.uplift / 1000.0,
            deposition: self.deposition,
            creep: self.creep,
            sea_level: self.sea.then_some(context.world_params.sea_level as f32),
        }
    }
}
