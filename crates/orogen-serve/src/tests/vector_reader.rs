//! A reader of vector tiles, written from the specification of their format alone.

use std::collections::BTreeMap;

use serde_json::{Value, json};

/// A feature: the type of its geometry (1 points, 2 lines, 3 polygons), its paths, and its attributes.
#[derive(Debug, Clone, PartialEq)]
pub struct Feature {
    pub kind: u64,
    pub paths: Vec<Vec<[i64; 2]>>,
    pub values: BTreeMap<String, Value>,
}

/// The layers of a tile, by name.
pub fn layers(bytes: &[u8]) -> BTreeMap<String, Vec<Feature>> {
    fields(bytes).into_iter().map(|(_, layer)| read_layer(layer.bytes())).collect()
}

fn read_layer(bytes: &[u8]) -> (String, Vec<Feature>) {
    let fields = fields(bytes);
    let all = |number: u64| fields.iter().filter(move |(own, _)| *own == number).map(|(_, content)| content);
    let texts = |number| all(number).map(|text| String::from_utf8(text.bytes().to_vec()).unwrap()).collect::<Vec<_>>();
    let (keys, values) = (texts(3), all(4).map(|value| read_value(value.bytes())).collect::<Vec<_>>());
    assert_eq!((all(15).next().unwrap().number(), all(5).next().unwrap().number()), (2, 4096));
    let feature = |bytes: &[u8]| {
        let parts: BTreeMap<u64, Content> = self::fields(bytes).into_iter().collect();
        let tags = numbers(parts[&2].bytes());
        let kind = parts[&3].number();
        let pair = |tag: &[u64]| (keys[tag[0] as usize].clone(), values[tag[1] as usize].clone());
        Feature {
            kind,
            paths: paths(&numbers(parts[&4].bytes()), kind),
            values: tags.chunks_exact(2).map(pair).collect(),
        }
    };
    (texts(1).remove(0), all(2).map(|content| feature(content.bytes())).collect())
}

fn read_value(bytes: &[u8]) -> Value {
    let (number, content) = fields(bytes).remove(0);
    match number {
        1 => json!(std::str::from_utf8(content.bytes()).unwrap()),
        2 => json!(f32::from_le_bytes(content.bytes().try_into().unwrap())),
        3 => json!(f64::from_le_bytes(content.bytes().try_into().unwrap())),
        5 => json!(content.number()),
        6 => json!(unzigzag(content.number())),
        7 => json!(content.number() == 1),
        _ => panic!("value of type {number}"),
    }
}

/// The paths of commands; rings are closed by their first point.
fn paths(commands: &[u64], kind: u64) -> Vec<Vec<[i64; 2]>> {
    let (mut at, mut next, mut paths) = ([0, 0], 0, Vec::<Vec<[i64; 2]>>::new());
    while next < commands.len() {
        let (command, count) = (commands[next] & 7, commands[next] >> 3);
        next += 1;
        if command == 7 {
            assert_eq!((kind, count), (3, 1));
            let ring = paths.last_mut().unwrap();
            ring.push(ring[0]);
            continue;
        }
        for _ in 0..count {
            at = [at[0] + unzigzag(commands[next]), at[1] + unzigzag(commands[next + 1])];
            next += 2;
            match command {
                1 => paths.push(vec![at]),
                2 => paths.last_mut().unwrap().push(at),
                _ => panic!("command {command}"),
            }
        }
    }
    paths
}

fn unzigzag(number: u64) -> i64 {
    (number >> 1) as i64 ^ -((number & 1) as i64)
}

/// The content of a field.
#[derive(Debug, Clone)]
enum Content<'a> {
    Number(u64),
    Bytes(&'a [u8]),
}

impl<'a> Content<'a> {
    fn number(&self) -> u64 {
        if let Content::Number(number) = self { *number } else { panic!("not a number") }
    }

    fn bytes(&self) -> &'a [u8] {
        if let Content::Bytes(bytes) = self { bytes } else { panic!("not bytes") }
    }
}

fn fields(mut bytes: &[u8]) -> Vec<(u64, Content<'_>)> {
    let mut fields = Vec::new();
    while !bytes.is_empty() {
        let key = number(&mut bytes);
        let mut take = |length: usize| {
            let (content, rest) = bytes.split_at(length);
            bytes = rest;
            Content::Bytes(content)
        };
        let content = match key & 7 {
            1 => take(8),
            5 => take(4),
            2 => {
                let length = number(&mut bytes);
                let (content, rest) = bytes.split_at(length as usize);
                bytes = rest;
                Content::Bytes(content)
            }
            0 => Content::Number(number(&mut bytes)),
            kind => panic!("wire type {kind}"),
        };
        fields.push((key >> 3, content));
    }
    fields
}

fn numbers(mut bytes: &[u8]) -> Vec<u64> {
    let mut numbers = Vec::new();
    while !bytes.is_empty() {
        numbers.push(number(&mut bytes));
    }
    numbers
}

fn number(bytes: &mut &[u8]) -> u64 {
    let (mut number, mut shift) = (0, 0);
    loop {
        let (byte, rest) = bytes.split_first().unwrap();
        *bytes = rest;
        number |= u64::from(byte & 0x7f) << shift;
        shift += 7;
        if byte & 0x80 == 0 {
            return number;
        }
    }
}
