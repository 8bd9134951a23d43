//! Merging of grid requests.

use super::request::Requests;
use orogen_grid::grid::Window;
use orogen_ops::ids::RequestId;

/// A grid to make, and the requests that it serves.
pub struct Cluster {
    pub window: Window,
    pub serves: Vec<RequestId>,
}

/// Merges nearby windows of the same cell: two become one if the union has at most a quarter more samples than both
/// together. A levelled op requests its inputs at the cells of its levels.
pub fn clusters(requests: &Requests, wanted: impl Iterator<Item = RequestId>) -> Vec<Cluster> {
    let mut clusters: Vec<Cluster> =
        wanted.map(|id| Cluster { window: requests.get(id).window, serves: vec![id] }).collect();
    let samples = |window: &Window| window.width as f64 * window.height as f64;
    let mut i = 0;
    while i < clusters.len() {
        let mut joined = false;
        let mut j = i + 1;
        while j < clusters.len() {
            let (a, b) = (clusters[i].window, clusters[j].window);
            if a.cell != b.cell {
                j += 1;
                continue;
            }
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
    use crate::plan::request::GridRequest;
    use crate::recipe::graph::LayerRef;
    use orogen_ops::ids::{Id, NodeId};

    #[test]
    fn near_windows_join_and_far_ones_do_not() {
        let mut requests = Requests::default();
        let ids = [(0, 100), (100_000, 100), (-5, 110), (100_050, 100)].map(|(x, side)| {
            let target = LayerRef { node: NodeId::new(0), layer: 0 };
            requests.add(GridRequest { target, raw: true, window: Window::new(side, side, 1.0).at(x, 0) })
        });
        let clusters = clusters(&requests, ids.into_iter());
        assert_eq!(clusters.len(), 2);
        for cluster in &clusters {
            assert!(cluster.serves.iter().all(|id| cluster.window.contains(&requests.get(*id).window)));
        }
    }

    #[test]
    fn a_request_that_nothing_serves_is_an_error() {
        let mut requests = Requests::default();
        let target = LayerRef { node: NodeId::new(0), layer: 0 };
        let id = requests.add(GridRequest { target, raw: true, window: Window::new(1, 1, 1.0) });
        assert!(requests.grid(id).is_err_and(|error| error.to_string().contains("no step makes a grid")));
    }
}
