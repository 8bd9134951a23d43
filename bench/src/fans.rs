//! Measures alluvial fans of recipes with an output `sediment`: slopes by distance from the apex, areas beside those of
//! the catchments, and depressions that are not closed basins. Prints a table.
#![allow(clippy::disallowed_methods, reason = "a measurement, of which no terrain is made")]

use crate::land::{grid, name, parse, quantile, sorted};
use crate::valleys::network::Network;
use orogen::Grid;
use orogen::grid::hydrology::steepest::Descent;
use orogen::grid::hydrology::{Outlets, route_carving};

/// Classes of catchments, in km².
const CATCHMENTS: [[f64; 2]; 4] = [[0.5, 2.0], [2.0, 5.0], [5.0, 15.0], [15.0, f64::INFINITY]];

/// Distances from the apex between which slopes are measured, in metres.
const RINGS: [[f64; 2]; 4] = [[0.0, 500.0], [500.0, 1500.0], [1500.0, 3000.0], [3000.0, 6000.0]];

/// Thickness of sediment, in metres, below which ground counts as rock.
const ROCK: f32 = 3.0;

/// Number of cells below an apex that must have sediment.
const BELOW: usize = 30;

/// Slope from which ground with sediment belongs to a fan.
const FAN_SLOPE: f64 = 0.008;

/// Depth of depressions that a run with deposition leaves, in metres.
const KEPT_DEPTH: f32 = 1.0;

struct Fan {
    apex: usize,
    /// Area of the catchment in km².
    catchment: f64,
    slopes: [Option<f64>; RINGS.len()],
    /// Area in km².
    area: f64,
}

/// Runs the measurement.
pub fn run(args: &[String]) -> Result<(), String> {
    let request = parse(args)?;
    println!("| land | catchment | fans | slope to 0.5 km | to 1.5 km | to 3 km | to 6 km | fan / catchment |");
    println!("|---|--:|--:|--:|--:|--:|--:|--:|");
    for source in &request.sources {
        let heights = grid(source, &request, "height")?;
        let sediment = grid(source, &request, "sediment")?;
        let name = name(source);
        let fans = fans(&heights, &sediment);
        for [least, most] in CATCHMENTS {
            let class: Vec<&Fan> = fans.iter().filter(|fan| (least..most).contains(&fan.catchment)).collect();
            let slopes: Vec<String> = (0..RINGS.len())
                .map(|ring| format!("{:.3}", median(class.iter().filter_map(|fan| fan.slopes[ring]))))
                .collect();
            let area = median(class.iter().map(|fan| fan.area / fan.catchment));
            println!("| {name} | {least} to {most} km² | {} | {} | {area:.2} |", class.len(), slopes.join(" | "));
        }
        let drainage = route_carving(&heights, &Outlets::new(&heights, None), Descent::Steepest);
        let depths: Vec<f32> = drainage
            .basins
            .order
            .iter()
            .map(|basin| {
                let spill = &drainage.basins.spills[*basin as usize];
                spill.level - heights.data()[spill.pit as usize]
            })
            .collect();
        let closed = depths.iter().filter(|depth| **depth > KEPT_DEPTH).count();
        println!("\n{name}: {closed} closed basins, {} other depressions", depths.len() - closed);
    }
    Ok(())
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    quantile(&sorted(values.collect()), 0.5)
}

fn fans(heights: &Grid, sediment: &Grid) -> Vec<Fan> {
    let network = Network::new(heights);
    let (h, s) = (heights.data(), sediment.data());
    let mut fans = Vec::new();
    for apex in (0..h.len()).filter(|cell| network.area[*cell] >= CATCHMENTS[0][0] && s[*cell] < ROCK) {
        let mut path = vec![apex];
        while path.len() < 300 && network.receiver[path[path.len() - 1]] != path[path.len() - 1] {
            path.push(network.receiver[path[path.len() - 1]]);
        }
        // The last place of the river on rock.
        if path.len() <= BELOW || path[1..BELOW].iter().any(|cell| s[*cell] < ROCK) {
            continue;
        }
        let slopes = RINGS.map(|[least, most]| {
            let in_ring = |cell: &&usize| (least..=most).contains(&network.length(apex, **cell));
            let (first, last) = (path.iter().find(in_ring)?, path.iter().rev().find(in_ring)?);
            let away = network.length(apex, *last) - network.length(apex, *first);
            (away > 0.5 * (most - least)).then(|| f64::from(h[*first] - h[*last]) / away)
        });
        fans.push(Fan { apex, catchment: network.area[apex], slopes, area: 0.0 });
    }
    // Ground of fans belongs to the nearest apex, where the distance counts less from a large one.
    let weights: Vec<f64> = fans.iter().map(|fan| fan.catchment.powf(-0.45)).collect();
    let cell_area = network.cell * network.cell / 1e6;
    for cell in (0..h.len()).filter(|cell| s[*cell] >= ROCK && network.receiver[*cell] != *cell) {
        let to = network.receiver[cell];
        if f64::from(h[cell] - h[to]) < FAN_SLOPE * network.length(cell, to) {
            continue;
        }
        let nearest = (0..fans.len()).min_by(|a, b| {
            let away = |fan: usize| network.length(fans[fan].apex, cell) * weights[fan];
            away(*a).total_cmp(&away(*b))
        });
        if let Some(nearest) = nearest {
            fans[nearest].area += cell_area;
        }
    }
    fans
}
