//! The texture of a file, without seam or repetition.

use super::positions::each;
use crate::declare::ExemplarFile;
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::exemplar::{Exemplar as Law, MIN_PATCH, MIN_SIDE, Texture};
use orogen_grid::words::{bytes_apart, number};
use orogen_io::dem::file_ref::FileKind;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// The texture of a DEM, of another layer or of a picture, without bounds, seam or repetition, exact at any
    /// position (Heitz and Neyret 2018).
    ///
    /// Random round patches of the file are blended on a lattice of triangles, so that the result has the histogram of
    /// the file. Supported are the files of `dem`, in metres as they are there, and gray pictures (.png), whose values
    /// are 0 to 1. Missing samples are filled as by `dem`. From a DEM the trend, which is longer than `wavelength`, is
    /// taken out first: the result has heights around 0, to be added to land.
    ///
    /// Forms larger than a patch are lost: there are no rivers, and hollows have no outlets. `breach`, `fill` or a
    /// short run of `stream-power` behind it drains the land. The file should show one kind of land; two kinds side by
    /// side become a mixture of both.
    pub struct Exemplar = "exemplar", field, revision 1;
    params {
        /// Path of the file. A relative path is resolved against the folder of the recipe.
        path: ExemplarFile = ExemplarFile::default();
        /// Band of a multi-band file, counted from 1. 0 stands for the only band of a single-band file.
        band: u32 = 0, range 0.0 to 65535.0;
        /// Seed of the positions of patches, hashed with the world's seed.
        seed: u64 = 0;
        /// Distance between the samples of the file in the world. With 0 it is the file's own, and 1 m for a picture.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
        /// Diameter of the patches in the world: 8 samples of the file up to 3/4 of its shorter side. Large patches
        /// keep more of the forms of the file, small ones repeat less. With 0 it is half of the shorter side.
        patch: f64 = 0.0, unit "m", range 0.0 to 1e9;
        /// Wavelength in the world above which the file is a trend that is taken out: a Gaussian halves waves of this
        /// length. With 0 it is a quarter of the shorter side of a DEM, and nothing is taken out of a picture.
        wavelength: f64 = 0.0, unit "m", range 0.0 to 1e9;
        /// Factor applied to the values.
        scale: f64 = 1.0, range -1e4 to 1e4;
        /// Whether patches are turned by quarter turns and mirrored, for textures without a direction.
        rotate: bool = false;
    }
    check |op| match op.path.file().is_empty() {
        true => Err(("path", "`path` is empty; write the path of a DEM, such as a .tif or .asc, or of a gray .png".to_string())),
        false => Ok(()),
    };
}

impl Exemplar {
    fn law(&self) -> Law {
        let ground = self.path.file().ground();
        let law = Law::default().with_cell(self.cell).with_patch(self.patch).with_rotate(self.rotate);
        let side = ground
            .map_or(0.0, |ground| ground.grid.width().min(ground.grid.height()) as f64 * law.cell_of(&ground.grid));
        law.with_wavelength(match (self.wavelength > 0.0, self.path.file().content()) {
            (true, _) => Some(self.wavelength),
            (false, FileKind::Picture) => None,
            (false, _) => Some(0.25 * side),
        })
    }

    /// Checks that the file is large enough for a texture, and that the texture fits into `left` bytes. Gives its
    /// memory.
    ///
    /// # Errors
    /// A message.
    #[doc(hidden)]
    pub fn check_file(&self, left: u64) -> std::result::Result<u64, String> {
        let file = self.path.file();
        let Some(ground) = file.ground() else { return Ok(0) };
        let (width, height) = (ground.grid.width(), ground.grid.height());
        let (name, side) = (file.path().display().to_string(), width.min(height));
        if side < MIN_SIDE {
            return Err(format!(
                "`{name}` has {width} x {height} samples; a texture needs at least {MIN_SIDE} x {MIN_SIDE}"
            ));
        }
        let law = self.law();
        let cell = law.cell_of(&ground.grid);
        let (least, most) = (MIN_PATCH * cell, Law::max_patch(side) * cell);
        if self.patch > 0.0 && !(least..=most).contains(&self.patch) {
            return Err(format!(
                "`patch` is {} m, but `{name}` has {width} x {height} samples of {} m: patches of {} to {} m fit into it",
                number(self.patch),
                number(cell),
                number(least),
                number(most)
            ));
        }
        let memory = Texture::memory(ground.grid.data().len());
        if memory > left {
            let [memory, left] = bytes_apart(memory, left);
            return Err(format!(
                "the texture of `{name}` needs {memory} of memory, and {left} are left; use a part of the file"
            ));
        }
        Ok(memory)
    }
}

impl Field for Exemplar {
    fn eval(&self, at: &Points, _: &Inputs, world_params: &WorldParams, out: &mut [f32]) -> Result<()> {
        // A world is not opened without its files. A plan that runs without a world has no values here.
        let Some(texture) = self.path.texture(self.law()) else {
            out.fill(f32::NAN);
            return Ok(());
        };
        let mut sampler = texture.sampler(world_params.seed_of(self.seed));
        let scale = self.scale as f32;
        each(at, out, |x, y| sampler.at(x, y) * scale);
        Ok(())
    }

    fn cost(&self) -> f64 {
        50.0
    }

    fn cost_in_rows(&self) -> f64 {
        45.0
    }

    fn memory(&self) -> u64 {
        let ground = self.path.file().ground();
        ground.map_or(0, |ground| ground.memory() + Texture::memory(ground.grid.data().len()))
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        Lowering::Processor("patches of files are blended")
    }
}
