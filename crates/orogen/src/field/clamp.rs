//! Cutting values off.

use crate::expression::function::Function;
use crate::expression::term::Term;
use crate::op::Field;

op! {
    /// The source, cut off below `low` and above `high`.
    pub struct Clamp = "clamp", field, revision 1;
    inputs {
        /// What is cut.
        source: required,
    }
    params {
        /// Lowest value left, in the source's unit.
        low: f64 = 0.0, range -1e9 to 1e9;
        /// Highest value left, in the source's unit.
        high: f64 = 1.0, range -1e9 to 1e9;
    }
    check |op| match op.low <= op.high {
        true => Ok(()),
        false => Err(("low", format!("`low` ({}) must not be above `high` ({})", op.low, op.high))),
    };
}

impl Field for Clamp {
    fn terms(&self) -> Option<Vec<Term>> {
        let ends = [self.low, self.high].map(Term::Number);
        Some(vec![Term::Name(0), ends[0], ends[1], Term::Apply(Function::Clamp, [0, 1, 2])])
    }
}
