//! Spits and bars: sand that goes on where the shore turns away.

use super::Coast;
use super::course::{Course, End, Root, STEP, angle, turned};
use super::drift::Drift;
use super::nodes::{NONE, Nodes, cell_of};
use super::ridges::{Part, Ridges};

/// The direction of a shore is that of a chord of this length, in metres.
const CHORD: f64 = 350.0;
/// Spits begin where the shore turns away by this angle at least, in radians.
const TURN: f64 = 0.5;
/// Mean sine of the angle of the waves at which spits begin, and at which all sand moves on.
const OBLIQUE: [f64; 2] = [0.01, 0.06];
/// The drift is that of a shore of this length: sand passes small headlands and coves, in metres.
const DRIFT: f64 = 2000.0;
/// Least length of a spit, in cells and in metres.
const SHORTEST: [f64; 2] = [8.0, 250.0];
/// Mean width of the water in the lee of a spit, in cells, at least.
const LEE: f64 = 5.0;
/// Distance between the roots of spits, in metres.
const APART: f64 = 500.0;
/// The shore of a bay is as many times longer than a bar before it, at least.
const BAY: f64 = 1.5;
/// A river with a basin larger than this, in m^2, keeps an inlet open.
pub(super) const RIVER: f64 = 0.2e6;
/// Width of an inlet, in cells.
const INLET: f64 = 2.5;
/// Widths of ridges that are tried, over the narrowest.
const WIDTHS: [f64; 4] = [1.9, 1.55, 1.25, 1.0];
/// Width of a spit at its end over that at its root.
const WIDENED: f64 = 2.0;
/// Angle by which waves turn the end of a spit, in radians.
const HOOK: f64 = 1.5;
/// Places of older ends along a spit, as shares of its length.
const OLDER: [f64; 2] = [0.55, 0.8];
/// Halvings of the length for which sand suffices.
const HALVINGS: usize = 6;

/// What a spit does to the water before which it is built.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Closing {
    /// It ends in open water.
    Never,
    /// It ends before another shore.
    Strait,
    /// It is a bar before a bay, with an inlet.
    Inlet,
    /// It is a bar before a lagoon.
    Closed,
}

/// A spit that may be built.
struct Site {
    node: usize,
    /// Whether the drift goes along the line of nodes, or against it.
    forward: bool,
    root: Root,
    course: Course,
    /// Angle by which the shore turns away.
    turn: f64,
}

/// The shore with what moves along it.
pub(super) struct Drifting<'a> {
    pub(super) nodes: &'a Nodes,
    pub(super) drift: &'a Drift,
    /// Cells at which rivers end, with the areas of their basins in m^2.
    pub(super) mouths: &'a [(usize, f64)],
}

impl Drifting<'_> {
    /// Builds spits and bars of sand at the nodes, in m^3, and takes it from there.
    pub(super) fn build(&self, law: &Coast, ridges: &mut Ridges, sand: &mut [f64]) {
        let oblique = self.oblique(law);
        let mut sites = self.sites(law, ridges, &oblique);
        let most = |site: &Site| self.brought(law, site, &oblique, sand).1;
        let mut ranked: Vec<(f64, usize)> = sites.iter().enumerate().map(|(k, site)| (most(site), k)).collect();
        ranked.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let rivers = self.rivers();
        for (_, k) in ranked {
            let site = &mut sites[k];
            // Others may have been built across its course.
            site.course = self.course(law, ridges, &site.root);
            if !fits(ridges, &site.course) {
                continue;
            }
            let (shares, most) = self.brought(law, site, &oblique, sand);
            let volume = self.build_at(ridges, site, most, &rivers);
            if volume > 0.0 {
                shares.iter().for_each(|(node, share)| sand[*node] -= volume / most * share);
            }
        }
    }

    /// Area of the basins of rivers that end at each node, in m^2.
    fn rivers(&self) -> Vec<f64> {
        let mut rivers = vec![0.0f64; self.nodes.nodes.len()];
        for (cell, area) in self.mouths {
            let node = self.nodes.nearest[*cell];
            if node != NONE {
                rivers[node as usize] = rivers[node as usize].max(*area);
            }
        }
        rivers
    }

    /// The node some steps along the drift, or against it.
    fn next(&self, mut node: usize, forward: bool, steps: usize) -> usize {
        for _ in 0..steps {
            node = self.nodes.nodes[node].ends[usize::from(forward)];
        }
        node
    }

    /// Places at which spits may begin, apart from each other.
    fn sites(&self, law: &Coast, ridges: &Ridges, oblique: &[f64]) -> Vec<Site> {
        let nodes = &self.nodes.nodes;
        let mut sites: Vec<Site> = Vec::new();
        for node in 0..nodes.len() {
            for forward in [true, false] {
                sites.extend(self.site(law, ridges, oblique, node, forward));
            }
        }
        sites.sort_by(|a, b| b.turn.total_cmp(&a.turn).then(a.node.cmp(&b.node)).then(b.forward.cmp(&a.forward)));
        let mut kept: Vec<Site> = Vec::new();
        let apart = APART / ridges.window.cell;
        for site in sites {
            let near = |other: &Site| {
                let [a, b] = [site.root.at, other.root.at];
                other.forward == site.forward && libm::hypot(a[0] - b[0], a[1] - b[1]) < apart
            };
            if !kept.iter().any(near) {
                kept.push(site);
            }
        }
        kept
    }

    fn site(&self, law: &Coast, ridges: &Ridges, oblique: &[f64], node: usize, forward: bool) -> Option<Site> {
        let nodes = &self.nodes.nodes;
        let at = nodes[node].at;
        let steps = ((CHORD / nodes[node].length) as usize).max(3);
        let (before, after) = (self.next(node, !forward, steps), self.next(node, forward, steps));
        if (if forward { oblique[node] } else { -oblique[node] }) < OBLIQUE[0] {
            return None;
        }
        let half = self.next(node, !forward, steps.div_ceil(3));
        let chord = |from: usize, to: usize| direction(nodes[from].at, nodes[to].at);
        let (far, near, behind) = (chord(before, node)?, chord(half, node)?, chord(node, after)?);
        let along = direction([0.0; 2], [0, 1].map(|k| far[k] + near[k]))?;
        // Along the line the land is to the left with north up: at a negative angle.
        let side = if forward { -1.0 } else { 1.0 };
        let turn = side * angle(along, behind);
        if turn < TURN {
            return None;
        }
        let root = Root { at, along, side };
        let course = self.course(law, ridges, &root);
        fits(ridges, &course).then_some(Site { node, forward, root, course, turn })
    }

    /// The course of a spit, as far as the waves at its root move sand.
    fn course(&self, law: &Coast, ridges: &Ridges, root: &Root) -> Course {
        Course::new(ridges, &self.drift.approach, root, law.reach * ridges.strength(root.at))
    }

    /// Mean sine of the angle of the waves along the shore around each node, positive where sand moves on.
    fn oblique(&self, law: &Coast) -> Vec<f64> {
        let nodes = &self.nodes.nodes;
        let mean = |node: usize| {
            let steps = (0.5 * law.reach.min(DRIFT) / nodes[node].length) as usize;
            let (mut sum, mut count) = (self.drift.oblique[node], 1.0);
            for forward in [false, true] {
                let mut at = node;
                for _ in 0..steps {
                    at = self.next(at, forward, 1);
                    sum += self.drift.oblique[at];
                    count += 1.0;
                }
            }
            sum / count
        };
        (0..nodes.len()).map(mean).collect()
    }

    /// The sand that comes to a site within the reach, from which nodes and in all, in m^3.
    fn brought(&self, law: &Coast, site: &Site, oblique: &[f64], sand: &[f64]) -> (Vec<(usize, f64)>, f64) {
        let nodes = &self.nodes.nodes;
        let (mut shares, mut sum) = (Vec::new(), 0.0);
        let (mut at, mut part) = (site.node, 1.0f64);
        for _ in 0..=(law.reach / nodes[site.node].length) as usize {
            let along = if site.forward { oblique[at] } else { -oblique[at] };
            part = part.min((along / OBLIQUE[1]).clamp(0.0, 1.0));
            if part <= 0.0 {
                break;
            }
            let share = law.spits * part * sand[at];
            sum += share;
            shares.push((at, share));
            let next = self.next(at, !site.forward, 1);
            if next == at || next == site.node {
                break;
            }
            at = next;
        }
        (shares, sum)
    }

    /// Builds what the sand suffices for. Returns its volume.
    fn build_at(&self, ridges: &mut Ridges, site: &Site, most: f64, rivers: &[f64]) -> f64 {
        let cell = ridges.window.cell;
        let shortest = (SHORTEST[0].max(SHORTEST[1] / cell) / STEP) as usize;
        let end = match site.course.end {
            End::Land(land) => match self.bay(site, land, rivers, cell) {
                Some(river) if river < RIVER => Closing::Closed,
                Some(_) => Closing::Inlet,
                None => Closing::Strait,
            },
            End::Open => Closing::Never,
        };
        let mut length = 0;
        for width in WIDTHS {
            let half = width * ridges.narrowest();
            // From the last point to the land, and the room of an inlet.
            let room = ((half / cell + INLET) / STEP) as usize;
            let room = match end {
                Closing::Inlet => room,
                // Between islands the sea stays open.
                Closing::Strait => 2 * room,
                _ => 0,
            };
            length = site.course.points.len().saturating_sub(room);
            if length <= shortest {
                continue;
            }
            match end {
                Closing::Closed | Closing::Inlet => lay_bar(ridges, site, length, half, end == Closing::Closed),
                _ => lay_spit(ridges, site, length, half),
            }
            if ridges.volume() <= most {
                return ridges.keep();
            }
            ridges.undo();
        }
        if length <= shortest {
            return 0.0;
        }
        let half = ridges.narrowest();
        let (mut low, mut high) = (shortest, length);
        for _ in 0..HALVINGS {
            let middle = (low + high) / 2;
            lay_spit(ridges, site, middle, half);
            if ridges.volume() <= most {
                low = middle
            } else {
                high = middle
            }
            ridges.undo();
        }
        lay_spit(ridges, site, low, half);
        if ridges.volume() > most {
            ridges.undo();
        }
        ridges.keep()
    }

    /// The largest basin of the rivers in the bay between a site and a cell at its other side; nothing if the cell is
    /// not on the same shore.
    fn bay(&self, site: &Site, land: usize, rivers: &[f64], cell: f64) -> Option<f64> {
        let nodes = &self.nodes.nodes;
        let other = self.nodes.nearest[land];
        let other = (other != NONE).then_some(other as usize)?;
        if nodes[other].first != nodes[site.node].first {
            return None;
        }
        let (mut at, mut steps, mut river) = (site.node, 0.0, 0.0f64);
        while at != other {
            river = river.max(rivers[at]);
            let next = self.next(at, site.forward, 1);
            if next == at || next == site.node {
                return None;
            }
            at = next;
            steps += 1.0;
        }
        let length = nodes[site.node].length;
        let [x, y] = [0, 1].map(|k| nodes[other].at[k] - nodes[site.node].at[k]);
        let straight = libm::hypot(x, y) * cell;
        (steps * length >= BAY * straight).then_some(river)
    }
}

/// Whether there is water for a spit along a course.
fn fits(ridges: &Ridges, course: &Course) -> bool {
    course.length() >= SHORTEST[0].max(SHORTEST[1] / ridges.window.cell) && course.lee >= LEE
}

/// The unit vector from one position to another.
fn direction(from: [f64; 2], to: [f64; 2]) -> Option<[f64; 2]> {
    let [x, y] = [0, 1].map(|k| to[k] - from[k]);
    let length = libm::hypot(x, y);
    (length > 1e-9).then(|| [x / length, y / length])
}

/// Lays a spit over the first points of a course: narrow at its root, wider at its end, which is recurved, with older
/// ends in its lee.
fn lay_spit(ridges: &mut Ridges, site: &Site, count: usize, half: f64) {
    let side = site.root.side;
    let width = |k: usize| {
        let share = k as f64 / count as f64;
        half * (1.0 + (WIDENED - 1.0) * share * share)
    };
    let points = &site.course.points;
    for (k, (at, along)) in points[..count].iter().enumerate().step_by(2) {
        let lee = turned(*along, side * std::f64::consts::FRAC_PI_2);
        ridges.add(Part { at: *at, lee, half: width(k) });
    }
    let (at, along) = points[count - 1];
    hook(ridges, at, along, side, width(count), HOOK);
    for share in OLDER {
        let k = (share * count as f64) as usize;
        let (at, along) = points[k];
        if k as f64 * STEP > 8.0 {
            hook(ridges, at, turned(along, 0.5 * side), side, 0.8 * width(k), 0.7 * HOOK);
        }
    }
}

/// Lays the recurved end of a spit.
fn hook(ridges: &mut Ridges, mut at: [f64; 2], mut along: [f64; 2], side: f64, half: f64, angle: f64) {
    let cell = ridges.window.cell;
    let radius = (2.2 * half / cell).max(2.5);
    let steps = (angle * radius / STEP) as usize;
    for k in 0..steps {
        along = turned(along, side * STEP / radius);
        at = [0, 1].map(|axis| at[axis] + STEP * along[axis]);
        let ahead = [0, 1].map(|axis| at[axis] + (half / cell + 2.0) * along[axis]);
        if [at, ahead].into_iter().any(|at| ridges.is_firm(cell_of(ridges.window, at))) {
            break;
        }
        let lee = turned(along, side * std::f64::consts::FRAC_PI_2);
        ridges.add(Part { at, lee, half: half * (1.0 - 0.5 * k as f64 / steps as f64) });
    }
}

/// Lays a bar over the first points of a course; a closed one goes on to the land.
fn lay_bar(ridges: &mut Ridges, site: &Site, count: usize, half: f64, closed: bool) {
    let points = &site.course.points;
    let side = site.root.side;
    for (k, (at, along)) in points[..count].iter().enumerate().step_by(2) {
        let share = 2.0 * k as f64 / count as f64 - 1.0;
        let lee = turned(*along, side * std::f64::consts::FRAC_PI_2);
        ridges.add(Part { at: *at, lee, half: half * (1.1 + 0.5 * share * share) });
    }
    let (at, along) = points[count - 1];
    if closed {
        let lee = turned(along, side * std::f64::consts::FRAC_PI_2);
        for k in 1..=(2.0 * half / ridges.window.cell / STEP) as usize + 4 {
            let at = [0, 1].map(|axis| at[axis] + STEP * k as f64 * along[axis]);
            ridges.add(Part { at, lee, half: 1.6 * half });
        }
    } else {
        hook(ridges, at, along, side, half, 0.6);
    }
}
