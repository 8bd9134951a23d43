//! Which grids serve which demands.

use super::compile::Demand;
use crate::grid::Window;

/// One grid to make, and the demands it serves.
pub struct Cluster {
    pub window: Window,
    pub serves: Vec<usize>,
}

/// Joins windows that lie near each other: two become one wherever that makes at most a quarter more samples than the two
/// apart.
pub fn clusters(demands: &[Demand], wanted: impl Iterator<Item = usize>) -> Vec<Cluster> {
    let mut clusters: Vec<Cluster> = wanted.map(|i| Cluster { window: demands[i].window, serves: vec![i] }).collect();
    let samples = |window: &Window| window.width as f64 * window.height as f64;
    let mut i = 0;
    while i < clusters.len() {
        let mut joined = false;
        let mut j = i + 1;
        while j < clusters.len() {
            let (a, b) = (clusters[i].window, clusters[j].window);
            let union = a.union(&b);
            if samples(&union) <= 1.25 * (samples(&a) + samples(&b)) {
                let other = clusters.swap_remove(j);
                clusters[i].window = union;
                clusters[i].serves.extend(other.serves);
                joined = true;
            } else {
                j += 1;
            }
        }
        // A cluster that grew may now reach others.
        if !joined {
            i += 1;
        }
    }
    clusters
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::graph::Target;

    #[test]
    fn near_windows_join_and_far_ones_do_not() {
        let demand = |x: i64, side: usize| Demand {
            target: Target { node: 0, layer: 0 },
            raw: true,
            window: Window::new(side, side, 1.0).at(x, 0),
        };
        let demands = [demand(0, 100), demand(100_000, 100), demand(-5, 110), demand(100_050, 100)];
        let clusters = clusters(&demands, 0..4);
        assert_eq!(clusters.len(), 2);
        for cluster in &clusters {
            assert!(cluster.serves.iter().all(|&i| cluster.window.contains(&demands[i].window)));
        }
    }
}
