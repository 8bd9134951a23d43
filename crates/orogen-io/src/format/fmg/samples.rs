//! A small map for the tests of this crate and of crates that depend on it.

use serde_json::{Value, json};

/// Columns and rows of cells.
const COLUMNS: usize = 20;
const ROWS: usize = 12;

/// Distance between the cells of a row, and between rows, in pixels.
const STEP: f64 = 10.0;
const ROW: f64 = 8.66;

/// The middle, the radius and the rise of the two landmasses, in pixels.
const LANDS: [([f64; 2], f64, f64); 2] = [([72.0, 57.0], 42.0, 45.0), ([156.0, 50.0], 30.0, 25.0)];

/// The cell of the lake.
const LAKE: (usize, usize) = (6, 6);

fn middle(column: usize, row: usize) -> [f64; 2] {
    [STEP * (column as f64 + 0.5 + 0.5 * (row % 2) as f64), ROW * row as f64 + 5.0]
}

fn height(column: usize, row: usize) -> f64 {
    let [x, y] = middle(column, row);
    let land = LANDS.iter().map(|([east, south], radius, rise)| {
        let share = 1.0 - libm::hypot(x - east, y - south) / radius;
        20.0 + rise * share
    });
    match land.fold(0.0, f64::max) {
        _ if (column, row) == LAKE => 16.0,
        height if height >= 20.0 => height.round(),
        height => (0.8 * height - 2.0).clamp(0.0, 19.0).round(),
    }
}

/// The cells of a row from a column on, to the first one in the sea.
fn along(row: usize, columns: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut cells = Vec::new();
    for column in columns {
        cells.push(row * COLUMNS + column);
        if height(column, row) < 20.0 && (column, row) != LAKE {
            break;
        }
    }
    cells
}

/// An export of 240 hexagonal cells, 20 km wide: two landmasses, a lake, five rivers with a confluence, and
/// settlements.
#[must_use]
pub fn map() -> Value {
    let mut vertices: Vec<[f64; 2]> = Vec::new();
    let mut corner = |at: [f64; 2]| {
        let is_it = |known: &[f64; 2]| libm::hypot(known[0] - at[0], known[1] - at[1]) < 0.1;
        vertices.iter().position(is_it).unwrap_or_else(|| {
            vertices.push(at);
            vertices.len() - 1
        })
    };
    let places = || (0..COLUMNS * ROWS).map(|cell| (cell % COLUMNS, cell / COLUMNS));
    let cells: Vec<Value> = places()
        .enumerate()
        .map(|(i, (column, row))| {
            let [x, y] = middle(column, row);
            let (half, near, far) = (STEP / 2.0, STEP * 0.288_675, STEP * 0.577_35);
            let corners = [[0.0, -far], [half, -near], [half, near], [0.0, far], [-half, near], [-half, -near]];
            let around = corners.map(|[east, south]| corner([x + east, y + south]));
            let feature = if (column, row) == LAKE { 4 } else { 1 };
            json!({ "i": i, "v": around, "c": [], "p": [x, y], "g": i, "h": height(column, row), "f": feature })
        })
        .collect();
    let grid: Vec<Value> = places()
        .map(|(column, row)| json!({ "h": height(column, row), "temp": 12, "prec": 5 + 10 * column / COLUMNS }))
        .collect();
    let points: Vec<[f64; 2]> = places().map(|(column, row)| middle(column, row)).collect();
    let cell = |column: usize, row: usize| row * COLUMNS + column;
    let main = along(6, 8..COLUMNS);
    let tributary = [cell(8, 5), cell(9, 5), cell(10, 6)];
    let outlet = along(6, (0..=LAKE.0).rev());
    let inlet = [cell(7, 8), cell(6, 7), cell(6, 6)];
    let eastern = along(5, 15..COLUMNS);
    let [[ax, ay], [bx, by]] = [middle(9, 6), middle(15, 4)];
    json!({
        "info": { "version": "1.147.1", "mapName": "Sample", "width": 205, "height": 105, "seed": "42" },
        "settings": { "distanceUnit": "km", "distanceScale": 2, "heightUnit": "m", "heightExponent": "2" },
        "mapCoordinates": { "latT": 20 },
        "pack": {
            "cells": cells,
            "vertices": vertices.iter().map(|at| json!({ "p": at, "v": [], "c": [] })).collect::<Vec<_>>(),
            "features": [
                0,
                { "i": 1, "type": "ocean" },
                { "i": 2, "type": "island" },
                { "i": 3, "type": "island" },
                { "i": 4, "type": "lake", "name": "Long Mere", "height": 30.5 },
            ],
            "rivers": [
                { "i": 2, "parent": 1, "discharge": 40, "width": 0.05, "name": "Ash", "type": "Brook",
                  "cells": tributary },
                { "i": 1, "parent": 1, "discharge": 90, "width": 0.1, "name": "Arden", "type": "River", "cells": main },
                { "i": 3, "parent": 3, "discharge": 70, "width": 0.1, "name": "Weir", "cells": outlet },
                { "i": 4, "parent": 3, "discharge": 30, "width": 0.1, "name": "Inlet", "cells": inlet },
                { "i": 5, "parent": 0, "discharge": 20, "width": 0.1, "name": "Eastern", "cells": eastern },
                { "i": 6, "parent": 6, "name": "Spring", "cells": [cell(8, 4)] },
            ],
            "burgs": [
                0,
                { "i": 1, "x": ax, "y": ay, "name": "Upper Ford", "capital": 0, "population": 3.5 },
                { "i": 2, "x": bx, "y": by, "name": "Aldermouth, \"old\"", "capital": 1, "population": 2 },
                { "i": 3, "x": 1.0, "y": 2.0, "name": "Gone", "removed": true },
                { "i": 4, "x": 1000.0, "y": 2.0, "name": "Outside" },
            ],
        },
        "grid": { "cells": grid, "points": points, "spacing": 10, "cellsX": COLUMNS, "cellsY": ROWS },
        "notes": [],
    })
}
