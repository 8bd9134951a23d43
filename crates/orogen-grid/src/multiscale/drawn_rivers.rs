//! Rivers drawn on the map, and the heights and drainage areas along them.

/// Drainage area in km^2 of a river that is `L` km long: (L / 1.27)^(1 / 0.6) (Hack 1957, in miles L = 1.4 A^0.6).
const HACK: f64 = 1.27;
const HACK_EXPONENT: f64 = 0.6;

/// Length in km above the first point of a line, so that a river has an area at its source.
const ABOVE_SOURCE: f64 = 1.0;

/// Slope of a river with a drainage area of 1 km^2 and exponent of the area, for lines without heights: that of the law
/// where uplift over erodibility is 0.4, as in low mountains.
const SLOPE: f64 = 0.1;
const CONCAVITY: f64 = 0.45;

/// Minimum slope of a drawn river.
const LEAST_SLOPE: f64 = 5e-5;

/// A river of the drawing, from its source to its mouth.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct River {
    /// Points: east, south, in metres.
    pub points: Vec<[f64; 2]>,
    /// Distance along the line to each point, in metres.
    pub chainage: Vec<f64>,
    /// Height of the bed at each point, in metres; it falls along the line.
    pub height: Vec<f64>,
    /// Tributaries: the chainage at which each joins, and the sum of their areas in km^2 up to there.
    joins: Vec<(f64, f64)>,
    pub low: [f64; 2],
    pub high: [f64; 2],
}

/// The rivers of a drawing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DrawnRivers {
    pub(super) rivers: Vec<River>,
}

impl DrawnRivers {
    /// The rivers along lines, each from its source to its mouth; points are metres east, metres south, and the height
    /// of the bed. A line that ends within `near` metres of another is its tributary. Lines without heights (all are 0)
    /// rise from their mouths by the law of slopes. Heights that rise downstream are lowered.
    #[must_use]
    pub fn new(lines: &[Vec<[f64; 3]>], near: f64) -> DrawnRivers {
        let lines: Vec<Vec<[f64; 3]>> = lines.iter().map(|line| cleaned(line)).filter(|line| line.len() > 1).collect();
        let drawn = DrawnRivers { rivers: lines.iter().map(|line| River::new(line, false, 0.0)).collect() };
        let mains: Vec<Option<usize>> = lines
            .iter()
            .enumerate()
            .map(|(own, line)| line.last().and_then(|[x, y, _]| drawn.nearest([*x, *y], Some(own))))
            .map(|found| found.filter(|(_, _, distance)| *distance <= near).map(|(main, ..)| main))
            .collect();
        // Main rivers come before their tributaries. Lines that end on each other in a circle stay in their order.
        let rank = |own: usize| {
            let (mut at, mut steps) = (own, 0);
            while let Some(main) = mains[at].filter(|_| steps < lines.len()) {
                (at, steps) = (main, steps + 1);
            }
            steps
        };
        let mut order: Vec<(usize, usize)> = (0..lines.len()).map(|own| (rank(own), own)).collect();
        order.sort_unstable();
        let mut made = DrawnRivers::default();
        for (_, own) in order {
            made.add(&lines[own], near);
        }
        made
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rivers.is_empty()
    }

    /// Memory in bytes.
    #[must_use]
    pub fn memory(&self) -> u64 {
        let bytes = |river: &River| 32 * river.points.len() + 16 * river.joins.len() + size_of::<River>();
        self.rivers.iter().map(bytes).sum::<usize>() as u64
    }

    /// Visits points of all lines, at most `step` metres apart.
    #[cfg(test)]
    pub(super) fn points(&self, step: f64, mut visit: impl FnMut([f64; 2])) {
        for river in &self.rivers {
            let steps = (river.length() / step) as usize;
            (0..=steps).for_each(|k| visit(river.place(k as f64 * step)));
        }
    }

    fn add(&mut self, line: &[[f64; 3]], near: f64) {
        let mut points = line.to_vec();
        let Some(&[x, y, _]) = points.last() else { return };
        let joined = self.nearest([x, y], None).filter(|(_, _, distance)| *distance <= near);
        let mouth = joined.map_or(0.0, |(main, chainage, _)| self.rivers[main].height_at(chainage));
        if let Some((main, chainage, distance)) = joined
            && distance > 0.0
        {
            let [x, y] = self.rivers[main].place(chainage);
            points.push([x, y, mouth]);
        }
        let has_heights = line.iter().any(|point| point[2] != 0.0);
        let river = River::new(&points, has_heights, mouth);
        if let Some((main, chainage, _)) = joined {
            let area = river.area_at(river.length());
            self.rivers[main].join(chainage, area);
        }
        self.rivers.push(river);
    }

    /// The river nearest to a position, other than `except`: its number, the chainage of the nearest point, and the
    /// distance.
    fn nearest(&self, [x, y]: [f64; 2], except: Option<usize>) -> Option<(usize, f64, f64)> {
        let mut best: Option<(usize, f64, f64)> = None;
        for (number, river) in self.rivers.iter().enumerate().filter(|(number, _)| Some(*number) != except) {
            let aside = [x, y].into_iter().enumerate();
            let least = aside.map(|(k, at)| (river.low[k] - at).max(at - river.high[k]).max(0.0)).fold(0.0, f64::max);
            if best.is_some_and(|(_, _, distance)| least >= distance) {
                continue;
            }
            for (ends, from) in river.points.windows(2).zip(&river.chainage) {
                let [dx, dy] = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
                let square = dx * dx + dy * dy;
                let share = ((x - ends[0][0]) * dx + (y - ends[0][1]) * dy) / square;
                let share = share.clamp(0.0, 1.0);
                let (off_x, off_y) = (x - ends[0][0] - share * dx, y - ends[0][1] - share * dy);
                let distance = (off_x * off_x + off_y * off_y).sqrt();
                if best.is_none_or(|(_, _, least)| distance < least) {
                    best = Some((number, from + share * square.sqrt(), distance));
                }
            }
        }
        best
    }
}

impl River {
    /// A line with its own heights.
    pub fn along(points: &[[f64; 3]]) -> River {
        let mut river = River::new(points, true, f64::NEG_INFINITY);
        river.height = points.iter().map(|point| point[2]).collect();
        river
    }

    fn new(points: &[[f64; 3]], has_heights: bool, mouth: f64) -> River {
        let mut chainage = vec![0.0];
        for ends in points.windows(2) {
            let (x, y) = (ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]);
            chainage.push(chainage.last().unwrap_or(&0.0) + (x * x + y * y).sqrt());
        }
        let side = |start: f64, pick: fn(f64, f64) -> f64| {
            [0, 1].map(|k| points.iter().map(|point| point[k]).fold(start, pick))
        };
        let (low, high) = (side(f64::INFINITY, f64::min), side(f64::NEG_INFINITY, f64::max));
        let mut river = River {
            points: points.iter().map(|[x, y, _]| [*x, *y]).collect(),
            chainage,
            height: points.iter().map(|point| point[2]).collect(),
            joins: Vec::new(),
            low,
            high,
        };
        if has_heights {
            // A bed that rises downstream is cut down to where it falls again.
            for k in 1..river.height.len() {
                river.height[k] = river.height[k].min(river.height[k - 1]);
            }
        }
        // From the mouth up: every bed is above the next one.
        let last = river.height.len() - 1;
        river.height[last] = river.height[last].max(mouth);
        for k in (0..last).rev() {
            let length = river.chainage[k + 1] - river.chainage[k];
            let middle = 0.5 * (river.chainage[k + 1] + river.chainage[k]);
            let slope = match has_heights {
                true => LEAST_SLOPE,
                false => (SLOPE * libm::pow(river.area_at(middle), -CONCAVITY)).max(LEAST_SLOPE),
            };
            river.height[k] = river.height[k].max(river.height[k + 1] + slope * length);
        }
        river
    }

    fn length(&self) -> f64 {
        self.chainage.last().copied().unwrap_or(0.0)
    }

    /// The index of the segment at a chainage, and the position on it, 0 to 1.
    fn segment(&self, chainage: f64) -> (usize, f64) {
        let k = self.chainage.partition_point(|start| *start <= chainage).clamp(1, self.chainage.len() - 1) - 1;
        let length = self.chainage[k + 1] - self.chainage[k];
        (k, if length > 0.0 { ((chainage - self.chainage[k]) / length).clamp(0.0, 1.0) } else { 0.0 })
    }

    pub fn place(&self, chainage: f64) -> [f64; 2] {
        let (k, share) = self.segment(chainage);
        [0, 1].map(|axis| self.points[k][axis] + share * (self.points[k + 1][axis] - self.points[k][axis]))
    }

    /// Height of the bed in metres.
    pub fn height_at(&self, chainage: f64) -> f64 {
        let (k, share) = self.segment(chainage);
        self.height[k] + share * (self.height[k + 1] - self.height[k])
    }

    /// Drainage area in km^2: of the river by its length, and of its tributaries.
    pub fn area_at(&self, chainage: f64) -> f64 {
        let own = libm::pow((chainage * 1e-3 + ABOVE_SOURCE) / HACK, 1.0 / HACK_EXPONENT);
        let joined = self.joins.partition_point(|(at, _)| *at <= chainage);
        own + joined.checked_sub(1).map_or(0.0, |last| self.joins[last].1)
    }

    fn join(&mut self, chainage: f64, area: f64) {
        let at = self.joins.partition_point(|(at, _)| *at <= chainage);
        let before = at.checked_sub(1).map_or(0.0, |last| self.joins[last].1);
        self.joins.insert(at, (chainage, before));
        self.joins[at..].iter_mut().for_each(|(_, sum)| *sum += area);
    }
}

/// A line without points that are not finite or the same as the point before.
pub(super) fn cleaned(line: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let mut points: Vec<[f64; 3]> = Vec::with_capacity(line.len());
    for point in line.iter().filter(|point| point.iter().all(|number| number.is_finite())) {
        if points.last().is_none_or(|last| last[..2] != point[..2]) {
            points.push(*point);
        }
    }
    points
}
