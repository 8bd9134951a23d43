//! The test of [`Law::Altitudes`].

use super::case::Case;
use super::check::Laws;
use super::forced::at_level;
use super::law::{Law, Verdict, Violation};
use super::recipes::{NODE, output_of, unsoftened, world_of};
use crate::world::sampler::Sampler;
use crate::world::volume::Volume;
use orogen_grid::grid::{Grid, Window};
use orogen_noise::Level;
use orogen_ops::declare::{Input, VERTICAL};
use orogen_ops::op::Op;
use orogen_ops::value::Value;

impl Laws<'_> {
    /// [`Law::Altitudes`], for a field that may read nodes that depend on the altitude. Where the op, its inputs and
    /// its mask are noises, they are noises in space. It forces SIMD levels for the whole process and restores the
    /// previous one at the end.
    ///
    /// # Errors
    /// The first difference.
    pub fn altitudes(&self, cell: f64) -> Verdict {
        match self.node.op() {
            Op::Field(field) if field.source_cell(cell, cell).is_none() => {}
            _ => return Ok(()),
        }
        let mut recipe = unsoftened(&(self.recipe)(world_of(cell), true));
        let mut refused = None;
        recipe.change(|node| {
            if let Some(param) = node.spec().params.iter().position(|param| param.name == VERTICAL) {
                refused = refused.take().or(node.set_param(param, &Value::Number(0.6)).err());
            }
        });
        for layer in self.node.layers().iter().skip(1) {
            recipe.output(output_of(layer), Input::Node(format!("{NODE}.{}", layer.name)));
        }
        let (window, part) = (Window::new(43, 31, cell).at(11, 20), Window::new(17, 9, cell).at(34, 25));
        let case = self.case(Law::Altitudes).in_window(window);
        if let Some(message) = refused {
            return case.breaks(message);
        }
        let altitudes = [-2.5, 0.0, 0.1, 7.3, 1e5].map(|cells| cells * cell);
        let (world, other) = (case.open(&recipe, 2)?, case.open(&recipe, 1)?);
        for layer in recipe.outputs() {
            let whole = slices(&case, &case.of(world.volume(layer, &window, &altitudes))?)?;
            case.same(
                &format!("layer `{layer}`, at altitude 0 and in the plane"),
                &whole[1],
                &case.of(other.window(layer, &window))?,
            )?;
            let same = |what: &str, order: &[usize], volume: &Volume| {
                slices(&case, volume)?.iter().zip(order).try_for_each(|(slice, &k)| {
                    case.same(&format!("layer `{layer}` at altitude {}, {what}", altitudes[k]), &whole[k], slice)
                })
            };
            // Fewer altitudes, in another order, in a part of the window.
            let order = [3, 0, 4];
            let few = order.map(|k| altitudes[k]);
            same("the whole and a part", &order, &case.of(other.volume(layer, &part, &few))?)?;
            let sampler = case.of(Sampler::new(&other, layer))?;
            same("the whole and a sampler", &order, &case.of(sampler.volume(&part, &few))?)?;
            let before = Level::current();
            for level in Level::available() {
                let made = at_level(level, || other.volume(layer, &part, &altitudes));
                let made = made.map_err(|error| case.violation(error.to_string()))?;
                same(&format!("{before:?} and {level:?}"), &[0, 1, 2, 3, 4], &case.of(made)?)?;
            }
        }
        Ok(())
    }
}

/// The slices of a volume as grids.
fn slices(case: &Case, volume: &Volume) -> Result<Vec<Grid>, Violation> {
    (0..volume.altitudes().len())
        .map(|k| Grid::from_data(*volume.window(), volume.slice(k).to_vec()))
        .collect::<Option<_>>()
        .ok_or_else(|| case.violation("a volume does not have the samples of its window at each altitude".to_string()))
}
