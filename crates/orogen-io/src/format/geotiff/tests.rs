//! Reads written files with an independent reader.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Write};

use super::options::Options;
use super::writer::{Writer, write};
use crate::file;
use crate::spool::Spool;
use orogen_grid::grid::{Grid, Window};

/// A parsed file.
struct Tiff {
    bytes: Vec<u8>,
    big: bool,
    directories: Vec<BTreeMap<u16, Vec<u8>>>,
    /// The offset of each directory.
    stands: Vec<usize>,
}

impl Tiff {
    fn open(bytes: Vec<u8>) -> Tiff {
        let big = match &bytes[..4] {
            b"II\x2a\0" => false,
            b"II\x2b\0" => true,
            other => panic!("{other:?}"),
        };
        let mut tiff = Tiff { bytes, big, directories: Vec::new(), stands: Vec::new() };
        let mut at = if big { tiff.number(8, 8) } else { tiff.number(4, 4) };
        while at != 0 {
            at = tiff.directory(at);
        }
        tiff
    }

    fn number(&self, at: usize, length: usize) -> usize {
        let mut number = [0; 8];
        number[..length].copy_from_slice(&self.bytes[at..at + length]);
        u64::from_le_bytes(number) as usize
    }

    /// Reads the directory at `at`; returns the offset of the next one.
    fn directory(&mut self, at: usize) -> usize {
        assert_eq!(at % 2, 0, "directories begin at words");
        let (count_length, word) = if self.big { (8, 8) } else { (2, 4) };
        let mut fields = BTreeMap::new();
        let (mut entry, mut last) = (at + count_length, 0);
        for _ in 0..self.number(at, count_length) {
            let (tag, kind) = (self.number(entry, 2), self.number(entry + 2, 2));
            assert!(tag > last, "tags are sorted");
            last = tag;
            let size = match kind {
                2 => 1,
                3 => 2,
                4 => 4,
                12 | 16 => 8,
                other => panic!("type {other}"),
            };
            let length = self.number(entry + 4, word) * size;
            let inline = entry + 4 + word;
            let start = if length <= word { inline } else { self.number(inline, word) };
            assert_eq!(start % 2, 0, "values begin at words");
            fields.insert(tag as u16, self.bytes[start..start + length].to_vec());
            entry = inline + word;
        }
        self.directories.push(fields);
        self.stands.push(at);
        self.number(entry, word)
    }

    fn values<const N: usize>(&self, k: usize, tag: u16) -> Vec<[u8; N]> {
        self.directories[k][&tag].chunks_exact(N).map(|value| value.try_into().unwrap()).collect()
    }

    fn short(&self, k: usize, tag: u16) -> u16 {
        u16::from_le_bytes(self.values(k, tag)[0])
    }

    fn long(&self, k: usize, tag: u16) -> usize {
        u32::from_le_bytes(self.values(k, tag)[0]) as usize
    }

    fn doubles(&self, tag: u16) -> Vec<f64> {
        self.values(0, tag).into_iter().map(f64::from_le_bytes).collect()
    }

    fn size(&self, k: usize) -> (usize, usize) {
        (self.long(k, 256), self.long(k, 257))
    }

    /// Offset and length of each tile.
    fn tiles(&self, k: usize) -> Vec<(usize, usize)> {
        let offsets: Vec<usize> = match self.big {
            true => self.values(k, 324).into_iter().map(|o| u64::from_le_bytes(o) as usize).collect(),
            false => self.values(k, 324).into_iter().map(|o| u32::from_le_bytes(o) as usize).collect(),
        };
        let lengths = self.values(k, 325).into_iter().map(|l| u32::from_le_bytes(l) as usize);
        offsets.into_iter().zip(lengths).collect()
    }

    /// All samples of a level.
    fn samples(&self, k: usize) -> Vec<f32> {
        let fixed: Vec<u16> = [258, 259, 262, 277, 284, 317, 339].into_iter().map(|tag| self.short(k, tag)).collect();
        assert_eq!(fixed, [32, 8, 1, 1, 1, 3, 3]);
        assert_eq!(self.long(k, 254), usize::from(k > 0));
        let ((width, height), side) = (self.size(k), self.long(k, 322));
        assert_eq!(side, self.long(k, 323));
        let across = width.div_ceil(side);
        let tiles = self.tiles(k);
        assert_eq!(tiles.len(), across * height.div_ceil(side));
        let mut samples = vec![f32::NAN; width * height];
        for (n, (offset, length)) in tiles.into_iter().enumerate() {
            let packed = &self.bytes[offset..offset + length];
            assert_eq!(self.number(offset - 4, 4), length, "the leader");
            assert_eq!(packed[length - 4..], self.bytes[offset + length..][..4], "the trailer");
            let tile = unpack(packed, side);
            let (left, top) = (n % across * side, n / across * side);
            for j in top..height.min(top + side) {
                let inside = side.min(width - left);
                let row = &tile[(j - top) * side..][..inside];
                samples[j * width + left..][..inside].copy_from_slice(row);
            }
        }
        samples
    }
}

/// Reverses the compression and the predictor.
fn unpack(packed: &[u8], side: usize) -> Vec<f32> {
    let mut bytes = miniz_oxide::inflate::decompress_to_vec_zlib(packed).unwrap();
    assert_eq!(bytes.len(), 4 * side * side);
    let mut samples = Vec::new();
    for row in bytes.chunks_exact_mut(4 * side) {
        for i in 1..row.len() {
            row[i] = row[i].wrapping_add(row[i - 1]);
        }
        samples.extend((0..side).map(|i| f32::from_be_bytes([0, 1, 2, 3].map(|k| row[k * side + i]))));
    }
    samples
}

/// An asymmetric grid with negative numbers and all mantissas.
fn rough(window: Window) -> Grid {
    let data = (0..window.len()).map(|n| {
        let (i, j) = ((n % window.width) as f32, (n / window.width) as f32);
        (i * 0.37 - j * 0.11) * (1.0 + (n.wrapping_mul(2_654_435_761) % 1000) as f32 * 1e-5) - 3.3
    });
    Grid::from_data(window, data.collect()).unwrap()
}

fn bits(samples: &[f32]) -> Vec<u32> {
    samples.iter().map(|sample| sample.to_bits()).collect()
}

fn written(grid: &Grid, options: &Options) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(&mut bytes, grid, options, Spool::in_memory()).unwrap();
    bytes
}

fn small_tiles() -> Options {
    Options { tile: Some(16), ..Options::default() }
}

#[test]
fn every_size_comes_back_bit_for_bit() {
    for (width, height) in
        [(1, 1), (16, 16), (17, 16), (16, 17), (1, 100), (100, 1), (33, 47), (64, 64), (129, 65), (250, 3), (15, 257)]
    {
        for big in [false, true] {
            let grid = rough(Window::new(width, height, 2.0));
            let tiff = Tiff::open(written(&grid, &Options { big, ..small_tiles() }));
            assert_eq!(tiff.big, big);
            assert_eq!(bits(&tiff.samples(0)), bits(grid.data()), "{width} x {height}");
            let mut expect = vec![(width, height)];
            while let Some(&(w, h)) = expect.last()
                && w.max(h) > 16
            {
                expect.push((w.div_ceil(2), h.div_ceil(2)));
            }
            let sizes: Vec<(usize, usize)> = (0..tiff.directories.len()).map(|k| tiff.size(k)).collect();
            assert_eq!(sizes, expect);
        }
    }
}

#[test]
fn the_default_tile_and_odd_values() {
    let mut grid = rough(Window::new(700, 513, 30.0));
    let odd = [f32::NAN, f32::INFINITY, -0.0, f32::MIN, f32::MIN_POSITIVE / 8.0, f32::from_bits(0x7fc0_1234)];
    for (n, value) in odd.into_iter().enumerate() {
        grid.data_mut()[n * 60_000 + 511] = value;
    }
    let tiff = Tiff::open(written(&grid, &Options::default()));
    assert_eq!((tiff.long(0, 322), tiff.tiles(0).len(), tiff.directories.len()), (512, 4, 2));
    assert_eq!(bits(&tiff.samples(0)), bits(grid.data()));
    for (width, height, tile, levels) in
        [(1024, 512, 512, 2), (1024, 600, 512, 2), (1023, 1026, 384, 3), (512, 513, 384, 2)]
    {
        let tiff = Tiff::open(written(&Grid::filled(Window::new(width, height, 1.0), 1.0), &Options::default()));
        assert_eq!((tiff.long(0, 322), tiff.directories.len()), (tile, levels), "{width} x {height}");
    }
}

#[test]
fn everything_lies_in_the_order_that_is_promised() {
    let grid = rough(Window::new(100, 70, 1.0));
    for big in [false, true] {
        let tiff = Tiff::open(written(&grid, &Options { big, ..small_tiles() }));
        assert!(tiff.stands.is_sorted() && tiff.stands[0] == if big { 200 } else { 192 });
        assert!(tiff.bytes[if big { 16 } else { 8 }..].starts_with(b"GDAL_STRUCTURAL_METADATA_SIZE=000140 bytes\n"));
        // Tiles are contiguous, from the coarsest level to the full one, up to the end of the file.
        let tiles: Vec<(usize, usize)> = (0..tiff.directories.len()).rev().flat_map(|k| tiff.tiles(k)).collect();
        assert!(tiff.stands.iter().all(|at| *at < tiles[0].0));
        assert!(tiles.windows(2).all(|pair| pair[0].0 + pair[0].1 + 8 == pair[1].0));
        let (offset, length) = tiles[tiles.len() - 1];
        assert_eq!(offset + length + 4, tiff.bytes.len());
    }
}

#[test]
fn it_says_where_it_lies() {
    let grid = rough(Window::new(40, 30, 2.5).at(100, -8));
    let tiff = Tiff::open(written(&grid, &Options { nodata: Some(-9999.0), ..small_tiles() }));
    assert_eq!(tiff.doubles(33550), [2.5, 2.5, 0.0]);
    // Column 0, row 0 is the first sample itself: 250 m east and 20 m north of the origin.
    assert_eq!(tiff.doubles(33922), [0.0, 0.0, 0.0, 250.0, 20.0, 0.0]);
    let keys: Vec<u16> = tiff.values(0, 34735).into_iter().map(u16::from_le_bytes).collect();
    assert_eq!(keys[..12], [1, 1, 0, 4, 1024, 0, 1, 32767, 1025, 0, 1, 2]);
    assert_eq!(keys[12..], [1026, 34737, 13, 0, 3076, 0, 1, 9001]);
    assert_eq!(tiff.directories[0][&34737], b"Local metres|\0");
    for directory in &tiff.directories {
        assert_eq!(directory[&42113], b"-9999\0");
    }
    assert!(!tiff.directories[1].contains_key(&33922));
    let origin = Tiff::open(written(&rough(Window::new(2, 2, 1.0)), &small_tiles()));
    assert!(origin.doubles(33922).iter().all(|v| v.to_bits() == 0));
    assert!(!origin.directories[0].contains_key(&42113));
    for (nodata, text) in [(f32::NAN, &b"nan\0"[..]), (0.1, b"0.10000000149011612\0"), (f32::NEG_INFINITY, b"-inf\0")] {
        let options = Options { nodata: Some(nodata), ..small_tiles() };
        assert_eq!(Tiff::open(written(&grid, &options)).directories[0][&42113], text);
    }
}

#[test]
fn overviews_stand_where_readers_put_them() {
    // On a plane, the mean over a sample's area is the value at its center.
    for (width, height) in [(128, 96), (127, 97), (1001, 333)] {
        let plane = |x: f64, y: f64| 3.0 * x - 2.0 * y;
        let window = Window::new(width, height, 1.0);
        let data = (0..window.len()).map(|n| plane((n % width) as f64, (n / width) as f64) as f32).collect();
        let tiff = Tiff::open(written(&Grid::from_data(window, data).unwrap(), &small_tiles()));
        assert!(tiff.directories.len() >= 4);
        for k in 1..tiff.directories.len() {
            let (w, h) = tiff.size(k);
            let (a, b) = (width as f64 / w as f64, height as f64 / h as f64);
            for (n, sample) in tiff.samples(k).into_iter().enumerate() {
                let (x, y) = ((n % w) as f64 + 0.5, (n / w) as f64 + 0.5);
                let expect = plane(x * a - 0.5, y * b - 0.5);
                // For odd sizes, a fiftieth of the overview's cell.
                let most = if width % 2 == 0 { 1e-3 } else { 0.02 * (3.0 * a + 2.0 * b) };
                assert!((f64::from(sample) - expect).abs() <= most, "{width} {k} {n}: {sample}, not {expect}");
            }
        }
    }
}

#[test]
fn the_bytes_depend_neither_on_threads_nor_on_pieces() {
    let grid = rough(Window::new(150, 333, 1.0));
    let expect = written(&grid, &small_tiles());
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        for rows in [1, 2, 15, 16, 100, 333] {
            let mut bytes = Vec::new();
            pool.install(|| {
                let mut writer = Writer::new(grid.window(), &small_tiles(), Spool::in_memory())?;
                grid.data().chunks(150 * rows).try_for_each(|piece| writer.rows(piece))?;
                writer.finish(&mut bytes)
            })
            .unwrap();
            assert!(bytes == expect, "{threads} threads, {rows} rows at a time");
        }
    }
}

#[test]
fn what_cannot_be_written_is_an_error() {
    let new = |window: Window, tile| {
        Writer::new(&window, &Options { tile: Some(tile), ..Options::default() }, Spool::in_memory())
            .err()
            .map(|e| e.to_string())
    };
    for (window, tile, expect) in [
        (Window::new(0, 5, 1.0), 512, "samples a side, not 0"),
        (Window::new(5, 1 << 31, 1.0), 512, "not 2147483648"),
        (Window::new(5, 5, 0.0), 512, "cells of 0 m"),
        (Window::new(5, 5, f64::NAN), 512, "cells of NaN m"),
        (Window::new(5, 5, 1.0), 100, "a multiple of 16, not 100"),
        (Window::new(5, 5, 1.0), 0, "not 0"),
        (Window::new(5, 5, 1.0), 1 << 20, "16 to 8192"),
    ] {
        let said = new(window, tile);
        assert!(said.as_ref().is_some_and(|said| said.contains(expect)), "{window:?} {tile}: {said:?}");
    }
    let window = Window::new(3, 2, 1.0);
    let writer = || Writer::new(&window, &small_tiles(), Spool::in_memory()).unwrap();
    assert!(writer().rows(&[0.0; 4]).is_err() && writer().rows(&[0.0; 9]).is_err());
    let mut short = writer();
    short.rows(&[0.0; 3]).unwrap();
    assert!(short.finish(&mut Vec::new()).is_err());
}

/// Accepts `left` bytes, then fails like a full disk.
struct Full<'a> {
    out: &'a mut dyn Write,
    left: usize,
}

impl Write for Full<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.left == 0 && !bytes.is_empty() {
            return Err(io::ErrorKind::StorageFull.into());
        }
        let take = bytes.len().min(self.left);
        self.left -= take;
        self.out.write(&bytes[..take])
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[test]
fn a_disk_that_fills_up_at_any_byte_leaves_no_file() {
    let folder = std::env::temp_dir().join(format!("orogen-geotiff-{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("a.tif");
    let grid = rough(Window::new(18, 2, 1.0));
    let expect = written(&grid, &small_tiles());
    for left in 0..=expect.len() {
        let result = file::replace_whole(&path, |out| {
            write(&mut Full { out, left }, &grid, &small_tiles(), Spool::beside(&path))
        });
        assert_eq!(result.is_ok(), left == expect.len(), "after {left} of {} bytes", expect.len());
        assert_eq!(fs::read_dir(&folder).unwrap().count(), usize::from(left == expect.len()));
    }
    assert!(fs::read(&path).unwrap() == expect);
    fs::remove_dir_all(&folder).unwrap();
}
