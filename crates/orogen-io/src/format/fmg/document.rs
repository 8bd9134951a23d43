//! The parts of an export that are read.

use std::fmt;

use serde::de::{self, DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

use super::table::Kind::{List, Number, Text};
use super::table::{Allowance, Column, RowSeed, Table, TableSeed, read_column};

const INFO: &[Column] = &[("width", Number), ("height", Number), ("mapName", Text), ("seed", Text)];
const SETTINGS: &[Column] =
    &[("distanceScale", Number), ("distanceUnit", Text), ("heightExponent", Number), ("mapName", Text)];
const CELLS: &[Column] = &[("p", List), ("v", List), ("h", Number), ("f", Number), ("g", Number), ("prec", Number)];
const VERTICES: &[Column] = &[("p", List)];
const FEATURES: &[Column] = &[("i", Number), ("type", Text), ("name", Text), ("height", Number)];
const RIVERS: &[Column] = &[
    ("i", Number),
    ("parent", Number),
    ("discharge", Number),
    ("width", Number),
    ("name", Text),
    ("type", Text),
    ("cells", List),
    ("points", List),
];
const BURGS: &[Column] = &[
    ("i", Number),
    ("x", Number),
    ("y", Number),
    ("name", Text),
    ("capital", Number),
    ("population", Number),
    ("removed", Number),
];
const GRID_CELLS: &[Column] = &[("h", Number), ("prec", Number)];
const POINTS: &[Column] = &[("points", List)];

/// Maximum number of values that are kept: a map of a million cells.
const MAX_VALUES: usize = 1 << 26;

/// The parts of an export.
#[derive(Debug, Clone, PartialEq)]
pub struct Document {
    pub info: Table,
    pub settings: Table,
    pub pack: Graph,
    /// Heights and precipitation of the grid from which the cells were made.
    pub grid: Table,
    /// The positions of the grid's cells, in the column `points`.
    pub points: Table,
    /// The name of the list of cells, for messages.
    pub cells_name: &'static str,
}

/// Cells and what is on them.
#[derive(Debug, Clone, PartialEq)]
pub struct Graph {
    pub cells: Table,
    pub vertices: Table,
    pub features: Table,
    pub rivers: Table,
    pub burgs: Table,
}

impl Document {
    /// Reads a text.
    pub fn parse(text: &str) -> Result<Document, String> {
        let pack = Graph {
            cells: Table::new(CELLS),
            vertices: Table::new(VERTICES),
            features: Table::new(FEATURES),
            rivers: Table::new(RIVERS),
            burgs: Table::new(BURGS),
        };
        let mut document = Document {
            info: Table::new(INFO),
            settings: Table::new(SETTINGS),
            pack,
            grid: Table::new(GRID_CELLS),
            points: Table::new(POINTS),
            cells_name: "pack.cells",
        };
        let allowance = Allowance::new(MAX_VALUES);
        let mut deserializer = serde_json::Deserializer::from_str(text);
        let read = deserializer.deserialize_map(Top(&mut document, &allowance));
        let read = read.and_then(|()| deserializer.end());
        read.map_err(|cause| format!("it is not valid JSON of an export ({cause})"))?;
        Ok(document)
    }
}

/// Reads the whole text.
struct Top<'a>(&'a mut Document, &'a Allowance);

impl<'de> Visitor<'de> for Top<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let Top(document, allowance) = self;
        while let Some(key) = map.next_key::<String>()? {
            match key.as_str() {
                "info" => map.next_value_seed(RowSeed(&mut document.info, allowance))?,
                "settings" => map.next_value_seed(RowSeed(&mut document.settings, allowance))?,
                "pack" => map.next_value_seed(GraphSeed(&mut document.pack, allowance))?,
                "cells" => {
                    document.cells_name = "cells.cells";
                    map.next_value_seed(GraphSeed(&mut document.pack, allowance))?;
                }
                "vertices" => map.next_value_seed(TableSeed(&mut document.pack.vertices, allowance))?,
                "grid" => map.next_value_seed(GridSeed(document, allowance))?,
                _ => drop(map.next_value::<IgnoredAny>()?),
            }
        }
        Ok(())
    }
}

/// Reads cells and what is on them. The object may also be the columns of the cells, or a list of cells.
struct GraphSeed<'a>(&'a mut Graph, &'a Allowance);

impl<'de> DeserializeSeed<'de> for GraphSeed<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for GraphSeed<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an object or a list of cells")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let GraphSeed(graph, allowance) = self;
        while let Some(key) = map.next_key::<String>()? {
            let table = match key.as_str() {
                "cells" => &mut graph.cells,
                "vertices" => &mut graph.vertices,
                "features" => &mut graph.features,
                "rivers" => &mut graph.rivers,
                "burgs" => &mut graph.burgs,
                other => {
                    read_column(&mut graph.cells, allowance, other, &mut map)?;
                    continue;
                }
            };
            map.next_value_seed(TableSeed(table, allowance))?;
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, rows: A) -> Result<(), A::Error> {
        TableSeed(&mut self.0.cells, self.1).visit_seq(rows)
    }

    fn visit_unit<E: de::Error>(self) -> Result<(), E> {
        Ok(())
    }
}

/// Reads the grid.
struct GridSeed<'a>(&'a mut Document, &'a Allowance);

impl<'de> DeserializeSeed<'de> for GridSeed<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for GridSeed<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let GridSeed(document, allowance) = self;
        while let Some(key) = map.next_key::<String>()? {
            match key.as_str() {
                "cells" => map.next_value_seed(TableSeed(&mut document.grid, allowance))?,
                "points" => read_column(&mut document.points, allowance, "points", &mut map)?,
                _ => drop(map.next_value::<IgnoredAny>()?),
            }
        }
        Ok(())
    }

    fn visit_unit<E: de::Error>(self) -> Result<(), E> {
        Ok(())
    }
}
