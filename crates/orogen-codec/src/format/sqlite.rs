//! SQLite database files (version 3), written once from start to end. Tables with sorted rows become packed B-trees.
//!
//! Follows "Database File Format", sqlite.org/fileformat2.html, with pages of 4096 bytes, UTF-8 and rollback journal.
//! Databases are neither changed here nor read; for that see `sqlite_reader`.

use std::io::{self, Write};

/// Page size in bytes.
pub const PAGE: usize = 4096;

/// Size of the file header in the first page, in bytes.
pub(super) const FILE_HEAD: usize = 100;

/// The version of SQLite that is written into the file.
const SQLITE_VERSION: u32 = 3_045_000;

/// The page that contains the byte that SQLite locks; it is never used.
const LOCKED: u32 = (1 << 30) / PAGE as u32 + 1;

/// Types of pages.
pub(super) const TABLE_LEAF: u8 = 0x0D;
pub(super) const TABLE_INTERIOR: u8 = 0x05;
const INDEX_LEAF: u8 = 0x0A;

/// A value of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Column<'a> {
    /// NULL, also for a column that is an alias of the row's number.
    Null,
    /// An integer.
    Integer(i64),
    /// A floating-point number.
    Real(f64),
    /// A text.
    Text(&'a str),
    /// Bytes.
    Blob(&'a [u8]),
}

/// A database that is being written.
pub struct Database {
    /// All pages. The first one is filled at the end.
    pages: Vec<u8>,
    /// The rows of `sqlite_schema`: type, name, table, root page, SQL.
    schema: Vec<(&'static str, String, String, u32, Option<String>)>,
}

impl Default for Database {
    fn default() -> Database {
        Database::new()
    }
}

impl Database {
    /// A database without tables.
    #[must_use]
    pub fn new() -> Database {
        Database { pages: vec![0; PAGE], schema: Vec::new() }
    }

    /// Adds a table. Its rows must be in ascending order of their numbers.
    ///
    /// Fails if the rows are not in order.
    pub fn table<'a>(
        &mut self,
        name: &str,
        sql: &str,
        rows: impl IntoIterator<Item = (i64, Vec<Column<'a>>)>,
    ) -> io::Result<()> {
        let mut tree = Tree::default();
        let mut before = None;
        for (number, columns) in rows {
            if before.is_some_and(|before| before >= number) {
                return Err(io::Error::other(format!("rows of {name} out of order: {number}")));
            }
            before = Some(number);
            let cell = self.table_cell(number, &record(&columns));
            if !tree.fits(&cell, PAGE) {
                self.leaf(&mut tree);
            }
            tree.cells.push(cell);
            tree.last = number;
        }
        let root = match tree.children.is_empty() {
            true => self.push(&page(TABLE_LEAF, &tree.cells, None, 0)),
            false => {
                self.leaf(&mut tree);
                let children = self.joined(tree.children, 0);
                self.push(&interior(&children, 0))
            }
        };
        self.schema.push(("table", name.to_string(), name.to_string(), root, Some(sql.to_string())));
        Ok(())
    }

    /// Adds the index that SQLite creates for the `number`-th UNIQUE or PRIMARY KEY constraint of a table. `keys` are
    /// the keys, each with its row number.
    ///
    /// Fails if the keys need more than a page.
    pub fn unique_index(&mut self, table: &str, number: usize, mut keys: Vec<(Vec<&str>, i64)>) -> io::Result<()> {
        keys.sort_unstable();
        let mut tree = Tree::default();
        for (columns, row) in &keys {
            let columns: Vec<Column> =
                columns.iter().map(|text| Column::Text(text)).chain([Column::Integer(*row)]).collect();
            let payload = record(&columns);
            let mut cell = Vec::new();
            varint(payload.len() as u64, &mut cell);
            cell.extend_from_slice(&payload);
            if !tree.fits(&cell, PAGE) {
                return Err(io::Error::other(format!("too many keys of {table} for a page")));
            }
            tree.cells.push(cell);
        }
        let root = self.push(&page(INDEX_LEAF, &tree.cells, None, 0));
        let name = format!("sqlite_autoindex_{table}_{number}");
        self.schema.push(("index", name, table.to_string(), root, None));
        Ok(())
    }

    /// Adds an object without rows: a `"trigger"`, or a virtual `"table"`.
    pub fn declare(&mut self, kind: &'static str, name: &str, table: &str, sql: String) {
        self.schema.push((kind, name.to_string(), table.to_string(), 0, Some(sql)));
    }

    /// Writes the file.
    ///
    /// Fails if `out` fails.
    pub fn write(mut self, out: &mut dyn Write, application: u32, user_version: u32) -> io::Result<()> {
        let schema = std::mem::take(&mut self.schema);
        let mut tree = Tree::default();
        for (k, (kind, name, table, root, sql)) in schema.iter().enumerate() {
            let sql = sql.as_deref().map_or(Column::Null, Column::Text);
            let columns =
                [Column::Text(kind), Column::Text(name), Column::Text(table), Column::Integer(i64::from(*root)), sql];
            let cell = self.table_cell(k as i64 + 1, &record(&columns));
            // The first page has less room. Only at the end is it known whether all rows fit there.
            if !tree.fits(&cell, PAGE - FILE_HEAD) {
                self.leaf(&mut tree);
            }
            tree.cells.push(cell);
            tree.last = k as i64 + 1;
        }
        let mut first = match tree.children.is_empty() {
            true => page(TABLE_LEAF, &tree.cells, None, FILE_HEAD),
            false => {
                self.leaf(&mut tree);
                let children = self.joined(tree.children, FILE_HEAD);
                interior(&children, FILE_HEAD)
            }
        };
        let count = self.count();
        let mut head = Vec::with_capacity(FILE_HEAD);
        head.extend_from_slice(b"SQLite format 3\0");
        head.extend_from_slice(&(PAGE as u16).to_be_bytes());
        // Rollback journal for writers and readers, no reserved bytes, and the fixed payload fractions.
        head.extend_from_slice(&[1, 1, 0, 64, 32, 32]);
        // Change counter, pages, free list, schema cookie and format, cache, vacuum, UTF-8, versions.
        let numbers = [1, count, 0, 0, 1, 4, 0, 0, 1, user_version, 0, application];
        numbers.iter().for_each(|number| head.extend_from_slice(&u32::to_be_bytes(*number)));
        head.extend_from_slice(&[0; 20]);
        [1, SQLITE_VERSION].iter().for_each(|number| head.extend_from_slice(&u32::to_be_bytes(*number)));
        first[..FILE_HEAD].copy_from_slice(&head);
        out.write_all(&first)?;
        out.write_all(&self.pages[PAGE..])
    }

    /// Number of pages.
    fn count(&self) -> u32 {
        (self.pages.len() / PAGE) as u32
    }

    /// Adds a page; returns its number, from 1.
    fn push(&mut self, page: &[u8]) -> u32 {
        if self.count() + 1 == LOCKED {
            self.pages.resize(self.pages.len() + PAGE, 0);
        }
        self.pages.extend_from_slice(page);
        self.count()
    }

    /// Writes the collected cells as a leaf.
    fn leaf(&mut self, tree: &mut Tree) {
        let number = self.push(&page(TABLE_LEAF, &tree.cells, None, 0));
        tree.children.push((number, tree.last));
        tree.cells.clear();
    }

    /// Adds interior pages until the remaining children fit on one page in addition to `taken` bytes.
    fn joined(&mut self, mut children: Vec<(u32, i64)>, taken: usize) -> Vec<(u32, i64)> {
        // A child needs its pointer, its page number and at most nine bytes of the number of its last row.
        const CHILD: usize = 2 + 4 + 9;
        let most = |taken: usize| (PAGE - taken - 12) / CHILD;
        while children.len() > most(taken) {
            // Children are distributed evenly, so that no page has a single child.
            let groups = children.len().div_ceil(most(0));
            let count = children.len();
            let ends = (1..=groups).map(|k| k * count / groups);
            let starts = (0..groups).map(|k| k * count / groups);
            let joined = starts.zip(ends).map(|(start, end)| {
                let group = &children[start..end];
                let number = self.push(&interior(group, 0));
                (number, group.last().map_or(0, |child| child.1))
            });
            children = joined.collect();
        }
        children
    }

    /// The cell of a row on a leaf. Adds overflow pages if the row does not fit.
    fn table_cell(&mut self, number: i64, payload: &[u8]) -> Vec<u8> {
        let mut cell = Vec::new();
        varint(payload.len() as u64, &mut cell);
        varint(number as u64, &mut cell);
        let here = local(payload.len());
        cell.extend_from_slice(&payload[..here]);
        let rest = &payload[here..];
        if !rest.is_empty() {
            let pieces: Vec<&[u8]> = rest.chunks(PAGE - 4).collect();
            // The last page comes first, because each page refers to the next one.
            let mut next = 0u32;
            for piece in pieces.iter().rev() {
                let mut page = Vec::with_capacity(PAGE);
                page.extend_from_slice(&next.to_be_bytes());
                page.extend_from_slice(piece);
                page.resize(PAGE, 0);
                next = self.push(&page);
            }
            cell.extend_from_slice(&next.to_be_bytes());
        }
        cell
    }
}

/// Number of bytes of a row of this length that are stored on its leaf.
fn local(length: usize) -> usize {
    let most = PAGE - 35;
    if length <= most {
        return length;
    }
    let least = (PAGE - 12) * 32 / 255 - 23;
    let fit = least + (length - least) % (PAGE - 4);
    if fit <= most { fit } else { least }
}

/// A table under construction.
#[derive(Default)]
struct Tree {
    /// The cells of the current leaf.
    cells: Vec<Vec<u8>>,
    /// The number of the last row.
    last: i64,
    /// The leaves so far, each with the number of its last row.
    children: Vec<(u32, i64)>,
}

impl Tree {
    /// Whether the current leaf has room for another cell.
    fn fits(&self, cell: &[u8], room: usize) -> bool {
        let taken: usize = self.cells.iter().map(|cell| cell.len() + 2).sum();
        8 + taken + cell.len() + 2 <= room
    }
}

/// A page of cells, which are placed from the end of the page.
fn page(kind: u8, cells: &[Vec<u8>], rightmost: Option<u32>, taken: usize) -> Vec<u8> {
    let mut page = vec![0u8; PAGE];
    let mut at = PAGE;
    let mut pointer = taken + if rightmost.is_some() { 12 } else { 8 };
    for cell in cells {
        at -= cell.len();
        page[at..at + cell.len()].copy_from_slice(cell);
        page[pointer..pointer + 2].copy_from_slice(&(at as u16).to_be_bytes());
        pointer += 2;
    }
    page[taken] = kind;
    page[taken + 3..taken + 5].copy_from_slice(&(cells.len() as u16).to_be_bytes());
    page[taken + 5..taken + 7].copy_from_slice(&(at as u16).to_be_bytes());
    if let Some(number) = rightmost {
        page[taken + 8..taken + 12].copy_from_slice(&number.to_be_bytes());
    }
    page
}

/// An interior page.
fn interior(children: &[(u32, i64)], taken: usize) -> Vec<u8> {
    let Some(((rightmost, _), others)) = children.split_last() else { return vec![0; PAGE] };
    let cells: Vec<Vec<u8>> = (others.iter())
        .map(|(number, last)| {
            let mut cell = number.to_be_bytes().to_vec();
            varint(*last as u64, &mut cell);
            cell
        })
        .collect();
    page(TABLE_INTERIOR, &cells, Some(*rightmost), taken)
}

/// A row: the types of its columns, then their values.
fn record(columns: &[Column]) -> Vec<u8> {
    let (mut types, mut body) = (Vec::new(), Vec::new());
    for column in columns {
        let kind = match column {
            Column::Null => 0,
            Column::Integer(0) => 8,
            Column::Integer(1) => 9,
            Column::Integer(number) => {
                let sizes = [(1, 1), (2, 2), (3, 3), (4, 4), (6, 5), (8, 6)];
                let fits =
                    |bytes: u32| bytes == 8 || (-(1i64 << (8 * bytes - 1))..1i64 << (8 * bytes - 1)).contains(number);
                let (bytes, kind) = sizes.into_iter().find(|(bytes, _)| fits(*bytes)).unwrap_or((8, 6));
                body.extend_from_slice(&number.to_be_bytes()[8 - bytes as usize..]);
                kind
            }
            Column::Real(number) => {
                body.extend_from_slice(&number.to_be_bytes());
                7
            }
            Column::Text(text) => {
                body.extend_from_slice(text.as_bytes());
                2 * text.len() as u64 + 13
            }
            Column::Blob(bytes) => {
                body.extend_from_slice(bytes);
                2 * bytes.len() as u64 + 12
            }
        };
        varint(kind, &mut types);
    }
    // The header's length includes itself; all lengths here take one or two bytes.
    let mut out = Vec::with_capacity(types.len() + body.len() + 2);
    let length = types.len() as u64 + 1;
    varint(if length < 128 { length } else { length + 1 }, &mut out);
    out.extend_from_slice(&types);
    out.extend_from_slice(&body);
    out
}

/// Appends a variable-length integer of 1 to 9 bytes: seven bits per byte from the highest, and eight in the ninth.
fn varint(number: u64, out: &mut Vec<u8>) {
    if number >> 56 != 0 {
        (0..8).for_each(|k| out.push((number >> (57 - 7 * k)) as u8 & 0x7F | 0x80));
        out.push(number as u8);
        return;
    }
    let groups = (70 - (number | 1).leading_zeros()) / 7;
    (0..groups).rev().for_each(|k| out.push((number >> (7 * k)) as u8 & 0x7F | if k > 0 { 0x80 } else { 0 }));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_take_as_many_bytes_as_they_need() {
        for (number, expect) in [
            (0u64, vec![0]),
            (127, vec![127]),
            (128, vec![0x81, 0]),
            (16_383, vec![0xFF, 0x7F]),
            (16_384, vec![0x81, 0x80, 0]),
            (1 << 56, vec![0x80, 0xC0, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0]),
            (u64::MAX, vec![0xFF; 9]),
        ] {
            let mut out = Vec::new();
            varint(number, &mut out);
            assert_eq!(out, expect, "{number}");
        }
    }

    #[test]
    fn rows_hold_their_types() {
        let row = record(&[
            Column::Null,
            Column::Integer(-3),
            Column::Integer(1),
            Column::Integer(70_000),
            Column::Real(1.0),
            Column::Text("ab"),
            Column::Blob(&[7]),
        ]);
        let expect = [8, 0, 1, 9, 3, 7, 17, 14, 0xFD, 1, 0x11, 0x70, 0x3F, 0xF0, 0, 0, 0, 0, 0, 0, b'a', b'b', 7];
        assert_eq!(row, expect);
    }

    #[test]
    fn what_does_not_fit_on_a_leaf_goes_on_elsewhere() {
        assert_eq!([100, 4061, 4062, 20_000].map(local), [100, 4061, 489, 489 + (20_000 - 489) % 4092]);
        let mut database = Database::new();
        let bytes = vec![5u8; 10_000];
        database.table("t", "CREATE TABLE t(a)", [(1, vec![Column::Blob(&bytes)])]).unwrap();
        let mut out = Vec::new();
        database.write(&mut out, 1, 2).unwrap();
        // The first page, two overflow pages, and the leaf.
        assert_eq!((out.len() % PAGE, out.len() / PAGE, &out[..15]), (0, 4, &b"SQLite format 3"[..]));
        assert_eq!(u32::from_be_bytes([out[28], out[29], out[30], out[31]]), 4);
    }

    #[test]
    fn trees_are_as_deep_as_needed_and_no_page_is_alone() {
        for count in [1i64, 300, 5000, 200_000] {
            let mut database = Database::new();
            let rows = (0..count).map(|k| (k + 1, vec![Column::Integer(k), Column::Text("some text")]));
            database.table("t", "CREATE TABLE t(a, b)", rows).unwrap();
            let mut out = Vec::new();
            database.write(&mut out, 0, 0).unwrap();
            // A walk from the root visits all rows in order.
            let root = out.chunks(PAGE).count();
            let mut found = 0;
            walk(&out, root as u32, &mut found);
            assert_eq!(found, count);
        }
        let mut database = Database::new();
        let rows = [2, 1].map(|k| (k, vec![Column::Null]));
        assert!(database.table("t", "", rows).is_err());
    }

    fn walk(file: &[u8], number: u32, found: &mut i64) {
        let page = &file[(number as usize - 1) * PAGE..number as usize * PAGE];
        let two = |at: usize| usize::from(u16::from_be_bytes([page[at], page[at + 1]]));
        let four = |at: usize| u32::from_be_bytes([page[at], page[at + 1], page[at + 2], page[at + 3]]);
        let cells = two(3);
        match page[0] {
            TABLE_LEAF => {
                assert!(cells > 0);
                for k in 0..cells {
                    let at = two(8 + 2 * k);
                    let (_, row) = (read(page, at), read(page, at + 1));
                    *found += 1;
                    assert_eq!(row, *found as u64);
                }
            }
            TABLE_INTERIOR => {
                assert!(cells > 0, "a page over one page");
                for k in 0..cells {
                    let at = two(12 + 2 * k);
                    walk(file, four(at), found);
                    assert_eq!(read(page, at + 4), *found as u64);
                }
                walk(file, four(8), found);
            }
            kind => panic!("page {number} is of kind {kind}"),
        }
    }

    fn read(page: &[u8], at: usize) -> u64 {
        let mut number = 0;
        for byte in page[at..].iter().take(8) {
            number = number << 7 | u64::from(byte & 0x7F);
            if byte & 0x80 == 0 {
                break;
            }
        }
        number
    }
}
