//! Basins, tile by tile: spill levels, and receivers routed out of depressions over the lowest passes.
//!
//! After Barnes, "Parallel Priority-Flood depression filling for trillion cell digital elevation models" (2016). The
//! tree of passes is kept (see [`tree`](super::tree)), so that both the levels and the flow paths equal the results in
//! memory.

use super::tiling::{Border, Tiling, border};
use super::tree::{self, Beside, Branch, Sets};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::basins::{OUTSIDE, ordered, passes};
use orogen_grid::hydrology::direction::{NONE, STEPS, opposite};
use orogen_grid::hydrology::outlets::Outlets;
use orogen_grid::progress::Progress;
use orogen_io::raster::Raster;

/// Fills depressions: writes the filled heights to `filled`, and changes `codes`, receivers with resolved flats, so
/// that they lead out of every depression.
///
/// # Errors
/// If the disk fails, or the work is cancelled.
pub fn drain(
    heights: &Raster,
    tiling: &Tiling,
    sea: Option<f32>,
    codes: &mut Raster,
    filled: &mut Raster,
    progress: &Progress,
) -> Result<()> {
    let mut shares = Vec::with_capacity(tiling.count());
    for t in 0..tiling.count() {
        progress.check()?;
        shares.push(Share::of(&Basins::new(heights, codes, tiling, t, sea)?, tiling));
        progress.advance(1.0);
    }
    let map = Map::new(tiling, &shares);
    // Paths that continue in another tile: the first cell there and its new receiver.
    let mut turns: Vec<Vec<(u32, u8)>> = vec![Vec::new(); tiling.count()];
    for (last, code) in map.over_borders(tiling) {
        let (t, index) = tiling.locate(last);
        turns[t].push((index as u32, code));
    }
    for t in 0..tiling.count() {
        progress.check()?;
        let basins = Basins::new(heights, codes, tiling, t, sea)?;
        let (levels, ways) = basins.spills(&map.tile(t, &shares[t]));
        let mut surface = basins.heights.clone();
        for (h, label) in surface.data_mut().iter_mut().zip(&basins.labels) {
            let level = levels[*label as usize];
            if *h < level {
                *h = level;
            }
        }
        filled.put(&surface)?;
        turns[t].extend(ways);
        progress.advance(1.0);
    }
    // Paths of different basins share no cells, so the order in which they are reversed does not matter.
    while turns.iter().any(|turns| !turns.is_empty()) {
        for t in 0..tiling.count() {
            let starts = std::mem::take(&mut turns[t]);
            if starts.is_empty() {
                continue;
            }
            progress.check()?;
            let mut grid = codes.get(&tiling.tile(t))?;
            for (cell, code) in starts.into_iter().filter_map(|start| turn_around(&mut grid, start)) {
                let (other, index) = tiling.locate(tiling.cell(cell.0, cell.1));
                turns[other].push((index as u32, code));
            }
            codes.put(&grid)?;
        }
    }
    Ok(())
}

/// Reverses the path from a cell to its pit within the tile; returns where it continues.
fn turn_around(codes: &mut Grid, (start, first): (u32, u8)) -> Option<((i64, i64), u8)> {
    let window = *codes.window();
    let (mut cell, mut code) = (start as usize, first);
    loop {
        let was = std::mem::replace(&mut codes.data_mut()[cell], f32::from(code)) as u8;
        if was == NONE {
            return None;
        }
        code = opposite(was);
        match step(&window, cell, was) {
            Ok(next) => cell = next,
            Err(place) => return Some((place, code)),
        }
    }
}

/// The cell of a window that a code leads to, or its position if it is outside.
fn step(window: &Window, cell: usize, code: u8) -> std::result::Result<usize, (i64, i64)> {
    let (east, south) = STEPS[usize::from(code & 7)];
    let (i, j) = ((cell % window.width) as i64 + east as i64, (cell / window.width) as i64 + south as i64);
    if i >= 0 && j >= 0 && i < window.width as i64 && j < window.height as i64 {
        Ok(j as usize * window.width + i as usize)
    } else {
        Err((window.x + i, window.y + j))
    }
}

/// The basins of a tile: the outside, one for each pit in the tile, and one for each cell where water leaves the tile.
struct Basins {
    heights: Grid,
    labels: Vec<u32>,
    /// Number of basins, including the outside.
    count: usize,
    /// Exits of the tile: the basin, and the position of the receiving cell.
    exits: Vec<(u32, (i64, i64))>,
    /// The names of basins that the map knows: 0 is the outside, followed by basins along the border and basins where
    /// paths between them branch.
    names: Vec<Option<u32>>,
    branches: Vec<Branch>,
}

impl Basins {
    fn new(heights: &Raster, codes: &Raster, tiling: &Tiling, t: usize, sea: Option<f32>) -> Result<Basins> {
        let (tile, near) = (tiling.tile(t), tiling.near(t, 1));
        let around = heights.get(&near)?;
        let outlets = Outlets::new(&around, sea).mask().crop(&tile).unwrap_or_else(|| Grid::filled(tile, true));
        let heights = around.crop(&tile).unwrap_or_else(|| Grid::filled(tile, 0.0));
        let codes = codes.get(&tile)?;
        const UNKNOWN: u32 = u32::MAX;
        let mut labels = vec![UNKNOWN; tile.len()];
        let (mut count, mut exits, mut path) = (1u32, Vec::new(), Vec::new());
        for start in 0..tile.len() {
            let mut cell = start;
            while labels[cell] == UNKNOWN {
                path.push(cell);
                let code = codes.data()[cell] as u8;
                if code == NONE && outlets.data()[cell] {
                    labels[cell] = OUTSIDE;
                    break;
                }
                let on = if code == NONE { Ok(cell) } else { step(&tile, cell, code) };
                match on {
                    Ok(next) if next != cell => cell = next,
                    beyond => {
                        if let Err(place) = beyond {
                            exits.push((count, place));
                        }
                        labels[cell] = count;
                        count += 1;
                    }
                }
            }
            let found = labels[cell];
            path.drain(..).for_each(|cell| labels[cell] = found);
        }
        let count = count as usize;
        let mut names = vec![None; count];
        names[0] = Some(0);
        let mut next = 1;
        for index in border(&tile) {
            names[labels[index] as usize].get_or_insert_with(|| {
                next += 1;
                next - 1
            });
        }
        let branches = tree::least(passes(&heights, &labels), &mut names);
        Ok(Basins { heights, labels, count, exits, names, branches })
    }

    /// The level of each basin, and the starts of paths to reverse: for each basin that drains over a pass in this
    /// tile, the last cell before the pass and the code that leads over it.
    fn spills(&self, known: &Known) -> (Vec<f32>, Vec<(u32, u8)>) {
        let mut levels = vec![f32::NEG_INFINITY; self.count];
        let mut taken = known.taken.iter();
        let kept: Vec<&Branch> = self
            .branches
            .iter()
            .filter(|branch| branch.joins.is_none() || taken.next().copied().unwrap_or(false))
            .collect();
        let beside = Beside::new(self.count, kept.iter().map(|branch| branch.pass.basins));
        let (mut reached, mut waiting, mut ways) = (vec![false; self.count], Vec::new(), Vec::new());
        for (basin, name) in self.names.iter().enumerate() {
            if let Some((level, false)) = name.and_then(|name| known.levels.get(name as usize)) {
                levels[basin] = *level;
                reached[basin] = true;
                waiting.push(basin as u32);
            }
        }
        while let Some(basin) = waiting.pop() {
            for branch in beside.of(basin).iter().map(|k| kept[*k as usize]) {
                let pass = &branch.pass;
                let forward = pass.basins[0] != basin;
                let next = pass.basins[usize::from(!forward)];
                if std::mem::replace(&mut reached[next as usize], true) {
                    continue;
                }
                let below = levels[basin as usize];
                levels[next as usize] = if pass.height > below { pass.height } else { below };
                waiting.push(next);
                if forward {
                    ways.push((pass.from, pass.code));
                } else if let Ok(there) = step(self.heights.window(), pass.from as usize, pass.code) {
                    ways.push((there as u32, opposite(pass.code)));
                }
            }
        }
        (levels, ways)
    }
}

/// The data of a tile's basins for the map.
struct Share {
    /// Number of named basins.
    named: usize,
    labels: Border<u32>,
    heights: Border<f32>,
    /// Basins with an exit from the tile, and the receiving cells.
    exits: Vec<(u32, u64)>,
    /// The passes that may be replaced: the names that they join, the height, and the position in row order.
    joins: Vec<([u32; 2], f32, u64)>,
}

impl Share {
    fn of(basins: &Basins, tiling: &Tiling) -> Share {
        let tile = basins.heights.window();
        let (mut labels, mut heights) = (Border::filled(tile, 0), Border::filled(tile, 0.0));
        let name = |label: u32| basins.names[label as usize].unwrap_or(0);
        for index in border(tile) {
            labels.set(index, name(basins.labels[index]));
            heights.set(index, basins.heights.data()[index]);
        }
        let exits = basins.exits.iter().map(|(label, (x, y))| (name(*label), tiling.cell(*x, *y))).collect();
        let join = |branch: &Branch| {
            let at = tiling.cell_of(tile, branch.pass.from as usize) * 4 + u64::from(branch.pass.code);
            branch.joins.map(|names| (names, branch.pass.height, at))
        };
        let mut joins: Vec<_> = basins.branches.iter().filter_map(join).collect();
        joins.shrink_to_fit();
        Share { named: basins.names.iter().flatten().count(), labels, heights, exits, joins }
    }
}

/// The results of the map for a tile's named basins.
struct Known<'a> {
    /// Whether each of the passes that may be replaced is part of the map's tree, in their order.
    taken: &'a [bool],
    /// The level of each named basin, and whether it drains over a pass of the tile.
    levels: Vec<(f32, bool)>,
}

/// A pass between named basins of the map.
struct Join {
    height: f32,
    /// For passes between tiles, the cell and code from which the pass leads.
    place: u64,
    ends: [u32; 2],
    /// The tile that contains it, and its index there; `None` for a pass between tiles.
    origin: Option<(u32, u32)>,
}

/// The tree of all named basins of the map.
struct Map {
    /// The first global name of each tile.
    bases: Vec<u32>,
    taken: Vec<Vec<bool>>,
    /// The levels by global name.
    levels: Vec<f32>,
    /// Whether the basin drains over a pass of its tile at this name.
    up: Vec<bool>,
    /// Passes between tiles over which basins drain: the last cell and its new code.
    crossings: Vec<(u64, u8)>,
}

impl Map {
    fn new(tiling: &Tiling, shares: &[Share]) -> Map {
        let mut bases = vec![0u32];
        for share in shares {
            bases.push(bases[bases.len() - 1] + share.named as u32);
        }
        let count = bases[shares.len()] as usize;
        let name = |cell: u64| {
            let (t, index) = tiling.locate(cell);
            shares[t].labels.get(index).map(|label| bases[t] + label)
        };
        // Merges names of the same basin: the outside is the same in all tiles, and water that leaves a tile belongs to
        // a basin of the next tile.
        let mut same = Sets::new(count);
        for (t, share) in shares.iter().enumerate() {
            same.join(0, bases[t]);
            for (label, to) in &share.exits {
                if let Some(there) = name(*to) {
                    same.join(there, bases[t] + label);
                }
            }
        }
        let mut joins = Map::crossings(tiling, shares, &bases);
        for (t, share) in shares.iter().enumerate() {
            for (k, (ends, height, place)) in share.joins.iter().enumerate() {
                let ends = ends.map(|end| bases[t] + end);
                joins.push(Join { height: *height, place: *place, ends, origin: Some((t as u32, k as u32)) });
            }
        }
        joins.sort_unstable_by_key(|join| (ordered(join.height), join.place));
        let mut joined = same.clone();
        let joins: Vec<Join> = joins.into_iter().filter(|join| joined.join(join.ends[0], join.ends[1])).collect();
        let mut map = Map {
            bases,
            taken: shares.iter().map(|share| vec![false; share.joins.len()]).collect(),
            levels: vec![f32::NEG_INFINITY; count],
            up: vec![false; count],
            crossings: Vec::new(),
        };
        for (t, k) in joins.iter().filter_map(|join| join.origin) {
            map.taken[t as usize][k as usize] = true;
        }
        map.flood(&joins, &mut same);
        map
    }

    /// The passes between tiles.
    fn crossings(tiling: &Tiling, shares: &[Share], bases: &[u32]) -> Vec<Join> {
        let within = shares.iter().map(|share| share.joins.len()).sum::<usize>();
        let border_cells = (0..tiling.count()).map(|t| border(&tiling.tile(t)).count()).sum::<usize>();
        // Two tiles have three passes for each cell along the border between them.
        let mut joins = Vec::with_capacity(within + border_cells * 3 / 2);
        for (t, share) in shares.iter().enumerate() {
            let tile = tiling.tile(t);
            for index in border(&tile) {
                let cell = tiling.cell_of(&tile, index);
                for (code, step) in STEPS.iter().take(4).enumerate() {
                    let Some(there) = tiling.step(cell, *step) else { continue };
                    let (other, beyond) = tiling.locate(there);
                    if other == t {
                        continue;
                    }
                    let values = (share.heights.get(index), shares[other].heights.get(beyond));
                    let labels = (share.labels.get(index), shares[other].labels.get(beyond));
                    if let ((Some(here), Some(there)), (Some(mine), Some(theirs))) = (values, labels) {
                        let height = (if there > here { there } else { here }) + 0.0;
                        let ends = [bases[t] + mine, bases[other] + theirs];
                        joins.push(Join { height, place: cell * 4 + code as u64, ends, origin: None });
                    }
                }
            }
        }
        joins
    }

    /// Traverses the tree of passes from the outside upward.
    fn flood(&mut self, joins: &[Join], same: &mut Sets) {
        let basins: Vec<u32> = (0..self.levels.len() as u32).map(|name| same.find(name)).collect();
        let ends = joins.iter().map(|join| join.ends.map(|end| basins[end as usize]));
        let beside = Beside::new(basins.len(), ends.clone());
        let ends: Vec<[u32; 2]> = ends.collect();
        let outside = basins.first().copied().unwrap_or(0);
        let (mut reached, mut waiting) = (vec![false; basins.len()], vec![outside]);
        if let Some(first) = reached.get_mut(outside as usize) {
            *first = true;
        }
        while let Some(basin) = waiting.pop() {
            for k in beside.of(basin).iter().map(|k| *k as usize) {
                let child = usize::from(ends[k][0] == basin);
                let next = ends[k][child];
                if std::mem::replace(&mut reached[next as usize], true) {
                    continue;
                }
                let (join, below) = (&joins[k], self.levels[basin as usize]);
                self.levels[next as usize] = if join.height > below { join.height } else { below };
                waiting.push(next);
                match join.origin {
                    Some(_) => self.up[join.ends[child] as usize] = true,
                    None => self.crossings.push((join.place, child as u8)),
                }
            }
        }
        for (name, basin) in basins.iter().enumerate() {
            self.levels[name] = self.levels[*basin as usize];
        }
    }

    /// The last cells of basins that drain to another tile, and their codes.
    fn over_borders(&self, tiling: &Tiling) -> Vec<(u64, u8)> {
        let way = |(place, child): &(u64, u8)| {
            let (cell, code) = (place / 4, (place % 4) as u8);
            match child {
                0 => Some((cell, code)),
                _ => tiling.step(cell, STEPS[usize::from(code)]).map(|there| (there, opposite(code))),
            }
        };
        self.crossings.iter().filter_map(way).collect()
    }

    fn tile(&self, t: usize, share: &Share) -> Known<'_> {
        let base = self.bases[t] as usize;
        let levels = (base..base + share.named).map(|name| (self.levels[name], self.up[name])).collect();
        Known { taken: &self.taken[t], levels }
    }
}
