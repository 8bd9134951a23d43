//! Measures the shape of valleys, of recipes and of real places alike: how their cross sections widen with height, and
//! how high the mouths of tributaries hang above the valleys that they enter. Prints a table.
#![allow(clippy::disallowed_methods, reason = "a measurement, of which no terrain is made")]

pub mod network;
mod sections;
mod steps;

use crate::land::{heights, name, parse, quantile, sorted};
use network::Network;

/// Runs the measurement.
pub fn run(args: &[String]) -> Result<(), String> {
    let request = parse(args)?;
    println!("| land | sections | exponent: median | quartiles | mouths | step: p75 | p90 |");
    println!("|---|--:|--:|--:|--:|--:|--:|");
    for source in &request.sources {
        let heights = heights(source, &request)?;
        let network = Network::new(&heights);
        let exponents = sorted(sections::exponents(&heights, &network));
        let steps = sorted(steps::falls(&heights, &network));
        let [low, median, high] = [0.25, 0.5, 0.75].map(|share| quantile(&exponents, share));
        let [p75, p90] = [0.75, 0.9].map(|share| quantile(&steps, share));
        let name = name(source);
        let (sections, mouths) = (exponents.len(), steps.len());
        println!("| {name} | {sections} | {median:.2} | {low:.2} to {high:.2} | {mouths} | {p75:.0} m | {p90:.0} m |");
    }
    Ok(())
}
