//! Roads.

use crate::declare::LinePoints;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Reading, Solution, Solver, Sources, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::roads::{Land, RoadLine, Roads as Law};

op! {
    /// Roads between places: routes with a maximum grade, and the ground with their cuts and embankments.
    ///
    /// After Galin, Peytavie, Maréchal and Guérin (2010). A route is the cheapest path (A*) on a lattice with moves in
    /// 80 directions. A move costs its length, more for its grade, for a slope across it, for ground above or below it,
    /// and for turns tighter than `radius`. Straight bridges and tunnels are moves of their own; water is crossed by
    /// bridges only. Routes become cubic B-splines. Their heights are the line with the least maximum distance from the
    /// evened ground that keeps the `grade`. Where that would need a cut or an embankment wider than `slope_width`,
    /// there is a tunnel or a bridge. Only where a road meets earlier ones at two places too close to each other may it
    /// be steeper.
    ///
    /// Roads are built in the order of `places`. Each may use earlier roads, at `reuse` times the cost, and joins them
    /// at their heights. `orogen export --layer roads` writes the roads as lines. Solving fails if a place is outside
    /// of the world or in water, or if no road can lead to it. Time grows with the domain and the number of places:
    /// about 5 microseconds per node of the lattice and place. Memory is 60 bytes per sample and 610 per node.
    pub struct Roads = "roads", solver, revision 1;
    margin;
    inputs {
        /// The heights of the ground. Roads avoid samples without a height.
        source: required,
        /// Water is where this is more than 0, such as the layer `depth` of `lakes` or `width` of `rivers`.
        water: optional,
        /// Factor on the cost of a road at each sample, 0.05 to 1 000 000: 0.5 where roads are welcome, 5 in forest.
        cost: optional,
    }
    params {
        /// Places to connect, one after the other, at most 100 000. Several lists are several roads.
        places: LinePoints = LinePoints::default(), unit "m", range -1e9 to 1e9;
        /// Width of the road.
        width: f64 = 7.0, unit "m", range 0.1 to 1000.0;
        /// Maximum grade, rise over run: 0.04 for a railway, 0.08 for a road, 0.15 for a track.
        grade: f64 = 0.08, range 1e-3 to 1.0;
        /// Radius below which curves are expensive.
        radius: f64 = 30.0, unit "m", range 0.0 to 10_000.0;
        /// Cost of a metre of bridge over that of a level road; high bridges cost more.
        bridge_cost: f64 = 8.0, range 1.0 to 1e6;
        /// Cost of a metre of tunnel over that of a level road.
        tunnel_cost: f64 = 12.0, range 1.0 to 1e6;
        /// Length of the longest bridge of a route. 0 makes none, so water is not crossed.
        longest_bridge: f64 = 300.0, unit "m", range 0.0 to 100_000.0;
        /// Length of the longest tunnel of a route. 0 makes none.
        longest_tunnel: f64 = 1000.0, unit "m", range 0.0 to 100_000.0;
        /// Cost of an existing road over that of a new one. With a lower one more roads share their way.
        reuse: f64 = 0.2, range 0.01 to 1.0;
        /// Slope of cuts, rise over run.
        cut_slope: f64 = 0.67, range 0.05 to 20.0;
        /// Slope of embankments, rise over run.
        embankment_slope: f64 = 0.67, range 0.05 to 20.0;
        /// Maximum width of a cut or an embankment at each side. On slopes too steep for them they end with walls.
        slope_width: f64 = 15.0, unit "m", range 0.0 to 1000.0;
        /// Distance between the nodes of the lattice, in whole cells of the solution.
        spacing: f64 = 20.0, unit "m", range 0.1 to 10_000.0;
        /// Whether the sea is water.
        sea: bool = true;
        /// Cell size of the solution; 0 uses the world's cell. In the ground a road is at least 1.5 cells wide.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// Heights with the roads, their cuts and embankments.
        height: height, unit "m";
        /// A mask: 1 on roads, falling smoothly to 0 beside them. Bridges and tunnels are left out.
        road: height;
        /// 1 on a road on the ground, 2 on a bridge, 3 over a tunnel, 0 elsewhere.
        kind: label;
        /// What was cut (negative) and filled.
        change: height, unit "m";
    }
    check |op| match op.places.is_empty() {
        true => Err((
            "places",
            "`roads` needs places to connect: write `places`, such as `places = [[500, 500], [2000, 1500]]`".into(),
        )),
        false => Ok(()),
    };
}

/// The layer that is a share.
const ROAD: usize = 1;

impl Roads {
    fn law(&self) -> Law {
        Law::default()
            .with_width(self.width)
            .with_grade(self.grade)
            .with_radius(self.radius)
            .with_spacing(self.spacing)
            .with_bridge_cost(self.bridge_cost)
            .with_tunnel_cost(self.tunnel_cost)
            .with_longest_bridge(self.longest_bridge)
            .with_longest_tunnel(self.longest_tunnel)
            .with_reuse(self.reuse)
            .with_cut_slope(self.cut_slope)
            .with_embankment_slope(self.embankment_slope)
            .with_slope_width(self.slope_width)
    }
}

impl Solver for Roads {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn scratch(&self, padded: &Window) -> u64 {
        self.law().memory(padded)
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let ground = super::terrain::heights(sources, context)?;
        let given = |name: &str| sources.given(name).then(|| sources.whole(name, sources.padded())).transpose();
        let (water, cost) = (given("water")?, given("cost")?);
        context.progress.check()?;
        let land = Land {
            ground: &ground,
            water: water.as_ref(),
            cost: cost.as_ref(),
            sea_level: super::terrain::sea_level(self.sea, context),
            domain: *sources.domain(),
        };
        let made = self.law().run(&land, self.places.lists(), context.progress)?;
        drop((ground, water, cost));
        let layers = [made.height, made.road, made.kind, made.change];
        let layers = layers.into_iter().map(|grid| sources.keep(grid)).collect::<Result<Vec<_>>>()?;
        Ok(Solution { layers, scalars: RoadLine::to_numbers(&made.lines) })
    }

    fn read(&self, solution: &Solution, asked: &Reading, out: &mut [f32]) -> Result<()> {
        solution.read(asked, out)?;
        if asked.layer == ROAD {
            out.iter_mut().for_each(|share| *share = share.clamp(0.0, 1.0));
        }
        Ok(())
    }

    fn lower(&self, _: &Window, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("routes are found node by node, in order of their costs")
    }

    fn cost(&self) -> f64 {
        6000.0
    }
}
