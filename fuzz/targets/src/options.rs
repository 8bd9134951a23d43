//! Texts of the command line: any text is a value or refused with a message, and values are within their bounds.

use crate::values::bytes::Bytes;
use crate::values::number;
use crate::values::region;
use crate::values::{arguments, seeds};
use clap::{Args, Command, FromArgMatches};
use orogen::builder::BuildSpec;
use orogen::export::derived::list;
use orogen::export::registry;
use orogen::export::targets::job::EngineJob;
use orogen::expression::Expression;
use orogen::fit::FitJob;
use orogen::io::format::crs::Crs;
use orogen::io::palette::names;
use orogen::jobs::noise::NoiseJob;
use orogen::jobs::refine::RefineJob;
use orogen::jobs::variants::VariantsJob;
use orogen::jobs::{AnalyzeJob, BlocksJob, GrowJob, MapJob, RenderJob};
use orogen::options::Options;
use orogen::output::sheet::paper;
use orogen::tilemap::TilemapJob;
use orogen::view::{Bounds, MAX_SIDE, Rectangle, Size};

/// Runs the target on an input; one that is no text is skipped.
pub fn run(input: &[u8]) {
    let Ok(text) = std::str::from_utf8(input) else { return };
    if let Ok(size) = text.parse::<Size>() {
        let sides = match size {
            Size::Longer(side) => [side, side],
            Size::Both(width, height) => [width, height],
        };
        assert!(sides.iter().all(|side| (1..=MAX_SIDE as usize).contains(side)), "{text}");
    }
    assert!(!number::seed(text).is_ok_and(|seed| seed > i64::MAX as u64), "{text}");
    assert!(!number::cell(text).is_ok_and(|number| !number.is_finite() || number <= 0.0), "{text}");
    assert!(!number::finite(text).is_ok_and(|number| !number.is_finite()), "{text}");
    assert!(!number::kilometres(text).is_ok_and(|number| !(1.0..=40_000.0).contains(&number)), "{text}");
    assert!(!text.parse::<Bytes>().is_ok_and(|bytes| bytes.0 == 0), "{text}");
    if let Ok(paper) = text.parse::<paper::Paper>() {
        let [width, height] = paper.sides(true);
        assert!(width >= height && height >= 50.0 && width <= 2000.0, "{text}");
    }
    match text.parse::<Rectangle>() {
        Ok(Rectangle::Samples(x, y, width, height)) => {
            assert!(x.abs() <= 1 << 52 && y.abs() <= 1 << 52 && width >= 1 && height >= 1, "{text}");
        }
        Ok(Rectangle::Metres(numbers)) => {
            assert!(numbers.iter().all(|number| number.is_finite()) && numbers[2] > 0.0 && numbers[3] > 0.0, "{text}");
        }
        Err(_) => {}
    }
    if let Ok(bounds) = text.parse::<Bounds>() {
        assert!(bounds.west < bounds.east && bounds.south < bounds.north, "{text}");
    }
    let _ = (region::place(text), text.parse::<seeds::Seeds>());
    let command = arguments::Arguments::augment_args(Command::new("it").no_binary_name(true));
    let given = command.try_get_matches_from(["--set", text]);
    if let Ok(given) = given.and_then(|matches| arguments::Arguments::from_arg_matches(&matches)) {
        assert!(given.values().iter().all(|(_, value)| value.is_finite()), "{text}");
    }
    let _ = (names::named(text), names::hexadecimal(text));
    if let Ok(crs) = text.parse::<Crs>() {
        assert_eq!(format!("EPSG:{}", crs.code()).parse::<Crs>(), Ok(crs));
    }
    let expression = Expression::from(text);
    if expression.error().is_none() {
        let values = vec![0.5; expression.names().len()];
        assert!(expression.value(&values).is_some(), "{text}");
    }
    let of_files = registry::options().into_iter().map(|(spec, _)| spec);
    let of_layers = list::options().into_iter().map(|(spec, _)| spec);
    let of_jobs = [MapJob::OPTIONS, RenderJob::OPTIONS, TilemapJob::OPTIONS, BlocksJob::OPTIONS].into_iter().flatten();
    let of_pictures =
        [NoiseJob::OPTIONS, VariantsJob::OPTIONS, GrowJob::OPTIONS, RefineJob::OPTIONS].into_iter().flatten();
    let of_others =
        [BuildSpec::OPTIONS, EngineJob::OPTIONS, AnalyzeJob::OPTIONS, FitJob::OPTIONS].into_iter().flatten();
    let mut options = Options::default();
    for spec in of_files.chain(of_layers) {
        let _ = options.give(spec, text);
    }
    let mut options = Options::default();
    for spec in of_jobs {
        let _ = options.give(spec, text);
    }
    let mut of_own = Options::default();
    for spec in of_pictures.chain(of_others) {
        let _ = of_own.give(spec, text);
    }
    assert!(options.number("time").is_none_or(|hours| (0.0..24.0).contains(&hours)), "{text}");
    assert!(options.numbers("levels").is_none_or(|numbers| numbers.iter().all(|number| number.is_finite())), "{text}");
}
