//! One iteration of the virtual pipes, row by row and in place.

use super::planes::Planes;
use super::rows::{least, most, positive};

/// Index of the plane of the bed, in metres.
pub const BED: usize = 0;
/// Index of the plane of the water depth, in metres.
pub const DEPTH: usize = 1;
/// Index of the plane of sediment in the water, as metres of ground.
pub const SEDIMENT: usize = 2;
/// Index of the plane of flow over the eastern side of each cell.
pub const EAST: usize = 3;
/// Index of the plane of flow over the southern side of each cell.
pub const SOUTH: usize = 4;

/// Parameters of one iteration that are common to all cells. Flows are in metres of a cell's water per iteration.
#[derive(Debug, Clone, Copy)]
pub struct Constants {
    /// Flow gained per metre of difference between two surfaces.
    pub pull: f32,
    /// Share of the flow that remains after friction.
    pub kept: f32,
    /// Rain, in metres.
    pub rain: f32,
    /// Capacity: sediment in metres per metre of the sum of two sides' flows.
    pub capacity: f32,
    /// (2 cell)^2: divisor of the squared difference of two beds.
    pub level: f32,
    /// Share of the unused capacity that is eroded.
    pub erosion: f32,
    /// Share of the excess sediment that is deposited.
    pub deposition: f32,
    /// Share of the water that remains after evaporation.
    pub left: f32,
}

/// The state of an iteration that moves down the rows. At row j it computes and limits the flows out of that row. All
/// flows of the row above are then known, and that row passes on water and sediment. All changes around the next row
/// above are then known, and its bed receives its share of them and is final for the iteration.
pub struct Sweep {
    /// The share of the outflow for which there is enough water. All three fields have three rows, indexed by row
    /// number modulo 3.
    limits: [Vec<f32>; 3],
    /// The sediment per metre of water.
    loads: [Vec<f32>; 3],
    /// The deposited ground, in metres; negative where ground is eroded.
    changes: [Vec<f32>; 3],
}

/// Number of rows by which a sweep must be ahead of the next one.
pub const AHEAD: usize = 3;

/// Depths and flows below this count as 0, to avoid division by 0.
const TINY: f32 = 1e-30;

impl Sweep {
    /// The state above the first row of planes with `width` columns.
    #[must_use]
    pub fn new(width: usize) -> Sweep {
        let rows = || std::array::from_fn(|_| vec![0.0; width]);
        Sweep { limits: rows(), loads: rows(), changes: rows() }
    }

    /// Processes row `j`; one more call is needed after the last row. The first and the last row and column are walls.
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

    /// Computes the flows out of row `j`.
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

    /// Computes the water and sediment of row `j` after the iteration, and the changes of the ground.
    #[inline(always)]
    fn pass_on(&mut self, planes: &mut Planes<5>, j: usize, constants: &Constants) {
        if j == 0 || j + 1 >= planes.height() {
            // Sediment that would be deposited beyond a wall stays in front of it.
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

    /// Updates the bed of row `j`. The changes of a cell are shared with the cells around it, so that erosion and
    /// deposition are wider than a cell.
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

/// Accelerates the flows over the eastern and southern sides of a row by the difference of the water surfaces.
#[inline(always)]
fn pull([bed, depth]: [&[f32]; 2], below: [&[f32]; 2], [east, south]: [&mut [f32]; 2], constants: &Constants) {
    let n = bed.len() - 2;
    let (kept, pull) = (constants.kept, constants.pull);
    {
        // The outer sides of the first and the last cell are walls, and stay 0.
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

/// The share of a row's outflow for which there is enough water, and its sediment per metre of water.
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

/// Limits the outflow of a cell to its water.
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

/// Moves water and sediment over the sides. Records erosion and deposition, and changes the sediment accordingly.
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
        // The outflow is at most the content, but rounding must not make it negative.
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

/// Shares the changes of cells over 3 x 3 cells, with weights (1, 2, 1) / 4 along each axis.
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
        // The rounding error of the bed is added to the sediment in the water.
        sediment[i] += change - (new - bed[i]);
        bed[i] = new;
    }
}
