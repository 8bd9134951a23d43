//! Drainage areas, watersheds and stream orders, tile by tile (Barnes, "Parallel non-divergent flow accumulation for
//! trillion cell digital elevation models on desktops or clusters", 2016).
//!
//! For each tile only the cells where water leaves or enters it are kept, as a graph of a few thousand cells per tile.
//! Sums are propagated through this graph, then each tile is finished separately.

use super::tiling::{Border, Queue, Tiling, border};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::accumulation::{UNIT_WEIGHT, weight};
use orogen_grid::hydrology::direction::{NONE, STEPS};
use orogen_grid::progress::Progress;
use orogen_io::raster::Raster;

/// No exit or outlet.
const NOWHERE: u32 = u32::MAX;

/// The result layers.
pub struct Layers<'a> {
    /// Drainage areas in m^2.
    pub flow: &'a mut Raster,
    /// Watersheds, numbered from 1 in row order of their outlets.
    pub watershed: &'a mut Raster,
    /// Strahler orders.
    pub strahler: &'a mut Raster,
    /// Minimum number of cells that a stream drains, weighted by rain if it is given.
    pub threshold: u64,
}

/// A cell where water leaves its tile.
#[derive(Debug, Clone, Copy)]
pub(super) struct Exit {
    /// The index of the cell in the tile.
    pub index: u32,
    /// The number of the cell of another tile that it drains to.
    pub to: u64,
    /// Number of cells that drain through it, or the sum of their weights.
    area: u64,
    /// Its watershed.
    watershed: u32,
    /// The order of the stream through it.
    order: u8,
}

/// The inflow at a cell of a tile's border.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Inflow {
    area: u64,
    order: u8,
    /// Whether two streams of the highest order flow in.
    met: bool,
}

impl Inflow {
    fn meet(&mut self, order: u8) {
        self.met = (self.met && self.order >= order) || self.order == order;
        self.order = self.order.max(order);
    }
}

/// Computes the layers from complete receivers: every cell leads to an outlet, which has the code [`NONE`]. Areas are
/// weighted by the factors of the `rain`, if they are given.
///
/// # Errors
/// If the disk fails, or the work is cancelled.
pub fn make(codes: &Raster, rain: Option<&Raster>, tiling: &Tiling, layers: Layers, progress: &Progress) -> Result<()> {
    let mut areas = Areas::new(codes, rain, tiling, progress)?;
    let unit = rain.map_or(1, |_| UNIT_WEIGHT);
    let unit_area = tiling.whole.cell * tiling.whole.cell / f64::from(unit);
    let threshold = layers.threshold * u64::from(unit);
    // Outlets with their own watershed, by row and column of tiles.
    let mut outlets = vec![0u32; tiling.whole.height * tiling.columns()];
    for t in 0..tiling.count() {
        let tile = areas.tile(t)?;
        let area = tile.areas(&areas.inflows(t));
        tile.count_outlets(&area, |row, count| outlets[areas.segment(t, row)] = count);
        layers.flow.put(&tile.grid(|c| (area[c] as f64 * unit_area) as f32))?;
    }
    let mut before = 0u32;
    for count in &mut outlets {
        before += std::mem::replace(count, before);
    }
    areas.name_outlets(&outlets)?;
    areas.order_streams(threshold)?;
    for t in 0..tiling.count() {
        let tile = areas.tile(t)?;
        let inflows = areas.inflows(t);
        let area = tile.areas(&inflows);
        let labels = tile.watersheds(&area, &areas.exits[t], |row| outlets[areas.segment(t, row)]);
        layers.watershed.put(&tile.grid(|c| labels[c] as f32))?;
        let orders = tile.orders(&area, &inflows, threshold);
        layers.strahler.put(&tile.grid(|c| f32::from(orders[c])))?;
    }
    Ok(())
}

pub(super) struct Areas<'a> {
    codes: &'a Raster,
    rain: Option<&'a Raster>,
    pub tiling: &'a Tiling,
    progress: &'a Progress,
    /// The exits of each tile.
    pub exits: Vec<Vec<Exit>>,
    /// For each tile, the end of the flow path that enters at each cell along its border.
    ends: Vec<Border<End>>,
}

/// The end of a flow path within a tile.
#[derive(Debug, Clone, Copy)]
pub(super) enum End {
    /// One of the tile's exits.
    Exit(u32),
    /// An outlet, by its index in the tile.
    Outlet(u32),
}

impl<'a> Areas<'a> {
    /// The graph, with the areas of all exits.
    pub(super) fn new(
        codes: &'a Raster,
        rain: Option<&'a Raster>,
        tiling: &'a Tiling,
        progress: &'a Progress,
    ) -> Result<Areas<'a>> {
        let mut areas = Areas { codes, rain, tiling, progress, exits: Vec::new(), ends: Vec::new() };
        for t in 0..tiling.count() {
            let tile = areas.tile(t)?;
            let (exits, ends) = tile.exits();
            areas.exits.push(exits);
            areas.ends.push(ends);
        }
        areas.pass_on();
        Ok(areas)
    }

    pub(super) fn tile(&self, t: usize) -> Result<Tile> {
        self.progress.check()?;
        self.progress.advance(1.0);
        let window = self.tiling.tile(t);
        let rain = self.rain.map(|rain| rain.get(&window)).transpose()?;
        let weights = rain.map(|rain| rain.data().iter().map(|factor| weight(*factor)).collect());
        Ok(Tile { weights, ..Tile::new(&self.codes.get(&window)?, self.tiling) })
    }

    /// The index of the first outlet in a row of a tile.
    fn segment(&self, t: usize, row: usize) -> usize {
        let top = (self.tiling.tile(t).y - self.tiling.whole.y) as usize;
        (top + row) * self.tiling.columns() + t % self.tiling.columns()
    }

    /// The exit that water from an exit reaches next.
    pub(super) fn next(&self, exit: &Exit) -> Option<(usize, usize)> {
        let (t, index) = self.tiling.locate(exit.to);
        match self.ends[t].get(index) {
            Some(End::Exit(next)) => Some((t, next as usize)),
            _ => None,
        }
    }

    /// Adds the areas of exits to those downstream.
    fn pass_on(&mut self) {
        for (t, k) in self.downstream() {
            if let Some((to, next)) = self.next(&self.exits[t][k]) {
                self.exits[to][next].area += self.exits[t][k].area;
            }
        }
    }

    /// All exits, each before those downstream.
    pub(super) fn downstream(&self) -> Vec<(usize, usize)> {
        let mut waiting: Vec<Vec<u32>> = self.exits.iter().map(|exits| vec![0; exits.len()]).collect();
        for (to, next) in self.exits.iter().flatten().filter_map(|exit| self.next(exit)) {
            waiting[to][next] += 1;
        }
        let all = (0..self.exits.len()).flat_map(|t| (0..self.exits[t].len()).map(move |k| (t, k)));
        let mut order: Vec<(usize, usize)> = all.filter(|(t, k)| waiting[*t][*k] == 0).collect();
        let mut done = 0;
        while let Some((t, k)) = order.get(done).copied() {
            done += 1;
            if let Some((to, next)) = self.next(&self.exits[t][k]) {
                waiting[to][next] -= 1;
                if waiting[to][next] == 0 {
                    order.push((to, next));
                }
            }
        }
        order
    }

    /// The inflows of a tile, by the cell's index in it.
    pub(super) fn inflows(&self, t: usize) -> Border<Inflow> {
        let mut inflows = Border::filled(&self.tiling.tile(t), Inflow::default());
        self.each_inflow(t, |index, from, k| {
            if let Some(mut inflow) = inflows.get(index) {
                let exit = &self.exits[from][k];
                inflow.area += exit.area;
                inflow.meet(exit.order);
                inflows.set(index, inflow);
            }
        });
        inflows
    }

    /// Visits each inflow of a tile: the index of its cell, the tile that it comes from, and its exit.
    pub(super) fn each_inflow(&self, t: usize, mut each: impl FnMut(usize, usize, usize)) {
        let (column, row) = (t % self.tiling.columns(), t / self.tiling.columns());
        for near in
            (row.max(1) - 1..=row + 1).flat_map(|row| (column.max(1) - 1..=column + 1).map(move |column| (row, column)))
        {
            let other = near.0 * self.tiling.columns() + near.1;
            if near.1 >= self.tiling.columns() || other >= self.exits.len() || other == t {
                continue;
            }
            for (k, exit) in self.exits[other].iter().enumerate() {
                let (to, index) = self.tiling.locate(exit.to);
                if to == t {
                    each(index, other, k);
                }
            }
        }
    }

    /// Assigns each exit the number of its watershed; `before` counts the outlets before each row of a tile.
    fn name_outlets(&mut self, before: &[u32]) -> Result<()> {
        let mut numbers: Vec<Vec<(u32, u32)>> = Vec::new();
        for t in 0..self.exits.len() {
            let tile = self.tile(t)?;
            let wanted: Vec<u32> = border(&tile.window)
                .filter_map(|index| match self.ends[t].get(index) {
                    Some(End::Outlet(outlet)) => Some(outlet),
                    _ => None,
                })
                .collect();
            let area = tile.areas(&self.inflows(t));
            numbers.push(tile.numbers(&area, wanted, |row| before[self.segment(t, row)]));
        }
        for (t, k) in self.downstream().into_iter().rev() {
            let exit = self.exits[t][k];
            let (to, index) = self.tiling.locate(exit.to);
            self.exits[t][k].watershed = match self.ends[to].get(index) {
                Some(End::Exit(next)) => self.exits[to][next as usize].watershed,
                Some(End::Outlet(outlet)) => {
                    let place = numbers[to].binary_search_by_key(&outlet, |(outlet, _)| *outlet);
                    place.map_or(0, |place| numbers[to][place].1)
                }
                None => 0,
            };
        }
        Ok(())
    }

    /// Computes the orders at the exits: tiles are processed again as long as their inflow grows.
    pub(super) fn order_streams(&mut self, threshold: u64) -> Result<()> {
        let mut queue = Queue::new(self.exits.len());
        (0..self.exits.len()).for_each(|t| queue.push(t));
        while let Some(t) = queue.pop() {
            let tile = self.tile(t)?;
            let inflows = self.inflows(t);
            let orders = tile.orders(&tile.areas(&inflows), &inflows, threshold);
            for k in 0..self.exits[t].len() {
                let exit = &mut self.exits[t][k];
                let order = orders[exit.index as usize];
                if std::mem::replace(&mut exit.order, order) != order {
                    let to = exit.to;
                    queue.push(self.tiling.locate(to).0);
                }
            }
        }
        Ok(())
    }
}

/// The receivers of a tile.
pub(super) struct Tile {
    pub window: Window,
    /// The receiver of each cell within the tile; the cell itself at outlets and exits.
    pub receivers: Vec<u32>,
    /// The exits, each with the cell of another tile that it drains to.
    leaving: Vec<(u32, u64)>,
    /// The cells, each before its receiver.
    pub order: Vec<u32>,
    /// The direction codes of the receivers.
    pub codes: Vec<u8>,
    /// The weights of the cells; `None` if each counts as 1.
    weights: Option<Vec<u32>>,
}

impl Tile {
    fn new(codes: &Grid, tiling: &Tiling) -> Tile {
        let window = *codes.window();
        let mut receivers: Vec<u32> = (0..window.len() as u32).collect();
        let mut leaving = Vec::new();
        let mut waiting = vec![0u8; window.len()];
        let codes: Vec<u8> = codes.data().iter().map(|code| *code as u8).collect();
        for (c, code) in codes.iter().copied().enumerate().filter(|(_, code)| *code != NONE) {
            let (east, south) = STEPS[usize::from(code & 7)];
            let (i, j) = ((c % window.width) as isize + east, (c / window.width) as isize + south);
            if i >= 0 && j >= 0 && i < window.width as isize && j < window.height as isize {
                receivers[c] = (j * window.width as isize + i) as u32;
                waiting[receivers[c] as usize] += 1;
            } else {
                leaving.push((c as u32, tiling.cell(window.x + i as i64, window.y + j as i64)));
            }
        }
        let mut order = Vec::with_capacity(window.len());
        for first in 0..window.len() {
            let mut cell = first;
            while waiting[cell] == 0 {
                waiting[cell] = u8::MAX;
                order.push(cell as u32);
                let receiver = receivers[cell] as usize;
                if receiver == cell {
                    break;
                }
                waiting[receiver] -= 1;
                cell = receiver;
            }
        }
        Tile { window, receivers, leaving, order, codes, weights: None }
    }

    fn grid(&self, value: impl Fn(usize) -> f32) -> Grid {
        let data = (0..self.window.len()).map(value).collect();
        Grid::from_data(self.window, data).unwrap_or_else(|| Grid::filled(self.window, 0.0))
    }

    /// The area of each cell, with `inflows` from other tiles.
    pub(super) fn areas(&self, inflows: &Border<Inflow>) -> Vec<u64> {
        let mut area = match &self.weights {
            Some(weights) => weights.iter().map(|weight| u64::from(*weight)).collect(),
            None => vec![1u64; self.window.len()],
        };
        for index in border(&self.window) {
            area[index] += inflows.get(index).map_or(0, |inflow| inflow.area);
        }
        for cell in self.order.iter().map(|cell| *cell as usize) {
            let receiver = self.receivers[cell] as usize;
            if receiver != cell {
                area[receiver] += area[cell];
            }
        }
        area
    }

    /// The exits with their areas within the tile, and the ends of flow paths that enter along the border.
    fn exits(&self) -> (Vec<Exit>, Border<End>) {
        let area = self.areas(&Border::filled(&self.window, Inflow::default()));
        let exit = |(index, to): &(u32, u64)| Exit {
            index: *index,
            to: *to,
            area: area[*index as usize],
            watershed: 0,
            order: 0,
        };
        let exits: Vec<Exit> = self.leaving.iter().map(exit).collect();
        let mut ends: Vec<End> = (0..self.window.len() as u32).map(End::Outlet).collect();
        for (k, exit) in exits.iter().enumerate() {
            ends[exit.index as usize] = End::Exit(k as u32);
        }
        for cell in self.order.iter().rev().map(|cell| *cell as usize) {
            ends[cell] = ends[self.receivers[cell] as usize];
        }
        let mut along = Border::filled(&self.window, End::Outlet(NOWHERE));
        border(&self.window).for_each(|index| along.set(index, ends[index]));
        (exits, along)
    }

    /// Whether other cells drain through a cell with this area.
    fn drains_others(&self, cell: usize, area: u64) -> bool {
        area > self.weights.as_ref().map_or(1, |weights| u64::from(weights[cell]))
    }

    fn is_outlet(&self, cell: usize, exits: &[bool]) -> bool {
        self.receivers[cell] as usize == cell && !exits[cell]
    }

    fn exit_marks(&self) -> Vec<bool> {
        let mut marks = vec![false; self.window.len()];
        self.leaving.iter().for_each(|(cell, _)| marks[*cell as usize] = true);
        marks
    }

    /// Calls `row` with the number of outlets of each row that drain other cells.
    fn count_outlets(&self, area: &[u64], mut row: impl FnMut(usize, u32)) {
        let exits = self.exit_marks();
        for j in 0..self.window.height {
            let cells = j * self.window.width..(j + 1) * self.window.width;
            row(j, cells.filter(|c| self.drains_others(*c, area[*c]) && self.is_outlet(*c, &exits)).count() as u32);
        }
    }

    /// The watershed of each outlet, 0 if it drains only itself; `before` returns their number before a row.
    fn own_watersheds(&self, area: &[u64], before: impl Fn(usize) -> u32) -> Vec<u32> {
        let exits = self.exit_marks();
        let mut labels = vec![0u32; self.window.len()];
        for j in 0..self.window.height {
            let mut last = before(j);
            for c in j * self.window.width..(j + 1) * self.window.width {
                if self.drains_others(c, area[c]) && self.is_outlet(c, &exits) {
                    last += 1;
                    labels[c] = last;
                }
            }
        }
        labels
    }

    /// The watersheds of some outlets, sorted by index.
    fn numbers(&self, area: &[u64], mut wanted: Vec<u32>, before: impl Fn(usize) -> u32) -> Vec<(u32, u32)> {
        wanted.sort_unstable();
        wanted.dedup();
        if wanted.is_empty() {
            return Vec::new();
        }
        let labels = self.own_watersheds(area, before);
        wanted.into_iter().map(|outlet| (outlet, labels.get(outlet as usize).copied().unwrap_or(0))).collect()
    }

    fn watersheds(&self, area: &[u64], exits: &[Exit], before: impl Fn(usize) -> u32) -> Vec<u32> {
        let mut labels = self.own_watersheds(area, before);
        exits.iter().for_each(|exit| labels[exit.index as usize] = exit.watershed);
        for cell in self.order.iter().rev().map(|cell| *cell as usize) {
            labels[cell] = labels[self.receivers[cell] as usize];
        }
        labels
    }

    /// Strahler orders (see [`strahler`](crate::hydrology::strahler)).
    pub(super) fn orders(&self, area: &[u64], inflows: &Border<Inflow>, threshold: u64) -> Vec<u8> {
        let mut streams = vec![(0u8, false); self.window.len()];
        for index in border(&self.window) {
            streams[index] =
                inflows.get(index).map_or((0, false), |inflow| (inflow.order, inflow.met && inflow.order > 0));
        }
        for cell in self.order.iter().map(|cell| *cell as usize) {
            if area[cell] < threshold {
                continue;
            }
            let (order, met) = streams[cell];
            let order = (order + u8::from(met)).max(1);
            streams[cell] = (order, false);
            let receiver = self.receivers[cell] as usize;
            if receiver != cell {
                let mut inflow = Inflow { area: 0, order: streams[receiver].0, met: streams[receiver].1 };
                inflow.meet(order);
                streams[receiver] = (inflow.order, inflow.met);
            }
        }
        streams.into_iter().map(|(order, _)| order).collect()
    }
}
