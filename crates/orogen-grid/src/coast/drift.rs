//! Sand that waves move along the shore.

use super::Coast;
use super::beach::Section;
use super::climate::Climate;
use super::nodes::{Node, Nodes, cell_of};
use crate::error::Result;
use crate::grid::Window;
use crate::parallel;
use crate::progress::Progress;

/// Angles of the shore at which transport is computed, in radians: transport is linear between them.
const TURN: f64 = 0.25;
/// Largest angle between the shore and the waves that counts, in radians.
const OBLIQUE: f64 = 0.3;
/// Largest angle of a beach to the shore behind it, in radians.
const STEEPEST: f64 = 0.9;
/// Bends of the shore shorter than this are not in the sea floor before it, in metres.
const REFRACTED: f64 = 900.0;
/// Share of the stable step of the diffusion.
const STEP: f64 = 0.2;
/// Most steps.
const MAX_STEPS: f64 = 20_000.0;

/// What waves move along the shore.
pub(super) struct Drift {
    /// Transport at each node, for a shore turned by -[`TURN`], 0 and [`TURN`].
    pub(super) turned: Vec<[f64; 3]>,
    /// Mean sine of the angle of the waves at each node, positive where sand moves to the next.
    pub(super) oblique: Vec<f64>,
    /// Sums of the directions that waves come from at each cell.
    pub(super) approach: Vec<[f32; 2]>,
}

impl Drift {
    /// Transport along the shore by the CERC formula in terms of waves in deep water,
    /// Q ~ H^(12/5) T^(1/5) cos(phi)^(6/5) sin(phi) (Ashton and Murray 2006).
    pub(super) fn new(
        window: &Window,
        nodes: &Nodes,
        shore: &[f32],
        climate: &Climate,
        progress: &Progress,
    ) -> Result<Drift> {
        // Waves are those of the water in front of a node.
        let place = |node: &Node| {
            let ahead = |far: f64| cell_of(window, [0, 1].map(|k| node.at[k] + far * node.out[k]));
            [2.0, 1.0, 0.5].into_iter().map(ahead).find(|cell| shore[*cell] <= 0.0)
        };
        let places: Vec<Option<usize>> = nodes.nodes.iter().map(place).collect();
        let turns = [-TURN, 0.0, TURN].map(|turn| [libm::cos(turn), libm::sin(turn)]);
        let mut turned = vec![[0.0f64; 3]; nodes.nodes.len()];
        let mut reaching = vec![0.0f64; nodes.nodes.len()];
        let mut approach = vec![[0.0f32; 2]; shore.len()];
        climate.each(window, shore, progress, |_, wind, fetch| {
            let nodes = nodes.nodes.iter().zip(&places);
            for (((node, place), sum), reaching) in nodes.zip(&mut turned).zip(&mut reaching) {
                let Some(place) = place else { continue };
                let power = wind.share * f64::from(climate.waves.of(fetch[*place])[1]);
                // Along the line, with the sea to the right: out is (-y, x) of the tangent.
                let along = [node.out[1], -node.out[0]];
                for (k, (sum, [cos, sin])) in sum.iter_mut().zip(turns).enumerate() {
                    // A shore that turns seaward along the line.
                    let out = [0, 1].map(|k| node.out[k] * cos - along[k] * sin);
                    let tangent = [0, 1].map(|k| along[k] * cos + node.out[k] * sin);
                    let facing = out[0] * wind.from[0] + out[1] * wind.from[1];
                    if facing > 0.0 {
                        let aside = tangent[0] * wind.from[0] + tangent[1] * wind.from[1];
                        let moving = power * libm::pow(facing, 1.2);
                        *sum -= moving * aside;
                        *reaching += if k == 1 { moving } else { 0.0 };
                    }
                }
            }
            let from = wind.from.map(|part| (part * wind.share) as f32);
            let pieces = approach.chunks_mut(parallel::SAMPLES).zip(fetch.chunks(parallel::SAMPLES));
            parallel::for_each(pieces, |(approach, fetch)| {
                for (approach, fetch) in approach.iter_mut().zip(fetch) {
                    let drift = climate.waves.of(*fetch)[1];
                    *approach = [0, 1].map(|k| approach[k] + drift * from[k]);
                }
            });
        })?;
        let oblique = turned.iter().zip(&reaching).map(|(sum, reaching)| sum[1] / reaching.max(f64::MIN_POSITIVE));
        Ok(Drift { oblique: oblique.collect(), turned, approach })
    }
}

/// Angles from the shore at each node to its course over some distance, positive towards the sea.
///
/// Waves feel the sea floor long before the shore, and the floor has only the large bends of the shore. So waves turn
/// towards headlands and carry their sand into bays (refraction, simplified).
fn bends(nodes: &[Node]) -> Vec<f64> {
    let tangent = |node: &Node| [node.out[1], -node.out[0]];
    let mean = |(k, node): (usize, &Node)| {
        let reach = (REFRACTED / node.length) as usize;
        let mut sum = tangent(node);
        for side in 0..2 {
            let mut at = k;
            for step in 0..reach {
                let next = nodes[at].ends[side];
                if next == at || next == k {
                    break;
                }
                at = next;
                let weight = 1.0 - (step + 1) as f64 / (reach + 1) as f64;
                sum = [0, 1].map(|axis| sum[axis] + weight * tangent(&nodes[at])[axis]);
            }
        }
        let own = tangent(node);
        let seaward = sum[0] * node.out[0] + sum[1] * node.out[1];
        libm::atan2(seaward, sum[0] * own[0] + sum[1] * own[1])
    };
    nodes.iter().enumerate().map(mean).collect()
}

/// Sand at each node, in m^3, after it has moved along the shore.
///
/// A line of shore (Pelnard-Considère 1956): sand of volume S moves the shore out by w = S / (length D) over a profile
/// D metres high. Sand moves until the shore is at right angles to the mean waves, as far as it reaches. Every edge
/// takes its own steps of time, so what counts is the angle that transport seeks.
pub(super) fn run(law: &Coast, nodes: &[Node], drift: &Drift, sections: &[Section], sand: &mut [f64]) {
    let Some(spacing) = nodes.first().map(|node| node.length) else { return };
    let bends = bends(nodes);
    // The angle towards the sea at which nothing moves along the edge behind each node.
    let sought = |(k, node): (usize, &Node)| {
        let next = node.ends[1];
        let [less, none, more] = [0, 1, 2].map(|turn| 0.5 * (drift.turned[k][turn] + drift.turned[next][turn]));
        let change = (more - less) / (2.0 * TURN);
        let strength = (-change).max(0.3 * none.abs()).max(1e-12);
        let waves = (none / strength).clamp(-OBLIQUE, OBLIQUE);
        (bends[k] + waves).clamp(-STEEPEST, STEEPEST)
    };
    let sought: Vec<f64> = nodes.iter().enumerate().map(sought).collect();
    let depth: Vec<f64> = sections.iter().map(Section::depth).collect();
    let most: Vec<f64> = sections.iter().zip(nodes).map(|(section, node)| section.most() * node.length).collect();
    let far = law.reach / spacing;
    let steps = (far * far / (2.0 * STEP)).clamp(0.0, MAX_STEPS) as usize;
    let mut moved = vec![0.0; nodes.len()];
    let out = |k: usize, sand: &[f64]| sand[k] / (nodes[k].length * depth[k]);
    for _ in 0..steps {
        for (k, node) in nodes.iter().enumerate() {
            let next = node.ends[1];
            if next == k {
                moved[k] = 0.0;
                continue;
            }
            let turned = ((out(next, sand) - out(k, sand)) / node.length).clamp(-1.5, 1.5);
            // Where the shore turns seaward along the line, sand runs back.
            let angle = sought[k] - turned;
            let from = if angle > 0.0 { k } else { next };
            let wanted = STEP * angle * node.length * node.length * depth[from];
            moved[k] = wanted.clamp(-0.4 * sand[from], 0.4 * sand[from]);
        }
        for (k, node) in nodes.iter().enumerate() {
            if node.ends[1] != k {
                sand[k] -= moved[k];
                sand[node.ends[1]] += moved[k];
            }
        }
        // What a beach cannot hold is lost to deep water.
        sand.iter_mut().zip(&most).for_each(|(sand, most)| *sand = sand.min(*most));
    }
}
