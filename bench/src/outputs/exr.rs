//! OpenEXR of 8192 x 8192 heights, ZIP, in one thread, CPU time: compared with the OpenEXR library, and with a general
//! compressor on the same bytes; and the sizes of the files.

use std::hint::black_box;
use std::io;

use cpu_time::ThreadTime;
use miniz_oxide::deflate::compress_to_vec_zlib;
use orogen::Grid;
use orogen::io::format::exr::{Picture, Sample, Writer};
use orogen::io::spool::Spool;

use super::counted::Counted;
use super::ground::ground;
use super::python;
use crate::measure::median;
use crate::options::Options;
use crate::world::figure::{Figure, Target};

const SIDE: usize = 8192;

/// The environment variable of a Python with OpenEXR: `cargo xtask bench` installs it and sets this.
const PYTHON: &str = "OROGEN_OPENEXR";

/// Rows per block of the format.
const ROWS: usize = 16;

/// The fastest useful level of the general compressor.
const LEVEL: u8 = 3;

/// Measures all on the same terrain.
pub fn measure(options: &Options) -> Result<Vec<Figure>, String> {
    let ground = ground(SIDE)?;
    let repetitions = options.repetitions.min(3);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|e| e.to_string())?;
    let (mut ours, mut general, mut size) = (Vec::new(), Vec::new(), 0);
    for _ in 0..repetitions {
        let (seconds, bytes) = pool.install(|| write(&ground))?;
        ours.push(seconds);
        size = bytes;
        general.push(packed(&ground));
    }
    let theirs = python::run(PYTHON, "exr.py", &ground, &[repetitions.to_string()])?;
    let seconds = median(&mut ours);
    let other = theirs.as_ref().map(|theirs| ("OpenEXR", theirs.seconds));
    let other_size = theirs.and_then(|theirs| theirs.values["bytes"].as_f64()).map(|bytes| ("OpenEXR", bytes / 1e6));
    let case = |what: &str| format!("EXR of {SIDE} x {SIDE}, f32, ZIP: {what}");
    let time = |what: &str, other, target| Figure { case: case(what), ours: seconds, unit: "s of CPU", other, target };
    Ok(vec![
        time("time", other, if other.is_some() { Target::FasterBy(2.0) } else { Target::None }),
        time(
            "time, the other's packing alone",
            Some(("miniz_oxide, level 3", median(&mut general))),
            Target::FasterBy(3.0),
        ),
        Figure {
            case: case("size"),
            ours: size as f64 / 1e6,
            unit: "MB",
            other: other_size,
            target: if other_size.is_some() { Target::RatioAtMost(1.05) } else { Target::None },
        },
    ])
}

/// Seconds, and size of the file in bytes.
fn write(ground: &Grid) -> Result<(f64, u64), String> {
    let picture = Picture {
        width: ground.width(),
        height: ground.height(),
        channels: vec!["Y".into()],
        sample: Sample::Float,
        comments: String::new(),
    };
    let start = ThreadTime::now();
    let mut counted = Counted(0);
    let mut write = || {
        let mut writer = Writer::new(picture.clone(), Spool::in_memory())?;
        writer.rows(&[ground.data()])?;
        writer.finish(&mut counted)
    };
    write().map_err(|e: io::Error| e.to_string())?;
    Ok((start.elapsed().as_secs_f64(), counted.0))
}

/// Seconds of the general compressor for the blocks, after splitting and differences.
fn packed(ground: &Grid) -> f64 {
    let mut seconds = 0.0;
    for rows in ground.data().chunks(ROWS * ground.width()) {
        let bytes: Vec<u8> = rows.iter().flat_map(|sample| sample.to_le_bytes()).collect();
        let parted: Vec<u8> = bytes.iter().step_by(2).chain(bytes.iter().skip(1).step_by(2)).copied().collect();
        let first = parted.first().copied();
        let differences = parted.windows(2).map(|pair| pair[1].wrapping_sub(pair[0]).wrapping_add(128));
        let differences: Vec<u8> = first.into_iter().chain(differences).collect();
        let start = ThreadTime::now();
        black_box(compress_to_vec_zlib(black_box(&differences), LEVEL));
        seconds += start.elapsed().as_secs_f64();
    }
    seconds
}
