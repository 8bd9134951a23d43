//! Flips and quarter turns of tiles.

/// The transformation of a tile before it is drawn: first a flip over its diagonal from the upper left to the lower
/// right, then left to right, then top to bottom.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Flip {
    /// Columns and rows are exchanged.
    pub diagonal: bool,
    /// Left and right are exchanged.
    pub x: bool,
    /// Top and bottom are exchanged.
    pub y: bool,
}

/// The flips and turns that a tileset allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Flips {
    /// Left and right may be exchanged.
    pub x: bool,
    /// Top and bottom may be exchanged.
    pub y: bool,
    /// Quarter turns are allowed.
    pub turns: bool,
}

impl Flip {
    /// No change.
    pub const NONE: Flip = Flip { diagonal: false, x: false, y: false };

    /// All eight transformations, the unchanged tile first.
    #[must_use]
    pub fn all() -> [Flip; 8] {
        std::array::from_fn(|n| Flip { diagonal: n & 4 != 0, x: n & 1 != 0, y: n & 2 != 0 })
    }

    /// The direction of `from` after the transformation. Directions are numbered clockwise from the north, 0 to 7.
    fn direction(self, from: usize) -> usize {
        let from = if self.diagonal { (14 - from) % 8 } else { from };
        let from = if self.x { (8 - from) % 8 } else { from };
        if self.y { (12 - from) % 8 } else { from }
    }

    /// Values for each direction, transformed like the tile.
    #[must_use]
    pub fn turned<T: Copy>(self, around: [T; 8]) -> [T; 8] {
        let mut turned = around;
        for (from, value) in around.into_iter().enumerate() {
            turned[self.direction(from)] = value;
        }
        turned
    }

    /// A mask of directions, transformed like the tile.
    #[must_use]
    pub fn mask(self, mask: u8) -> u8 {
        (0..8).filter(|from| mask >> from & 1 == 1).fold(0, |turned, from| turned | 1 << self.direction(from))
    }

    /// The pixel of the tile that is shown at (x, y), for tiles of `size` x `size` pixels.
    #[inline]
    #[must_use]
    pub fn pixel(self, [x, y]: [usize; 2], size: usize) -> [usize; 2] {
        let x = if self.x { size - 1 - x } else { x };
        let y = if self.y { size - 1 - y } else { y };
        if self.diagonal { [y, x] } else { [x, y] }
    }
}

impl Flips {
    /// All flips and turns that follow from the allowed ones, the unchanged tile first.
    #[must_use]
    pub fn all(self) -> Vec<Flip> {
        let is_allowed = |flip: &Flip| match self {
            Flips { turns: true, x: false, y: false } => {
                // Quarter turns without mirror images, which have an odd number of flips.
                (usize::from(flip.diagonal) + usize::from(flip.x) + usize::from(flip.y)).is_multiple_of(2)
            }
            Flips { turns: true, .. } => true,
            Flips { x, y, .. } => !flip.diagonal && (x || !flip.x) && (y || !flip.y),
        };
        Flip::all().into_iter().filter(is_allowed).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autotile::mask::OFFSETS;

    #[test]
    fn masks_turn_with_the_pixels() {
        for flip in Flip::all() {
            for (from, [dx, dy]) in OFFSETS.into_iter().enumerate() {
                // The direction as a pixel of a tile of three pixels.
                let to = OFFSETS[flip.direction(from)].map(|at| (at + 1) as usize);
                assert_eq!(flip.pixel(to, 3), [dx, dy].map(|at| (at + 1) as usize), "{flip:?}");
                assert_eq!(flip.mask(1 << from), 1 << flip.direction(from));
            }
        }
    }

    #[test]
    fn allowed_flips_are_groups() {
        let count = |x, y, turns| Flips { x, y, turns }.all().len();
        assert_eq!([count(false, false, false), count(true, false, false), count(true, true, false)], [1, 2, 4]);
        assert_eq!([count(false, false, true), count(true, false, true)], [4, 8]);
        assert_eq!(Flips { x: true, y: true, turns: true }.all()[0], Flip::NONE);
    }
}
