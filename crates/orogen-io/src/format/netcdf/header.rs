//! The header of a NetCDF-3 file: its dimensions, variables and attributes, parsed without trusting the file.
//!
//! The format: Unidata, "The NetCDF Classic Format Specification"; CDF-5: PnetCDF. All numbers are big-endian.

use std::io::{BufReader, Read};

use crate::format::dem::{Input, length};
use crate::format::stored::{self, Stored};

/// Maximum length of a header, in bytes.
const MAX_LENGTH: u64 = 1 << 20;

/// Tags of the lists.
const DIMENSIONS: u32 = 10;
const VARIABLES: u32 = 11;
const ATTRIBUTES: u32 = 12;

/// The type of values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Signed,
    Unsigned,
    Float,
    Text,
}

/// The type of values and their size in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Type {
    pub kind: Kind,
    pub size: usize,
}

impl Type {
    fn of(code: u32) -> Option<Type> {
        let (kind, size) = match code {
            1 => (Kind::Signed, 1),
            2 => (Kind::Text, 1),
            3 => (Kind::Signed, 2),
            4 => (Kind::Signed, 4),
            5 => (Kind::Float, 4),
            6 => (Kind::Float, 8),
            7 => (Kind::Unsigned, 1),
            8 => (Kind::Unsigned, 2),
            9 => (Kind::Unsigned, 4),
            10 => (Kind::Signed, 8),
            11 => (Kind::Unsigned, 8),
            _ => return None,
        };
        Some(Type { kind, size })
    }

    /// The type in which values are stored; text is stored as numbers.
    pub fn stored(self) -> Stored {
        let kind = match self.kind {
            Kind::Signed => stored::Kind::Signed,
            Kind::Unsigned | Kind::Text => stored::Kind::Unsigned,
            Kind::Float => stored::Kind::Float,
        };
        Stored { kind, size: self.size, big_endian: true }
    }
}

/// The value of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub enum Attribute {
    Text(String),
    Numbers(Vec<f64>),
}

/// Attributes by name.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Attributes(Vec<(String, Attribute)>);

impl Attributes {
    pub fn text(&self, name: &str) -> Option<&str> {
        self.0.iter().find(|(own, _)| own == name).and_then(|(_, value)| match value {
            Attribute::Text(text) => Some(text.trim()),
            Attribute::Numbers(_) => None,
        })
    }

    pub fn numbers(&self, name: &str) -> &[f64] {
        self.0.iter().find(|(own, _)| own == name).map_or(&[], |(_, value)| match value {
            Attribute::Numbers(numbers) => numbers,
            Attribute::Text(_) => &[],
        })
    }

    pub fn number(&self, name: &str) -> Option<f64> {
        self.numbers(name).first().copied()
    }
}

/// A variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    pub name: String,
    /// Indices of the dimensions.
    pub dimensions: Vec<usize>,
    pub attributes: Attributes,
    pub type_of: Type,
    /// Position of the first value in the file.
    pub begin: u64,
}

/// The header.
#[derive(Debug, Clone, PartialEq)]
pub struct Header {
    /// Names and lengths. The length of the record dimension is the number of records.
    pub dimensions: Vec<(String, u64)>,
    /// The index of the record dimension.
    pub record: Option<usize>,
    pub attributes: Attributes,
    pub variables: Vec<Variable>,
    /// Length of the file in bytes.
    pub length: u64,
}

/// The first bytes of an HDF5 file.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";

impl Header {
    /// Reads the header. `name` is the file's name in the command that converts it.
    pub fn read(input: &mut dyn Input, name: &str) -> Result<Header, String> {
        let length = length(input)?;
        let mut magic = Vec::new();
        let failed = |cause: std::io::Error| cause.to_string();
        (&mut *input).take(8).read_to_end(&mut magic).map_err(failed)?;
        input.seek(std::io::SeekFrom::Start(4)).map_err(failed)?;
        let version = match magic[..] {
            [b'C', b'D', b'F', version @ (1 | 2 | 5), ..] => version,
            _ if magic.starts_with(HDF5) => {
                return Err(format!(
                    "it is NetCDF-4, which is HDF5 and not supported (supported is NetCDF-3: classic, 64-bit offset and CDF-5); convert it, for example with gdal_translate {name} out.tif"
                ));
            }
            _ => {
                return Err(format!(
                    "it is not NetCDF: it does not begin with CDF; if it is a grid of another format, convert it, for example with gdal_translate {name} out.tif"
                ));
            }
        };
        let mut source =
            Source { input: BufReader::new(input), left: length.min(MAX_LENGTH).saturating_sub(4), version };
        source.header(length)
    }
}

struct Source<'a> {
    input: BufReader<&'a mut dyn Input>,
    /// Number of bytes that may be read.
    left: u64,
    version: u8,
}

impl Source<'_> {
    fn header(&mut self, length: u64) -> Result<Header, String> {
        let records = self.count()?;
        let mut record = None;
        let dimensions = self.list(DIMENSIONS, |source, k| {
            let (name, length) = (source.name()?, source.count()?);
            if length == 0 {
                record = record.or(Some(k));
            }
            Ok((name, length))
        })?;
        let attributes = self.attributes()?;
        let variables = self.list(VARIABLES, |source, _| source.variable(dimensions.len()))?;
        let mut header = Header { dimensions, record, attributes, variables, length };
        if let Some(record) = record {
            // A file that is still being written does not state the number of records.
            let streaming = records == if self.version == 5 { u64::MAX } else { u64::from(u32::MAX) };
            header.dimensions[record].1 = if streaming { header.records_in_file() } else { records };
        }
        Ok(header)
    }

    fn variable(&mut self, dimensions: usize) -> Result<Variable, String> {
        let name = self.name()?;
        let count = self.count()?;
        let mut own = Vec::new();
        for _ in 0..count {
            let dimension = self.count()?;
            let known = usize::try_from(dimension).ok().filter(|dimension| *dimension < dimensions);
            own.push(known.ok_or_else(|| format!("its variable `{}` has an unknown dimension", name.escape_debug()))?);
        }
        let attributes = self.attributes()?;
        let type_of = self.type_of()?;
        // The stated size of a variable is skipped; it follows from its dimensions.
        self.count()?;
        let begin = if self.version == 1 { u64::from(self.word()?) } else { self.wide()? };
        Ok(Variable { name, dimensions: own, attributes, type_of, begin })
    }

    fn attributes(&mut self) -> Result<Attributes, String> {
        Ok(Attributes(self.list(ATTRIBUTES, |source, _| {
            let (name, type_of) = (source.name()?, source.type_of()?);
            let count = source.count()?;
            let bytes = source.padded(count.saturating_mul(type_of.size as u64))?;
            let value = match type_of.kind {
                Kind::Text => Attribute::Text(String::from_utf8_lossy(&bytes).trim_end_matches('\0').into()),
                _ => Attribute::Numbers(
                    bytes.chunks_exact(type_of.size).map(|bytes| type_of.stored().value(bytes)).collect(),
                ),
            };
            Ok((name, value))
        })?))
    }

    fn type_of(&mut self) -> Result<Type, String> {
        let code = self.word()?;
        Type::of(code).ok_or_else(|| format!("its header has a value of the unknown type {code}"))
    }

    fn list<T>(
        &mut self,
        tag: u32,
        mut item: impl FnMut(&mut Self, usize) -> Result<T, String>,
    ) -> Result<Vec<T>, String> {
        let (own, count) = (self.word()?, self.count()?);
        if !(own == tag || own == 0 && count == 0) {
            return Err("its header is damaged".into());
        }
        let mut items = Vec::new();
        for k in 0..count {
            items.push(item(self, k as usize)?);
        }
        Ok(items)
    }

    fn name(&mut self) -> Result<String, String> {
        let length = self.count()?;
        Ok(String::from_utf8_lossy(&self.padded(length)?).into_owned())
    }

    /// A count: four bytes, or eight in CDF-5.
    fn count(&mut self) -> Result<u64, String> {
        if self.version == 5 { self.wide() } else { Ok(u64::from(self.word()?)) }
    }

    fn word(&mut self) -> Result<u32, String> {
        let bytes = self.bytes(4)?;
        Ok(bytes.iter().fold(0, |word, byte| word << 8 | u32::from(*byte)))
    }

    fn wide(&mut self) -> Result<u64, String> {
        Ok(u64::from(self.word()?) << 32 | u64::from(self.word()?))
    }

    /// Bytes that are padded to a multiple of four.
    fn padded(&mut self, count: u64) -> Result<Vec<u8>, String> {
        let mut bytes = self.bytes(count.checked_next_multiple_of(4).unwrap_or(u64::MAX))?;
        bytes.truncate(count as usize);
        Ok(bytes)
    }

    fn bytes(&mut self, count: u64) -> Result<Vec<u8>, String> {
        self.left = self.left.checked_sub(count).ok_or("it ends within its header")?;
        let mut bytes = vec![0; count as usize];
        self.input.read_exact(&mut bytes).map_err(|cause| cause.to_string())?;
        Ok(bytes)
    }
}

impl Header {
    /// The lengths of a variable's dimensions.
    pub fn shape(&self, variable: &Variable) -> Vec<u64> {
        variable.dimensions.iter().map(|dimension| self.dimensions[*dimension].1).collect()
    }

    /// Whether a variable has a part in each record.
    pub fn is_recorded(&self, variable: &Variable) -> bool {
        self.record.is_some() && variable.dimensions.first().copied() == self.record
    }

    /// Number of bytes from one record to the next.
    pub fn record_size(&self) -> u64 {
        let sizes: Vec<u64> =
            self.variables.iter().filter(|variable| self.is_recorded(variable)).map(|own| self.part(own)).collect();
        match sizes[..] {
            // Records of a single variable are not padded.
            [only] => only,
            _ => sizes
                .iter()
                .fold(0, |sum: u64, size| sum.saturating_add(size.checked_next_multiple_of(4).unwrap_or(u64::MAX))),
        }
    }

    /// Bytes of a variable in a record.
    fn part(&self, variable: &Variable) -> u64 {
        let others = variable.dimensions.iter().skip(1).map(|dimension| self.dimensions[*dimension].1);
        others.fold(variable.type_of.size as u64, u64::saturating_mul)
    }

    fn records_in_file(&self) -> u64 {
        let first = self.variables.iter().filter(|variable| self.is_recorded(variable)).map(|own| own.begin).min();
        first.map_or(0, |first| self.length.saturating_sub(first).checked_div(self.record_size()).unwrap_or(0))
    }
}
