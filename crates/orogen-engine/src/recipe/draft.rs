//! Drafts of recipes: the same world, sooner and coarser.

use super::document::Recipe;
use orogen_ops::declare::Shape;
use orogen_ops::declare::spec::Locality;
use orogen_ops::value::Value;

/// The parameter with the cell size of a solver's own solution.
const CELL: &str = "cell";

/// The parameter with the number of time steps of a solver.
const STEPS: &str = "steps";

/// The fewest steps of a draft: with fewer, erosion by an implicit scheme loses its shape.
const FEWEST_STEPS: f64 = 8.0;

impl Recipe {
    /// A draft: the same world with solvers at `coarser` times their cell and with a `coarser`-th of their time steps,
    /// at least 8. Fields, filters and levels do not change. Solvers take about `coarser` cubed times less work, so a
    /// draft is suited for a first picture while the recipe itself is solved. The terrain differs in detail: valleys
    /// are in other places.
    ///
    /// ```
    /// let recipe = orogen_engine::presets::find("alpine").ok_or("no such preset")?.recipe()?;
    /// let draft = recipe.draft(2);
    /// assert_eq!(draft.world.cell, 2.0 * recipe.world.cell);
    /// assert_eq!(recipe.draft(1), recipe);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn draft(&self, coarser: u32) -> Recipe {
        let factor = f64::from(coarser.max(1));
        let mut draft = self.clone();
        draft.world.cell *= factor;
        draft.change(|node| {
            let spec = node.spec();
            if spec.locality != Locality::Solver {
                return;
            }
            for (i, param) in spec.params.iter().enumerate() {
                let Some(value) = node.param(i).number() else { continue };
                let changed = match (param.name, param.shape) {
                    // 0 is the world's cell.
                    (CELL, Shape::Number) if value > 0.0 => Value::Number(value * factor),
                    (STEPS, Shape::Integer) if value > FEWEST_STEPS => {
                        Value::Integer((value / factor).ceil().max(FEWEST_STEPS) as i64)
                    }
                    _ => continue,
                };
                // A value outside of the parameter's range is rejected and stays as it is.
                let _ = node.set_param(i, &changed);
            }
        });
        draft
    }
}
