//! FlatBuffers (flatbuffers.dev, "FlatBuffer Internals"): tables whose fields are located by offsets. Buffers are built
//! from the end to the start.

/// A buffer that grows towards its start. Offsets are counted from its end.
#[derive(Default)]
pub struct Builder {
    /// The bytes in reverse order.
    reversed: Vec<u8>,
    /// The largest alignment of the content.
    align: usize,
}

/// The position of an object, in bytes from the end of the buffer.
pub type Offset = u32;

/// The value of a field of a table.
#[derive(Debug, Clone, Copy)]
pub enum Slot {
    /// The default value; not stored.
    Absent,
    /// One byte: a boolean or an enumeration value.
    Byte(u8),
    /// Two bytes.
    Short(u16),
    /// Four bytes.
    Int(i32),
    /// Eight bytes.
    Long(u64),
    /// An object that was written before.
    Reference(Offset),
}

impl Builder {
    /// An empty builder.
    #[must_use]
    pub fn new() -> Builder {
        Builder { reversed: Vec::new(), align: 4 }
    }

    fn push(&mut self, bytes: &[u8]) {
        self.reversed.extend(bytes.iter().rev());
    }

    /// Adds padding so that an object that starts after `more` further bytes is aligned.
    fn prepare(&mut self, align: usize, more: usize) {
        self.align = self.align.max(align);
        let end = (self.reversed.len() + more).next_multiple_of(align);
        self.reversed.resize(end - more, 0);
    }

    fn here(&self) -> Offset {
        self.reversed.len() as Offset
    }

    /// Adds a text.
    pub fn text(&mut self, text: &str) -> Offset {
        self.prepare(4, text.len() + 1);
        self.push(&[0]);
        self.push(text.as_bytes());
        self.push(&(text.len() as u32).to_le_bytes());
        self.here()
    }

    /// Adds a vector of elements of `size` bytes each, which are little-endian.
    fn vector(&mut self, bytes: &[u8], size: usize) -> Offset {
        self.prepare(4, bytes.len());
        self.prepare(size, bytes.len());
        self.push(bytes);
        self.push(&((bytes.len() / size) as u32).to_le_bytes());
        self.here()
    }

    /// Adds a vector of bytes.
    pub fn bytes(&mut self, bytes: &[u8]) -> Offset {
        self.vector(bytes, 1)
    }

    /// Adds a vector of integers.
    pub fn wholes(&mut self, numbers: &[u32]) -> Offset {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        self.vector(&bytes, 4)
    }

    /// Adds a vector of 64-bit floats, given as little-endian bytes.
    pub fn numbers(&mut self, bytes: &[u8]) -> Offset {
        self.vector(bytes, 8)
    }

    /// Adds a vector of tables.
    pub fn references(&mut self, tables: &[Offset]) -> Offset {
        self.prepare(4, tables.len() * 4);
        tables.iter().rev().for_each(|table| self.reference(*table));
        self.push(&(tables.len() as u32).to_le_bytes());
        self.here()
    }

    fn reference(&mut self, to: Offset) {
        self.prepare(4, 0);
        let from = self.here() + 4;
        self.push(&(from - to).to_le_bytes());
    }

    /// Adds a table with these fields, in the order of its schema.
    pub fn table(&mut self, slots: &[Slot]) -> Offset {
        let start = self.here();
        let mut places = vec![0; slots.len()];
        for (place, slot) in places.iter_mut().zip(slots) {
            match slot {
                Slot::Absent => continue,
                Slot::Byte(value) => self.push(&[*value]),
                Slot::Short(value) => {
                    self.prepare(2, 0);
                    self.push(&value.to_le_bytes());
                }
                Slot::Int(value) => {
                    self.prepare(4, 0);
                    self.push(&value.to_le_bytes());
                }
                Slot::Long(value) => {
                    self.prepare(8, 0);
                    self.push(&value.to_le_bytes());
                }
                Slot::Reference(offset) => self.reference(*offset),
            }
            *place = self.here();
        }
        // The offset from the table to its vtable is filled in after the vtable is written.
        self.prepare(4, 0);
        self.push(&[0; 4]);
        let table = self.here();
        let fields = places.iter().rposition(|place| *place > 0).map_or(0, |last| last + 1);
        for place in places[..fields].iter().rev() {
            let within = if *place > 0 { table - place } else { 0 };
            self.push(&(within as u16).to_le_bytes());
        }
        self.push(&((table - start) as u16).to_le_bytes());
        self.push(&((4 + 2 * fields) as u16).to_le_bytes());
        let back = (self.here() - table) as i32;
        let end = table as usize;
        self.reversed[end - 4..end].iter_mut().zip(back.to_be_bytes()).for_each(|(byte, new)| *byte = new);
        table
    }

    /// The bytes of a buffer whose root is the table `root`, preceded by their length.
    #[must_use]
    pub fn finish(mut self, root: Offset) -> Vec<u8> {
        self.prepare(self.align, 8);
        self.reference(root);
        let length = self.here();
        self.push(&length.to_le_bytes());
        self.reversed.reverse();
        self.reversed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_read_by_its_offsets() {
        let mut builder = Builder::new();
        let text = builder.text("hello");
        let numbers = builder.numbers(&[1.5f64, -2.0].map(f64::to_le_bytes).concat());
        let root = builder.table(&[
            Slot::Reference(text),
            Slot::Absent,
            Slot::Byte(7),
            Slot::Long(1 << 40),
            Slot::Reference(numbers),
            Slot::Absent,
        ]);
        let bytes = builder.finish(root);
        let four = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let two = |at: usize| usize::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]));
        assert_eq!((four(0), bytes.len() % 8), (bytes.len() - 4, 0));
        let table = 4 + four(4);
        let fields = table - four(table);
        assert_eq!(two(fields), 4 + 2 * 5, "fields at the end that are absent are left out");
        let field = |k: usize| table + two(fields + 4 + 2 * k);
        assert_eq!((two(fields + 6), bytes[field(2)]), (0, 7));
        assert_eq!((field(3) % 8, u64::from_le_bytes(bytes[field(3)..field(3) + 8].try_into().unwrap())), (0, 1 << 40));
        let text = field(0) + four(field(0));
        assert_eq!((four(text), &bytes[text + 4..text + 10]), (5, &b"hello\0"[..]));
        let numbers = field(4) + four(field(4));
        assert_eq!((four(numbers), numbers % 8), (2, 4));
        assert_eq!(f64::from_le_bytes(bytes[numbers + 12..numbers + 20].try_into().unwrap()), -2.0);
    }
}
