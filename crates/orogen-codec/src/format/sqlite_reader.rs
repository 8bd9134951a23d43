//! Reads tables of SQLite database files (version 3).
//!
//! Follows "Database File Format", sqlite.org/fileformat2.html. Indexes, views, virtual tables and write-ahead logs are
//! not read.

use std::borrow::Cow;

use super::sqlite::{Column, FILE_HEAD, TABLE_INTERIOR, TABLE_LEAF};

/// The first bytes of a file.
const MAGIC: &[u8; 16] = b"SQLite format 3\0";

/// Maximum depth of a tree; those of files that fit in memory are far below it.
const MAX_DEPTH: usize = 20;

/// The smallest page size, in bytes.
const LEAST_PAGE: usize = 512;

/// The number of UTF-8 among the encodings of texts.
const UTF_8: u32 = 1;

/// What is wrong with a file whose parts contradict each other.
const DAMAGED: &str = "its database is damaged";

/// The names of the columns in `CREATE TABLE name (column type, ...)`.
fn column_names(made: &str) -> Vec<String> {
    let body = made.split_once('(').map_or("", |(_, body)| body);
    let (mut names, mut depth, mut quote, mut part) = (Vec::new(), 0, None, String::new());
    for letter in body.chars() {
        match (quote, letter) {
            (Some(end), _) => quote = Some(end).filter(|end| *end != letter),
            (None, '"' | '`' | '\'') => quote = Some(letter),
            (None, '[') => quote = Some(']'),
            (None, '(') => depth += 1,
            (None, ')') => depth -= 1,
            _ => {}
        }
        if depth < 0 || (depth == 0 && letter == ',' && quote.is_none()) {
            names.push(first_name(&part));
            part.clear();
        } else {
            part.push(letter);
        }
        if depth < 0 {
            break;
        }
    }
    names
}

/// The first word of the definition of a column, without quotes.
fn first_name(definition: &str) -> String {
    let definition = definition.trim();
    let end = |letter: char| match letter {
        '[' => Some(']'),
        '"' | '`' | '\'' => Some(letter),
        _ => None,
    };
    let quoted = definition.chars().next().and_then(end);
    match quoted {
        Some(end) => definition[1..].split(end).next().unwrap_or_default().to_string(),
        None => definition.split_whitespace().next().unwrap_or_default().to_string(),
    }
}

/// A database file in memory.
pub struct Reader<'a> {
    bytes: &'a [u8],
    page: usize,
    /// Bytes of a page that are in use.
    usable: usize,
}

impl<'a> Reader<'a> {
    /// The reader of a file.
    ///
    /// # Errors
    /// A message if the file is not such a database.
    pub fn new(bytes: &'a [u8]) -> Result<Reader<'a>, String> {
        let Some(head) = bytes.get(..FILE_HEAD).filter(|head| head.starts_with(MAGIC)) else {
            return Err("it is not an SQLite database".into());
        };
        let page = match u16::from_be_bytes([head[16], head[17]]) {
            1 => 1 << 16,
            size => usize::from(size),
        };
        let usable = page.saturating_sub(usize::from(head[20]));
        if !page.is_power_of_two() || page < LEAST_PAGE || usable < LEAST_PAGE - 32 {
            return Err(DAMAGED.into());
        }
        match four(head, 56)? {
            // A database without tables has no encoding yet.
            0 | UTF_8 => Ok(Reader { bytes, page, usable }),
            _ => Err("its texts are in UTF-16; save it as a new file in UTF-8".into()),
        }
    }

    /// The first page of a table with this name; `None` if there is no such table.
    ///
    /// # Errors
    /// A message if the file is damaged.
    pub fn table(&self, name: &str) -> Result<Option<u32>, String> {
        let mut found = None;
        self.rows(1, &mut |row| {
            if let [Column::Text("table"), Column::Text(own), _, Column::Integer(root), ..] = row
                && own.eq_ignore_ascii_case(name)
            {
                found = u32::try_from(*root).ok().filter(|root| *root > 0);
            }
            Ok(())
        })?;
        Ok(found)
    }

    /// The names of the columns of a table, by the statement that made it; empty if it cannot be understood.
    ///
    /// # Errors
    /// A message if the file is damaged.
    pub fn columns(&self, name: &str) -> Result<Vec<String>, String> {
        let mut found = Vec::new();
        self.rows(1, &mut |row| {
            if let [Column::Text("table"), Column::Text(own), _, _, Column::Text(made), ..] = row
                && own.eq_ignore_ascii_case(name)
            {
                found = column_names(made);
            }
            Ok(())
        })?;
        Ok(found)
    }

    /// Calls `visit` with the columns of each row of the table whose first page is `root`, in the order of the rows'
    /// numbers. Columns that were added to the table after the row are missing.
    ///
    /// # Errors
    /// A message if the file is damaged, or that of `visit`.
    pub fn rows(&self, root: u32, visit: &mut dyn FnMut(&[Column]) -> Result<(), String>) -> Result<(), String> {
        // In a sound file each byte is read at most twice: as a part of a page, and of a row.
        let mut left = 2 * self.bytes.len() + self.page;
        self.tree(root, 0, &mut left, visit)
    }

    fn tree(
        &self,
        number: u32,
        depth: usize,
        left: &mut usize,
        visit: &mut dyn FnMut(&[Column]) -> Result<(), String>,
    ) -> Result<(), String> {
        spend(left, self.page)?;
        let page = self.page(number)?;
        // The first page begins with the head of the file.
        let start = if number == 1 { FILE_HEAD } else { 0 };
        let (kind, cells) = (*page.get(start).ok_or(DAMAGED)?, two(page, start + 3)?);
        match kind {
            TABLE_LEAF => (0..cells).try_for_each(|k| {
                let cell = two(page, start + 8 + 2 * k)?;
                visit(&record(&self.payload(page, cell, left)?)?)
            }),
            TABLE_INTERIOR if depth < MAX_DEPTH => {
                for k in 0..cells {
                    let cell = two(page, start + 12 + 2 * k)?;
                    self.tree(four(page, cell)?, depth + 1, left, visit)?;
                }
                self.tree(four(page, start + 8)?, depth + 1, left, visit)
            }
            _ => Err(DAMAGED.into()),
        }
    }

    /// A page without its reserved part.
    fn page(&self, number: u32) -> Result<&'a [u8], String> {
        let start = (number as usize).checked_sub(1).and_then(|before| before.checked_mul(self.page)).ok_or(DAMAGED)?;
        let rest = self.bytes.get(start..).ok_or(DAMAGED)?;
        Ok(rest.get(..self.usable).ok_or("its database ends too early")?)
    }

    /// The content of a row, which may go on in other pages.
    fn payload(&self, page: &'a [u8], mut at: usize, left: &mut usize) -> Result<Cow<'a, [u8]>, String> {
        let length = usize::try_from(varint(page, &mut at)?).map_err(|_| DAMAGED)?;
        varint(page, &mut at)?;
        spend(left, length)?;
        let local = self.local(length);
        let first = page.get(at..at.saturating_add(local)).ok_or(DAMAGED)?;
        if local == length {
            return Ok(Cow::Borrowed(first));
        }
        let mut payload = Vec::with_capacity(length);
        payload.extend_from_slice(first);
        let mut next = four(page, at + local)?;
        while payload.len() < length {
            let page = self.page(next)?;
            let part = (length - payload.len()).min(self.usable - 4);
            payload.extend_from_slice(page.get(4..4 + part).ok_or(DAMAGED)?);
            next = four(page, 0)?;
        }
        Ok(Cow::Owned(payload))
    }

    /// The number of bytes of a row's content on its leaf.
    fn local(&self, length: usize) -> usize {
        if length <= self.usable - 35 {
            return length;
        }
        let least = (self.usable - 12) * 32 / 255 - 23;
        let local = least + (length - least) % (self.usable - 4);
        if local <= self.usable - 35 { local } else { least }
    }
}

/// Takes `bytes` from what may be read.
fn spend(left: &mut usize, bytes: usize) -> Result<(), String> {
    *left = left.checked_sub(bytes).ok_or(DAMAGED)?;
    Ok(())
}

fn bytes_at<const N: usize>(bytes: &[u8], at: usize) -> Result<[u8; N], String> {
    let part = at.checked_add(N).and_then(|end| bytes.get(at..end)).ok_or(DAMAGED)?;
    <[u8; N]>::try_from(part).map_err(|_| DAMAGED.into())
}

fn two(bytes: &[u8], at: usize) -> Result<usize, String> {
    bytes_at(bytes, at).map(u16::from_be_bytes).map(usize::from)
}

fn four(bytes: &[u8], at: usize) -> Result<u32, String> {
    bytes_at(bytes, at).map(u32::from_be_bytes)
}

/// Reads a variable-length integer of 1 to 9 bytes: seven bits per byte from the highest, and eight in the ninth.
fn varint(bytes: &[u8], at: &mut usize) -> Result<u64, String> {
    let mut number = 0;
    for k in 0..9 {
        let byte = *bytes.get(*at).ok_or(DAMAGED)?;
        *at += 1;
        if k == 8 {
            return Ok(number << 8 | u64::from(byte));
        }
        number = number << 7 | u64::from(byte & 0x7F);
        if byte & 0x80 == 0 {
            break;
        }
    }
    Ok(number)
}

/// The columns of a row.
fn record(payload: &[u8]) -> Result<Vec<Column<'_>>, String> {
    let mut at = 0;
    let end = usize::try_from(varint(payload, &mut at)?).map_err(|_| DAMAGED)?;
    let head = payload.get(..end).ok_or(DAMAGED)?;
    let (mut columns, mut body) = (Vec::new(), end);
    while at < end {
        let kind = varint(head, &mut at)?;
        let length = match kind {
            0 | 8 | 9 => 0,
            1..=4 => kind as usize,
            5 => 6,
            6 | 7 => 8,
            10 | 11 => return Err(DAMAGED.into()),
            _ => usize::try_from((kind - 12) / 2).map_err(|_| DAMAGED)?,
        };
        let part = body.checked_add(length).and_then(|end| payload.get(body..end)).ok_or(DAMAGED)?;
        body += length;
        columns.push(match kind {
            0 => Column::Null,
            8 => Column::Integer(0),
            9 => Column::Integer(1),
            7 => Column::Real(f64::from_be_bytes(bytes_at(part, 0)?)),
            1..=6 => Column::Integer(integer(part)),
            _ if kind.is_multiple_of(2) => Column::Blob(part),
            _ => Column::Text(std::str::from_utf8(part).map_err(|_| "a text of its database is not UTF-8")?),
        });
    }
    Ok(columns)
}

/// A big-endian integer of 1 to 8 bytes in two's complement.
fn integer(bytes: &[u8]) -> i64 {
    let sign = if bytes.first().is_some_and(|byte| byte & 0x80 != 0) { -1 } else { 0 };
    bytes.iter().fold(sign, |number, byte| number << 8 | i64::from(*byte))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::sqlite::Database;

    /// A database with a table `t` of these rows.
    fn written(rows: &[(i64, Vec<Column>)]) -> Vec<u8> {
        let mut database = Database::new();
        database.table("other", "CREATE TABLE other(a)", [(1, vec![Column::Integer(5)])]).unwrap();
        database.table("t", "CREATE TABLE t(a, b)", rows.iter().cloned()).unwrap();
        database.declare("view", "v", "v", "CREATE VIEW v AS SELECT * FROM t".into());
        let mut out = Vec::new();
        database.write(&mut out, 1, 2).unwrap();
        out
    }

    fn rows_of(bytes: &[u8], table: &str) -> Result<usize, String> {
        let reader = Reader::new(bytes)?;
        let Some(root) = reader.table(table)? else { return Ok(0) };
        let mut count = 0;
        reader.rows(root, &mut |_| {
            count += 1;
            Ok(())
        })?;
        Ok(count)
    }

    #[test]
    fn rows_are_those_that_were_written() {
        let long = [7u8; 20_000];
        let text = "text ".repeat(900);
        let numbers = [0, 1, -1, 127, -128, 128, 40_000, -8_388_609, 1 << 40, i64::MIN, i64::MAX];
        let mut rows: Vec<(i64, Vec<Column>)> =
            numbers.iter().map(|number| vec![Column::Integer(*number), Column::Null]).zip(1..).map(swap).collect();
        rows.push((20, vec![Column::Real(-0.1), Column::Blob(&long)]));
        rows.push((21, vec![Column::Text(&text), Column::Text("")]));
        rows.extend((22..9000).map(|k| (k, vec![Column::Integer(k), Column::Text("some text")])));
        let bytes = written(&rows);
        let reader = Reader::new(&bytes).unwrap();
        let mut expect = rows.iter();
        let root = reader.table("T").unwrap().unwrap();
        reader
            .rows(root, &mut |row| {
                assert_eq!(row, expect.next().unwrap().1);
                Ok(())
            })
            .unwrap();
        assert!(expect.next().is_none());
        assert_eq!((reader.table("v"), reader.table("none")), (Ok(None), Ok(None)));
    }

    fn swap((row, number): (Vec<Column<'_>>, i64)) -> (i64, Vec<Column<'_>>) {
        (number, row)
    }

    #[test]
    fn damaged_files_are_read_or_refused() {
        let long = [7u8; 9000];
        let rows: Vec<(i64, Vec<Column>)> =
            (1..600).map(|k| (k, vec![Column::Integer(k), Column::Blob(&long[..(k as usize * 37) % 9000])])).collect();
        let bytes = written(&rows);
        assert_eq!(rows_of(&bytes, "t"), Ok(599));
        assert!(rows_of(b"GPKG", "t").unwrap_err().contains("not an SQLite database"));
        for length in (0..bytes.len()).step_by(997) {
            assert!(rows_of(&bytes[..length], "t").is_err());
        }
        // Every byte of the first pages changed, and a few of the others.
        let mut damaged = bytes.clone();
        for at in (0..4 * 4096).chain((4 * 4096..bytes.len()).step_by(1009)) {
            for value in [0, 1, 5, 0x7F, 0xFF] {
                damaged[at] = value;
                if at % 64 < 8 || at < 4200 {
                    let _ = rows_of(&damaged, "t");
                }
            }
            damaged[at] = bytes[at];
        }
    }

    #[test]
    fn circles_of_pages_end() {
        let rows: Vec<(i64, Vec<Column>)> = (1..6000).map(|k| (k, vec![Column::Integer(k)])).collect();
        let mut bytes = written(&rows);
        let root = Reader::new(&bytes).unwrap().table("t").unwrap().unwrap();
        let at = (root as usize - 1) * 4096 + 8;
        bytes[at..at + 4].copy_from_slice(&root.to_be_bytes());
        assert_eq!(rows_of(&bytes, "t"), Err(DAMAGED.to_string()));
    }
}
