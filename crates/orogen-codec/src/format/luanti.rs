//! Map blocks of Luanti (Minetest), and the database that contains them.
//!
//! Follows "Luanti World Format 22...29" (doc/world_format.md): blocks of 16 x 16 x 16 nodes in version 28, which
//! Luanti reads since 0.4.16, compressed with zlib. x points east, y up and z north.

use std::io::{self, Write};

use miniz_oxide::deflate::compress_to_vec_zlib;

use super::sqlite::{Column, Database};

/// Number of nodes along a side of a map block.
pub const SIDE: usize = 16;

/// Number of nodes in a map block.
pub const NODES: usize = SIDE * SIDE * SIDE;

/// Maximum coordinate of a node, at which the world of Luanti ends.
pub const MAX_COORDINATE: i64 = 30_911;

/// Compression level.
const LEVEL: u8 = 6;

/// Returns the name of a node for its number in a block.
pub type Names<'a> = &'a dyn Fn(u8) -> &'a str;

/// The bytes of a map block, from its nodes and their daylight (0 to 15), each in the order z, y, x.
#[must_use]
pub fn block(nodes: &[u8; NODES], light: &[u8; NODES], is_underground: bool, names: Names) -> Vec<u8> {
    // Flags, then complete lighting, then the numbers of bytes of a node's content and parameters.
    let mut bytes = vec![28, u8::from(is_underground), 0xff, 0xff, 2, 2];
    let mut data: Vec<u8> = nodes.iter().flat_map(|node| [0, *node]).collect();
    data.extend_from_slice(light);
    data.resize(4 * NODES, 0);
    bytes.extend(compress_to_vec_zlib(&data, LEVEL));
    // No metadata.
    bytes.extend(compress_to_vec_zlib(&[0], LEVEL));
    // No objects, no time stamp.
    bytes.extend_from_slice(&[0, 0, 0, 0xff, 0xff, 0xff, 0xff]);
    let mut used = [false; 256];
    nodes.iter().for_each(|node| used[usize::from(*node)] = true);
    let used: Vec<u8> = (0..=255u8).filter(|node| used[usize::from(*node)]).collect();
    bytes.push(0);
    bytes.extend_from_slice(&(used.len() as u16).to_be_bytes());
    for node in used {
        let name = names(node).as_bytes();
        bytes.extend_from_slice(&[0, node]);
        bytes.extend_from_slice(&(name.len() as u16).to_be_bytes());
        bytes.extend_from_slice(name);
    }
    // No timers; a timer would have ten bytes.
    bytes.extend_from_slice(&[10, 0, 0]);
    bytes
}

/// The key of a map block at a position in blocks.
#[must_use]
pub fn key([x, y, z]: [i64; 3]) -> i64 {
    (z << 24) + (y << 12) + x
}

/// Writes `map.sqlite` from blocks with their keys, in ascending order of keys.
///
/// # Errors
/// If `out` fails, or the blocks are not in order.
pub fn write_database(out: &mut dyn Write, blocks: &[(i64, Vec<u8>)]) -> io::Result<()> {
    let mut database = Database::new();
    let rows = blocks.iter().map(|(key, bytes)| (*key, vec![Column::Null, Column::Blob(bytes)]));
    // The key is the row number, so the table needs no index.
    database.table("blocks", "CREATE TABLE `blocks` (`pos` INTEGER PRIMARY KEY, `data` BLOB)", rows)?;
    database.write(out, 0, 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_holds_its_nodes_and_the_names_of_those_it_has() {
        let mut nodes = [0u8; NODES];
        nodes[5] = 7;
        let mut light = [15u8; NODES];
        light[5] = 0;
        let names = |node: u8| if node == 7 { "a:stone" } else { "air" };
        let bytes = block(&nodes, &light, true, &names);
        assert_eq!(bytes[..6], [28, 1, 0xff, 0xff, 2, 2]);
        let data = miniz_oxide::inflate::decompress_to_vec_zlib(&bytes[6..]).unwrap();
        assert_eq!((data.len(), data[11], data[2 * NODES + 5], data[2 * NODES + 6]), (4 * NODES, 7, 0, 15));
        assert!(bytes.ends_with(b"\xff\xff\xff\xff\0\0\x02\0\0\0\x03air\0\x07\0\x07a:stone\x0a\0\0"));
        assert_eq!([key([1, 0, 0]), key([-1, 2, 0]), key([0, 0, -1])], [1, 8191, -16_777_216]);
    }

    #[test]
    fn the_database_is_in_order() {
        let mut out = Vec::new();
        write_database(&mut out, &[(-7, vec![1]), (3, vec![2; 5000])]).unwrap();
        assert!(out.starts_with(b"SQLite format 3\0"));
        assert!(write_database(&mut Vec::new(), &[(3, vec![]), (3, vec![])]).is_err());
    }
}
