//! The stratum that is exposed at the surface.

use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// The stratum that is exposed at the surface, for colors, masks and the erodibility of other ops.
    ///
    /// Give it the heights, `bedding` and `strata` of the op that eroded them. With the height of a surface at depth as
    /// the source it is a geological map at that depth.
    pub struct Outcrop = "outcrop", field, revision 1;
    strata;
    inputs {
        /// The heights.
        source: required,
    }
    layers {
        /// Number of the stratum from the top down, from 1; 0 without strata and where a height is missing.
        stratum: label;
        /// Its erodibility factor; 1 where there is none.
        erodibility_factor: label;
    }
}

impl Field for Outcrop {
    fn eval_layer(&self, layer: usize, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        let heights = inputs.required("source")?;
        let tops = inputs.get("bedding");
        // Talus angles are not read.
        let strata = self.prepared_strata(1.0);
        for (k, (sample, height)) in out.iter_mut().zip(heights).enumerate() {
            let top = tops.and_then(|tops| tops.get(k)).map_or(0.0, |top| f64::from(*top));
            let above = f64::from(*height) - top;
            let strata = strata.as_ref().filter(|_| above.is_finite());
            let stratum = strata.map(|strata| strata.index(above + strata.thickness()));
            *sample = match layer {
                0 => stratum.map_or(0.0, |stratum| (stratum + 1) as f32),
                _ => {
                    let stratum = stratum.and_then(|stratum| self.strata.get(stratum));
                    stratum.map_or(1.0, |stratum| stratum.erodibility_factor as f32)
                }
            };
        }
        Ok(())
    }

    fn cost(&self) -> f64 {
        6.0
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        Lowering::Processor("heights are compared with strata in f64")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::declare::{Declared, Stratum};

    #[test]
    fn strata_are_numbered_from_the_top() {
        let stratum =
            |thickness: f64, erodibility_factor: f64| Stratum { thickness, erodibility_factor, ..Stratum::default() };
        let once = Outcrop { strata: vec![stratum(30.0, 1.0), stratum(10.0, 0.1)], ..Outcrop::default() };
        let heights = [495.0, 75.0, 69.0, 61.0, 59.0, -40.0, f32::NAN];
        let read = |op: &Outcrop, layer: usize| {
            let mut out = [0.0; 7];
            let slots = [Some(&heights[..]), Some(&[100.0; 7][..])];
            let params = WorldParams { seed: 1, size: None, cell: 1.0, sea_level: 0.0 };
            let at = Points::Lattice { xs: &[0.0; 7], ys: &[0.0] };
            op.eval_layer(layer, &at, &Inputs::new(op.spec(), &slots), &params, &mut out).unwrap();
            out
        };
        assert_eq!(read(&once, 0), [1.0, 1.0, 2.0, 2.0, 2.0, 2.0, 0.0]);
        assert_eq!(read(&once, 1), [1.0, 1.0, 0.1, 0.1, 0.1, 0.1, 1.0]);
        let again = Outcrop { repeat_strata: true, ..once };
        assert_eq!(read(&again, 0), [1.0, 1.0, 2.0, 2.0, 1.0, 1.0, 0.0]);
        assert_eq!(read(&Outcrop::default(), 0), [0.0; 7]);
    }
}
