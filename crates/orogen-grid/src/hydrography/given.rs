//! Water from known drainage: receivers, drainage areas and standing water are given by the caller, not computed from
//! the heights. Water that enters the grid from outside is included.

use crate::checks::now_and_then;
use crate::error::{Error, ErrorKind, Result};
use crate::grid::{Grid, Window};
use crate::hydrology::accumulation::{Accumulation, accumulate_with};
use crate::hydrology::direction::{NONE, STEPS};
use crate::hydrology::lakes::Lake;
use crate::hydrology::receivers::Receivers;
use crate::hydrology::rivers::Streams;
use crate::multiscale::level::{LAKE, direction};
use crate::progress::Progress;

use super::network::{AT_SEA, Network};
use super::water::{Cover, Least, Water};

/// Known drainage. All grids have the same window.
#[derive(Debug, Clone)]
pub struct GivenWater {
    /// Heights of the samples, in metres.
    pub heights: Grid,
    /// Height of the surface of standing water at the samples, in metres; NaN where there is none, and in the sea.
    pub standing: Grid,
    /// The nodes of the network, one per sample.
    pub nodes: Nodes,
}

/// Nodes of a given network, one per sample.
#[derive(Debug, Clone)]
pub struct Nodes {
    /// Height of each node in metres: the ground, or the surface of standing water.
    pub height: Grid,
    /// Drainage area of each node in m^2.
    pub flow: Grid,
    /// Code of the direction of each node's receiver; 8 in standing water. Nodes in a lake with an outlet also have
    /// receivers. If nodes are not at their samples, 16 is added to the codes of these nodes.
    pub receiver: Grid,
    /// Columns and rows from the sample to its node; `None` if nodes are at their samples.
    pub offset: Option<[Grid; 2]>,
}

/// Maximum difference between two water levels of one lake, in metres: more than rounding errors, less than a step
/// between lakes.
const ONE_LEVEL: f32 = 0.05;

/// Positions are integer multiples of this part of a cell. Their sums are exact, so they are the same in every window.
const PARTS: f64 = (1 << 20) as f64;

/// Rounds a coordinate in columns or rows to 2^-20 of a cell.
#[must_use]
pub fn snapped(coordinate: f64) -> f64 {
    (coordinate * PARTS).round() / PARTS
}

impl Water {
    /// The water of known drainage. Rivers begin where the drainage area reaches that of `least.spring` samples and
    /// continue to standing water or the border. A reach that receives water from outside the grid has order 0, which
    /// means unknown. Lakes are connected samples of standing water with one level. Lakes of fewer than `least.lake`
    /// samples are [small](Water::is_small).
    ///
    /// # Errors
    /// If the grids do not have the same window, or the work was cancelled.
    pub fn given(given: GivenWater, sea_level: Option<f32>, least: Least, progress: &Progress) -> Result<Water> {
        let GivenWater { heights, standing, nodes } = given;
        let Nodes { height: mut bed, flow, receiver, mut offset } = nodes;
        let window = *heights.window();
        let grids = [&standing, &bed, &flow, &receiver].into_iter().chain(offset.iter().flatten());
        if grids.into_iter().any(|grid| *grid.window() != window) {
            return Err(Error::new(ErrorKind::Internal, "the grids of given water must have the same window"));
        }
        for grid in offset.iter_mut().flatten() {
            grid.data_mut().iter_mut().for_each(|offset| *offset = snapped(f64::from(*offset)) as f32);
        }
        let (labels, lakes) = lakes_of(&heights, &standing, sea_level, progress)?;
        drop(standing);
        let in_lake: Vec<bool> = receiver.data().iter().map(|code| *code >= f32::from(LAKE)).collect();
        let mut receivers = inside(&receiver);
        drop(receiver);
        // Rivers have no courses in the sea and beyond it.
        let sea = at_sea(&heights, &bed, offset.as_ref(), &receivers, sea_level);
        let drowned = match sea_level {
            Some(level) => {
                // The bed of a river may be lower than the sea, but its water is not.
                let beds = bed.data_mut().iter_mut().zip(&sea);
                beds.filter(|(_, at_sea)| !**at_sea).for_each(|(bed, _)| *bed = bed.max(level));
                beyond(&receivers, &sea, progress)?
            }
            None => vec![false; window.len()],
        };
        // Another river may join beyond the sea and continues.
        let codes = receivers.codes_mut().iter_mut().zip(&sea);
        codes.filter(|(_, at_sea)| **at_sea).for_each(|(code, _)| *code = NONE);
        let drained = accumulate_with(&receivers, &progress.part(0.0))?;
        // A cycle has no first node, so its nodes and the nodes below it are not visited. Levels have no cycles, but a
        // recipe may introduce one.
        let mut visited = vec![false; window.len()];
        drained.upstream_first().for_each(|node| visited[node] = true);
        let lost = receivers.codes_mut().iter_mut().zip(&visited);
        lost.filter(|(_, visited)| !**visited).for_each(|(code, _)| *code = NONE);
        drop(visited);
        let cell_area = window.cell * window.cell;
        let spring = (f64::from(least.spring.max(1)) * cell_area) as f32;
        let is_large = |node: usize| flow.data()[node] >= spring && !drowned[node];
        let river = orders(&receivers, &drained, is_large, &mut bed, progress)?;
        drop((drained, drowned));
        let mut streams = Streams::default();
        for (node, order) in river.iter().enumerate().filter(|(_, order)| order.is_river) {
            let known = if order.is_unknown { 0 } else { order.order };
            streams.push(node as u32, receivers.of(node) as u32, known);
        }
        drop(river);
        let reaches = streams.network();
        progress.check()?;
        let covers = offset.is_some().then(|| covers_of(&receivers, &in_lake, &sea, &labels));
        let mut water = Water {
            heights,
            surface: bed,
            receivers,
            area: Grid::filled(Window::new(0, 0, window.cell), 0),
            labels,
            lakes,
            reaches,
            sea_level,
            network: Some(Network { flow, offset, covers }),
            small: Vec::new(),
        };
        water.small = water.small_lakes(least.lake);
        Ok(water)
    }

    /// Whether each lake is too small to be shown: it has fewer than `fewest` samples, no river ends in it, and it does
    /// not reach the border.
    fn small_lakes(&self, fewest: u32) -> Vec<bool> {
        let mut small: Vec<bool> = self.lakes.iter().map(|lake| lake.cells < fewest).collect();
        let mut keep = |label: u32| {
            if let Some(small) = label.checked_sub(1).and_then(|k| small.get_mut(k as usize)) {
                *small = false;
            }
        };
        for reach in &self.reaches {
            if let Some(Cover::Lake(lake)) = reach.cells.last().map(|node| self.node_cover(*node as usize)) {
                keep(lake);
            }
        }
        let window = self.heights.window();
        (0..window.len())
            .filter(|sample| is_border(window, *sample))
            .for_each(|sample| keep(self.labels.data()[sample]));
        small
    }
}

/// The state of a node while orders are computed.
#[derive(Clone, Copy, Default)]
struct Stream {
    order: u8,
    /// Whether at least two inflows have the highest order so far.
    met: bool,
    is_river: bool,
    is_unknown: bool,
}

/// Finds the rivers that begin at nodes with a large drainage area, and their orders. Lowers beds so that they do not
/// rise along rivers.
fn orders(
    receivers: &Receivers,
    drained: &Accumulation,
    is_large: impl Fn(usize) -> bool,
    bed: &mut Grid,
    progress: &Progress,
) -> Result<Vec<Stream>> {
    let window = *bed.window();
    let mut river = vec![Stream::default(); window.len()];
    for (k, node) in drained.upstream_first().enumerate() {
        now_and_then(k, &|| progress.check())?;
        let is_border = is_border(&window, node);
        let order = &mut river[node];
        // Areas that are carried down from level to level may decrease a little downstream; a river continues there.
        order.is_river |= is_large(node);
        if !order.is_river {
            continue;
        }
        order.is_unknown |= is_border;
        order.order = (order.order + u8::from(order.met)).max(1);
        let (from, to) = (*order, receivers.of(node));
        if to != node {
            let next = &mut river[to];
            next.is_river = true;
            next.is_unknown |= from.is_unknown;
            next.met = (next.met && next.order >= from.order) || next.order == from.order;
            next.order = next.order.max(from.order);
            // A bed may rise where heights are interpolated or changed by the recipe.
            let height = bed.data()[node];
            let below = &mut bed.data_mut()[to];
            *below = if receivers.code(to) == NONE { *below } else { below.min(height) };
        }
    }
    Ok(river)
}

fn is_border(window: &Window, sample: usize) -> bool {
    let (i, j) = (sample % window.width.max(1), sample / window.width.max(1));
    i == 0 || j == 0 || i + 1 == window.width || j + 1 == window.height
}

/// Number of consecutive nodes along the course that must be in the sea where a river ends in a narrow bay. It is less
/// than the number of samples beyond a window.
const COURSE: usize = 16;

/// Number of samples on each side of a node, and number of these that must be in the sea where it is wide.
const WIDE: (usize, usize) = (2, 15);

/// Whether each node is in the sea: the ground between the samples is not above sea level, and either the sea is wide
/// there or the course continues in it. The height alone is not sufficient, because a bed on a plain may be lower than
/// the sea far inland, and the land around a valley of a coarser level may have drowned.
fn at_sea(
    heights: &Grid,
    bed: &Grid,
    offset: Option<&[Grid; 2]>,
    receivers: &Receivers,
    sea_level: Option<f32>,
) -> Vec<bool> {
    let Some(sea) = sea_level else { return vec![false; bed.data().len()] };
    let (width, height) = (heights.width(), heights.height());
    let is_drowned = |k: usize| {
        let (i, j) = (k % width, k / width);
        let [east, south] = offset.map_or([0.0; 2], |offset| [offset[0].data()[k], offset[1].data()[k]]);
        let sample = |i: usize, j: usize| heights[(i.min(width - 1), j.min(height - 1))];
        let row = |j: usize| sample(i, j) * (1.0 - east) + sample(i + 1, j) * east;
        let ground = row(j) * (1.0 - south) + row(j + 1) * south;
        // Standing water of the network whose shore the samples show is the sea, even if the recipe raises its level.
        let touches = || [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)].into_iter().any(|(i, j)| sample(i, j) <= sea);
        ground <= sea || receivers.code(k) == NONE && (bed.data()[k] <= sea || touches())
    };
    let drowned: Vec<bool> = (0..bed.data().len()).map(is_drowned).collect();
    let is_wide = |k: usize| {
        let near = |at: usize, count: usize| at.saturating_sub(WIDE.0)..(at + WIDE.0 + 1).min(count);
        let rows = near(k / width, height);
        let low = rows.map(|j| near(k % width, width).filter(|i| heights[(*i, j)] <= sea).count());
        low.sum::<usize>() >= WIDE.1
    };
    let goes_on = |k: usize| {
        let course = std::iter::successors(Some(k), |at| Some(receivers.of(*at)));
        course.take(COURSE).all(|at| drowned[at])
    };
    let is_at_sea = |k: usize| drowned[k] && (goes_on(k) || is_wide(k));
    (0..drowned.len()).map(is_at_sea).collect()
}

/// Whether each node is in the sea or receives water that has been in the sea.
fn beyond(receivers: &Receivers, sea: &[bool], progress: &Progress) -> Result<Vec<bool>> {
    let mut beyond = sea.to_vec();
    for node in accumulate_with(receivers, &progress.part(0.0))?.upstream_first() {
        beyond[receivers.of(node)] |= beyond[node];
    }
    Ok(beyond)
}

/// The receivers that lead to nodes inside the grid.
fn inside(codes: &Grid) -> Receivers {
    let window = *codes.window();
    let mut receivers = Receivers::none(window);
    let out = receivers.codes_mut();
    for (k, code) in codes.data().iter().enumerate() {
        let code = if *code >= 0.0 { direction(*code as u8) } else { NONE };
        let Some((east, south)) = STEPS.get(usize::from(code)) else { continue };
        let (i, j) = (k % window.width, k / window.width);
        let there = |at: usize, step: isize, count: usize| at.checked_add_signed(step).is_some_and(|at| at < count);
        if there(i, *east, window.width) && there(j, *south, window.height) {
            out[k] = code;
        }
    }
    receivers
}

/// Connected samples of standing water above the sea with one level, numbered from 1 in row order.
fn lakes_of(
    heights: &Grid,
    standing: &Grid,
    sea_level: Option<f32>,
    progress: &Progress,
) -> Result<(Grid<u32>, Vec<Lake>)> {
    let window = *heights.window();
    let mut labels = Grid::filled(window, 0u32);
    let mut lakes: Vec<Lake> = Vec::new();
    let is_wet = |k: usize| {
        let (height, level) = (heights.data()[k], standing.data()[k]);
        level.is_finite() && height.is_finite() && sea_level.is_none_or(|sea| level > sea)
    };
    let mut waiting: Vec<usize> = Vec::new();
    for start in 0..window.len() {
        now_and_then(start, &|| progress.check())?;
        if labels.data()[start] > 0 || !is_wet(start) {
            continue;
        }
        let label = lakes.len() as u32 + 1;
        labels.data_mut()[start] = label;
        waiting.push(start);
        let mut lake = Lake::at(standing.data()[start], start as u32);
        while let Some(at) = waiting.pop() {
            let level = standing.data()[at];
            lake.cells += 1;
            lake.level = lake.level.max(level);
            let deeper = (heights.data()[at], at) < (heights.data()[lake.deepest as usize], lake.deepest as usize);
            lake.deepest = if deeper { at as u32 } else { lake.deepest };
            let (i, j) = (at % window.width, at / window.width);
            for (east, south) in STEPS {
                let (Some(x), Some(y)) = (i.checked_add_signed(east), j.checked_add_signed(south)) else { continue };
                let near = y * window.width + x;
                if x < window.width && y < window.height && labels.data()[near] == 0 && is_wet(near) {
                    let other = standing.data()[near];
                    if (other - level).abs() <= ONE_LEVEL {
                        labels.data_mut()[near] = label;
                        waiting.push(near);
                    }
                }
            }
        }
        lake.outlet = lake.deepest;
        lakes.push(lake);
    }
    Ok((labels, lakes))
}

/// The standing water of each node: the sea, a nearby lake, or 0 on land. A lake without an outlet that no sample shows
/// has the number [`AT_SEA`] - 1.
fn covers_of(receivers: &Receivers, in_lake: &[bool], sea: &[bool], labels: &Grid<u32>) -> Grid<u32> {
    let window = *labels.window();
    let unseen = AT_SEA - 1;
    let mut covers = Grid::filled(window, 0u32);
    for (k, &in_lake) in in_lake.iter().enumerate() {
        let (i, j) = (k % window.width, k / window.width);
        if sea[k] {
            covers.data_mut()[k] = AT_SEA;
        } else if (in_lake || receivers.code(k) == NONE) && !is_border(&window, k) {
            // The corners of the node's cell first, then the samples around them.
            let near = |reach: usize| {
                let rows = j.saturating_sub(reach)..(j + 2 + reach).min(window.height);
                let columns = i.saturating_sub(reach)..(i + 2 + reach).min(window.width);
                rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
                    .map(|at| labels[at])
                    .find(|label| *label > 0)
            };
            // A river continues through a lake with an outlet that no sample shows.
            let hidden = if in_lake { 0 } else { unseen };
            covers.data_mut()[k] = near(0).or_else(|| near(1)).unwrap_or(hidden);
        }
    }
    covers
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydrography::clip::Rectangle;
    use crate::hydrography::rivers::{Mouth, Source, rivers_within};
    use crate::hydrography::shores::Shores;
    use crate::hydrography::water::Frame;

    /// A slope to the east with a river in row 4 that enters from the west, a river that joins it from the north in
    /// column 5, and a lake from column 15 on.
    fn given(width: usize) -> GivenWater {
        let window = Window::new(width, 9, 10.0);
        let grid = |value: &dyn Fn(usize, usize) -> f32| {
            Grid::from_data(window, (0..window.len()).map(|k| value(k % width, k / width)).collect()).unwrap()
        };
        let is_wet = |i: usize| i >= 15;
        let level = 200.0 - 15.0;
        let ground = |i: usize, j: usize| 200.0 - i as f32 + j.abs_diff(4) as f32 - if is_wet(i) { 10.0 } else { 0.0 };
        let heights = grid(&ground);
        let standing = grid(&|i, _| if is_wet(i) { level } else { f32::NAN });
        let nodes = Nodes {
            height: grid(&|i, j| if is_wet(i) { level } else { ground(i, j) }),
            flow: grid(&|i, j| match (i, j) {
                (_, 4) => 1e6 + 100.0 * i as f32,
                (5, 0..4) => 5000.0,
                _ => 100.0,
            }),
            receiver: grid(&|i, j| match (i, j) {
                (15.., _) => 8.0,
                (5, 0..4) => 2.0,
                _ => 0.0,
            }),
            offset: None,
        };
        GivenWater { heights, standing, nodes }
    }

    #[test]
    fn a_river_ends_in_the_sea_and_does_not_rise_again_on_an_island() {
        let mut land = given(20);
        // A channel of the sea with an island, which the valley crosses.
        for j in 0..9 {
            land.heights.row_mut(j)[6..15].fill(-5.0);
            land.nodes.height.row_mut(j)[6..15].fill(if j == 4 { 3.0 } else { -5.0 });
        }
        land.heights.row_mut(4)[9..12].fill(8.0);
        land.nodes.offset = Some([0, 1].map(|_| Grid::filled(*land.heights.window(), 0.5)));
        let water = Water::given(land, Some(0.0), Least::new(20, 1000), &Progress::none()).unwrap();
        let frame = Frame { columns: 2..18, rows: 1..8 };
        let rectangle = Rectangle { sides: [1.5, 0.5, 17.5, 7.5] };
        let mut shores = Shores::of(&water, &Frame::whole(&water), 1).unwrap();
        let rivers = rivers_within(&water, &frame, &rectangle, 3, &mut shores);
        assert!(rivers.iter().any(|river| river.mouth == Mouth::Sea));
        for river in &rivers {
            assert!(river.points.iter().all(|point| point[0] < 8.0 || point[0] > 14.0), "{:?}", river.points);
        }
    }

    #[test]
    fn rivers_begin_outside_and_lakes_go_on_outside() {
        let water = Water::given(given(20), Some(0.0), Least::new(20, 1000), &Progress::none()).unwrap();
        let frame = Frame { columns: 2..18, rows: 1..8 };
        let rectangle = Rectangle { sides: [1.5, 0.5, 17.5, 7.5] };
        let mut shores = Shores::of(&water, &Frame::whole(&water), 1).unwrap();
        let rivers = rivers_within(&water, &frame, &rectangle, 3, &mut shores);
        let areas = shores.areas_within(&water, &rectangle);
        // A lake with few samples that reaches the border is not small.
        assert_eq!((water.lakes.len(), areas.len(), water.is_small(1)), (1, 1, false));
        assert_eq!((water.lakes[0].level, water.lakes[0].cells), (185.0, 45));
        assert_eq!(rivers.len(), 3);
        let (main, north, last) = (&rivers[1], &rivers[0], &rivers[2]);
        assert_eq!((main.source, north.source, last.source), (Source::Border, Source::Border, Source::Land));
        assert_eq!((main.points[0], north.points[0][1]), ([1.5, 4.0, 198.5], 0.5));
        assert_eq!((main.mouth, last.mouth, last.downstream), (Mouth::Reach(2), Mouth::Lake(1), None));
        // Both come from outside, so neither order is known.
        assert!(rivers.iter().all(|river| river.order == 0));
        assert_eq!(last.drained, f64::from(1e6f32 + 1400.0) / 100.0);
        let end = last.points[last.points.len() - 1];
        assert_eq!(end[2], 185.0);
        assert!(areas[0].parts[0][0].contains(&[end[0], end[1]]));
        // The lake is clipped at the side.
        assert!(areas[0].parts[0][0].iter().all(|[x, y]| *x <= 17.5 && (0.5..=7.5).contains(y)));
    }

    #[test]
    fn rivers_of_the_grid_have_orders_and_beds_do_not_rise() {
        let mut given = given(12);
        let window = *given.heights.window();
        // All water begins inside.
        for k in 0..window.len() {
            let (i, j) = (k % window.width, k / window.width);
            let is_river = j == 4 && (2..12).contains(&i) || i == 5 && (2..4).contains(&j);
            given.nodes.flow.data_mut()[k] = if is_river { 5000.0 } else { 100.0 };
        }
        // A step up, and a decreasing area.
        given.nodes.height[(8, 4)] = 260.0;
        given.nodes.flow[(9, 4)] = 1900.0;
        let water = Water::given(given, None, Least::new(20, 1), &Progress::none()).unwrap();
        let orders: Vec<u8> = water.reaches.iter().map(|reach| reach.order).collect();
        assert_eq!(orders, [1, 1, 2]);
        assert_eq!(water.reaches[2].cells.len(), 7);
        for reach in &water.reaches {
            let bed = |cell: u32| water.surface.data()[cell as usize];
            assert!(reach.cells.windows(2).all(|pair| bed(pair[1]) <= bed(pair[0])));
        }
    }

    #[test]
    fn receivers_that_lead_nowhere_are_dropped() {
        let mut given = given(12);
        // A cycle, an invalid code, and another window.
        given.nodes.receiver[(7, 4)] = 4.0;
        given.nodes.receiver[(3, 2)] = f32::NAN;
        given.nodes.receiver[(3, 3)] = 77.0;
        let water = Water::given(given.clone(), None, Least::new(20, 1), &Progress::none()).unwrap();
        assert_eq!([(7, 4), (3, 2), (3, 3)].map(|at| water.receivers.grid()[at]), [NONE; 3]);
        given.standing = Grid::filled(Window::new(3, 3, 1.0), 0.0);
        assert!(Water::given(given, None, Least::new(20, 1), &Progress::none()).is_err());
    }
}
