//! The text of a kernel: a part of a program as one shader, and the words that it reads. The text depends only on the
//! structure of the part.

use super::functions;
use crate::job::GROUP;
use orogen_engine::device::{Lowered, LoweredCoords, LoweredOperand, LoweredProgram};
use orogen_engine::layer::LayerKind;
use orogen_noise::shader::lattice::PLACE;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::ops::Range;

orogen_noise::shader_constants! {
    // Words of a grid, after the index of its first sample.
    pub GRID = "grid.wgsl", GRID_COLUMNS = 1, GRID_ROWS = 2, GRID_LATTICE = 3
}

/// A word of a kernel's data, before indices are known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Word {
    /// A number.
    Number(f32),
    /// The index of the data of an instruction's function.
    Function(usize),
    /// The index of the block of the grid that an instruction reads.
    Grid(usize),
    /// The index of a value that is kept between kernels.
    Slot(usize),
}

/// A part of a program as a shader.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Kernel {
    /// The text without the header.
    pub text: String,
    /// The words of its data.
    pub words: Vec<Word>,
}

/// Weight of a call of a field's function, which drivers inline; all other instructions have weight 1.
const FIELD: usize = 8;

/// Divides a program into parts of at most this weight.
pub(crate) fn parts(program: &LoweredProgram, most: usize) -> Vec<Range<usize>> {
    let mut parts = Vec::new();
    let (mut start, mut weight) = (0, 0);
    for (i, instruction) in program.instructions.iter().enumerate() {
        let own = if matches!(instruction, Lowered::Field { .. }) { FIELD } else { 1 };
        if weight + own > most && i > start {
            parts.push(start..i);
            (start, weight) = (i, 0);
        }
        weight += own;
    }
    parts.push(start..program.instructions.len());
    parts
}

/// The kernel of a part. `kept` are the values of the part that later parts or the outputs need; `copies` says for each
/// instruction whether it copies its grid without interpolation, because the grid has the samples of the block.
pub(crate) fn kernel(program: &LoweredProgram, part: Range<usize>, kept: &[usize], copies: &[bool]) -> Kernel {
    let mut writer = Writer {
        program,
        part: part.clone(),
        names: BTreeMap::new(),
        places: BTreeMap::new(),
        words: Vec::new(),
        body: String::new(),
    };
    let mut chunks: Vec<&str> = vec![PLACE, functions::TEXT];
    for i in part {
        let value = writer.instruction(i, copies);
        if let Lowered::Field { shader, coords, .. } = &program.instructions[i] {
            for chunk in shader.function(*coords != 0).1 {
                if !chunks.contains(&chunk) {
                    chunks.push(chunk);
                }
            }
        }
        if matches!(program.instructions[i], Lowered::Grid { .. }) && !chunks.contains(&GRID) {
            chunks.push(GRID);
        }
        if let Some(value) = value {
            writer.define(i, &value);
        }
    }
    for value in kept {
        let (name, slot) = (writer.value(*value), writer.word(Word::Slot(*value)));
        writer.line(&format!("samples[{slot} + at] = {name};"));
    }
    let mut text = String::new();
    for chunk in chunks {
        text.push_str(chunk);
        text.push('\n');
    }
    text.push_str(&format!(
        "@compute @workgroup_size({GROUP}, {GROUP})\nfn main(@builtin(global_invocation_id) id: vec3<u32>) {{\n    \
         if (id.x >= frame.width || id.y >= frame.height) {{\n        return;\n    }}\n    let base = frame.base;\n    \
         let at = id.y * frame.width + id.x;\n{}}}\n",
        writer.body
    ));
    Kernel { text, words: writer.words }
}

struct Writer<'a> {
    program: &'a LoweredProgram,
    part: Range<usize>,
    /// The names of values that the text has so far.
    names: BTreeMap<usize, String>,
    /// The names of coordinate sets that the text has so far.
    places: BTreeMap<usize, String>,
    words: Vec<Word>,
    body: String,
}

impl Writer<'_> {
    fn line(&mut self, line: &str) {
        self.body.push_str("    ");
        self.body.push_str(line);
        self.body.push('\n');
    }

    /// The expression of a word of the data.
    fn word(&mut self, word: Word) -> String {
        self.words.push(word);
        format!("data[base + {}u]", self.words.len() - 1)
    }

    fn number(&mut self, number: f32) -> String {
        self.words.push(Word::Number(number));
        format!("number(base, {}u)", self.words.len() - 1)
    }

    fn define(&mut self, value: usize, expression: &str) {
        // Numbered in the order of the text: equal parts of different programs have equal texts.
        let name = format!("v{}", self.names.len());
        self.line(&format!("let {name} = {expression};"));
        self.names.insert(value, name);
    }

    /// The name of a value; a value of an earlier part is read from its slot.
    fn value(&mut self, value: usize) -> String {
        if let Some(name) = self.names.get(&value) {
            return name.clone();
        }
        let expression = match self.program.instructions.get(value) {
            Some(Lowered::Constant(number)) => self.number(*number),
            _ => {
                let slot = self.word(Word::Slot(value));
                format!("samples[{slot} + at]")
            }
        };
        self.define(value, &expression);
        self.names.get(&value).cloned().unwrap_or_default()
    }

    /// The name of a coordinate set.
    fn place(&mut self, coords: usize) -> String {
        // Starts from the block, without recursion: a chain of maps may have any length.
        let mut chain = vec![coords];
        while let Some(LoweredCoords::Displaced { from, .. } | LoweredCoords::Mapped { from, .. }) =
            chain.last().and_then(|set| self.program.coord_sets.get(*set))
        {
            chain.push(*from);
        }
        let mut name = String::new();
        for set in chain.into_iter().rev() {
            name = match self.places.get(&set) {
                Some(known) => known.clone(),
                None => self.new_place(set, &name),
            };
        }
        name
    }

    fn new_place(&mut self, set: usize, from: &str) -> String {
        let moved = match self.program.coord_sets.get(set) {
            None | Some(LoweredCoords::Block) => "vec2<f32>(0.0)".to_string(),
            Some(LoweredCoords::Displaced { east, south, strength, reach, .. }) => {
                let (east, south) = (self.value(*east), self.value(*south));
                let (strength, reach) = (self.number(*strength as f32), self.number(*reach as f32));
                // A displacement that is NaN does not move the position.
                let metres = |input: &str| {
                    format!("select(clamp({input} * {strength}, -{reach}, {reach}), 0.0, is_nan({input}))")
                };
                format!("{from}.moved + vec2<f32>({}, {})", metres(&east), metres(&south))
            }
            Some(LoweredCoords::Mapped { map, .. }) => {
                let [cos, sin] = map.turn.map(|number| self.number((number * map.scale) as f32));
                format!(
                    "vec2<f32>({cos} * {from}.moved.x - {sin} * {from}.moved.y, {sin} * {from}.moved.x + {cos} * {from}.moved.y)"
                )
            }
        };
        let name = format!("p{}", self.places.len());
        self.line(&format!("let {name} = Placement(id.x, id.y, {moved});"));
        self.places.insert(set, name.clone());
        name
    }

    /// The expression of an instruction's value; `None` for a constant, which is written where it is used.
    fn instruction(&mut self, i: usize, copies: &[bool]) -> Option<String> {
        debug_assert!(self.part.contains(&i), "an instruction of another part");
        Some(match self.program.instructions.get(i)?.clone() {
            Lowered::Constant(_) => return None,
            Lowered::Field { shader, coords, inputs } => {
                let place = self.place(coords);
                let mut call = format!("{}({}, {place}", shader.function(coords != 0).0, self.word(Word::Function(i)));
                for input in inputs {
                    let input = input.map_or("0.0".to_string(), |input| self.value(input));
                    // Writing to a string cannot fail.
                    let _ = write!(call, ", {input}");
                }
                call + ")"
            }
            Lowered::Apply { function, arguments } => {
                let arguments: Vec<String> = arguments
                    .iter()
                    .map(|argument| match argument {
                        LoweredOperand::Number(number) => self.number(*number),
                        LoweredOperand::Value(value) => self.value(*value),
                    })
                    .collect();
                functions::expression(function, &arguments)
            }
            Lowered::Grid { kind, coords, .. } => {
                let function = match kind {
                    _ if copies[i] => "grid_copy",
                    LayerKind::Label => "grid_label",
                    LayerKind::Flow => "grid_flow",
                    _ => "grid_height",
                };
                let place = self.place(coords);
                format!("{function}({}, {place})", self.word(Word::Grid(i)))
            }
            Lowered::Mask { source, result, mask } => {
                let (result, mask) = (self.value(result), self.value(mask));
                match source {
                    Some(source) => {
                        let source = self.value(source);
                        format!("{source} + ({result} - {source}) * cut({mask}, 0.0, 1.0)")
                    }
                    None => format!("{result} * cut({mask}, 0.0, 1.0)"),
                }
            }
        })
    }
}
