//! `cargo xtask resolution`: writes a page of the docs with the differences of each preset at larger cells.

use serde_json::Value;

use crate::failure::{Failure, Result, on_file};
use crate::shell;

pub const ABOUT: &str = "measure the differences of presets at coarser cells; write docs/resolution.md";

pub const HELP: &str = "
Usage: cargo xtask resolution

Makes every preset at its own cell and at 2, 4 and 8 times that, compares the heights and writes docs/resolution.md. Run it after
adding a preset or an intended change of its terrain.
";

const PAGE: &str = "docs/resolution.md";

const TEXT: &str = "\
# Resolution

The table compares each preset at its own cell with the same preset at cells 2, 4 and 8 times as large (`--cell`, `--size`, the levels of [chunks](chunks.md)).
Written by `cargo xtask resolution`.

- *Shared* compares the samples that both grids have: every 2nd, 4th or 8th of the finer grid.
  Fields and results of solvers are bit-equal there: 0.
  A filter is computed at the requested cell, so its results differ; `resample` or `bake` [fixes it at one cell](recipes.md#filters-at-a-fixed-cell).
  A levelled op (`continents`) answers with a coarser level, which has the same rivers and ranges without their finest valleys.
- *Everywhere* compares all samples of the finer grid with the coarser grid, interpolated with the engine's interpolating cubic.
  The difference is mostly the detail smaller than two of the larger cells.
  A border of two large cells is excluded.
- RMS is the root of the mean squared difference; worst is the largest absolute difference.
  Both are in metres and, in brackets, as a share of the relief, the difference between the highest and the lowest sample.
- Slopes depend on the cell: the same terrain is less steep at larger cells.

| preset | cell | requested cell | shared, RMS | shared, worst | everywhere, RMS | everywhere, worst |
|---|--:|--:|--:|--:|--:|--:|
";

/// Writes the page.
pub fn run(args: &[String]) -> Result {
    if !args.is_empty() {
        return Err(Failure::usage("expected nothing"));
    }
    let measured = shell::capture(&mut shell::cargo("run --quiet --release --package orogen-bench -- resolution"))?;
    let report: Value =
        serde_json::from_str(&measured).map_err(|e| Failure::new(format!("the bench printed no JSON: {e}")))?;
    let rows = report["rows"].as_array().filter(|rows| !rows.is_empty());
    let rows = rows.ok_or_else(|| Failure::new("the bench compared nothing"))?;
    let path = shell::root().join(PAGE);
    std::fs::write(&path, page(rows)).map_err(|e| on_file("write", &path, &e))?;
    println!("{PAGE}");
    Ok(())
}

fn page(rows: &[Value]) -> String {
    let mut text = TEXT.to_owned();
    let mut last = "";
    for row in rows {
        let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
        let (cell, ratio) = (number(&row["cell_m"]), number(&row["ratio"]));
        let off = |part: &str, kind: &str| {
            let part = &row[part];
            amount(number(&part[format!("{kind}_m")]), number(&part[format!("{kind}_share")]))
        };
        let preset = row["preset"].as_str().unwrap_or("?");
        // A preset is named only in its first row.
        let again = std::mem::replace(&mut last, preset) == preset;
        let (name, own) = match again {
            true => (String::new(), String::new()),
            false => (format!("{preset}, relief {:.0} m", number(&row["relief_m"])), format!("{cell} m")),
        };
        text.push_str(&format!(
            "| {name} | {own} | {} m | {} | {} | {} | {} |\n",
            cell * ratio,
            off("shared", "rms"),
            off("shared", "worst"),
            off("everywhere", "rms"),
            off("everywhere", "worst"),
        ));
    }
    text
}

/// Metres and the share of the relief; a plain 0 for equal bits.
fn amount(metres: f64, share: f64) -> String {
    match metres {
        0.0 => "0".to_owned(),
        _ => format!("{} m ({} %)", figures(metres), figures(100.0 * share)),
    }
}

/// Two significant digits; fewer below 0.01.
fn figures(x: f64) -> String {
    let places = match x {
        x if x >= 9.95 => 0,
        x if x >= 0.995 => 1,
        x if x >= 0.0995 => 2,
        x if x >= 0.00995 => 3,
        _ => 4,
    };
    format!("{x:.places$}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn rows_of_a_page() {
        let off = |rms: f64, worst: f64| json!({ "rms_m": rms, "worst_m": worst, "rms_share": rms / 500.0, "worst_share": worst / 500.0 });
        let row = |ratio, shared, everywhere| json!({ "preset": "p", "cell_m": 15.0, "ratio": ratio, "relief_m": 500.2, "shared": shared, "everywhere": everywhere });
        let text = page(&[row(2, off(0.0, 0.0), off(0.123, 4.56)), row(4, off(0.5, 12.3), off(1.0, 78.9))]);
        let lines: Vec<&str> = text.lines().rev().take(2).collect();
        assert_eq!(lines[1], "| p, relief 500 m | 15 m | 30 m | 0 | 0 | 0.12 m (0.025 %) | 4.6 m (0.91 %) |");
        assert_eq!(lines[0], "|  |  | 60 m | 0.50 m (0.10 %) | 12 m (2.5 %) | 1.0 m (0.20 %) | 79 m (16 %) |");
    }
}
