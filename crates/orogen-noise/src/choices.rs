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
    /// The sum of triangle waves of the noise: contour bands, like agate.
    ///
    /// ```text
    /// t = strength (n_i + 1);  h += gain^i (1 - 2 |1 - (t - 2 floor(t / 2))|)
    /// ```
    ///
    /// Its gradient is exact except on the creases.
    PingPong {
        /// How often the range of the noise is folded, 2 strength - 1 times: 0.5 gives the noise itself, 1 its ridges, 2 (usual) three folds.
        strength: f64,
    },
    /// Musgrave's hybrid multifractal: an octave counts as much as the product of those before it, so that lowlands are smooth and
    /// heights rough.
    ///
    /// ```text
    /// s_i = gain^i (n_i + offset);  h += w s_i;  w = clamp(w s_i, 0, 1), starting at 1
    /// ```
    ///
    /// Its gradient is exact except where w is held. F. K. Musgrave in Ebert et al., "Texturing and Modeling" (1994).
    Hybrid {
        /// Added to the noise: where the sum of both is small, ground is smooth. Usual: 0.7.
        offset: f64,
    },
    /// Musgrave's heterogeneous terrain: an octave counts as much as the height so far.
    ///
    /// ```text
    /// h = n_0 + offset;  h += h gain^i (n_i + offset)
    /// ```
    ///
    /// Its gradient is exact. F. K. Musgrave in Ebert et al., "Texturing and Modeling" (1994).
    Hetero {
        /// Added to the noise: where the sum of both is small, ground is smooth. Usual: 0.7.
        offset: f64,
    },
    /// De Carpentier's swiss turbulence: ridges that pull the finer octaves down their slopes, so that crests branch.
    ///
    /// ```text
    /// n_i at p + warp d;  h += a_i (1 - |n_i|);  d -= a_i n_i grad n_i;  a_i+1 = a_i gain clamp(h, 0, 1)
    /// ```
    ///
    /// with grad n_i per cell of octave i and p in first wavelengths. Its gradient leaves out how places move and amplitudes
    /// change: an approximation. G. de Carpentier, "Scape: procedural basics" (2011).
    Swiss {
        /// How far slopes move what comes after, in first wavelengths. Usual: 0.15.
        warp: f64,
    },
    /// De Carpentier's jordan turbulence: squared noise, moved and damped by the slopes so far: rounded massifs with worn flanks.
    ///
    /// ```text
    /// n_i at p lacunarity^i + warp d;  h += a_i n_i^2;  d += n_i grad n_i;  a_i = gain^i (1 - 1 / (1 + |damp d|^2)), a_0 = 1
    /// ```
    ///
    /// with grad n_i per cell of octave i. Its gradient leaves out how places move and amplitudes change: an approximation. G. de
    /// Carpentier, "Scape: procedural basics" (2011).
    Jordan {
        /// How far slopes move what comes after, in cells of the octave. Usual: 0.35.
        warp: f64,
        /// How much slopes so far let the finer octaves through; 0 leaves the first one alone. Usual: 0.8.
        damp: f64,
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

/// How far the corners of [`crate::OpenSimplex2`] reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Smoothness {
    /// As few corners to a sample as there can be.
    #[default]
    Fast,
    /// Wider, rounder kernels and more of them: softer noise, about twice the work.
    Smooth,
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
