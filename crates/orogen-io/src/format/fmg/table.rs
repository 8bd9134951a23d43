//! Lists of objects as tables: only the columns that are read are kept, whatever else the objects have.

use std::cell::Cell;
use std::fmt;

use serde::de::{self, DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

/// The methods of a visitor that passes over numbers, texts, `true`, `false` and `null`.
macro_rules! without_scalars {
    () => {
        fn visit_unit<E: de::Error>(self) -> Result<(), E> {
            Ok(())
        }

        fn visit_bool<E: de::Error>(self, _: bool) -> Result<(), E> {
            Ok(())
        }

        fn visit_i64<E: de::Error>(self, _: i64) -> Result<(), E> {
            Ok(())
        }

        fn visit_u64<E: de::Error>(self, _: u64) -> Result<(), E> {
            Ok(())
        }

        fn visit_f64<E: de::Error>(self, _: f64) -> Result<(), E> {
            Ok(())
        }

        fn visit_str<E: de::Error>(self, _: &str) -> Result<(), E> {
            Ok(())
        }
    };
}

/// Maximum number of rows of a table.
const MAX_ROWS: usize = 1 << 20;

/// Maximum length of a text, in characters; the rest is left out.
const MAX_TEXT: usize = 200;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A number.
    Number,
    /// A list of numbers; pairs of numbers in a list follow each other.
    List,
    /// A text.
    Text,
}

/// A name of a column, and what it holds.
pub type Column = (&'static str, Kind);

/// A value of a column. What it does not hold is missing.
#[derive(Debug, Clone, PartialEq)]
enum Data {
    Numbers(Vec<f64>),
    Lists { ends: Vec<usize>, items: Vec<f64> },
    Texts(Vec<Option<String>>),
}

/// The rows of a list of objects, or of an object of lists.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    columns: &'static [Column],
    data: Vec<Data>,
    rows: usize,
}

impl Table {
    /// A table without rows.
    pub fn new(columns: &'static [Column]) -> Table {
        let data = columns.iter().map(|(_, kind)| match kind {
            Kind::Number => Data::Numbers(Vec::new()),
            Kind::List => Data::Lists { ends: Vec::new(), items: Vec::new() },
            Kind::Text => Data::Texts(Vec::new()),
        });
        Table { columns, data: data.collect(), rows: 0 }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    fn data(&self, name: &str) -> Option<&Data> {
        self.data.get(self.columns.iter().position(|column| column.0 == name)?)
    }

    /// The number in a row, if it is finite.
    pub fn number(&self, name: &str, row: usize) -> Option<f64> {
        match self.data(name)? {
            Data::Numbers(numbers) => numbers.get(row).copied().filter(|number| number.is_finite()),
            Data::Texts(texts) => {
                texts.get(row)?.as_ref()?.trim().parse().ok().filter(|number: &f64| number.is_finite())
            }
            Data::Lists { .. } => None,
        }
    }

    /// The list in a row; empty if there is none.
    pub fn list(&self, name: &str, row: usize) -> &[f64] {
        let Some(Data::Lists { ends, items }) = self.data(name) else { return &[] };
        let Some(&end) = ends.get(row) else { return &[] };
        let start = row.checked_sub(1).and_then(|above| ends.get(above)).copied().unwrap_or(0);
        items.get(start..end).unwrap_or(&[])
    }

    /// The first two numbers of the list in a row, if they are finite.
    pub fn position(&self, name: &str, row: usize) -> Option<[f64; 2]> {
        match self.list(name, row) {
            &[x, y, ..] if x.is_finite() && y.is_finite() => Some([x, y]),
            _ => None,
        }
    }

    /// The text in a row, without white space around it, if it is not empty.
    pub fn text(&self, name: &str, row: usize) -> Option<&str> {
        let Some(Data::Texts(texts)) = self.data(name) else { return None };
        Some(texts.get(row)?.as_ref()?.trim()).filter(|text| !text.is_empty())
    }

    /// Whether any row has a value in this column.
    pub fn has(&self, name: &str) -> bool {
        match self.data(name) {
            Some(Data::Numbers(numbers)) => numbers.iter().any(|number| number.is_finite()),
            Some(Data::Lists { items, .. }) => !items.is_empty(),
            Some(Data::Texts(texts)) => texts.iter().any(Option::is_some),
            None => false,
        }
    }

    /// Sets a value of a row that has none yet. Rows come in order.
    fn set(&mut self, column: usize, row: usize, item: Item) {
        let Some(data) = self.data.get_mut(column) else { return };
        data.pad(row);
        match (data, item) {
            (Data::Numbers(numbers), item) if numbers.len() == row => numbers.push(item.number()),
            (Data::Lists { ends, items }, Item::List(list)) if ends.len() == row => {
                items.extend(list);
                ends.push(items.len());
            }
            (Data::Texts(texts), item) if texts.len() == row => texts.push(item.text()),
            _ => {}
        }
    }

    /// Makes all columns as long as the longest, with missing values.
    fn pad(&mut self, rows: usize) {
        self.rows = self.rows.max(rows);
        self.data.iter_mut().for_each(|data| data.pad(self.rows));
    }

    fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.0 == name)
    }
}

impl Data {
    fn pad(&mut self, rows: usize) {
        match self {
            Data::Numbers(numbers) if numbers.len() < rows => numbers.resize(rows, f64::NAN),
            Data::Lists { ends, items } if ends.len() < rows => ends.resize(rows, items.len()),
            Data::Texts(texts) if texts.len() < rows => texts.resize(rows, None),
            _ => {}
        }
    }
}

/// A value of JSON.
enum Item {
    Number(f64),
    Text(String),
    List(Vec<f64>),
    Other,
}

impl Item {
    fn number(self) -> f64 {
        match self {
            Item::Number(number) => number,
            Item::Text(text) => text.trim().parse().unwrap_or(f64::NAN),
            _ => f64::NAN,
        }
    }

    fn text(self) -> Option<String> {
        match self {
            Item::Text(text) => Some(text.chars().take(MAX_TEXT).collect()),
            Item::Number(number) => Some(number.to_string()),
            _ => None,
        }
    }
}

/// The number of values that may still be kept, so that a small file cannot take much memory.
#[derive(Debug)]
pub struct Allowance(Cell<usize>);

impl Allowance {
    /// An allowance of this many values.
    pub fn new(values: usize) -> Allowance {
        Allowance(Cell::new(values))
    }

    fn take<E: de::Error>(&self, values: usize) -> Result<(), E> {
        match self.0.get().checked_sub(values) {
            Some(left) => {
                self.0.set(left);
                Ok(())
            }
            None => Err(E::custom("it has more values than a map of the largest size")),
        }
    }
}

/// Reads a table: a list of objects, or an object of lists.
pub struct TableSeed<'a>(pub &'a mut Table, pub &'a Allowance);

impl<'de> DeserializeSeed<'de> for TableSeed<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for TableSeed<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a list of objects")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut rows: A) -> Result<(), A::Error> {
        let TableSeed(table, allowance) = self;
        while rows.next_element_seed(RowSeed(table, allowance))?.is_some() {
            if table.rows > MAX_ROWS {
                return Err(de::Error::custom(format!("it has a list of more than {MAX_ROWS} objects")));
            }
        }
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let TableSeed(table, allowance) = self;
        while let Some(key) = map.next_key::<String>()? {
            read_column(table, allowance, &key, &mut map)?;
        }
        Ok(())
    }

    without_scalars!();
}

/// Reads the value of a key as a column, or skips it if the table has no such column.
pub fn read_column<'de, A: MapAccess<'de>>(
    table: &mut Table,
    allowance: &Allowance,
    key: &str,
    map: &mut A,
) -> Result<(), A::Error> {
    match table.column(key) {
        Some(column) => map.next_value_seed(ColumnSeed { table, allowance, column }),
        None => map.next_value::<IgnoredAny>().map(drop),
    }
}

/// Reads one object into the next row. What is no object is a row without values.
pub struct RowSeed<'a>(pub &'a mut Table, pub &'a Allowance);

impl<'de> DeserializeSeed<'de> for RowSeed<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        let RowSeed(table, allowance) = self;
        allowance.take(table.columns.len())?;
        let row = table.rows;
        let read = deserializer.deserialize_any(RowVisitor { table, allowance, row });
        table.pad(row + 1);
        read
    }
}

struct RowVisitor<'a> {
    table: &'a mut Table,
    allowance: &'a Allowance,
    row: usize,
}

impl<'de> Visitor<'de> for RowVisitor<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key::<String>()? {
            match self.table.column(&key) {
                Some(column) => {
                    let item = map.next_value_seed(ItemSeed(self.allowance))?;
                    self.table.set(column, self.row, item);
                }
                None => drop(map.next_value::<IgnoredAny>()?),
            }
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<(), A::Error> {
        while items.next_element::<IgnoredAny>()?.is_some() {}
        Ok(())
    }

    without_scalars!();
}

/// Reads a list of values into a column.
struct ColumnSeed<'a> {
    table: &'a mut Table,
    allowance: &'a Allowance,
    column: usize,
}

impl<'de> DeserializeSeed<'de> for ColumnSeed<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for ColumnSeed<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a list")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<(), A::Error> {
        let ColumnSeed { table, allowance, column } = self;
        let mut row = 0;
        while let Some(item) = items.next_element_seed(ItemSeed(allowance))? {
            allowance.take(table.columns.len())?;
            if row >= MAX_ROWS {
                return Err(de::Error::custom(format!("it has a list of more than {MAX_ROWS} values")));
            }
            table.set(column, row, item);
            row += 1;
        }
        // Other columns may still come.
        table.rows = table.rows.max(row);
        Ok(())
    }
}

/// Reads any value.
struct ItemSeed<'a>(&'a Allowance);

impl<'de> DeserializeSeed<'de> for ItemSeed<'_> {
    type Value = Item;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Item, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for ItemSeed<'_> {
    type Value = Item;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Item, A::Error> {
        let mut list = Vec::new();
        while let Some(item) = items.next_element_seed(ItemSeed(self.0))? {
            match item {
                Item::List(pair) => {
                    let number = |k: usize| pair.get(k).copied().unwrap_or(f64::NAN);
                    self.0.take(2)?;
                    list.extend([number(0), number(1)]);
                }
                item => {
                    self.0.take(1)?;
                    list.push(item.number());
                }
            }
        }
        Ok(Item::List(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Item, A::Error> {
        while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
        Ok(Item::Other)
    }

    fn visit_unit<E: de::Error>(self) -> Result<Item, E> {
        Ok(Item::Other)
    }

    fn visit_bool<E: de::Error>(self, value: bool) -> Result<Item, E> {
        Ok(Item::Number(f64::from(u8::from(value))))
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Item, E> {
        Ok(Item::Number(value as f64))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Item, E> {
        Ok(Item::Number(value as f64))
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Item, E> {
        Ok(Item::Number(value))
    }

    fn visit_str<E: de::Error>(self, value: &str) -> Result<Item, E> {
        Ok(Item::Text(value.to_owned()))
    }
}
