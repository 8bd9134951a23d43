//! Values of the command line over generated texts: valid texts are parsed to the intended value, and other texts are
//! refused. The cases are the same in every run.

use crate::values::bytes::Bytes;
use crate::values::number;
use crate::values::region;
use crate::values::seeds;
use orogen::export::targets::job::EngineJob;
use orogen::fit::FitJob;
use orogen::jobs::noise::NoiseJob;
use orogen::jobs::refine::RefineJob;
use orogen::jobs::{AnalyzeJob, GrowJob, MapJob, RenderJob};
use orogen::options::{OptionSpec, Options};
use orogen::output::sheet::paper::Paper;
use orogen::view::{Bounds, MAX_SIDE, Rectangle, Size};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseResult, TestRng, TestRunner};
use std::fmt::Debug;

fn check<S: Strategy>(cases: u32, strategy: S, test: impl Fn(S::Value) -> TestCaseResult)
where
    S::Value: Debug,
{
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    TestRunner::new_with_rng(config, rng).run(&strategy, test).unwrap_or_else(|failure| panic!("{failure}"));
}

/// The declared options of jobs.
fn declared() -> impl Iterator<Item = &'static OptionSpec> {
    let drawn = [MapJob::OPTIONS, RenderJob::OPTIONS, NoiseJob::OPTIONS, GrowJob::OPTIONS];
    let others = [AnalyzeJob::OPTIONS, FitJob::OPTIONS, EngineJob::OPTIONS, RefineJob::OPTIONS];
    drawn.into_iter().chain(others).flatten()
}

/// The options with this value; `None` if it is not valid.
fn given(name: &str, text: &str) -> Option<Options> {
    let mut options = Options::default();
    options.give(declared().find(|spec| spec.name == name)?, text).ok()?;
    Some(options)
}

/// Finite numbers, in the notations of people and programs.
fn number() -> impl Strategy<Value = (f64, String)> {
    let plain = any::<f64>().prop_filter("finite", |number| number.is_finite());
    (prop_oneof![plain, -1e6..1e6f64], any::<bool>(), " {0,2}").prop_map(|(number, exponent, blanks)| {
        let text = if exponent { format!("{blanks}{number:e}") } else { format!("{number}{blanks}") };
        (number, text)
    })
}

#[test]
fn numbers_are_read_as_they_are_written() {
    check(2000, number(), |(value, text)| {
        prop_assert_eq!(number::finite(&text), Ok(value));
        let number = |name: &str| given(name, &text).and_then(|options| options.number(name));
        prop_assert_eq!(number("gain"), Some(value));
        prop_assert_eq!(number("wavelength"), Some(value).filter(|value| *value > 0.0));
        prop_assert_eq!(number("strength"), Some(value).filter(|value| *value >= 0.0));
        prop_assert_eq!(number::cell(&text).ok(), Some(value).filter(|value| (1e-6..=1e12).contains(value)));
        Ok(())
    });
    check(500, proptest::collection::vec(number(), 1..5), |numbers| {
        let text: Vec<&str> = numbers.iter().map(|(_, text)| text.as_str()).collect();
        let values: Vec<f64> = numbers.iter().map(|(value, _)| *value).collect();
        let read = given("levels", &text.join(",")).and_then(|options| options.numbers("levels").map(<[f64]>::to_vec));
        prop_assert_eq!(read, Some(values));
        prop_assert!(given("levels", &(text.join(",") + ",")).is_none());
        Ok(())
    });
}

#[test]
fn sizes_seeds_and_times_are_read_as_they_are_written() {
    let side = || prop_oneof![1u64..5000, 1..=MAX_SIDE, Just(0), MAX_SIDE..=u64::MAX];
    check(1000, (side(), side(), prop_oneof![Just('x'), Just('X'), Just('×')]), |(width, height, sign)| {
        let [valid_width, valid_height] = [width, height].map(|side| (1..=MAX_SIDE).contains(&side));
        let longer = Some(Size::Longer(width as usize)).filter(|_| valid_width);
        prop_assert_eq!(width.to_string().parse::<Size>().ok(), longer);
        let both = Some(Size::Both(width as usize, height as usize)).filter(|_| valid_width && valid_height);
        prop_assert_eq!(format!("{width}{sign} {height}").parse::<Size>().ok(), both);
        prop_assert_eq!(number::seed(&width.to_string()).ok(), Some(width).filter(|seed| *seed <= i64::MAX as u64));
        Ok(())
    });
    check(500, (0u32..30, 0u32..70), |(hour, minute)| {
        let time = given("time", &format!("{hour}:{minute:02}")).and_then(|options| options.number("time"));
        let expected = (hour < 24 && minute < 60).then_some(f64::from(hour) + f64::from(minute) / 60.0);
        prop_assert_eq!(time, expected);
        Ok(())
    });
    let range = (0u64..50, 0u64..50, any::<bool>());
    check(500, proptest::collection::vec(range, 1..4), |ranges| {
        let text: Vec<String> = ranges
            .iter()
            .map(|(first, count, whole)| if *whole { format!("{first}..{}", first + count) } else { first.to_string() })
            .collect();
        let all: Vec<u64> =
            ranges.iter().flat_map(|(first, count, whole)| *first..=first + if *whole { *count } else { 0 }).collect();
        let distinct: std::collections::BTreeSet<&u64> = all.iter().collect();
        let seeds = text.join(",").parse::<seeds::Seeds>();
        prop_assert_eq!(seeds.is_ok(), distinct.len() == all.len(), "{:?}", text);
        if let Ok(seeds) = seeds {
            prop_assert_eq!(seeds.first(), all[0]);
        }
        Ok(())
    });
}

#[test]
fn amounts_of_memory_are_read_in_their_units() {
    let units =
        [("", 1.0), ("B", 1.0), ("KiB", 1024.0), ("MB", 1e6), ("MiB", 1048576.0), ("g", 1073741824.0), ("TB", 1e12)];
    check(
        1000,
        (0u64..100_000, 0u32..10, proptest::sample::select(units.to_vec()), " {0,1}"),
        |(whole, tenth, unit, blank)| {
            let text = format!("{whole}.{tenth}{blank}{}", unit.0);
            let bytes = format!("{whole}.{tenth}").parse::<f64>().unwrap() * unit.1;
            prop_assert_eq!(text.parse::<Bytes>().ok(), (bytes >= 1.0).then_some(Bytes(bytes as u64)), "{}", text);
            let negative = format!("-{text}");
            prop_assert!(negative.parse::<Bytes>().is_err());
            Ok(())
        },
    );
}

#[test]
fn windows_are_read_in_samples_and_in_metres() {
    let corner = prop_oneof![-1000i64..1000, any::<i64>()];
    check(1000, (corner.clone(), corner, 0u64..3000, 1u64..3000), |(x, y, width, height)| {
        let read = format!("{x}, {y},{width},{height}").parse::<Rectangle>().ok();
        let near = |at: i64| (-(1i64 << 52)..=1 << 52).contains(&at);
        let expected =
            (near(x) && near(y) && width > 0).then_some(Rectangle::Samples(x, y, width as usize, height as usize));
        prop_assert_eq!(read, expected);
        let (x, y) = (x % 1_000_000, y % 1_000_000);
        let read = format!("{x}m,{y}km,{width}m,{height}.5km").parse::<Rectangle>().ok();
        let metres = [x as f64, y as f64 * 1000.0, width as f64, (height as f64 + 0.5) * 1000.0];
        prop_assert_eq!(read, (width > 0).then_some(Rectangle::Metres(metres)));
        let mixed = format!("{x}m,{y},{width},{height}");
        prop_assert!(mixed.parse::<Rectangle>().is_err());
        Ok(())
    });
    check(500, (number(), number(), number(), number()), |(west, south, east, north)| {
        let text = [&west.1, &south.1, &east.1, &north.1].map(String::as_str).join(",");
        let read = text.parse::<Bounds>();
        prop_assert_eq!(read.is_ok(), west.0 < east.0 && south.0 < north.0, "{}", text);
        prop_assert_eq!(region::place(&format!("{},{}", west.1, south.1)), Ok([west.0, south.0]));
        Ok(())
    });
}

#[test]
fn papers_are_read_in_millimetres() {
    check(500, (1u32..3000, 1u32..3000), |(width, height)| {
        let read = format!("{width}x{height}mm").parse::<Paper>().ok().map(|paper| paper.sides(false));
        let fits = [width, height].iter().all(|side| (50..=2000).contains(side));
        prop_assert_eq!(read, fits.then_some([f64::from(width), f64::from(height)]));
        Ok(())
    });
}

/// Any text gives a value or a message about the text.
#[test]
fn other_texts_are_refused_with_a_message() {
    check(3000, "[-+0-9.,:;xX× a-zA-Zé%=#\u{0}]{0,16}", |text| {
        let declared = declared().map(|spec| spec.check(&text).err());
        let messages = [
            text.parse::<Size>().err(),
            number::seed(&text).err(),
            text.parse::<Bytes>().err(),
            text.parse::<Rectangle>().err(),
            text.parse::<Bounds>().err(),
            text.parse::<seeds::Seeds>().err(),
            text.parse::<Paper>().err(),
            region::place(&text).err(),
        ];
        prop_assert!(
            messages.into_iter().chain(declared).flatten().all(|message| message.len() > 10 && !message.ends_with('.'))
        );
        Ok(())
    });
}
