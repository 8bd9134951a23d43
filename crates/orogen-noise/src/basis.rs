//! The list of bases, by name.

use crate::tables::reference::BOUND_3D;

/// A coherent noise that a [`crate::Fractal`] can be made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
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
}

impl Basis {
    const ALL: [Basis; 6] =
        [Basis::White, Basis::Value, Basis::Perlin, Basis::ClassicDiagonal, Basis::ClassicEight, Basis::ClassicAngle];

    /// Every basis.
    #[must_use]
    pub const fn all() -> &'static [Basis] {
        &Basis::ALL
    }

    /// The name recipes and the command line use.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Basis::White => "white",
            Basis::Value => "value",
            Basis::Perlin => "perlin",
            Basis::ClassicDiagonal => "classic-diagonal",
            Basis::ClassicEight => "classic-eight",
            Basis::ClassicAngle => "classic-angle",
        }
    }

    /// The basis of that [name](Basis::name).
    #[must_use]
    pub fn from_name(name: &str) -> Option<Basis> {
        Basis::ALL.into_iter().find(|basis| basis.name() == name)
    }

    /// Whether the noise is smooth. White noise is not: its gradient is given as zero everywhere.
    #[must_use]
    pub const fn has_gradient(self) -> bool {
        !matches!(self, Basis::White)
    }

    /// The greatest size a value of the basis reaches in 2D; a [`crate::Fractal`] divides by it.
    #[must_use]
    pub const fn bound(self) -> f64 {
        1.0
    }

    /// The greatest size a value of the basis reaches in 3D. Perlin's reference noise is not bounded by 1: where its
    /// gradients agree best, at (.355, .519, .5) in a cell, it reaches 1.03635.
    #[must_use]
    pub const fn bound3(self) -> f64 {
        match self {
            Basis::White | Basis::Value | Basis::Perlin => 1.0,
            Basis::ClassicDiagonal | Basis::ClassicEight | Basis::ClassicAngle => BOUND_3D,
        }
    }
}
