//! The inputs of ops, by name.

use crate::declare::Spec;
use orogen_grid::error::Result;
use orogen_grid::grid::Grid;

/// A node's inputs evaluated at the requested points: one block of samples each, by the names of its declaration. All
/// points have the same altitude.
pub struct Inputs<'a> {
    spec: &'static Spec,
    pub(crate) slots: &'a [Option<&'a [f32]>],
    altitude: f64,
}

impl<'a> Inputs<'a> {
    /// Inputs in the order of their declaration, in the plane: at altitude 0.
    #[must_use]
    pub fn new(spec: &'static Spec, slots: &'a [Option<&'a [f32]>]) -> Inputs<'a> {
        Inputs { spec, slots, altitude: 0.0 }
    }

    /// The same inputs at an altitude in metres.
    #[must_use]
    pub fn with_altitude(self, altitude: f64) -> Inputs<'a> {
        Inputs { altitude, ..self }
    }

    /// The altitude of the points in metres: 0 in the plane. Only a field that [reads the
    /// altitude](crate::op::Field::reads_altitude) may use it.
    #[must_use]
    pub fn altitude(&self) -> f64 {
        self.altitude
    }

    /// The input with this name, if it is given.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&'a [f32]> {
        self.spec.given(name, self.slots)
    }

    /// The input with this name, which must be declared as required.
    ///
    /// # Errors
    /// If the input is not given or not declared. This is an internal error, because plans always provide required
    /// inputs.
    pub fn required(&self, name: &str) -> Result<&'a [f32]> {
        self.get(name).ok_or_else(|| self.spec.missing(name))
    }

    /// The source of a field with a [stencil](crate::op::Field::stencil), at its four positions east, west, south and
    /// north of each point.
    ///
    /// # Errors
    /// If the field has no stencil: an internal error.
    pub fn around(&self) -> Result<[&'a [f32]; 4]> {
        match self.slots.get(self.spec.inputs.len()..) {
            Some(&[Some(east), Some(west), Some(south), Some(north)]) => Ok([east, west, south, north]),
            _ => Err(self.spec.missing("source around the points")),
        }
    }
}

/// The grids of a node's inputs, by the names of its declaration.
#[derive(Clone, Copy)]
pub struct GridInputs<'a> {
    spec: &'static Spec,
    grids: &'a [Option<&'a Grid>],
}

impl<'a> GridInputs<'a> {
    /// Inputs in the order of their declaration; `None` for inputs that are not given.
    #[must_use]
    pub fn new(spec: &'static Spec, grids: &'a [Option<&'a Grid>]) -> GridInputs<'a> {
        GridInputs { spec, grids }
    }

    /// The input with this name, if it is given.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&'a Grid> {
        self.spec.given(name, self.grids)
    }

    /// The input with this name, which must be declared as required.
    ///
    /// # Errors
    /// If the input is not given or not declared. This is an internal error, because plans always provide required
    /// inputs.
    pub fn required(&self, name: &str) -> Result<&'a Grid> {
        self.get(name).ok_or_else(|| self.spec.missing(name))
    }

    /// The inputs in the order of their declaration.
    #[must_use]
    pub fn all(&self) -> &'a [Option<&'a Grid>] {
        self.grids
    }

    /// The same declaration with other grids.
    #[must_use]
    pub fn with<'b>(&self, grids: &'b [Option<&'b Grid>]) -> GridInputs<'b> {
        GridInputs { spec: self.spec, grids }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::declare::Declared;
    use crate::field::Gullies;
    use crate::filter::LocalStreamPower;
    use crate::op::{Field, WorldParams};
    use orogen_grid::error::ErrorKind;
    use orogen_grid::grid::Window;
    use orogen_noise::Points;

    #[test]
    fn inputs_are_found_by_name_and_a_missing_one_is_an_internal_error() {
        let op = LocalStreamPower::default();
        let grid = Grid::filled(Window::new(2, 1, 1.0), 3.0);
        let whole = [Some(&grid), None];
        let inputs = GridInputs::new(op.spec(), &whole);
        assert_eq!((inputs.required("source").unwrap(), inputs.get("source")), (&grid, Some(&grid)));
        assert_eq!((inputs.get("flow"), inputs.get("none")), (None, None));
        for (inputs, name) in [(inputs, "flow"), (inputs, "none"), (inputs.with(&[]), "source")] {
            let error = inputs.required(name).unwrap_err();
            let said = format!("the input `{name}` of `local-stream-power` is missing");
            assert_eq!((error.kind(), error.to_string()), (ErrorKind::Internal, said));
        }
    }

    #[test]
    fn fields_have_their_inputs_by_name_and_their_source_around_the_points() {
        let op = Gullies::default();
        let slots = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(|value| [value]);
        let slots: Vec<Option<&[f32]>> = slots.iter().map(|slot| Some(&slot[..])).collect();
        let inputs = Inputs::new(op.spec(), &slots);
        assert_eq!((inputs.required("source").unwrap(), inputs.get("fade")), (&[1.0][..], Some(&[2.0][..])));
        assert_eq!(inputs.around().unwrap(), [[3.0], [4.0], [5.0], [6.0]]);
        for (inputs, name) in [(&slots[..2], "source around the points"), (&[], "source")] {
            let world_params = WorldParams { seed: 0, size: None, cell: 1.0, sea_level: 0.0 };
            let at = Points::Scattered { x: &[0.0], y: &[0.0] };
            let error = op.eval(&at, &Inputs::new(op.spec(), inputs), &world_params, &mut [0.0]).unwrap_err();
            let said = format!("the input `{name}` of `gullies` is missing");
            assert_eq!((error.kind(), error.to_string()), (ErrorKind::Internal, said));
        }
    }
}
