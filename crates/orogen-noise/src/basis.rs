//! The bases of fractals.

use crate::tables::reference::{BOUND_3D, BOUND_4D};

/// The noise that a [`crate::Fractal`] sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Basis {
    /// [`crate::White`]: a value per square.
    White,
    /// [`crate::Value`] with [`crate::Fade::Quintic`].
    Value,
    /// [`crate::Perlin`]: hashed gradients.
    #[default]
    Perlin,
    /// [`crate::Classic`] with [`crate::ClassicVariant::Diagonal`].
    ClassicDiagonal,
    /// [`crate::Classic`] with [`crate::ClassicVariant::Eight`].
    ClassicEight,
    /// [`crate::Classic`] with [`crate::ClassicVariant::Angle`].
    ClassicAngle,
    /// [`crate::Simplex`]: gradients on the corners of triangles.
    Simplex,
    /// [`crate::OpenSimplex2`] with [`crate::Smoothness::Fast`].
    OpenSimplex2,
    /// [`crate::OpenSimplex2`] with [`crate::Smoothness::Smooth`].
    OpenSimplex2Smooth,
    /// [`crate::Worley`] with [`crate::Feature::F1`] and euclidean distance.
    Worley,
    /// [`crate::Worley`] with [`crate::Feature::Edge`] and euclidean distance.
    WorleyEdge,
}

impl Basis {
    const ALL: [Basis; 11] = [
        Basis::White,
        Basis::Value,
        Basis::Perlin,
        Basis::ClassicDiagonal,
        Basis::ClassicEight,
        Basis::ClassicAngle,
        Basis::Simplex,
        Basis::OpenSimplex2,
        Basis::OpenSimplex2Smooth,
        Basis::Worley,
        Basis::WorleyEdge,
    ];

    /// Every basis.
    #[must_use]
    pub const fn all() -> &'static [Basis] {
        &Basis::ALL
    }

    /// The name in recipes and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Basis::White => "white",
            Basis::Value => "value",
            Basis::Perlin => "perlin",
            Basis::ClassicDiagonal => "classic-diagonal",
            Basis::ClassicEight => "classic-eight",
            Basis::ClassicAngle => "classic-angle",
            Basis::Simplex => "simplex",
            Basis::OpenSimplex2 => "opensimplex2",
            Basis::OpenSimplex2Smooth => "opensimplex2-smooth",
            Basis::Worley => "worley",
            Basis::WorleyEdge => "worley-edge",
        }
    }

    /// The basis with this [name](Basis::name).
    #[must_use]
    pub fn from_name(name: &str) -> Option<Basis> {
        Basis::ALL.into_iter().find(|basis| basis.name() == name)
    }

    /// Whether the noise has a gradient. White noise has none, and that of Worley noise is not computed; methods that
    /// return gradients return zeros for them.
    #[must_use]
    pub const fn has_gradient(self) -> bool {
        !matches!(self, Basis::White | Basis::Worley | Basis::WorleyEdge)
    }

    /// Whether the noise can repeat along the axes; Simplex and OpenSimplex2 cannot.
    #[must_use]
    pub const fn is_tileable(self) -> bool {
        !matches!(self, Basis::Simplex | Basis::OpenSimplex2 | Basis::OpenSimplex2Smooth)
    }

    /// The maximum absolute value of the basis in 2, 3 or 4 dimensions; a [`crate::Fractal`] divides by it. Perlin's
    /// reference noise reaches 1.03635 in 3D and 1.53658 in 4D.
    #[must_use]
    pub const fn bound(self, dimensions: usize) -> f64 {
        match (self, dimensions) {
            (Basis::ClassicDiagonal | Basis::ClassicEight | Basis::ClassicAngle, 3) => BOUND_3D,
            (Basis::ClassicDiagonal | Basis::ClassicEight | Basis::ClassicAngle, 4..) => BOUND_4D,
            _ => 1.0,
        }
    }
}
