//! Dolines: closed hollows of karst.

use crate::budget::memory;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, wrong_layers};
use orogen_grid::dolines::Dolines as Law;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::words::number;

op! {
    /// Dolines (sinkholes): closed hollows where water has dissolved limestone, or where ground has sunk into caves.
    ///
    /// Dolines are scattered at random, with log-normal diameters, and lie along the joints of the rock. A bowl of
    /// radius r is d (1 - (x / r)^2)^1.5 deep, a funnel has straight sides, and the floor of a doline with sediment is
    /// level. The hollow is laid on the ground, so that its rim follows a slope. Where dolines overlap, the deepest
    /// counts: they merge to uvalas. Density, diameters and depths are those of Ford and Williams, "Karst Hydrogeology
    /// and Geomorphology" (2007).
    ///
    /// Dolines whose diameter is less than two cells fade out, so coarse cells show fewer.
    pub struct Dolines = "dolines", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
        /// Share of the density at the center of a doline, 0 to 1, such as a mask of limestone. Default: 1 everywhere.
        share: optional,
    }
    params {
        /// Seed of the node, hashed with the world's seed.
        seed: u64 = 0;
        /// Mean number on a square kilometre: 1 to 50 in most karst.
        density: f64 = 10.0, unit "1/km^2", range 0.0 to 1e6;
        /// Minimum and maximum diameter. The median is the square root of their product.
        diameters: [f64; 2] = [10.0, 300.0], unit "m", range 0.1 to 5000.0;
        /// Minimum and maximum depth, as a share of the diameter.
        depths: [f64; 2] = [0.1, 0.3], range 0.0 to 1.0;
        /// Minimum and maximum length over width. The area does not change with it.
        elongations: [f64; 2] = [1.0, 1.8], range 1.0 to 5.0;
        /// Direction of the joints along which dolines are long, clockwise from north.
        direction: f64 = 45.0, unit "deg", range -360.0 to 360.0;
        /// Share of the dolines that are funnels.
        funnels: f64 = 0.3, range 0.0 to 1.0;
        /// Share of the dolines that have a level floor. The others are bowls.
        floors: f64 = 0.2, range 0.0 to 1.0;
        /// How much the density varies by place: 0 not at all, 1 from none to twice the mean.
        clustering: f64 = 0.8, range 0.0 to 1.0;
        /// Distance between clusters.
        cluster_distance: f64 = 1500.0, unit "m", range 1.0 to 1e6;
        /// Slope of the ground, over the diameter, from which on there are no dolines. They become rarer from half of
        /// it on; 90 puts them everywhere.
        max_slope: f64 = 20.0, unit "deg", range 0.0 to 90.0;
    }
    layers {
        /// Heights with the dolines.
        height: height, unit "m";
        /// Depth of the dolines below the ground before.
        hollow: height, unit "m";
    }
    check |op| {
        let pairs = [("diameters", op.diameters), ("depths", op.depths), ("elongations", op.elongations)];
        match pairs.into_iter().find(|(_, [least, most])| least > most) {
            Some((name, [least, most])) => Err((
                name,
                format!("the first of `{name}` ({}) must not be greater than the second ({})", number(least), number(most)),
            )),
            None if op.funnels + op.floors > 1.0 => Err((
                "floors",
                format!("`funnels` and `floors` are shares of all dolines; together they are {}, more than 1", number(op.funnels + op.floors)),
            )),
            None => Ok(()),
        }
    };
}

impl Filter for Dolines {
    fn halo(&self, cell: f64) -> usize {
        self.law(0).halo(cell)
    }

    fn scratch(&self, window: &Window) -> u64 {
        // The hollows, once in tiles and once together.
        memory(window, 8)
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        if window.is_empty() {
            return Ok(());
        }
        let law = self.law(context.world_params.seed_of(self.seed));
        let hollow = law.hollow(source, inputs.get("share"), context.progress)?;
        let [height, depth] = out else { return Err(wrong_layers()) };
        if let Some(height) = height {
            let halo = self.halo(window.cell);
            for j in 0..window.height {
                let ground = source.row(j + halo)[halo..].iter();
                for ((height, ground), depth) in height.row_mut(j).iter_mut().zip(ground).zip(hollow.row(j)) {
                    *height = ground - depth;
                }
            }
        }
        if let Some(depth) = depth {
            depth.paste(&hollow);
        }
        Ok(())
    }

    fn lower(&self, _: f64, _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("its dolines are found in lists of random places")
    }

    fn cost(&self, cell: f64) -> f64 {
        // How many dolines cover a sample, and those of a tile that are found for it.
        let covered = self.density * 1e-6 * self.diameters[0] * self.diameters[1];
        20.0 + 60.0 * covered + 100.0 * self.density * 1e-6 * cell * cell
    }
}

impl Dolines {
    fn law(&self, seed: u64) -> Law {
        Law::default()
            .with_density(self.density)
            .with_diameters(self.diameters)
            .with_depths(self.depths)
            .with_elongations(self.elongations)
            .with_direction(self.direction)
            .with_funnels(self.funnels)
            .with_floors(self.floors)
            .with_clustering(self.clustering)
            .with_cluster_distance(self.cluster_distance)
            .with_max_slope(self.max_slope)
            .with_seed(seed)
    }
}
