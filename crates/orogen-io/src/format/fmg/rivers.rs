//! Rivers of a map as lines from source to mouth.

use super::document::Document;
use super::parts::{River, Water};
use super::surroundings::Surroundings;

/// Maximum distance from a tributary's end to the river that it joins, in distances between cells.
const REACH: f64 = 3.0;

/// Maximum number of rivers, and of points of one.
const MAX_RIVERS: usize = 10_000;
const MAX_POINTS: usize = 10_000;

/// A river before it is joined to others.
struct Draft {
    river: River,
    id: f64,
    parent: f64,
    /// The water in which the line ends.
    end: Option<Water>,
}

/// The rivers, main rivers before their tributaries; otherwise those with more discharge are first. Tributaries end on
/// a vertex of the river that they join. Returns also the number of rivers that have fewer than two points.
pub fn rivers(document: &Document, around: &Surroundings) -> Result<(Vec<River>, usize), String> {
    let table = &document.pack.rivers;
    if table.rows() > MAX_RIVERS {
        return Err(format!("it has {} rivers (`pack.rivers`), and at most {MAX_RIVERS} are read", table.rows()));
    }
    let (mut drafts, mut short) = (Vec::new(), 0);
    for row in 0..table.rows() {
        let Some(id) = table.number("i", row) else { continue };
        let (points, end) = line(document, row, around);
        if points.len() > MAX_POINTS {
            return Err(format!(
                "`pack.rivers[{row}]` has {} points, and at most {MAX_POINTS} are read; draw it as several rivers",
                points.len()
            ));
        }
        if points.len() < 2 {
            short += 1;
            continue;
        }
        let positive = |name| table.number(name, row).filter(|number| *number > 0.0);
        let name =
            [table.text("name", row), table.text("type", row)].into_iter().flatten().collect::<Vec<_>>().join(" ");
        let river = River {
            name,
            points,
            discharge: positive("discharge"),
            width: positive("width").map(|width| width * around.metres_per_pixel),
            parent: None,
        };
        drafts.push(Draft { river, id, parent: table.number("parent", row).unwrap_or(id), end });
    }
    Ok((ordered(drafts, around.spacing), short))
}

/// The points of a river in metres, without repetitions, and the water of its last cell.
fn line(document: &Document, row: usize, around: &Surroundings) -> (Vec<[f64; 2]>, Option<Water>) {
    let table = &document.pack.rivers;
    let (cells, drawn) = (table.list("cells", row), table.list("points", row));
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut add = |at: [f64; 2]| {
        let at = around.limited(at);
        if at.iter().all(|number| number.is_finite()) && points.last() != Some(&at) {
            points.push(at);
        }
    };
    let cell = |k: usize| cells.get(k).filter(|cell| **cell >= 0.0).map(|cell| *cell as usize);
    if let [_, _, _, _, ..] = drawn {
        drawn.chunks_exact(2).for_each(|at| add([at[0] * around.metres_per_pixel, at[1] * around.metres_per_pixel]));
    } else {
        for k in 0..cells.len() {
            match cell(k).map(|cell| around.cells.middles.get(cell)) {
                Some(Some(&middle)) => add(middle),
                Some(None) => {}
                // The river leaves the map.
                None => {
                    let before = k.checked_sub(1).and_then(cell).and_then(|cell| around.cells.middles.get(cell));
                    before.into_iter().for_each(|&middle| add(around.edge(middle)));
                }
            }
        }
    }
    let last = cells.len().checked_sub(1);
    let (before, last) = (last.and_then(|last| last.checked_sub(1)).and_then(cell), last.and_then(cell));
    let end = last.and_then(|last| around.water.get(last).copied().flatten());
    // The river ends at the shore of the sea, not in the middle of the cell.
    if let (Some(Water::Sea), Some(before), Some(last), true) = (end, before, last, points.len() >= 2)
        && let (Some(end), Some(shore)) = (points.last_mut(), around.shore(before, last))
    {
        *end = shore;
    }
    (points, end)
}

/// Joins tributaries to their rivers, and orders them.
fn ordered(mut drafts: Vec<Draft>, spacing: f64) -> Vec<River> {
    let discharge = |draft: &Draft| draft.river.discharge.unwrap_or(0.0);
    drafts.sort_by(|a, b| discharge(b).total_cmp(&discharge(a)).then(a.id.total_cmp(&b.id)));
    let mut by_id: Vec<(f64, usize)> = drafts.iter().enumerate().map(|(k, draft)| (draft.id, k)).collect();
    by_id.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let find = |id: f64| {
        let at = by_id.partition_point(|known| known.0 < id);
        by_id.get(at).filter(|known| known.0 == id).map(|known| known.1)
    };
    let parents: Vec<Option<usize>> =
        drafts.iter().enumerate().map(|(k, draft)| find(draft.parent).filter(|parent| *parent != k)).collect();
    let mut donors = vec![Vec::new(); drafts.len()];
    let mut order: Vec<usize> = Vec::new();
    for (k, parent) in parents.iter().enumerate() {
        match parent {
            Some(parent) => donors[*parent].push(k),
            None => order.push(k),
        }
    }
    let mut next = 0;
    while let Some(&k) = order.get(next) {
        order.extend(&donors[k]);
        next += 1;
    }
    // Rivers that are each other's tributaries are main rivers.
    let mut is_placed = vec![false; drafts.len()];
    order.iter().for_each(|&k| is_placed[k] = true);
    let circular: Vec<usize> = (0..drafts.len()).filter(|&k| !is_placed[k]).collect();
    order.extend(&circular);
    let mut places = vec![0; drafts.len()];
    order.iter().enumerate().for_each(|(place, &k)| places[k] = place);
    for &k in order.iter().filter(|&&k| is_placed[k]) {
        let Some(parent) = parents[k] else { continue };
        let main = drafts[parent].river.points.clone();
        let draft = &mut drafts[k];
        let Some(&end) = draft.river.points.last() else { continue };
        if !main.contains(&end) {
            // A tributary that ends in a lake continues to where the river leaves it.
            let joined = match draft.end {
                Some(Water::Lake) => main.first().copied(),
                Some(Water::Sea) => None,
                None => nearest(&main, end).filter(|at| distance(*at, end) <= REACH * spacing),
            };
            let Some(joined) = joined else { continue };
            draft.river.points.push(joined);
        }
        draft.river.parent = Some(places[parent]);
    }
    let mut drafts: Vec<Option<Draft>> = drafts.into_iter().map(Some).collect();
    order.into_iter().filter_map(|k| drafts[k].take()).map(|draft| draft.river).collect()
}

fn distance([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    libm::hypot(ax - bx, ay - by)
}

/// The nearest vertex of a line.
fn nearest(line: &[[f64; 2]], at: [f64; 2]) -> Option<[f64; 2]> {
    line.iter().copied().min_by(|a, b| distance(*a, at).total_cmp(&distance(*b, at)))
}
