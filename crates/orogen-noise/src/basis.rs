//! The bases of fractals. To add a basis, add a row to this table.

use crate::choices::{ClassicVariant, Distance, Fade, Feature, Smoothness};
use crate::program::{Cellular, Source};
use crate::tables::reference::{BOUND_3D, BOUND_4D};

/// Declares the bases. A row has a description for recipes, more documentation, the variant, its name in recipes and on
/// the command line, its source, and its [cost](Basis::cost).
macro_rules! bases {
    ($(
        #[doc = $about:literal]
        $(#[$more:meta])*
        $basis:ident = $name:literal, $source:expr, cost $anywhere:literal, $in_rows:literal;
    )*) => {
        /// The noise that a [`crate::Fractal`] sums.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
        #[non_exhaustive]
        pub enum Basis {
            $(
                #[doc = $about]
                $(#[$more])*
                $basis,
            )*
        }

        impl Basis {
            /// Every basis.
            #[must_use]
            pub const fn all() -> &'static [Basis] {
                &[$(Basis::$basis),*]
            }

            /// The name in recipes and on the command line.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Basis::$basis => $name,)*
                }
            }

            /// The description in recipes.
            #[doc(hidden)]
            #[must_use]
            pub const fn about(self) -> &'static str {
                match self {
                    $(Basis::$basis => $about.trim_ascii_start(),)*
                }
            }

            /// Nanoseconds per sample of one octave, at arbitrary positions and on a lattice of columns and rows,
            /// measured over 512 x 512 samples with a wavelength of 100 samples and 6 octaves.
            #[doc(hidden)]
            #[must_use]
            pub const fn cost(self) -> [f64; 2] {
                match self {
                    $(Basis::$basis => [$anywhere, $in_rows],)*
                }
            }

            /// The source of the numbers at lattice points.
            pub(crate) const fn source(self) -> Source {
                match self {
                    $(Basis::$basis => $source,)*
                }
            }
        }
    };
}

bases! {
    /// White noise: an independent value for each square.
    /// See [`crate::White`].
    White = "white", Source::Value(Fade::Step), cost 0.4, 0.06;
    /// Value noise: random values on a lattice, interpolated.
    /// See [`crate::Value`], with [`crate::Fade::Quintic`].
    Value = "value", Source::Value(Fade::Quintic), cost 0.8, 0.1;
    /// Perlin's gradient noise on a hashed lattice; it has no period.
    /// See [`crate::Perlin`].
    #[default]
    Perlin = "perlin", Source::Perlin, cost 1.0, 0.15;
    /// Perlin's 2002 table, four diagonal gradients, as in most textbooks.
    /// See [`crate::Classic`], with [`crate::ClassicVariant::Diagonal`].
    ClassicDiagonal = "classic-diagonal", Source::Classic(ClassicVariant::Diagonal), cost 2.2, 0.15;
    /// Perlin's 2002 table, eight gradients.
    /// See [`crate::Classic`], with [`crate::ClassicVariant::Eight`].
    ClassicEight = "classic-eight", Source::Classic(ClassicVariant::Eight), cost 2.2, 0.15;
    /// Perlin's 2002 table, unit gradients at 256 angles.
    /// See [`crate::Classic`], with [`crate::ClassicVariant::Angle`].
    ClassicAngle = "classic-angle", Source::Classic(ClassicVariant::Angle), cost 5.0, 0.15;
    /// Perlin's Simplex noise: gradients at the corners of a triangular lattice.
    /// See [`crate::Simplex`].
    Simplex = "simplex", Source::Simplex, cost 1.8, 0.9;
    /// OpenSimplex2, fast variant: Simplex noise with more gradient directions.
    /// See [`crate::OpenSimplex2`], with [`crate::Smoothness::Fast`].
    OpenSimplex2 = "opensimplex2", Source::OpenSimplex2(Smoothness::Fast), cost 2.0, 1.0;
    /// OpenSimplex2, smooth variant: wider and rounder kernels.
    /// See [`crate::OpenSimplex2`], with [`crate::Smoothness::Smooth`].
    OpenSimplex2Smooth = "opensimplex2-smooth", Source::OpenSimplex2(Smoothness::Smooth), cost 2.5, 2.5;
    /// Worley's cellular noise: distance to the nearest feature point.
    /// See [`crate::Worley`], with [`crate::Feature::F1`] and euclidean distance.
    Worley = "worley", cells(Feature::F1), cost 2.7, 2.7;
    /// Worley's cellular noise: distance to the nearest cell edge.
    /// See [`crate::Worley`], with [`crate::Feature::Edge`] and euclidean distance.
    WorleyEdge = "worley-edge", cells(Feature::Edge), cost 7.2, 7.2;
}

/// Cellular noise with points anywhere in their cells.
const fn cells(feature: Feature) -> Source {
    Source::Worley(Cellular { distance: Distance::Euclidean, feature, jitter: 1.0 })
}

impl Basis {
    /// The basis with this [name](Basis::name).
    #[must_use]
    pub fn from_name(name: &str) -> Option<Basis> {
        Basis::all().iter().copied().find(|basis| basis.name() == name)
    }

    /// Whether the noise has a gradient. White noise has none, and the gradient of Worley noise is not implemented.
    /// Methods that return gradients return zeros for them.
    #[must_use]
    pub const fn has_gradient(self) -> bool {
        self.source().sloped()
    }

    /// Whether the noise can repeat along the axes; Simplex and OpenSimplex2 cannot.
    #[must_use]
    pub const fn is_tileable(self) -> bool {
        self.source().repeats()
    }

    /// The maximum absolute value of the basis in 2, 3 or 4 dimensions, by which a [`crate::Fractal`] divides. Perlin's
    /// reference noise reaches 1.03635 in 3D and 1.53658 in 4D.
    #[must_use]
    pub const fn bound(self, dimensions: usize) -> f64 {
        match (self.source(), dimensions) {
            (Source::Classic(_), 3) => BOUND_3D,
            (Source::Classic(_), 4..) => BOUND_4D,
            _ => 1.0,
        }
    }
}
