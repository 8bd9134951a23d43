//! Roads as lines.

/// What a road is at a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum RoadKind {
    /// A road on the ground.
    Road = 1,
    /// A bridge.
    Bridge = 2,
    /// A tunnel.
    Tunnel = 3,
}

impl RoadKind {
    /// The name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            RoadKind::Road => "road",
            RoadKind::Bridge => "bridge",
            RoadKind::Tunnel => "tunnel",
        }
    }

    fn numbered(number: f64) -> RoadKind {
        match number {
            2.0 => RoadKind::Bridge,
            3.0 => RoadKind::Tunnel,
            _ => RoadKind::Road,
        }
    }
}

/// A road, or the part of it that does not use earlier ones.
#[derive(Debug, Clone, PartialEq)]
pub struct RoadLine {
    /// Index of the list of places that it connects.
    pub road: usize,
    /// Points: metres east and south, and the height of the road.
    pub points: Vec<[f64; 3]>,
    /// What the road is from each point to the next; as many as points.
    pub kinds: Vec<RoadKind>,
}

/// Numbers of a line before those of its points, and numbers of a point.
const HEAD: usize = 2;
const POINT: usize = 4;

impl RoadLine {
    /// The lines as numbers.
    #[must_use]
    pub fn to_numbers(lines: &[RoadLine]) -> Vec<f64> {
        let mut numbers = Vec::new();
        for line in lines {
            numbers.extend([line.road as f64, line.points.len() as f64]);
            for (point, kind) in line.points.iter().zip(&line.kinds) {
                numbers.extend(point);
                numbers.push(f64::from(*kind as u8));
            }
        }
        numbers
    }

    /// The lines from [numbers](RoadLine::to_numbers).
    #[must_use]
    pub fn from_numbers(numbers: &[f64]) -> Vec<RoadLine> {
        let mut lines = Vec::new();
        let mut rest = numbers;
        while let Some(([road, count], after)) = rest.split_first_chunk::<HEAD>() {
            let count = (*count as usize).min(after.len() / POINT);
            let (own, next) = after.split_at(count * POINT);
            let points = own.chunks_exact(POINT);
            lines.push(RoadLine {
                road: *road as usize,
                points: points.clone().map(|point| [point[0], point[1], point[2]]).collect(),
                kinds: points.map(|point| RoadKind::numbered(point[3])).collect(),
            });
            rest = next;
        }
        lines
    }

    /// The stretches of one kind, each with the indices of its points: the last point of one is the first of the next.
    #[must_use]
    pub fn stretches(&self) -> Vec<(RoadKind, std::ops::Range<usize>)> {
        let mut stretches = Vec::new();
        let mut first = 0;
        while first + 1 < self.points.len() {
            let kind = self.kinds[first];
            let last = self.points.len() - 1;
            let end = (first + 1..last).find(|k| self.kinds[*k] != kind).unwrap_or(last);
            stretches.push((kind, first..end + 1));
            first = end;
        }
        stretches
    }
}
