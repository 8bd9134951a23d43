//! A gray picture as a field.

use super::positions::each;
use crate::layer::LayerKind;
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::resample;
use orogen_io::dem::file_ref::Picture;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// A gray picture as a field: black is 0, white is 1. Use it as a mask, for example a painted coast, a forest or a
    /// road.
    ///
    /// Supported format: gray PNG (.png) of 8 or 16 bits. Pixels are square and represent points: the first one, in the
    /// north-west corner, is placed at `at`, the last one of a row `width` metres east of it. Between pixels the values
    /// are interpolated by a cubic (Catmull and Rom 1974) and limited to 0 ..= 1. Stored solutions are reused as long
    /// as the content of the file is the same; its name does not matter. The picture is kept in memory. For heights use
    /// `dem`.
    pub struct Image = "image", field, revision 1;
    params {
        /// Path of the file. A relative path is resolved against the folder of the recipe.
        path: Picture = Picture::default();
        /// Position of the picture's north-west corner: metres east, metres south.
        at: [f64; 2] = [0.0, 0.0], unit "m", range -1e9 to 1e9;
        /// Width of the picture on the ground.
        width: f64 = 1000.0, unit "m", range 1e-3 to 1e9;
        /// Value outside the picture.
        outside: f64 = 0.0, range 0.0 to 1.0;
    }
    check |image| match image.path.0.is_empty() {
        true => Err(("path", "`path` is empty; write the path of a grey .png file".to_string())),
        false => Ok(()),
    };
}

impl Field for Image {
    fn eval(&self, at: &Points, _: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        // A world is not opened without its files. A plan that runs without a world has no values here.
        let Some(picture) = self.path.0.ground() else {
            out.fill(self.outside as f32);
            return Ok(());
        };
        let columns = (picture.grid.width() as f64 - 1.0).max(1.0);
        let last = [picture.grid.width(), picture.grid.height()].map(|pixels| pixels as f64 - 1.0);
        let [left, top] = self.at;
        let pixel = |metres: f64, from: f64| (metres - from) / self.width * columns;
        let mut inside = vec![0.0f32; out.len()];
        each(at, &mut inside, |x, y| {
            let (x, y) = (pixel(x, left), pixel(y, top));
            f32::from(u8::from((0.0..=last[0]).contains(&x) && (0.0..=last[1]).contains(&y)))
        });
        match at {
            Points::Lattice { xs, ys } if !xs.is_empty() => {
                let xs: Vec<f64> = xs.iter().map(|x| pixel(*x, left)).collect();
                let ys: Vec<f64> = ys.iter().map(|y| pixel(*y, top)).collect();
                resample::read(&picture.grid, LayerKind::Height, &Points::Lattice { xs: &xs, ys: &ys }, out);
            }
            _ => {
                let places = (0..out.len()).map(|k| at.position(k).unwrap_or(resample::NOWHERE));
                let (xs, ys): (Vec<f64>, Vec<f64>) = places.map(|(x, y)| (pixel(x, left), pixel(y, top))).unzip();
                resample::read(&picture.grid, LayerKind::Height, &Points::Scattered { x: &xs, y: &ys }, out);
            }
        }
        for (sample, inside) in out.iter_mut().zip(&inside) {
            *sample = if *inside > 0.0 { sample.clamp(0.0, 1.0) } else { self.outside as f32 };
        }
        Ok(())
    }

    fn cost(&self) -> f64 {
        30.0
    }

    fn cost_in_rows(&self) -> f64 {
        9.0
    }

    fn memory(&self) -> u64 {
        self.path.0.ground().map_or(0, |picture| picture.memory())
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        Lowering::Processor("pictures are interpolated in f64")
    }
}
