//! Area `studio`: from a change of a parameter to the pictures of the studio, without the drawing of the window. Wall
//! time of all cores.

use std::sync::Arc;
use std::time::{Duration, Instant};

use orogen::{Options as SessionOptions, Recipe, Session, presets};
use orogen_studio::editing::document::Document;
use orogen_studio::editing::edit::Edit;
use orogen_studio::preview::frame::Quality;
use orogen_studio::preview::request::Request;
use orogen_studio::preview::worker::{Event, Worker};
use orogen_studio::studio::Studio;
use serde_json::{Value, json};

use crate::measure::median;
use crate::options::Options;
use crate::world::figure::{Figure, Target};

/// A preset, the text of a parameter in it, the text that varies there, and the maximum times to the first and to the
/// finest picture, in seconds.
const CASES: [(&str, &str, &str, [f64; 2]); 2] = [
    ("classic", "wavelength = 1024.0", "wavelength = ", [0.060, 0.5]),
    ("alpine", "default = 0.7", "default = ", [0.150, 3.5]),
];

/// Samples along a side of the finest picture.
const FINEST: usize = 1024;

/// Maximum time to wait for a picture.
const PATIENCE: Duration = Duration::from_secs(120);

/// Measures each case.
pub fn run(options: &Options) -> Result<Value, String> {
    let mut rows = Vec::new();
    for (preset, parameter, key, limits) in CASES.into_iter().filter(|(preset, ..)| preset.contains(&options.case)) {
        let text = presets::find(preset).ok_or("no such preset")?.text;
        let value: f64 = parameter.trim_start_matches(key).parse().map_err(|_| "the parameter is no number")?;
        let session = Session::new(SessionOptions::default()).map_err(|e| e.to_string())?;
        let mut worker = Worker::new(session, Arc::new(|| ()));
        let mut times: [Vec<f64>; 2] = Default::default();
        // For the first request nothing is kept yet, as when a recipe is opened.
        for k in 0..=options.repetitions {
            let changed = text.replacen(parameter, &format!("{key}{:?}", value * (1.0 + 0.01 * k as f64)), 1);
            let recipe = Recipe::parse(&changed, preset).map_err(|e| e.to_string())?;
            let [first, finest] = pictures(&mut worker, Request { finest: FINEST, ..Request::new(recipe) })?;
            if k > 0 {
                times[0].push(first);
                times[1].push(finest);
            }
        }
        let cases = [format!("{preset}: first picture, 256 x 256"), format!("{preset}: {FINEST} x {FINEST}")];
        for ((case, mut times), limit) in cases.into_iter().zip(times).zip(limits) {
            let target = Target::AtMost(limit);
            rows.push(Figure { case, ours: median(&mut times), unit: "s", other: None, target }.json());
        }
    }
    if "interface".contains(&options.case) {
        rows.push(interface()?);
    }
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    Ok(json!({ "area": "studio", "simd": orogen_simd::Level::current().name(), "threads": threads, "rows": rows }))
}

/// Number of nodes of the largest recipe.
const NODES: usize = 500;
/// Number of edits of each recipe.
const EDITS: u64 = 40;

/// Maximum time that the thread of the interface may be busy with work other than drawing, in seconds.
const BUSY: f64 = 0.016;

/// The maximum time that an edit, the request for its pictures and the handling of the results take on the thread of
/// the interface, over all presets and a recipe of `NODES` nodes. The median counts for each recipe, because on a
/// shared machine a single edit may be interrupted.
fn interface() -> Result<Value, String> {
    let mut large = String::from("orogen = 1\n\n[world]\ncell = 10\nsize = 1000\n\n[nodes.n0]\nop = \"fbm\"\n");
    for n in 1..NODES {
        large.push_str(&format!("\n[nodes.n{n}]\nop = \"add\"\na = \"n{}\"\nb = 0.5\n", n - 1));
    }
    large.push_str(&format!("\n[outputs]\nheight = \"n{}\"\n", NODES - 1));
    let large = Document::unsaved("large", large, None);
    if !large.is_valid() {
        return Err(format!("the large recipe is not valid: {:?}", large.diagnostics()));
    }
    let opened =
        presets::all().iter().map(Document::of_preset).collect::<Result<Vec<_>, _>>().map_err(|e| e.to_string())?;
    let mut longest = (0.0, String::new());
    for document in opened.into_iter().chain([large]) {
        let title = document.title().to_owned();
        let session = Session::new(SessionOptions::default()).map_err(|e| e.to_string())?;
        let mut studio = Studio::new(session, Arc::new(|| ()), document);
        let mut times = Vec::new();
        for seed in 0..EDITS {
            let begun = Instant::now();
            studio.poll();
            studio.edit(&Edit::Seed(seed)).map_err(|e| e.to_string())?;
            studio.refresh();
            times.push(begun.elapsed().as_secs_f64());
            std::thread::sleep(Duration::from_millis(5));
        }
        let time = median(&mut times);
        if time > longest.0 {
            longest = (time, title);
        }
    }
    let case = format!("thread of the interface, an edit ({})", longest.1);
    Ok(Figure { case, ours: longest.0, unit: "s", other: None, target: Target::AtMost(BUSY) }.json())
}

/// The seconds until the first and until the finest picture of a request.
fn pictures(worker: &mut Worker, request: Request) -> Result<[f64; 2], String> {
    let begun = Instant::now();
    worker.ask(request);
    let mut first = None;
    while begun.elapsed() < PATIENCE {
        for event in worker.events() {
            match event {
                Event::Frame(frame) => {
                    let now = begun.elapsed().as_secs_f64();
                    let first = *first.get_or_insert(now);
                    if frame.quality == Quality::Fine {
                        return Ok([first, now]);
                    }
                }
                Event::Failed(error) => return Err(error.to_string()),
                Event::Next(_) | Event::Done => {}
            }
        }
        std::thread::sleep(Duration::from_micros(200));
    }
    Err("no picture".into())
}
