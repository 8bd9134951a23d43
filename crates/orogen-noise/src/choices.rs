//! Enums for the parameters of noises.

/// How value noise interpolates between lattice points, as a function of the fraction t in the cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Fade {
    /// No interpolation: the value of the cell's lower corner, as in [`crate::White`]. Its gradient is zero.
    Step,
    /// t: the slope jumps at cell borders.
    Linear,
    /// 3 t^2 - 2 t^3: the slope is continuous.
    Cubic,
    /// 6 t^5 - 15 t^4 + 10 t^3: slope and curvature are continuous.
    #[default]
    Quintic,
}

/// The gradients of [`crate::Classic`] in 2D. In 3D all variants are the 2002 reference: the twelve edges of a cube,
/// four of them twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum ClassicVariant {
    /// As in most textbook ports: the low three bits of the hash select +-x +-y, which gives four diagonals, each
    /// twice.
    #[default]
    Diagonal,
    /// The low three bits of the hash select one of eight directions: four diagonals (1, 1) and four axes (1, 0).
    Eight,
    /// Vectors of length sqrt 2 at 256 angles, as in textbook versions for array languages.
    Angle,
}

/// How a fractal combines its octaves. All kinds are normalized by the sum of the octaves' amplitudes and stay in -1
/// ..= 1.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
#[non_exhaustive]
pub enum Kind {
    /// Fractional Brownian motion: the sum. Its gradient is exact.
    #[default]
    Fbm,
    /// The sum of 1 - 2 |noise|: sharp crests. Its gradient is exact except where the noise is 0.
    Ridged,
    /// The sum of 2 |noise| - 1: sharp valleys, round hills. Its gradient is exact except where the noise is 0.
    Billow,
    /// Each octave is damped by the slope of the previous ones, so level ground is detailed and steep ground is smooth.
    ///
    /// ```text
    /// d += (gain lacunarity)^i grad n_i       slope of the plain sum, per wavelength of the first octave
    /// h += gain^i n_i falloff(k |d|^2)
    /// ```
    ///
    /// With gain 1/2 and lacunarity 2 this is the sum of I. Quilez, "Value noise derivatives" (2008), over any basis.
    /// Its gradient is approximate: it omits the slope of the falloff, which would need second derivatives. White noise
    /// has no slope, so with it this kind equals [`Kind::Fbm`].
    Weighted {
        /// Strength of the damping, at least 0; 0 gives [`Kind::Fbm`]. It has no unit and does not depend on the
        /// wavelength. Typical: 1.
        k: f64,
        /// Shape of the damping.
        falloff: Falloff,
    },
    /// The sum of triangle waves of the noise, which gives bands like those of agate.
    ///
    /// ```text
    /// t = strength (n_i + 1);  h += gain^i (1 - 2 |1 - (t - 2 floor(t / 2))|)
    /// ```
    ///
    /// Its gradient is exact except at the folds.
    PingPong {
        /// The range of the noise is folded 2 strength - 1 times: 0.5 gives the noise itself, 1 its ridges, 2 (typical)
        /// three folds.
        strength: f64,
    },
    /// Musgrave's hybrid multifractal: the weight of an octave is the product of the previous octaves, so lowlands are
    /// smooth and heights are rough.
    ///
    /// ```text
    /// s_i = gain^i (n_i + offset);  h += w s_i;  w = clamp(w s_i, 0, 1), starting at 1
    /// ```
    ///
    /// Its gradient is exact except where w is clamped. F. K. Musgrave in Ebert et al., "Texturing and Modeling"
    /// (1994).
    Hybrid {
        /// Added to the noise. Ground is smooth where the sum of both is small. Typical: 0.7.
        offset: f64,
    },
    /// Musgrave's heterogeneous terrain: the weight of an octave is the height so far.
    ///
    /// ```text
    /// h = n_0 + offset;  h += h gain^i (n_i + offset)
    /// ```
    ///
    /// Its gradient is exact. F. K. Musgrave in Ebert et al., "Texturing and Modeling" (1994).
    Hetero {
        /// Added to the noise. Ground is smooth where the sum of both is small. Typical: 0.7.
        offset: f64,
    },
    /// De Carpentier's swiss turbulence: ridged noise whose slopes displace the finer octaves downhill, so that crests
    /// branch.
    ///
    /// ```text
    /// n_i at p + warp d;  h += a_i (1 - |n_i|);  d -= a_i n_i grad n_i;  a_i+1 = a_i gain clamp(h, 0, 1)
    /// ```
    ///
    /// with grad n_i per cell of octave i and p in first wavelengths. Its gradient is approximate: it omits the
    /// derivatives of displacements and amplitudes. G. de Carpentier, "Scape: procedural basics" (2011).
    Swiss {
        /// Displacement of later octaves by the slopes, in first wavelengths. Typical: 0.15.
        warp: f64,
    },
    /// De Carpentier's jordan turbulence: squared noise, displaced and damped by the slopes of the previous octaves. It
    /// gives rounded massifs with eroded flanks.
    ///
    /// ```text
    /// n_i at p lacunarity^i + warp d;  h += a_i n_i^2;  d += n_i grad n_i;
    /// a_i = gain^i (1 - 1 / (1 + |damp d|^2)), a_0 = 1
    /// ```
    ///
    /// with grad n_i per cell of octave i. Its gradient is approximate: it omits the derivatives of displacements and
    /// amplitudes. G. de Carpentier, "Scape: procedural basics" (2011).
    Jordan {
        /// Displacement of later octaves by the slopes, in cells of the octave. Typical: 0.35.
        warp: f64,
        /// Strength with which slopes of previous octaves enable later octaves; with 0 only the first octave remains.
        /// Typical: 0.8.
        damp: f64,
    },
}

/// The damping factor of [`Kind::Weighted`] for a squared slope m. It is 1 where the slope is 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Falloff {
    /// 1 / (1 + k m).
    #[default]
    Reciprocal,
    /// e^(-k m).
    Exponential,
    /// 1 / (1 + k sqrt m).
    SquareRoot,
    /// 1 - smoothstep(k m), which is 0 from k m = 1 on.
    Smoothstep,
}

/// The kernels of [`crate::OpenSimplex2`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Smoothness {
    /// Small kernels: the minimum number of corners per sample.
    #[default]
    Fast,
    /// Wider and rounder kernels, and more of them per sample: softer noise at about twice the cost.
    Smooth,
}

/// The distance that [`crate::Worley`] uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Distance {
    /// Length of the straight line: round cells.
    #[default]
    Euclidean,
    /// Sum of the distances along the axes: cells with diagonal sides.
    Manhattan,
    /// Maximum of the distances along the axes: square cells.
    Chebyshev,
}

/// The value that [`crate::Worley`] computes from the points near a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Feature {
    /// Distance to the nearest point.
    #[default]
    F1,
    /// Distance to the second nearest point.
    F2,
    /// F2 - F1: zero on the edges between cells.
    Difference,
    /// F1 * F2.
    Product,
    /// A random value per cell.
    Value,
    /// Distance to the nearest edge between cells, exact for [`Distance::Euclidean`]. For the other distances it is
    /// (F2 - F1) / 2, which is 0 on the edges and never more than the distance to them.
    Edge,
}
