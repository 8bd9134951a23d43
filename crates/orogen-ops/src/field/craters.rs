//! Impact craters.

use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::craters::{Cratered, Craters as Law, MAX_RATIO};
use orogen_grid::error::Result;
use orogen_grid::resample::NOWHERE;
use orogen_grid::words::number;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// Impact craters: heights in metres over the ground, to be added to it, without bounds and exact at any position.
    ///
    /// Craters are scattered at random, N = 1.54 `density` / L^2 (L / D)^`exponent` of a diameter D and larger for each
    /// square metre, where L is the largest diameter. Simple craters are bowls 0.196 D deep with a rim of 0.036 D;
    /// ejecta thin with the cube of the distance (McGetchin and others 1973). From the `transition` on, craters have
    /// flat floors, terraces and central peaks, and their depth grows with D^0.301 (Pike 1977).
    ///
    /// Craters have ages between that of the surface and 0, and are worn by diffusion (Fassett and Thomson 2014): small
    /// ones vanish first. They are laid in the order of their ages. A crater replaces the relief of older ones up to
    /// its size in its bowl, and buries small ones with its ejecta.
    pub struct Craters = "craters", field, revision 1;
    params {
        /// Seed of the node, hashed with the world's seed.
        seed: u64 = 0;
        /// Minimum and maximum diameter. The maximum is at most 65536 times the minimum.
        diameters: [f64; 2] = [200.0, 20000.0], unit "m", range 1e-3 to 1e7;
        /// Exponent of the number of craters of a diameter and larger: 2 in old land, where new craters remove as many
        /// as they add, about 3 in young land.
        exponent: f64 = 2.0, range 1.0 to 4.0;
        /// Number of the largest craters, as a share of geometric saturation, at which rims touch everywhere. At most
        /// 0.3 is reached, also by small craters.
        density: f64 = 0.06, range 0.0 to 1.0;
        /// Diameter from which craters are complex: about 15 km on the Moon, 10 km on Mercury, 6 km on Mars, 3 km on
        /// Earth.
        transition: f64 = 15000.0, unit "m", range 1.0 to 1e7;
        /// Diffusivity of the ground times the age of the surface, for a crater of 1 km: about 20 000 m^2 for 3 billion
        /// years on the Moon. It grows with D^0.9. 0 keeps all craters fresh.
        diffusion: f64 = 20000.0, unit "m^2", range 0.0 to 1e12;
    }
    layers {
        /// Height over the ground before.
        height: height, unit "m";
        /// Share of older fine relief that craters replaced: 1 in bowls, 0 where there are none.
        resurfaced: height;
        /// Share of bright young ejecta: 1 in the youngest craters, falling with the distance and the age.
        ejecta: height;
    }
    check |op| match op.diameters {
        [least, most] if least >= most => Err((
            "diameters",
            format!("the first of `diameters` ({}) must be less than the second ({})", number(least), number(most)),
        )),
        [least, most] if most / least > MAX_RATIO => Err((
            "diameters",
            format!("the largest of `diameters` is {} times the smallest; at most {MAX_RATIO} are allowed. Add a second `craters` node for the small ones", number(most / least)),
        )),
        _ => Ok(()),
    };
}

/// The layers by their index.
const HEIGHT: usize = 0;
const RESURFACED: usize = 1;

/// Samples along the sides of a tile of a lattice whose craters are found together.
const TILE: usize = 32;

impl Craters {
    fn law(&self, world_params: &WorldParams) -> Law {
        Law::default()
            .with_diameters(self.diameters)
            .with_exponent(self.exponent)
            .with_density(self.density)
            .with_transition(self.transition)
            .with_diffusion(self.diffusion)
            .with_seed(world_params.seed_of(self.seed))
    }

    /// Number of classes of diameters.
    fn classes(&self) -> f64 {
        2.0 * libm::log2(self.diameters[1] / self.diameters[0])
    }
}

impl Field for Craters {
    fn eval_layer(
        &self,
        layer: usize,
        at: &Points,
        _: &Inputs,
        world_params: &WorldParams,
        out: &mut [f32],
    ) -> Result<()> {
        let craters = self.law(world_params).prepare();
        let mut take = |k: usize, ground: Cratered| {
            out[k] = match layer {
                HEIGHT => ground.height,
                RESURFACED => ground.resurfaced,
                _ => ground.ejecta,
            } as f32;
        };
        match *at {
            Points::Lattice { xs, ys } => {
                for (row, tile_ys) in ys.chunks(TILE).enumerate() {
                    for (column, tile_xs) in xs.chunks(TILE).enumerate() {
                        let first = row * TILE * xs.len() + column * TILE;
                        let positions = tile_ys.iter().enumerate().flat_map(|(j, y)| {
                            tile_xs.iter().enumerate().map(move |(i, x)| (first + j * xs.len() + i, [*x, *y]))
                        });
                        craters.each(positions, &mut take);
                    }
                }
            }
            _ => {
                let positions = (0..at.len()).map(|k| {
                    let (x, y) = at.position(k).unwrap_or(NOWHERE);
                    (k, [x, y])
                });
                craters.each(positions, take);
            }
        }
        Ok(())
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        Lowering::Processor("craters are laid in the order of their ages")
    }

    fn cost(&self) -> f64 {
        100.0 + 60.0 * self.classes()
    }

    fn cost_in_rows(&self) -> f64 {
        self.cost()
    }
}
