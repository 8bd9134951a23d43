//! Strata of rock as a parameter.

use super::param::{Param, read_param};
use super::spec::{ParamSpec, Shape, TableSpec};
use super::tables::{self, Problem, shortest};
use crate::value::{Spanned, Value};
pub use orogen_grid::strata::Strata;
use orogen_grid::strata::Stratum;

/// Maximum number of strata of a parameter.
const MAX_STRATA: usize = 1000;

/// The form of a stratum, and what to do about too many, for messages.
const FORM: [&str; 2] =
    ["{ thickness = 100, erodibility_factor = 0.2 }", "set `repeat_strata` to repeat a shorter sequence"];

/// The keys of a stratum, in the order of its values.
const KEYS: &[ParamSpec; 3] = &[
    ParamSpec { name: "thickness", alias: "", doc: "Thickness.", unit: "m", shape: Shape::Number, range: [0.1, 1e6] },
    ParamSpec {
        name: "erodibility_factor",
        alias: "",
        doc: "Factor of the erodibility, smaller where rock is harder.",
        unit: "",
        shape: Shape::Number,
        range: [1e-3, 1e3],
    },
    ParamSpec {
        name: "talus_angle",
        alias: "",
        doc: "Maximum stable slope; 0: that of the node.",
        unit: "deg",
        shape: Shape::Number,
        range: [0.0, 89.0],
    },
];

/// The declaration of a stratum.
static STRATUM: TableSpec = TableSpec {
    names: ["stratum", "strata"],
    keys: KEYS,
    required: 1,
    defaults: || values(&Stratum::default()).map(shortest).into(),
    max: MAX_STRATA,
    problem: |name, value| read(name, value).err(),
};

/// The values of the keys of a stratum.
fn values(stratum: &Stratum) -> [f64; 3] {
    [stratum.thickness, stratum.erodibility_factor, stratum.talus_angle]
}

/// Reads strata; an error has the position of the part that is wrong.
fn read(name: &str, value: &Value) -> Result<Vec<Stratum>, Problem> {
    let items = tables::items(&STRATUM, FORM, name, value)?;
    items.iter().enumerate().map(|(k, item)| stratum(name, k + 1, item)).collect()
}

/// Reads the stratum of this number.
fn stratum(name: &str, number: usize, item: &Spanned<Value>) -> Result<Stratum, Problem> {
    let mut stratum = Stratum::default();
    tables::table(&STRATUM, FORM[0], name, number, item, |k, spec, value| {
        let key = match k {
            0 => &mut stratum.thickness,
            1 => &mut stratum.erodibility_factor,
            _ => &mut stratum.talus_angle,
        };
        let read = read_param(spec, &value.value).map(|value| *key = value);
        read.map_err(|message| tables::refused(&STRATUM, name, number, value, &message))
    })?;
    Ok(stratum)
}

impl Param for Vec<Stratum> {
    const SHAPE: Shape = Shape::Tables(&STRATUM);

    fn read(value: &Value) -> Option<Vec<Stratum>> {
        read("", value).ok()
    }

    fn write(&self) -> Value {
        let table = |stratum: &Stratum| {
            let entries = KEYS.iter().zip(values(stratum));
            let entry = |(key, value): (&ParamSpec, f64)| {
                (Spanned::unplaced(key.name.to_string()), Spanned::unplaced(shortest(value)))
            };
            Value::Table(entries.map(entry).collect())
        };
        Value::List(self.iter().map(|stratum| Spanned::unplaced(table(stratum))).collect())
    }

    fn within(&self, _: [f64; 2]) -> bool {
        self.len() <= MAX_STRATA
            && self.iter().all(|stratum| KEYS.iter().zip(values(stratum)).all(|(key, value)| value.within(key.range)))
    }
}
