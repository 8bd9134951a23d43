//! What the parameters of noises choose from.

/// How value noise blends from one lattice point to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Fade {
    /// No blend: the value of the cell's lower corner. This is what [`crate::White`] is made of; its gradient is zero.
    Step,
    /// t: creases along the lattice.
    Linear,
    /// 3 t^2 - 2 t^3: no creases.
    Cubic,
    /// 6 t^5 - 15 t^4 + 10 t^3: no creases in the slope either.
    #[default]
    Quintic,
}

/// Which gradients a hash of [`crate::Classic`] stands for in 2D. In 3D all variants are the 2002 reference: the twelve edges of a
/// cube, four of them twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum ClassicVariant {
    /// As most textbook ports have it: the low three bits pick +-x +-y, so there are four diagonals, each twice.
    #[default]
    Diagonal,
    /// The low three bits pick one of eight directions: four diagonals (1, 1) and four axes (1, 0).
    Eight,
    /// Unit vectors at 256 angles times sqrt 2, as the textbook versions for array languages have it.
    Angle,
}

/// How octaves become one number. All kinds are normalised by the sum of the octaves' amplitudes and stay within [-1, 1].
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Kind {
    /// Fractional Brownian motion: the sum. Its gradient is exact.
    #[default]
    Fbm,
    /// The sum of 1 - 2 |noise|: sharp crests. Its gradient is exact except on the creases.
    Ridged,
    /// The sum of 2 |noise| - 1: sharp valleys, round hills. Its gradient is exact except on the creases.
    Billow,
    /// Each octave is damped by the slope so far, so that detail gathers on the flats and steep ground stays smooth:
    ///
    /// ```text
    /// d += (gain lacunarity)^i grad n_i       slope of the plain sum, per wavelength of the first octave
    /// h += gain^i n_i falloff(k |d|^2)
    /// ```
    ///
    /// With gain 1/2 and lacunarity 2 this is the sum of I. Quilez, "Value noise derivatives" (2008), over any basis.
    /// Its gradient leaves the falloff's own slope out, which would take second derivatives: an approximation, not the
    /// exact slope. White noise has no slope, so over it this is [`Kind::Fbm`].
    Weighted {
        /// Strength of the damping, 0 and up; 0 is [`Kind::Fbm`]. No unit: it means the same at any wavelength. Usual: 1.
        k: f64,
        /// Shape of the damping.
        falloff: Falloff,
    },
}

/// The damping factor of [`Kind::Weighted`] for a squared slope m, 1 at no slope.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Falloff {
    /// 1 / (1 + k m).
    #[default]
    Reciprocal,
    /// e^(-k m).
    Exponential,
    /// 1 / (1 + k sqrt m).
    SquareRoot,
    /// 1 - smoothstep(k m): no detail at all from k m = 1 on.
    Smoothstep,
}

/// How [`crate::Worley`] measures distance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Distance {
    /// The straight line: round cells.
    #[default]
    Euclidean,
    /// The sum along the axes: cells with slanted sides.
    Manhattan,
    /// The greatest along the axes: square cells.
    Chebyshev,
}

/// What [`crate::Worley`] tells about the points near a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Feature {
    /// The distance to the nearest point.
    #[default]
    F1,
    /// The distance to the second nearest point.
    F2,
    /// F2 - F1: zero on the edges between cells.
    Difference,
    /// F1 * F2.
    Product,
    /// A value of its own for each cell.
    Value,
    /// The distance to the nearest edge between cells: exact for [`Distance::Euclidean`]. For the others (F2 - F1) / 2, which is zero
    /// on the edges and never more than the distance to them.
    Edge,
}
