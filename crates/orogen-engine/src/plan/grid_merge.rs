//! Merging of grid requests.

use super::compile::GridRequest;
use orogen_grid::grid::Window;

/// A grid to make, and the requests that it serves.
pub struct Cluster {
    pub window: Window,
    pub serves: Vec<usize>,
}

/// Merges nearby windows: two become one if the union has at most a quarter more samples than both together.
pub fn clusters(requests: &[GridRequest], wanted: impl Iterator<Item = usize>) -> Vec<Cluster> {
    let mut clusters: Vec<Cluster> = wanted.map(|i| Cluster { window: requests[i].window, serves: vec![i] }).collect();
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
        // A cluster that grew may now overlap others.
        if !joined {
            i += 1;
        }
    }
    clusters
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::graph::LayerRef;

    #[test]
    fn near_windows_join_and_far_ones_do_not() {
        let request = |x: i64, side: usize| GridRequest {
            target: LayerRef { node: 0, layer: 0 },
            raw: true,
            window: Window::new(side, side, 1.0).at(x, 0),
        };
        let requests = [request(0, 100), request(100_000, 100), request(-5, 110), request(100_050, 100)];
        let clusters = clusters(&requests, 0..4);
        assert_eq!(clusters.len(), 2);
        for cluster in &clusters {
            assert!(cluster.serves.iter().all(|&i| cluster.window.contains(&requests[i].window)));
        }
    }
}
