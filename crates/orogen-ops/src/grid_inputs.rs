//! The inputs of filters and levelled ops.

use crate::declare::Spec;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Grid;

/// The grids of a node's inputs, by the names of its declaration.
#[derive(Clone, Copy)]
pub struct GridInputs<'a> {
    spec: &'static Spec,
    grids: &'a [Option<&'a Grid>],
}

impl<'a> GridInputs<'a> {
    /// Inputs in the order of their declaration; `None` for those that are not given.
    #[must_use]
    pub fn new(spec: &'static Spec, grids: &'a [Option<&'a Grid>]) -> GridInputs<'a> {
        GridInputs { spec, grids }
    }

    /// The input with this name, if it is given.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&'a Grid> {
        let i = self.spec.inputs.iter().position(|input| input.name == name)?;
        self.grids.get(i).copied().flatten()
    }

    /// The input with this name, which must be declared as required.
    ///
    /// # Errors
    /// If it is not given, or not declared: an internal error, because plans always provide it.
    pub fn required(&self, name: &str) -> Result<&'a Grid> {
        let missing =
            || Error::new(ErrorKind::Internal, format!("the input `{name}` of `{}` is missing", self.spec.op));
        self.get(name).ok_or_else(missing)
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
    use crate::filter::LocalStreamPower;
    use orogen_grid::grid::Window;

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
}
