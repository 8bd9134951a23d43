//! One iteration of the virtual pipes, going down the rows in place.

use super::planes::Planes;
use super::rows::{least, most, positive};

/// The planes by their places.
pub const BED: usize = 0;
/// Depth of the water.
pub const DEPTH: usize = 1;
/// Sediment in the water, as metres of ground.
pub const SEDIMENT: usize = 2;
/// What flows over the cell's eastern side.
pub const EAST: usize = 3;
/// What flows over the cell's southern side.
pub const SOUTH: usize = 4;

/// What does not differ between cells, for one iteration. Flows are in metres of a cell's water an iteration.
#[derive(Debug, Clone, Copy)]
pub struct Constants {
    /// Flow gained for each metre between two surfaces.
    pub pull: f32,
    /// The share of the flow that friction leaves.
    pub kept: f32,
    /// Water that falls, in metres.
    pub rain: f32,
    /// Sediment, in metres, for each metre of two sides' flows together.
    pub capacity: f32,
    /// (2 cell)^2: what the square of two beds' difference is to be divided by.
    pub level: f32,
    /// The share of what could still be carried that is cut.
    pub erosion: f32,
    /// The share of what is too much that is laid down.
    pub deposition: f32,
    /// The share of the water that evaporation leaves.
    pub left: f32,
}

/// An iteration on its way down the rows. At row j the flows out of that row are made and limited; the row above, all
/// of whose sides are then known, passes on water and sediment; the bed of the row above that, round which all changes
/// are then known, takes its part of them and is what it is after the iteration.
pub struct Sweep {
    /// Of three rows, by the remainder of their number: the share of the outflow that there is water for,
    limits: [Vec<f32>; 3],
    /// the sediment in a metre of water,
    loads: [Vec<f32>; 3],
    /// and how much ground the water lays down.
    changes: [Vec<f32>; 3],
}

/// Rows that a sweep has to be ahead of the next.
pub const AHEAD: usize = 3;

/// Depths and flows below this are none: nothing is divided by 0.
const TINY: f32 = 1e-30;

impl Sweep {
    /// At the top of planes of this width.
    pub fn new(width: usize) -> Sweep {
        let rows = || std::array::from_fn(|_| vec![0.0; width]);
        Sweep { limits: rows(), loads: rows(), changes: rows() }
    }

    /// Goes on to row `j`; after the last there is one more to go. The first and the last row and column are walls.
    #[inline(always)]
    pub fn row(&mut self, planes: &mut Planes<5>, j: usize, constants: &Constants) {
        let rows = planes.height();
        if j == 0 || j + 1 >= rows {
            self.limits[j % 3].fill(0.0);
            self.loads[j % 3].fill(0.0);
        } else {
            self.flow(planes, j, constants);
        }
        if j >= 1 && j <= rows {
            self.pass_on(planes, j - 1, constants);
        }
        if j >= 2 {
            self.lay(planes, j - 2);
        }
    }

    /// Flows out of row `j`.
    #[inline(always)]
    fn flow(&mut self, planes: &mut Planes<5>, j: usize, constants: &Constants) {
        let last = j + 2 == planes.height();
        let [above, here, below] = planes.three(j);
        let [bed, depth, sediment, east, south] = here;
        pull([&*bed, &*depth], [&*below[BED], &*below[DEPTH]], [&mut *east, &mut *south], constants);
        if last {
            south.fill(0.0);
        }
        let (limits, loads) = (&mut self.limits[j % 3], &mut self.loads[j % 3]);
        limit([&*depth, &*sediment], [&*east, &*south, &*above[SOUTH]], [limits, loads]);
    }

    /// Water and sediment of row `j` as they are after the iteration, and what that does to the ground.
    #[inline(always)]
    fn pass_on(&mut self, planes: &mut Planes<5>, j: usize, constants: &Constants) {
        if j == 0 || j + 1 >= planes.height() {
            // What would be laid beyond a wall stays before it.
            let before = std::mem::take(&mut self.changes[(j + 2) % 3]);
            self.changes[j % 3].copy_from_slice(&before);
            self.changes[(j + 2) % 3] = before;
            return;
        }
        let changes = &mut self.changes[j % 3];
        let order = [j - 1, j, j + 1].map(|row| row % 3);
        let limits = order.map(|k| self.limits[k].as_slice());
        let loads = order.map(|k| self.loads[k].as_slice());
        let [above, [bed, depth, sediment, east, south], below] = planes.three(j);
        hold([limits[1], limits[2]], [&mut *east, &mut *south]);
        let flows = [&*east, &*south, &*above[SOUTH]];
        settle(loads, [&*above[BED], &*bed, &*below[BED]], flows, [&mut *depth, &mut *sediment, changes], constants);
        let inner = bed.len() - 2;
        (changes[0], changes[inner + 1]) = (changes[1], changes[inner]);
        if j == 1 {
            let (first, rest) = self.changes.split_at_mut(1);
            first[0].copy_from_slice(&rest[0]);
        }
    }

    /// The bed of row `j`: what the water does to a cell is shared with those around it, which fills and cuts in
    /// strokes wider than a cell.
    #[inline(always)]
    fn lay(&mut self, planes: &mut Planes<5>, j: usize) {
        if j == 0 || j + 1 >= planes.height() {
            return;
        }
        let changes = [j - 1, j, j + 1].map(|row| self.changes[row % 3].as_slice());
        let rows = planes.height();
        let [above, [bed, _, sediment, ..], below] = planes.three(j);
        share(changes, [&mut *bed, &mut *sediment]);
        let inner = bed.len() - 2;
        (bed[0], bed[inner + 1]) = (bed[1], bed[inner]);
        if j == 1 {
            above[BED].copy_from_slice(bed);
        }
        if j + 2 == rows {
            below[BED].copy_from_slice(bed);
        }
    }
}

/// Flows over the eastern and southern sides of a row, as far as the surfaces pull.
#[inline(always)]
fn pull([bed, depth]: [&[f32]; 2], below: [&[f32]; 2], [east, south]: [&mut [f32]; 2], constants: &Constants) {
    let n = bed.len() - 2;
    let (kept, pull) = (constants.kept, constants.pull);
    {
        // The first and the last cell's outer sides are walls, and stay 0.
        let n = n - 1;
        let ([b0, b1], [d0, d1]) = ([&bed[1..=n], &bed[2..n + 2]], [&depth[1..=n], &depth[2..n + 2]]);
        let east = &mut east[1..=n];
        for i in 0..n {
            east[i] = kept * east[i] + pull * ((b0[i] - b1[i]) + (d0[i] - d1[i]));
        }
    }
    let ([b0, b1], [d0, d1]) = ([&bed[1..=n], &below[0][1..=n]], [&depth[1..=n], &below[1][1..=n]]);
    let south = &mut south[1..=n];
    for i in 0..n {
        south[i] = kept * south[i] + pull * ((b0[i] - b1[i]) + (d0[i] - d1[i]));
    }
}

/// The share of a row's outflow that there is water for, and its sediment in a metre of water.
#[inline(always)]
fn limit([depth, sediment]: [&[f32]; 2], [east, south, north]: [&[f32]; 3], [limits, loads]: [&mut [f32]; 2]) {
    let n = depth.len() - 2;
    let (depth, sediment) = (&depth[1..=n], &sediment[1..=n]);
    let (west, east, south, north) = (&east[..n], &east[1..=n], &south[1..=n], &north[1..=n]);
    let (limits, loads) = (&mut limits[1..=n], &mut loads[1..=n]);
    for i in 0..n {
        let out = (positive(east[i]) + positive(-west[i])) + (positive(south[i]) + positive(-north[i]));
        limits[i] = least(depth[i] / most(out, TINY), 1.0);
        loads[i] = sediment[i] / most(depth[i], TINY);
    }
}

/// No cell gives more water than it has.
#[inline(always)]
fn hold([here, below]: [&[f32]; 2], [east, south]: [&mut [f32]; 2]) {
    let n = here.len() - 2;
    let (next, here, below) = (&here[2..n + 2], &here[1..=n], &below[1..=n]);
    let (east, south) = (&mut east[1..=n], &mut south[1..=n]);
    for i in 0..n {
        east[i] *= if east[i] > 0.0 { here[i] } else { next[i] };
        south[i] *= if south[i] > 0.0 { here[i] } else { below[i] };
    }
}

/// Water and sediment move over the sides; what the water cuts or lays down is told, and taken from or added to its
/// sediment.
#[inline(always)]
fn settle(
    loads: [&[f32]; 3],
    beds: [&[f32]; 3],
    [east, south, north]: [&[f32]; 3],
    [depth, sediment, changes]: [&mut [f32]; 3],
    constants: &Constants,
) {
    let n = depth.len() - 2;
    let (west, east, south, north) = (&east[..n], &east[1..=n], &south[1..=n], &north[1..=n]);
    let (load_n, load_s) = (&loads[0][1..=n], &loads[2][1..=n]);
    let (load_w, load_c, load_e) = (&loads[1][..n], &loads[1][1..=n], &loads[1][2..n + 2]);
    let (bed_n, bed_s) = (&beds[0][1..=n], &beds[2][1..=n]);
    let (bed_w, bed_c, bed_e) = (&beds[1][..n], &beds[1][1..=n], &beds[1][2..n + 2]);
    let (depth, sediment, changes) = (&mut depth[1..=n], &mut sediment[1..=n], &mut changes[1..=n]);
    let c = *constants;
    for i in 0..n {
        let (e, w, s, nn) = (east[i], west[i], south[i], north[i]);
        let (out_e, out_w, out_s, out_n) = (positive(e), positive(-w), positive(s), positive(-nn));
        let out = (out_e + out_w) + (out_s + out_n);
        let came = (positive(-e) * load_e[i] + positive(w) * load_w[i])
            + (positive(-s) * load_s[i] + positive(nn) * load_n[i]);
        // What goes is at most what is there; rounding must not leave less than nothing.
        let carried = positive(sediment[i] - out * load_c[i]) + came;
        let left = positive(depth[i] + ((w - e) + (nn - s)));
        let (across, down) = (w + e, nn + s);
        let (rise_x, rise_y) = (bed_e[i] - bed_w[i], bed_s[i] - bed_n[i]);
        let steep = rise_x * rise_x + rise_y * rise_y;
        let could = c.capacity * ((across * across + down * down) * (steep / (c.level + steep))).sqrt();
        let more = could - carried;
        let lowest = least(least(bed_n[i], bed_s[i]), least(bed_w[i], bed_e[i]));
        let mean = 0.25 * ((bed_n[i] + bed_s[i]) + (bed_w[i] + bed_e[i]));
        let cut = least(c.erosion * more, 0.5 * positive(bed_c[i] - lowest));
        let laid = least(-c.deposition * more, positive(mean - bed_c[i]) + 0.25 * left);
        let change = if more > 0.0 { -cut } else { laid };
        changes[i] = change;
        sediment[i] = carried - change;
        depth[i] = left * c.left + c.rain;
    }
}

/// A cell's change is shared over 3 x 3 cells, (1, 2, 1) each way over 16.
#[inline(always)]
fn share([north, here, south]: [&[f32]; 3], [bed, sediment]: [&mut [f32]; 2]) {
    let n = bed.len() - 2;
    let (nw, nc, ne) = (&north[..n], &north[1..=n], &north[2..n + 2]);
    let (w, c, e) = (&here[..n], &here[1..=n], &here[2..n + 2]);
    let (sw, sc, se) = (&south[..n], &south[1..=n], &south[2..n + 2]);
    let (bed, sediment) = (&mut bed[1..=n], &mut sediment[1..=n]);
    for i in 0..n {
        let above = (nw[i] + ne[i]) + 2.0 * nc[i];
        let middle = (w[i] + e[i]) + 2.0 * c[i];
        let under = (sw[i] + se[i]) + 2.0 * sc[i];
        let change = 0.0625 * ((above + under) + 2.0 * middle);
        let new = bed[i] + change;
        // What the bed's rounding takes or gives stays with the water.
        sediment[i] += change - (new - bed[i]);
        bed[i] = new;
    }
}
