//! The ground of a floodplain: the channel, oxbow lakes, scroll bars and levees.

use super::{History, Meanders, Oxbow, smoothstep};
use crate::polylines::outline::Outline;
use crate::polylines::segments::{Nearest, Segments};

/// Width of the soft edge of the channel, in widths.
const EDGE: f64 = 0.1;

/// Height of natural levees and of scroll bars, in depths, and the width in which levees fall by a factor of e, in
/// widths.
const LEVEE: f64 = 0.15;
const SCROLL: f64 = 0.25;
const LEVEE_WIDTH: f64 = 1.5;

/// Where levees end, in these widths.
const LEVEE_END: f64 = 5.0;

/// Widths of nominal movement from one scroll bar to the next, and the distance between scroll bars, in widths, from
/// which they are as high as they get.
const SCROLL_TIME: f64 = 7.0;
const SCROLL_SPACING: f64 = 0.5;

/// Share of an oxbow that is filled at once, and the widths of nominal movement until it is filled.
const FILLED: f64 = 0.2;
const FILL_TIME: f64 = 150.0;

/// Widths of nominal movement in which scroll bars fall by a factor of e.
const SCROLL_FALL: f64 = 250.0;

/// Widths of nominal movement after which the ground that the river left is not at its inner bank any more.
const YOUNG: f64 = 30.0;

/// Width of an oxbow, in those of the channel.
const OXBOW_WIDTH: f64 = 0.9;

/// The phase between bars of different height, in radians: an irrational share of a turn.
const FLOODS: f64 = 2.4;

/// Length of the filled ends of an oxbow, in widths.
const PLUG: f64 = 2.5;

/// The floodplain of rivers.
#[derive(Debug, Clone, PartialEq)]
pub struct Floodplain {
    river: Meanders,
    /// The present rivers.
    channel: Segments,
    /// The rivers at equal times, from the first to the present ones.
    courses: Vec<Segments>,
    /// The oxbows that are not filled.
    oxbows: Vec<OxbowLake>,
}

/// An oxbow with water.
#[derive(Debug, Clone, PartialEq)]
struct OxbowLake {
    line: Segments,
    /// When it was cut off, as an index of courses.
    time: f64,
    /// The share that is filled.
    filled: f64,
}

impl OxbowLake {
    /// The share of water at a position, and the depth of the bed, in depths of the channel.
    fn at(&self, at: [f64; 2], width: f64) -> (f64, f64) {
        let half = 0.5 * OXBOW_WIDTH * width;
        let Some(nearest) = self.line.nearest(at, half) else { return (0.0, 0.0) };
        let end = nearest.chainage().min(nearest.line_length() - nearest.chainage());
        let open = smoothstep(end / (PLUG * width));
        let narrow = half * open * (1.0 - self.filled).sqrt();
        if narrow <= 0.0 {
            return (0.0, 0.0);
        }
        let away = nearest.distance();
        let share = (away / narrow).min(1.0);
        let depth = (1.0 - self.filled) * open * (1.0 - share * share);
        (1.0 - smoothstep((away - narrow) / (EDGE * width) + 1.0), depth)
    }
}

/// The floodplain at a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alluvial {
    /// Height over the floodplain before, in metres: negative in the channel and in oxbows.
    pub height: f64,
    /// Share of the channel: 1 in it, 0 beside it.
    pub inside: f64,
    /// Share of the water of oxbow lakes.
    pub oxbow: f64,
    /// The time since the river was here, as a share of the whole time: 0 in the channel, 1 where it never was.
    pub age: f64,
}

impl Floodplain {
    pub(super) fn new(river: &Meanders, rivers: Vec<History>) -> Floodplain {
        let outline =
            |line: &[[f64; 2]]| Outline::of_points(&line.iter().map(|[x, y]| [*x, *y, 0.0]).collect::<Vec<_>>());
        let most = rivers.iter().map(|river| river.courses.len()).max().unwrap_or(0);
        let courses = (0..most).map(|k| {
            let lines = rivers.iter().filter_map(|river| river.courses.get(k).or(river.courses.last()));
            Segments::new(&lines.map(|line| outline(line)).collect::<Vec<_>>(), 0.0)
        });
        let courses: Vec<Segments> = courses.collect();
        let last = courses.len().saturating_sub(1).max(1) as f64;
        let lake = |oxbow: &Oxbow| {
            let filled = FILLED + (last - oxbow.time) * river.migration / last / FILL_TIME;
            let line = || Segments::new(&[outline(&oxbow.line)], 0.0);
            (filled < 1.0).then(|| OxbowLake { line: line(), time: oxbow.time, filled })
        };
        Floodplain {
            river: *river,
            channel: courses.last().cloned().unwrap_or_default(),
            oxbows: rivers.iter().flat_map(|river| &river.oxbows).filter_map(lake).collect(),
            courses,
        }
    }

    /// The present river that is nearest to a position; `None` without rivers.
    #[must_use]
    pub fn nearest(&self, at: [f64; 2]) -> Option<Nearest> {
        self.channel.nearest(at, f64::INFINITY)
    }

    /// The index of the present course.
    fn last(&self) -> f64 {
        self.courses.len().saturating_sub(1).max(1) as f64
    }

    /// The ground at a position.
    #[must_use]
    pub fn at(&self, at: [f64; 2]) -> Alluvial {
        let Meanders { width, depth, .. } = self.river;
        let half = 0.5 * width;
        let passed = self.passed(at);
        let reach = half + LEVEE_END * LEVEE_WIDTH * width;
        let away = self.channel.nearest(at, reach).map_or(reach, |nearest| nearest.distance());
        let inside = 1.0 - smoothstep((away - half) / (EDGE * width));
        let (oxbow, hollow) = self.oxbow(at, passed);
        let (scroll, young) = passed.map_or((0.0, 0.0), |passed| (self.scroll(passed), self.young(passed)));
        let fall = |away: f64| libm::exp(-away) - libm::exp(-LEVEE_END);
        // The inner bank of a bend is the last bar, without a levee.
        let levee = LEVEE * (1.0 - young) * fall((away - half).max(0.0) / (LEVEE_WIDTH * width)) / fall(0.0);
        let ground = levee + scroll * (1.0 - oxbow) * smoothstep((away - half) / half) - hollow;
        let share = (away / half).min(1.0);
        let bed = levee * share * share - (1.0 - share * share);
        Alluvial {
            height: depth * if away < half { bed } else { ground },
            inside,
            oxbow: oxbow * (1.0 - inside),
            age: passed.map_or(1.0, |passed| 1.0 - passed.time / self.last()),
        }
    }

    /// When the river was last at a position; `None` if it never was.
    fn passed(&self, at: [f64; 2]) -> Option<Passed> {
        let half = 0.5 * self.river.width;
        let found = |(k, course): (usize, &Segments)| course.nearest(at, half).map(|nearest| (k, nearest.distance()));
        let (k, before) = self.courses.iter().enumerate().rev().find_map(found)?;
        let Some(next) = self.courses.get(k + 1) else { return Some(Passed { time: k as f64, speed: 0.0 }) };
        let reach = 8.0 * half;
        let after = next.nearest(at, reach).map_or(reach, |nearest| nearest.distance());
        let speed = after - before;
        Some(Passed { time: k as f64 + ((half - before) / speed).clamp(0.0, 1.0), speed })
    }

    /// Whether the river was at a position a short time ago: 1 at an inner bank.
    fn young(&self, passed: Passed) -> f64 {
        let age = (self.last() - passed.time) * self.river.migration / self.last();
        1.0 - smoothstep(age / YOUNG)
    }

    /// The height of scroll bars, in depths.
    fn scroll(&self, passed: Passed) -> f64 {
        let Meanders { width, migration, .. } = self.river;
        let widths = migration / self.last();
        let spacing = passed.speed * SCROLL_TIME / widths;
        let bars = passed.time * widths / SCROLL_TIME;
        // Where the river jumped, or hardly moved, it left no bars.
        let height = smoothstep(spacing / (SCROLL_SPACING * width) - 0.2) * smoothstep(3.0 - passed.speed / width);
        let age = (self.last() - passed.time) * widths;
        // Some floods leave higher bars than others.
        let flood = 0.7 + 0.3 * libm::cos(FLOODS * bars.round());
        SCROLL * height * flood * libm::exp(-age / SCROLL_FALL) * 0.5 * (1.0 + libm::cos(std::f64::consts::TAU * bars))
    }

    /// The share of the water of oxbows, and the depth of their beds, in depths.
    fn oxbow(&self, at: [f64; 2], passed: Option<Passed>) -> (f64, f64) {
        let (mut water, mut depth): (f64, f64) = (0.0, 0.0);
        for oxbow in &self.oxbows {
            // The river came here later, and removed it.
            if passed.is_none_or(|passed| passed.time <= oxbow.time.ceil() + 1e-6) {
                let (own, bed) = oxbow.at(at, self.river.width);
                (water, depth) = (water.max(own), depth.max(bed));
            }
        }
        (water, depth)
    }
}

/// When the river was last at a position.
#[derive(Clone, Copy)]
struct Passed {
    /// The time, as an index of courses.
    time: f64,
    /// How far it moved away from one course to the next.
    speed: f64,
}
