//! Collects the outlines that readers of vector files find.

use orogen_grid::polylines::outline::{Outline, Piece};
use sha2::{Digest, Sha256};

/// Maximum number of points of a file.
pub const MAX_POINTS: usize = 1 << 20;

/// Maximum coordinate, in the unit of the file.
pub const MAX_COORDINATE: f64 = 1e9;

/// The kind of outlines that are read from a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum DrawingKind {
    /// Lines.
    Lines,
    /// Boundaries of areas.
    Areas,
    /// Lines and points with heights. An outline without pieces is a point.
    Ridges,
}

impl DrawingKind {
    /// The noun for this kind in messages.
    #[doc(hidden)]
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            DrawingKind::Lines => "line",
            DrawingKind::Areas => "area",
            DrawingKind::Ridges => "ridge",
        }
    }

    /// The other kind.
    #[doc(hidden)]
    #[must_use]
    pub fn other(self) -> DrawingKind {
        match self {
            DrawingKind::Lines => DrawingKind::Areas,
            DrawingKind::Areas => DrawingKind::Lines,
            DrawingKind::Ridges => DrawingKind::Areas,
        }
    }

    /// The name of the op that reads this kind.
    #[doc(hidden)]
    #[must_use]
    pub fn op(self) -> &'static str {
        match self {
            DrawingKind::Lines => "path",
            DrawingKind::Areas => "polygon",
            DrawingKind::Ridges => "continents",
        }
    }
}

/// The outlines that a reader finds.
#[doc(hidden)]
pub struct Collector {
    kind: DrawingKind,
    /// The outlines of the requested kind.
    pub outlines: Vec<Outline>,
    /// Number of outlines of the other kind.
    pub others: usize,
    /// The height of the feature that is being read, by its properties, in metres. Ridges have it whose points have no
    /// heights.
    pub height: Option<f64>,
    points: usize,
}

impl Collector {
    /// A collector for outlines of one kind.
    #[must_use]
    pub fn new(kind: DrawingKind) -> Collector {
        Collector { kind, outlines: Vec::new(), others: 0, height: None, points: 0 }
    }

    /// The kind of outlines that is requested.
    #[must_use]
    pub fn kind(&self) -> DrawingKind {
        self.kind
    }

    /// Adds the outlines of an element that can be used as any of `kinds`.
    pub fn take(&mut self, kinds: &[DrawingKind], outlines: Vec<Outline>) -> Result<(), String> {
        let is_ridge = self.kind == DrawingKind::Ridges;
        let kind = if is_ridge { DrawingKind::Lines } else { self.kind };
        if !kinds.iter().any(|usable| [kind, self.kind].contains(usable)) {
            self.others += outlines.len();
            return Ok(());
        }
        for mut outline in outlines {
            self.points += 1 + outline.pieces.len();
            if self.points > MAX_POINTS {
                return Err(format!("it has more than {MAX_POINTS} points; simplify its lines, or split it"));
            }
            if is_ridge && !has_heights(&outline) {
                let Some(height) = self.height else { return Err(NO_HEIGHT.into()) };
                raise(&mut outline, height);
            }
            let is_valid = |numbers: &[f64]| numbers.iter().all(|number| number.abs() <= MAX_COORDINATE);
            let is_sound = is_valid(&outline.start)
                && outline.pieces.iter().all(|piece| match piece {
                    Piece::Straight(end) => is_valid(end),
                    Piece::Curve(control, end) => control.iter().all(|point| is_valid(point)) && is_valid(end),
                });
            if !is_sound {
                return Err(format!(
                    "it has a coordinate that is not a number from -{MAX_COORDINATE:e} to {MAX_COORDINATE:e}"
                ));
            }
            outline.closed |= self.kind == DrawingKind::Areas;
            // A single point is neither a line nor an area.
            if is_ridge || !outline.pieces.is_empty() {
                self.outlines.push(outline);
            }
        }
        Ok(())
    }
}

/// What is wrong with a ridge whose height is not known.
const NO_HEIGHT: &str = "a ridge or summit has no height; give its points a third coordinate (Z) in metres, or the \
                         feature a number `height` or `elevation` (in SVG `data-height`)";

/// Names of properties with the height of a feature, in the order in which they are used.
const HEIGHTS: [&str; 3] = ["height", "elevation", "ele"];

/// The place of a property among those with the height of a feature; a smaller one comes first.
#[doc(hidden)]
#[must_use]
pub fn height_rank(name: &str) -> Option<usize> {
    HEIGHTS.iter().position(|known| name.eq_ignore_ascii_case(known))
}

fn has_heights(outline: &Outline) -> bool {
    outline.start[2] != 0.0 || outline.pieces.iter().any(|piece| piece.end()[2] != 0.0)
}

fn raise(outline: &mut Outline, height: f64) {
    outline.start[2] = height;
    for piece in &mut outline.pieces {
        let (Piece::Straight(end) | Piece::Curve(_, end)) = piece;
        end[2] = height;
    }
}

/// A hash of all properties of outlines.
#[doc(hidden)]
#[must_use]
pub fn hash(outlines: &[Outline]) -> [u8; 32] {
    let mut hash = Sha256::new();
    let mut put = |tag: u8, numbers: &[f64]| {
        hash.update([tag]);
        numbers.iter().for_each(|number| hash.update(number.to_bits().to_le_bytes()));
    };
    for outline in outlines {
        put(u8::from(outline.closed), &outline.start);
        for piece in &outline.pieces {
            match piece {
                Piece::Straight(end) => put(2, end),
                Piece::Curve([b, c], end) => {
                    put(3, b);
                    put(4, c);
                    put(5, end);
                }
            }
        }
    }
    hash.finalize().into()
}
