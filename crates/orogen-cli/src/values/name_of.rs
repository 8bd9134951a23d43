//! Values that are names of declared items: formats, noises.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use orogen::export::{Format, registry};
use orogen::jobs::{BlockFormat, SheetFormat};
use orogen::noise::Basis;

/// A parser for a value that is one of several names, each with a line of help.
fn one_of<T: Copy + Send + Sync + 'static>(
    all: impl IntoIterator<Item = (PossibleValue, T)>,
) -> impl TypedValueParser<Value = T> {
    let all: Vec<(PossibleValue, T)> = all.into_iter().collect();
    let names: Vec<PossibleValue> = all.iter().map(|(name, _)| name.clone()).collect();
    PossibleValuesParser::new(names).try_map(move |text| {
        let found = all.iter().find(|(name, _)| name.matches(&text, false));
        found.map(|(_, value)| *value).ok_or("it is not known")
    })
}

fn named(name: &'static str, about: &'static str) -> PossibleValue {
    PossibleValue::new(name).help(about)
}

/// The noise bases.
pub fn basis() -> impl TypedValueParser<Value = Basis> {
    one_of(Basis::all().iter().map(|basis| (PossibleValue::new(basis.name()), *basis)))
}

/// The formats of layers.
pub fn format() -> impl TypedValueParser<Value = &'static Format> {
    one_of(registry::all().iter().map(|format| (named(format.name, format.about).aliases(format.aliases), *format)))
}

/// The formats of map sheets.
pub fn sheet() -> impl TypedValueParser<Value = SheetFormat> {
    one_of(SheetFormat::ALL.map(|format| (named(format.name(), format.about()), format)))
}

/// The formats of blocks.
pub fn blocks() -> impl TypedValueParser<Value = BlockFormat> {
    one_of(BlockFormat::ALL.map(|format| (named(format.name(), format.about()), format)))
}
