//! Sand that slides down slopes steeper than its angle of repose, and that creeps down gentler ones as it moves.

use super::torus::Heading;
use crate::parallel;
use std::sync::atomic::{AtomicU32, Ordering};

/// Tangent of the angle of repose, 33 degrees.
const REPOSE: f32 = 0.649_407_6;

/// Share of the excess over the angle of repose that slides to each neighbor in a step.
const RATE: f32 = 0.14;

/// Neighbors: the line, before, own or after, and the first sample of that line with one more at its ends.
const NEXT: [[usize; 2]; 4] = [[0, 1], [1, 0], [1, 2], [2, 1]];
const DIAGONAL: [[usize; 2]; 4] = [[0, 0], [0, 2], [2, 0], [2, 2]];

/// Lets sand move to the neighbors of each sample, all at once; returns the largest thickness that leaves a sample.
/// `creep` times the mean flux times the difference of heights moves to the next samples of the line and of the lines
/// beside it. `shares` is scratch space.
pub(super) fn slide(
    heading: Heading,
    cell: f32,
    [height, flux]: [&[f32]; 2],
    creep: f32,
    shares: &mut [f32],
    sand: &mut [f32],
) -> f32 {
    let (across, lines) = (heading.across, heading.lines);
    let most = AtomicU32::new(0);
    let limits = [cell * REPOSE, cell * REPOSE * std::f32::consts::SQRT_2];
    let scratch = || (Near::new(across), Near::new(across), Near::new(across), [vec![0.0; across], vec![0.0; across]]);
    // First, how much each sample would lose, and the share of it that it has.
    let items = shares.chunks_mut(across).zip(sand.chunks(across)).enumerate();
    parallel::for_each_init(items, scratch, |(near, flows, _, [leaving, _]), (line, (shares, sand))| {
        near.read(line, heading, height);
        flows.read(line, heading, flux);
        leaving.fill(0.0);
        for neighbor in NEXT {
            let pairs = near.pairs(neighbor).zip(flows.pairs(neighbor));
            for (leaving, ((own, other), (flux, other_flux))) in leaving.iter_mut().zip(pairs) {
                let fall = own - other;
                *leaving += fall.max(0.0) * ((flux + other_flux) * creep) + (fall - limits[0]).max(0.0) * RATE;
            }
        }
        for neighbor in DIAGONAL {
            for (leaving, (own, other)) in leaving.iter_mut().zip(near.pairs(neighbor)) {
                *leaving += (own - other - limits[1]).max(0.0) * RATE;
            }
        }
        let mut largest = 0.0f32;
        for (share, (leaving, sand)) in shares.iter_mut().zip(leaving.iter().zip(sand)) {
            let limited = sand.min(*leaving);
            largest = largest.max(limited);
            *share = limited / leaving.max(f32::MIN_POSITIVE);
        }
        // Thicknesses are not negative, so that their bits are in the order of the numbers.
        most.fetch_max(largest.to_bits(), Ordering::Relaxed);
    });
    let most = f32::from_bits(most.into_inner());
    if most == 0.0 {
        return 0.0;
    }
    let shares = &*shares;
    let items = sand.chunks_mut(across).enumerate();
    parallel::for_each_init(items, scratch, |(near, flows, parts, [leaving, coming]), (line, sand)| {
        let around = [(line + lines - 1) % lines, line, (line + 1) % lines];
        if around.iter().all(|line| shares[line * across..][..across].iter().all(|share| *share == 0.0)) {
            return;
        }
        near.read(line, heading, height);
        flows.read(line, heading, flux);
        parts.read(line, heading, shares);
        leaving.fill(0.0);
        coming.fill(0.0);
        for neighbor in NEXT {
            let pairs = near.pairs(neighbor).zip(flows.pairs(neighbor)).zip(parts.pairs(neighbor));
            let sums = leaving.iter_mut().zip(coming.iter_mut());
            for ((leaving, coming), (((own, other), (flux, other_flux)), (_, part))) in sums.zip(pairs) {
                let (fall, creeping) = (own - other, (flux + other_flux) * creep);
                *leaving += fall.max(0.0) * creeping + (fall - limits[0]).max(0.0) * RATE;
                *coming += part * ((-fall).max(0.0) * creeping + (-fall - limits[0]).max(0.0) * RATE);
            }
        }
        for neighbor in DIAGONAL {
            let sums = leaving.iter_mut().zip(coming.iter_mut());
            for ((leaving, coming), ((own, other), (_, part))) in
                sums.zip(near.pairs(neighbor).zip(parts.pairs(neighbor)))
            {
                let fall = own - other;
                *leaving += (fall - limits[1]).max(0.0) * RATE;
                *coming += part * ((-fall - limits[1]).max(0.0) * RATE);
            }
        }
        let shares = &shares[line * across..][..across];
        for ((sand, share), (leaving, coming)) in sand.iter_mut().zip(shares).zip(leaving.iter().zip(coming.iter())) {
            *sand = (*sand - leaving * share + coming).max(0.0);
        }
    });
    most
}

/// A line and those beside it, each with a sample more at its ends.
struct Near {
    lines: [Vec<f32>; 3],
}

impl Near {
    fn new(across: usize) -> Near {
        Near { lines: [(); 3].map(|()| vec![0.0; across + 2]) }
    }

    fn read(&mut self, line: usize, heading: Heading, plane: &[f32]) {
        let (across, lines) = (heading.across, heading.lines);
        for (wide, line) in self.lines.iter_mut().zip([(line + lines - 1) % lines, line, (line + 1) % lines]) {
            let line = &plane[line * across..][..across];
            wide[0] = line[across - 1];
            wide[1..=across].copy_from_slice(line);
            wide[across + 1] = line[0];
        }
    }

    /// Each sample with a neighbor.
    fn pairs(&self, [line, first]: [usize; 2]) -> impl Iterator<Item = (&f32, &f32)> {
        self.lines[1][1..].iter().zip(&self.lines[line][first..])
    }
}
