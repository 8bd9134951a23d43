//! Land shaped by glaciers.

use crate::budget::memory;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::error::Result;
use orogen_grid::glaciation::{Glaciated, Glaciation};
use orogen_grid::grid::{Grid, Window};

op! {
    /// Land shaped by glaciers: troughs with flat floors and steep walls, hanging side valleys, basins below the level
    /// of their outlets, cirques, end moraines, and outwash before them.
    ///
    /// A glacier with ice I (km^2) makes a trough `width` I^0.32 wide and `depth` I^0.35 below the bed of the river,
    /// with walls that rise as the distance to the power of 1.5 (Svensson 1959, Harbor 1992). Where the valley does not
    /// confine the ice, it erodes less. Beds are smooth along the valley and vary with a wavelength of 1.5 to 7 km, so
    /// that there are basins; half of the tributaries hang. Where ice ends, moraines cross the valley, most of them cut
    /// by the river. `lakes` fills the basins.
    ///
    /// `ice` is the sum along the drainage of the balance b, the snow that falls less the ice that melts: 1 far above
    /// the equilibrium line, negative below it. With b + 1 as the `rain` of a `drainage` it is the `flow` of that less
    /// the `flow` without it.
    pub struct Glaciate = "glaciate", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
        /// Flow direction, clockwise from east (0) to north-east (7), such as `drainage.receiver`.
        receiver: required,
        /// The ice that passes, in m^2: the sum of the balance along the drainage. Glaciers are where it is at least
        /// 0.6 km^2.
        ice: required,
        /// Height of the equilibrium line in metres, above which more snow falls than melts.
        equilibrium_line: required,
    }
    params {
        /// Seed of the node, hashed with the world's seed.
        seed: u64 = 0;
        /// Width of the trough of a glacier with ice of 1 km^2.
        width: f64 = 400.0, unit "m", range 0.0 to 1e4;
        /// Depth of that trough below the bed of the river.
        depth: f64 = 80.0, unit "m", range 0.0 to 1000.0;
        /// Maximum width of a trough.
        max_width: f64 = 2400.0, unit "m", range 0.0 to 1e4;
        /// Share of the heads of glaciers with a cirque.
        cirques: f64 = 0.3, range 0.0 to 1.0;
        /// Height of the end moraines of large glaciers.
        moraines: f64 = 40.0, unit "m", range 0.0 to 200.0;
    }
}

impl Filter for Glaciate {
    fn halo(&self, cell: f64) -> usize {
        self.law(0).halo(cell)
    }

    fn scratch(&self, window: &Window) -> u64 {
        // The ground three times, three planes of troughs, shares, and the nodes of beds.
        memory(&window.grown(self.halo(window.cell)), 40)
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let land = glaciated(inputs)?;
        let out = only_layer(out)?;
        if window.is_empty() {
            return Ok(());
        }
        *out = self.law(context.world_params.seed_of(self.seed)).run(&land, context.progress)?;
        Ok(())
    }

    fn lower(&self, _: f64, _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("its troughs are found along the lines of glaciers, one after the other")
    }

    fn cost(&self, cell: f64) -> f64 {
        200.0 + 20.0 * (self.max_width / cell).min(200.0)
    }
}

/// The land and its ice, which the ops of glaciers read.
pub(super) fn glaciated<'a>(inputs: &GridInputs<'a>) -> Result<Glaciated<'a>> {
    Ok(Glaciated {
        height: inputs.required("source")?,
        receiver: inputs.required("receiver")?,
        ice: inputs.required("ice")?,
        equilibrium_line: inputs.required("equilibrium_line")?,
    })
}

impl Glaciate {
    fn law(&self, seed: u64) -> Glaciation {
        Glaciation::default()
            .with_width(self.width)
            .with_depth(self.depth)
            .with_max_width(self.max_width)
            .with_cirques(self.cirques)
            .with_moraines(self.moraines)
            .with_seed(seed)
    }
}
