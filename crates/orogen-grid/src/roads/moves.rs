//! The moves from a node of the lattice to others, and the cost of turns between them.

/// Maximum columns and rows of a move.
const REACH: i32 = 5;
/// Half of the moves: the others are their opposites.
pub(super) const HALF: usize = 40;
/// All moves: columns and rows without a common divisor.
pub(super) const COUNT: usize = 2 * HALF;
/// Sectors of directions: a state of the search is a node and the sector of the direction from which it is reached.
pub(super) const SECTORS: usize = 8;
/// Largest turn at a node, in radians.
const SHARPEST: f64 = 1.8;
/// Limit of the ratio of the radius to that of a turn.
const TIGHTEST: f64 = 2.0;

/// The moves, and the cost of each turn.
pub(super) struct MoveSet {
    /// Columns and rows of each move; move `m + HALF` is the opposite of `m`.
    pub(super) steps: Vec<[i32; 2]>,
    /// The sector of each move.
    pub(super) sectors: Vec<u8>,
    /// The cost of each turn, from a move (rows) to another; infinite where it is too sharp.
    turns: Vec<f32>,
    spacing: f64,
    radius: f64,
}

impl MoveSet {
    pub(super) fn new(spacing: f64, radius: f64) -> MoveSet {
        let mut steps = Vec::with_capacity(COUNT);
        for row in 0..=REACH {
            for column in -REACH..=REACH {
                if (row > 0 || column > 0) && divisor(column.abs(), row) == 1 {
                    steps.push([column, row]);
                }
            }
        }
        let opposites: Vec<[i32; 2]> = steps.iter().map(|[column, row]| [-column, -row]).collect();
        steps.extend(opposites);
        let sectors = steps.iter().map(|step| sector(*step)).collect();
        let mut moves = MoveSet { steps, sectors, turns: Vec::new(), spacing, radius };
        moves.turns = (0..COUNT * COUNT)
            .map(|pair| moves.turn(moves.steps[pair / COUNT], moves.steps[pair % COUNT]) as f32)
            .collect();
        moves
    }

    /// The cost of a turn between moves.
    pub(super) fn turn_between(&self, from: usize, to: usize) -> f64 {
        f64::from(self.turns[from * COUNT + to])
    }

    /// The cost of a turn between two steps of columns and rows: the length of an arc with the radius, times the ratio
    /// of the radius to that of the turn.
    pub(super) fn turn(&self, from: [i32; 2], to: [i32; 2]) -> f64 {
        let [[a, b], [c, d]] = [from, to].map(|step| step.map(f64::from));
        let (cross, dot) = (a * d - b * c, a * c + b * d);
        let angle = libm::atan2(cross.abs(), dot);
        if angle > SHARPEST {
            return f64::INFINITY;
        }
        let shorter = (a * a + b * b).min(c * c + d * d).sqrt() * self.spacing;
        let tight = 2.0 * libm::tan(0.5 * angle) * self.radius / shorter;
        self.radius * angle * tight.min(TIGHTEST)
    }
}

fn divisor(a: i32, b: i32) -> i32 {
    if b == 0 { a } else { divisor(b, a % b) }
}

/// The sector of a direction: the nearest of the eight neighbors.
pub(super) fn sector([column, row]: [i32; 2]) -> u8 {
    // The tangent of 22.5 degrees.
    const TANGENT: f64 = std::f64::consts::SQRT_2 - 1.0;
    let [across, down] = [column, row].map(|part| f64::from(part.abs()));
    let part = |part: i32, one: f64, other: f64| if one < TANGENT * other { 0 } else { part.signum() };
    match [part(column, across, down), part(row, down, across)] {
        [1, 0] => 0,
        [1, 1] => 1,
        [0, 1] => 2,
        [-1, 1] => 3,
        [-1, 0] => 4,
        [-1, -1] => 5,
        [0, -1] => 6,
        _ => 7,
    }
}
