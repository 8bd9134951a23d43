//! A Cloud-Optimized GeoTIFF of 8192 x 8192 heights compared with GDAL: the same encoding (deflate, predictor 3, tiles
//! of 512, averaged overviews), one thread each, CPU time; and the sizes of the files.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use cpu_time::ThreadTime;
use orogen::Grid;
use orogen::io::format::geotiff::{options::Options as Layout, writer};
use orogen::io::format::raw;
use orogen::io::spool::Spool;

use super::ground::ground;
use crate::measure::median;
use crate::options::Options;
use crate::world::figure::{Figure, Target};
use crate::world::process::watch;

const SIDE: usize = 8192;

/// GDAL's program.
const GDAL: &str = "gdal_translate";

/// Measures both on the same terrain in turns.
pub fn measure(options: &Options) -> Result<Vec<Figure>, String> {
    let folder = Folder::new()?;
    let ground = ground(SIDE)?;
    let ours = folder.0.join("ours.tif");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|e| e.to_string())?;
    let mut times = Vec::new();
    for _ in 0..options.repetitions.min(3) {
        times.push(pool.install(|| write(&ground, &ours))?);
    }
    let length = |path: &Path| std::fs::metadata(path).map(|file| file.len() as f64 / 1e6).map_err(|e| e.to_string());
    let (seconds, size) = (median(&mut times), length(&ours)?);
    let theirs = match gdal(&ground, &folder.0)? {
        Some((seconds, path)) => Some((seconds, length(&path)?)),
        None => None,
    };
    let target = |target: Target| if theirs.is_some() { target } else { Target::None };
    let case = |what: &str| format!("COG of {SIDE} x {SIDE}, deflate, predictor 3: {what}");
    Ok(vec![
        Figure {
            case: case("time"),
            ours: seconds,
            unit: "s of CPU",
            other: theirs.map(|(seconds, _)| (GDAL, seconds)),
            target: target(Target::FasterBy(2.0)),
        },
        Figure {
            case: case("size"),
            ours: size,
            unit: "MB",
            other: theirs.map(|(_, size)| (GDAL, size)),
            target: target(Target::RatioAtMost(1.05)),
        },
    ])
}

fn write(ground: &Grid, path: &Path) -> Result<f64, String> {
    let start = ThreadTime::now();
    let mut file = BufWriter::with_capacity(1 << 18, File::create(path).map_err(|e| e.to_string())?);
    writer::write(&mut file, ground, &Layout::default(), Spool::beside(path)).map_err(|e| e.to_string())?;
    drop(file);
    Ok(start.elapsed().as_secs_f64())
}

/// GDAL on the same heights, which it reads as raw data; `None` without GDAL.
fn gdal(ground: &Grid, folder: &Path) -> Result<Option<(f64, PathBuf)>, String> {
    let found = watch(Path::new(GDAL), &["--version"], f64::INFINITY);
    if found.is_err() {
        eprintln!("    {GDAL} is not installed (Debian: gdal-bin): measured alone");
        return Ok(None);
    }
    let (plain, out) = (folder.join("plain.raw"), folder.join("theirs.tif"));
    let mut file = BufWriter::new(File::create(&plain).map_err(|e| e.to_string())?);
    raw::write_r32(&mut file, ground).map_err(|e| e.to_string())?;
    drop(file);
    let header = format!(
        "ENVI\nsamples = {SIDE}\nlines = {SIDE}\nbands = 1\nheader offset = 0\nfile type = ENVI Standard\ndata type = 4\n\
         interleave = bsq\nbyte order = 0\n"
    );
    std::fs::write(folder.join("plain.hdr"), header).map_err(|e| e.to_string())?;
    let (plain, out_text) = (plain.to_string_lossy().into_owned(), out.to_string_lossy().into_owned());
    let arguments = [
        "-q",
        "-of",
        "COG",
        "-co",
        "COMPRESS=DEFLATE",
        "-co",
        "PREDICTOR=3",
        "-co",
        "NUM_THREADS=1",
        "-co",
        "OVERVIEW_RESAMPLING=AVERAGE",
        &plain,
        &out_text,
    ];
    let (cost, _) = watch(Path::new(GDAL), &arguments, f64::INFINITY)?;
    Ok(Some((cost.cpu, out)))
}

/// A folder that is removed on drop.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Result<Folder, String> {
        let path = std::env::temp_dir().join(format!("orogen-bench-cog-{}", std::process::id()));
        std::fs::create_dir_all(&path).map_err(|e| e.to_string())?;
        Ok(Folder(path))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
