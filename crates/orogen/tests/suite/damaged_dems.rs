//! Damaged files of heights.

use crate::dems::corpus;
use crate::support::Random;
use orogen::io::format::{Request, Sidecar, import};
use std::io::Cursor;
use std::path::PathBuf;

/// Changes bytes of a file at random, like damage or an attack.
fn damage(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(3) {
        let length = bytes.len() as u64;
        if length == 0 {
            return;
        }
        // Headers and directories are at either end and affect most of the parser.
        let at = match random.below(4) {
            0 => random.below(length),
            1 => length - 1 - random.below(length.min(600)),
            _ => random.below(length.min(600)),
        } as usize;
        match random.below(6) {
            0 => bytes.truncate(at),
            1 => bytes[at] ^= 1 << random.below(8),
            2 => bytes[at] = random.below(256) as u8,
            3 => {
                let odd = [0u64, 1, 0x7fff_ffff, 0xffff_ffff, u64::MAX, 1 << 40][random.below(6) as usize];
                let size = [2, 4, 8][random.below(3) as usize].min(bytes.len() - at);
                bytes[at..at + size].copy_from_slice(&odd.to_le_bytes()[..size]);
            }
            4 => {
                let from = random.below(length) as usize;
                let size = (random.below(40) as usize).min(bytes.len() - at.max(from));
                bytes.copy_within(from..from + size, at);
            }
            _ => bytes.insert(at, random.below(256) as u8),
        }
    }
}

#[test]
fn damaged_files_are_heights_or_sentences() {
    read_damaged(300);
}

#[test]
#[ignore = "long: 30 000 damaged files of each kind"]
fn many_damaged_files_are_heights_or_sentences() {
    read_damaged(30_000);
}

/// Arbitrary bytes yield heights or an error, without a panic and within the memory limit.
fn read_damaged(rounds: usize) {
    let mut files: Vec<PathBuf> = std::fs::read_dir(corpus()).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let (mut read, mut refused) = (0, 0);
    let request = Request::new(1 << 20).with_band(Some(1));
    for (k, path) in files.iter().filter(|path| import::is_dem(path)).enumerate() {
        let whole = std::fs::read(path).unwrap();
        let extension = path.extension().unwrap().to_str().unwrap();
        let sidecar = Sidecar::beside(path).unwrap();
        let mut random = Random(k as u64);
        for round in 0..rounds {
            let mut bytes = whole.clone();
            damage(&mut bytes, &mut random);
            let mut result = None;
            let taken = allocation_counter::measure(|| {
                result = Some(import::parse(&mut Cursor::new(&bytes), "it", extension, sidecar.clone(), request));
            });
            assert!(taken.bytes_max < 12 << 20, "{} round {round} takes {} bytes", path.display(), taken.bytes_max);
            match result.unwrap() {
                Ok(dem) => {
                    assert!(dem.heights.len() == dem.width * dem.height && dem.missing() < dem.heights.len());
                    read += 1;
                }
                Err(error) => {
                    assert!(error.to_string().starts_with("cannot read it: "), "{error}");
                    refused += 1;
                }
            }
        }
        // A truncated file never yields heights, unless only unused bytes are missing.
        for n in (0..whole.len()).step_by(7) {
            if let Ok(dem) = import::parse(&mut Cursor::new(&whole[..n]), "it", extension, sidecar.clone(), request) {
                assert_eq!(dem.heights.len(), dem.width * dem.height, "{} cut at {n}", path.display());
            }
        }
    }
    assert!(read > 100 && refused > 1000, "{read} read, {refused} refused");
}
