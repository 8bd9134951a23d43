//! Worley's cellular noise.

choice! {
    /// The feature of cellular noise: what is computed from the points near a sample.
    pub enum Feature as orogen_noise::Feature {
        /// Distance to the nearest point (F1): dimples.
        F1 = "f1",
        /// Distance to the second nearest point (F2).
        F2 = "f2",
        /// F2 - F1: 0 on the edges between cells.
        Difference = "difference",
        /// F1 * F2.
        Product = "product",
        /// A constant random value for each cell.
        Value = "value",
        /// Distance to the nearest edge between cells: cracks.
        Edge = "edge",
    }
}

choice! {
    /// Distance metric of cellular noise.
    pub enum Distance as orogen_noise::Distance {
        /// Straight-line distance: round cells.
        Euclidean = "euclidean",
        /// Sum of the distances along the axes: cells with slanted sides.
        Manhattan = "manhattan",
        /// Maximum of the distances along the axes: square cells.
        Chebyshev = "chebyshev",
    }
}

op! {
    /// Worley's cellular noise, in -1 ..= 1: each cell of a lattice holds one random point, and the value follows from
    /// the distances to the nearest points.
    ///
    /// A distance d becomes 2 d / maximum - 1, where the maximum is the largest possible distance of the feature. F1 is
    /// -1 at the points, `edge` is -1 on the edges between cells. The search covers all cells that can hold a nearest
    /// point, so the noise has no discontinuities from missed points. Worley, "A cellular texture basis function"
    /// (1996).
    pub struct Worley = "worley", field, revision 1;
    params {
        /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
        seed: u64 = 0;
        /// Side of a cell, which is about the distance between points.
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9, alias "scale";
        /// The feature to compute.
        feature: Feature = Feature::F1;
        /// Distance metric.
        distance: Distance = Distance::Euclidean;
        /// Share of its cell, along each axis, in which a point is placed: 0 places it in the middle (a regular
        /// lattice), 1 anywhere in the cell.
        jitter: f64 = 1.0, range 0.0 to 1.0;
    }
    noise |op, world_params| {
        orogen_noise::Worley::new(world_params.seed_of(op.seed), op.wavelength)
            .with_distance(op.distance.into())
            .with_feature(op.feature.into())
            .with_jitter(op.jitter)
    };
    // A single octave reads fewer cells per block than the fine octaves of a fractal.
    cost |op| if op.feature == Feature::Edge { [5.8, 2.6] } else { [3.0, 1.1] };
}
