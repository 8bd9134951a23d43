//! Places joined by routes, and the lines of roads. Later roads use earlier ones and meet them.

use super::lattice::Lattice;
use super::lines::{RoadKind, RoadLine};
use super::profile::{Profile, profile};
use super::route::{Existing, Link, Search};
use super::smooth::{Control, curve};
use super::ways::Ways;
use super::{Land, Roads};
use crate::error::{Error, ErrorKind, Result};
use crate::progress::Progress;
use crate::words::number;
use std::collections::BTreeMap;

/// Distance between the points of a line, as a share of the spacing of nodes.
const STRIDE: f64 = 0.3;
/// Lines have no more points, so that they can be stored.
const MAX_POINTS: f64 = 100_000.0;

/// Where earlier roads are.
struct Network {
    existing: Existing,
    /// The point of the line at each node of a road.
    points: BTreeMap<u32, [f64; 3]>,
    /// The points of roads on the ground near each node.
    near: BTreeMap<u32, Vec<[f64; 3]>>,
}

/// Builds the roads one after the other.
pub(super) fn build(
    roads: &Roads,
    land: &Land,
    lattice: &Lattice,
    places: &[Vec<[f64; 3]>],
    progress: &Progress,
) -> Result<Vec<RoadLine>> {
    let mut network = Network { existing: Existing::default(), points: BTreeMap::new(), near: BTreeMap::new() };
    let ways = Ways::new(roads, land, lattice, &progress.part(2.0))?;
    let mut search = Search::new(roads, lattice, &ways);
    let mut routes: Vec<(usize, Vec<Control>)> = Vec::new();
    let mut ends: BTreeMap<u32, [f64; 2]> = BTreeMap::new();
    let origin = [lattice.window.east(0), lattice.window.south(0)];
    let local = |[x, y, _]: [f64; 3]| [x - origin[0], y - origin[1]];
    for (road, line) in places.iter().enumerate() {
        let mut nodes = Vec::with_capacity(line.len());
        for (k, place) in line.iter().enumerate() {
            check(land, *place, &name(road, k, places.len()))?;
            nodes.push(node_of(lattice, local(*place), *place, &name(road, k, places.len()))?);
        }
        for (k, pair) in nodes.windows(2).enumerate() {
            let part = progress.part(1.0);
            if pair[0] == pair[1] {
                part.finish();
                continue;
            }
            let Some((links, _)) = search.run([pair[0], pair[1]], &network.existing, &part)? else {
                let names = [k, k + 1].map(|k| name(road, k, places.len()));
                return Err(unreachable(&names, [line[k], line[k + 1]]));
            };
            for (node, place) in pair.iter().zip(&line[k..k + 2]) {
                if !lattice.wet[lattice.sample_at(local(*place))] {
                    ends.entry(*node as u32).or_insert(local(*place));
                }
            }
            let runs = new_runs(lattice, &network.existing, &links);
            let lines: Vec<Vec<Control>> =
                runs.into_iter().map(|run| without_loops(controls(lattice, run, &ends))).collect();
            for controls in lines {
                network.existing.add(lattice, &built(&controls));
                routes.push((road, controls));
            }
        }
    }
    drop(search);
    let length: f64 = routes.iter().map(|(_, controls)| length(controls)).sum();
    let stride = (STRIDE * lattice.spacing).max(length / MAX_POINTS);
    let part = progress.part(1.0);
    part.expect(routes.len() as f64);
    let line = |(road, controls): (usize, Vec<Control>)| {
        part.step(1.0)?;
        Ok(network.line(roads, land, lattice, road, &controls, stride))
    };
    let lines = routes.into_iter().map(line).collect();
    part.finish();
    lines
}

fn length(controls: &[Control]) -> f64 {
    controls.windows(2).map(|pair| libm::hypot(pair[1].at[0] - pair[0].at[0], pair[1].at[1] - pair[0].at[1])).sum()
}

/// A place for messages.
fn name(road: usize, place: usize, roads: usize) -> String {
    match roads {
        1 => format!("place {}", place + 1),
        _ => format!("place {} of road {}", place + 1, road + 1),
    }
}

fn refused(place: [f64; 3], name: &str, what: &str) -> Error {
    let [x, y, _] = place.map(number);
    Error::new(ErrorKind::Request, format!("`roads`: {name} ({x}, {y}) is {what}"))
}

/// Checks that a place is in the domain.
fn check(land: &Land, place: [f64; 3], name: &str) -> Result<()> {
    let domain = &land.domain;
    let last = |first: i64, count: usize| (first + count as i64 - 1) as f64 * domain.cell;
    let ends = [[domain.east(0), last(domain.x, domain.width)], [domain.south(0), last(domain.y, domain.height)]];
    if place.iter().zip(ends).all(|(at, [first, last])| (first..=last).contains(at)) {
        return Ok(());
    }
    let [[west, east], [north, south]] = ends.map(|side| side.map(number));
    let what = format!("outside of the world, which is {west} to {east} m east and {north} to {south} m south");
    Err(refused(place, name, &what))
}

/// The node of a place, which is `at` from the first sample.
fn node_of(lattice: &Lattice, at: [f64; 2], place: [f64; 3], name: &str) -> Result<usize> {
    let what = "in water or where the ground has no height; move it to dry land";
    lattice.nearest(at).ok_or_else(|| refused(place, name, what))
}

fn unreachable(names: &[String; 2], [from, to]: [[f64; 3]; 2]) -> Error {
    let [from, to] = [from, to].map(|[x, y, _]| format!("({}, {})", number(x), number(y)));
    let [one, other] = names;
    let message = format!(
        "`roads`: no road leads from {one} {from} to {other} {to}: water or missing heights are between them, wider \
         than the longest bridge; raise `longest_bridge`, or move a place"
    );
    Error::new(ErrorKind::Request, message)
}

/// The runs of links that do not exist yet.
fn new_runs<'a>(lattice: &Lattice, existing: &Existing, links: &'a [Link]) -> Vec<&'a [Link]> {
    let is_new: Vec<bool> = links.iter().map(|link| !existing.has(lattice, link)).collect();
    let mut runs = Vec::new();
    let mut first = 0;
    while first < links.len() {
        let end = (first..links.len()).find(|k| is_new[*k] != is_new[first]).unwrap_or(links.len());
        if is_new[first] {
            runs.push(&links[first..end]);
        }
        first = end;
    }
    runs
}

/// The controls of the curve along links: nodes, and places at their nodes.
fn controls(lattice: &Lattice, links: &[Link], ends: &BTreeMap<u32, [f64; 2]>) -> Vec<Control> {
    let control = |node: u32, kind: Option<RoadKind>, at: Option<[f64; 2]>| Control {
        at: at.unwrap_or_else(|| lattice.position(node as usize)),
        kind,
        node: Some(node),
    };
    let mut controls = Vec::with_capacity(links.len() + 1);
    for (k, link) in links.iter().enumerate() {
        // A bridge or a tunnel is straight from node to node.
        let place = if k == 0 && link.kind.is_none() { ends.get(&link.from).copied() } else { None };
        controls.push(control(link.from, link.kind, place));
    }
    if let Some(link) = links.last() {
        let place = if link.kind.is_none() { ends.get(&link.to).copied() } else { None };
        controls.push(control(link.to, None, place));
    }
    controls
}

/// The controls without loops: a route may turn around by crossing itself, a road has a hairpin there.
fn without_loops(mut controls: Vec<Control>) -> Vec<Control> {
    let mut first = 0;
    while first + 2 < controls.len() {
        let again = (first + 1..controls.len()).rev().find(|k| controls[*k].node == controls[first].node);
        if let Some(again) = again {
            controls.drain(first..again);
            continue;
        }
        let ends = |k: usize| [controls[k].at, controls[k + 1].at];
        let is_free = |k: usize| controls[k].kind.is_none();
        let crossing = (first + 2..controls.len() - 1)
            .rev()
            .filter(|k| is_free(first) && is_free(*k))
            .find_map(|k| Some((k, crossing(ends(first), ends(k))?)));
        if let Some((last, at)) = crossing {
            controls.splice(first + 1..last + 1, [Control { at, kind: None, node: None }]);
        }
        first += 1;
    }
    controls
}

/// The point at which two straight pieces cross.
fn crossing([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let [r, s, q] = [[a, b], [c, d], [a, c]].map(|[from, to]| [to[0] - from[0], to[1] - from[1]]);
    let cross = |u: [f64; 2], v: [f64; 2]| u[0] * v[1] - u[1] * v[0];
    let turn = cross(r, s);
    let [t, u] = [cross(q, s) / turn, cross(q, r) / turn];
    let inside = |share: f64| (0.0..=1.0).contains(&share);
    (turn != 0.0 && inside(t) && inside(u)).then(|| [a[0] + t * r[0], a[1] + t * r[1]])
}

/// The links that controls still have.
fn built(controls: &[Control]) -> Vec<Link> {
    let link = |pair: &[Control]| Some(Link { from: pair[0].node?, to: pair[1].node?, kind: pair[0].kind });
    controls.windows(2).filter_map(link).collect()
}

impl Network {
    /// The line of a route. Where it is at nodes of earlier roads, it has their heights, and it begins and ends at
    /// their lines.
    fn line(
        &mut self,
        roads: &Roads,
        land: &Land,
        lattice: &Lattice,
        road: usize,
        controls: &[Control],
        stride: f64,
    ) -> RoadLine {
        let mut controls = controls.to_vec();
        let last = controls.len().saturating_sub(1);
        for k in [0, last] {
            let met = controls.get(k).and_then(|control| control.node).and_then(|node| self.points.get(&node));
            if let Some([x, y, _]) = met {
                controls[k].at = [*x, *y];
            }
        }
        let curve = curve(lattice, &controls, stride);
        let met = curve.nodes.iter().filter_map(|(node, point)| Some((*point, self.points.get(node)?[2])));
        let mut pins: BTreeMap<usize, f64> = self.crossings(lattice, &curve.points, roads.width).into_iter().collect();
        pins.extend(met);
        let pins: Vec<(usize, f64)> = pins.into_iter().collect();
        let Profile { heights, kinds } = profile(roads, land, lattice, &curve, &pins, stride);
        let points: Vec<[f64; 3]> = curve.points.iter().zip(heights).map(|([x, y], z)| [*x, *y, z]).collect();
        for (node, point) in &curve.nodes {
            self.points.entry(*node).or_insert(points[*point]);
        }
        for (point, _) in points.iter().zip(&kinds).filter(|(_, kind)| **kind == RoadKind::Road) {
            if let Some(node) = node_near(lattice, [point[0], point[1]], [0, 0]) {
                self.near.entry(node).or_default().push(*point);
            }
        }
        RoadLine { road, points, kinds }
    }

    /// Points at which a curve crosses earlier roads on the ground, with the heights of these.
    fn crossings(&self, lattice: &Lattice, points: &[[f64; 2]], width: f64) -> Vec<(usize, f64)> {
        let mut crossings: Vec<(usize, f64)> = Vec::new();
        // The nearest point of the stretch that is near an earlier road now.
        let mut open: Option<(f64, (usize, f64))> = None;
        for (k, at) in points.iter().enumerate() {
            let around = (0..9).filter_map(|k| node_near(lattice, *at, [k % 3 - 1, k / 3 - 1]));
            let known = around.filter_map(|node| self.near.get(&node)).flatten();
            let mut nearest: Option<(f64, f64)> = None;
            for [x, y, z] in known {
                let distance = libm::hypot(x - at[0], y - at[1]);
                if distance < width && nearest.is_none_or(|(least, _)| distance < least) {
                    nearest = Some((distance, *z));
                }
            }
            match nearest {
                Some((distance, z)) if open.is_none_or(|(least, _)| distance < least) => {
                    open = Some((distance, (k, z)));
                }
                Some(_) => {}
                None => crossings.extend(open.take().map(|(_, crossing)| crossing)),
            }
        }
        crossings.extend(open.map(|(_, crossing)| crossing));
        crossings
    }
}

/// The node nearest to a position, and some columns and rows from it.
fn node_near(lattice: &Lattice, at: [f64; 2], [column, row]: [i32; 2]) -> Option<u32> {
    let [x, y] = lattice.columns(at).map(|samples| (samples / lattice.step as f64).round() as i32);
    lattice.node([x + column, y + row]).map(|node| node as u32)
}
