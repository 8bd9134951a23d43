//! The light of the sky on every sample.

use crate::failure::Failure;
use crate::gpu::Gpu;
use crate::job::{Dispatch, GROUP, Job};
use orogen_output::render::skylight::{ENTRIES, Shed, SkylightInput};

/// Invocations of a workgroup.
const INVOCATIONS: u32 = GROUP * GROUP;

/// Lines in one direction that cross every column of the land. If the direction is closer to north or south, the
/// sweep's columns are the land's rows.
struct Sweep {
    /// Number of columns and of rows of the sweep.
    length: usize,
    lines: usize,
    /// The direction along the columns, and across them; the first component is the larger.
    towards: [f64; 2],
    turned: bool,
}

impl Sweep {
    fn new([columns, rows]: [usize; 2], [x, y]: [f64; 2]) -> Sweep {
        match x.abs() >= y.abs() {
            true => Sweep { length: columns, lines: rows, towards: [x, y], turned: false },
            false => Sweep { length: rows, lines: columns, towards: [y, x], turned: true },
        }
    }

    /// Rows per column of a line.
    fn slant(&self) -> f64 {
        self.towards[1] / self.towards[0]
    }

    /// The first line's row at column 0, and the number of lines, such that each sample is between two of them.
    fn starts(&self) -> (i32, usize) {
        let drift = self.slant() * self.length.saturating_sub(1) as f64;
        ((-drift.max(0.0)) as i32 - 1, self.lines + drift.abs() as usize + 3)
    }

    /// The words of its dispatches, by their names in the shader. `starts` are the indices of the table of the
    /// direction's light and of the grids.
    fn words(&self, columns: usize, starts: [u32; 5]) -> [(&'static str, u32); 16] {
        let [dome, turned, horizons, hulls, shed] = starts;
        let (first, lines) = self.starts();
        let strides = if self.turned { [columns, 1] } else { [1, columns] };
        let float = |value: f64| (value as f32).to_bits();
        [
            ("LENGTH", self.length as u32),
            ("LINES", self.lines as u32),
            ("FIRST_LINE", first.cast_unsigned()),
            ("LINE_COUNT", lines as u32),
            // Rows per column of a line, and the distance of a column along it.
            ("SLANT", float(self.slant())),
            ("STEP", float(1.0 / self.towards[0].abs())),
            ("FORWARDS", u32::from(self.towards[0] > 0.0)),
            // The ground with the samples of a column of the sweep next to each other.
            ("BED", if self.turned { 0 } else { turned }),
            ("ALONG", float(self.towards[0])),
            ("ACROSS", float(self.towards[1])),
            ("DOME", dome),
            ("HORIZONS", horizons),
            ("HULLS", hulls),
            ("SHED", shed),
            // Strides of the light.
            ("STRIDE_ALONG", strides[0] as u32),
            ("STRIDE_ACROSS", strides[1] as u32),
        ]
    }
}

/// Computes the light of the sky on every sample of the land. `is_cancelled` is called between parts of the work.
/// Returns `Ok(None)` if the work was cancelled.
///
/// # Errors
/// If the land does not fit into a buffer of the card, or the card fails.
pub fn skylight(
    gpu: &Gpu,
    input: &SkylightInput,
    is_cancelled: impl Fn() -> bool,
) -> Result<Option<Vec<Shed>>, Failure> {
    let mut text = format!("const ENTRIES = {ENTRIES}u;\n{}", include_str!("skylight.wgsl"));
    for (k, (name, _)) in Sweep::new(input.size, [1.0, 0.0]).words(0, [0; 5]).into_iter().enumerate() {
        text += &format!("const {name} = {k}u;\n");
    }
    let [columns, rows] = input.size;
    let count = columns * rows;
    let sweeps: Vec<Sweep> = input.directions.iter().map(|(towards, _)| Sweep::new(input.size, *towards)).collect();
    let crossings = sweeps.iter().map(|sweep| sweep.starts().1 * sweep.length).max().unwrap_or(0);
    let [turned, shed, horizons, hulls] = [count, 2 * count, 6 * count, 6 * count + crossings];
    let samples = hulls + 2 * crossings;
    if 4 * samples as u64 > gpu.buffer_limit() {
        let [needed, limit] = [4 * samples as u64, gpu.buffer_limit()].map(|bytes| bytes >> 20);
        return Err(Failure::Memory(format!("the light takes {needed} MiB, and a buffer has at most {limit} MiB")));
    }
    let mut data = Vec::new();
    let mut dispatches = Vec::new();
    for (sweep, (_, dome)) in sweeps.iter().zip(&input.directions) {
        let table = data.len() as u32;
        data.extend(dome.sums.as_flattened().as_flattened().iter().map(|light| light.to_bits()));
        let base = data.len() as u32;
        let (_, lines) = sweep.starts();
        let starts = [table, turned as u32, horizons as u32, hulls as u32, shed as u32];
        data.extend(sweep.words(columns, starts).map(|(_, word)| word));
        let groups = (lines as u32).div_ceil(INVOCATIONS);
        dispatches.push(Dispatch { text: &text, base, size: [groups * GROUP, GROUP], ..Dispatch::default() });
        dispatches.push(Dispatch {
            text: &text,
            base,
            size: [columns as u32, rows as u32],
            step: 1,
            ..Dispatch::default()
        });
    }
    let uploads = vec![(0, input.bed.as_slice().into()), (turned, input.turned.as_slice().into())];
    let job = Job { data, samples, uploads, dispatches, downloads: vec![(shed, 4 * count)], ..Job::default() };
    // The two dispatches of one direction are submitted together.
    let back = job.run_in_parts(gpu, 2, is_cancelled)?;
    Ok(back.and_then(|mut grids| grids.pop()).map(|shed| shed.as_chunks::<4>().0.to_vec()))
}
