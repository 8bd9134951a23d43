//! Limits values to a range.

use crate::expression::function::Function;
use crate::expression::term::Term;
use crate::op::Field;

op! {
    /// The source limited to the range from `low` to `high`: lower values become `low`, higher values become `high`.
    pub struct Clamp = "clamp", field, revision 1;
    inputs {
        /// The values to limit.
        source: required,
    }
    params {
        /// Lower limit, in the source's unit.
        low: f64 = 0.0, range -1e9 to 1e9;
        /// Upper limit, in the source's unit.
        high: f64 = 1.0, range -1e9 to 1e9;
    }
    check |op| match op.low <= op.high {
        true => Ok(()),
        false => Err(("low", format!("`low` ({}) must not be greater than `high` ({})", op.low, op.high))),
    };
}

impl Field for Clamp {
    fn terms(&self) -> Option<Vec<Term>> {
        let ends = [self.low, self.high].map(Term::Number);
        Some(vec![Term::Name(0), ends[0], ends[1], Term::Apply(Function::Clamp, [0, 1, 2])])
    }
}
