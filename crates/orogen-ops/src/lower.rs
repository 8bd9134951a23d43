//! How ops are computed on a graphics card: each field has a function of WGSL, and each filter has passes, beside its
//! computation on the processor.

/// The function `selected` of WGSL, which several ops have: a range with smooth ends.
pub const SELECTION: &str = include_str!("lower/selection.wgsl");

/// How a graphics card computes a node.
#[derive(Debug, Clone, PartialEq)]
pub enum Lowering<T> {
    /// By this.
    Shader(T),
    /// Not at all: the processor computes it, for this reason.
    Processor(&'static str),
    /// Not declared: the processor computes it. Every built-in op declares one of the others.
    Missing,
}

impl<T> Lowering<T> {
    /// By what a graphics card computes it, if it does.
    pub fn shader(self) -> Option<T> {
        match self {
            Lowering::Shader(shader) => Some(shader),
            Lowering::Processor(_) | Lowering::Missing => None,
        }
    }
}

/// A filter, a solver, a level of a levelled op, or the layers of a level, as passes over planes: grids of one size in
/// the same place.
///
/// The planes are the inputs, the layers, and others beside them. Those that hold neither an input nor what was made
/// before start as zeros. The text of a pass defines a function `fn NAME(base: u32, at: vec2<i32>)`, which is called
/// for every sample of a part of the planes. It reads numbers with `number(base, i)`, or by the name that was declared
/// with them, and samples with `plane(k, at)`, where positions beyond the border are those of the border, and writes
/// samples with `set_plane(k, at, value)`; `size()` is the number of columns and rows of the planes. A pass may run for
/// all samples at once: it must not read samples that another call writes. Calls of a [shared](Pass::is_shared) pass
/// may, if the result does not depend on their order: they read and write planes as words, `word(k, cell)`. All
/// functions that passes have in common are in `planes.wgsl` of orogen-gpu.
#[derive(Debug, Clone, PartialEq)]
pub struct Passes {
    /// Declarations that stand before the text of each pass: the numbers that it shares with this side. They do not
    /// depend on parameters.
    pub head: String,
    /// The numbers that the functions read.
    pub words: Vec<u32>,
    /// What the planes hold before the passes, and which samples they have.
    pub extent: Extent,
    /// The plane of each input, if it has one.
    pub inputs: Vec<Option<usize>>,
    /// The planes of the wanted layers.
    pub layers: Vec<usize>,
    /// Number of planes.
    pub planes: usize,
    /// Whether rounding errors can change where rivers run: for drafts only.
    pub is_chaotic: bool,
    /// The passes, in order.
    pub passes: Vec<Pass>,
    /// The text of the passes that follow.
    code: &'static str,
}

/// What the planes of passes hold before them, and which samples they have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Extent {
    /// The inputs over a window grown by this number of samples: those of a filter.
    Halo(usize),
    /// The inputs over the whole domain at once: those of a solver.
    Domain,
    /// The inputs, and in planes of half the columns and rows the layers of the level above: those of a level. Sample
    /// (i, j) of the level is in the cell of sample (i / 2, j / 2) of the level above. Functions also read `above(k,
    /// at)`, write `set_above(k, at, value)`, and have the number `above_size()` of columns and rows of the level
    /// above, and the position of the first sample on the lattice as whole numbers of 64 bits, `first_column()` and
    /// `first_row()`.
    Above {
        /// Number of planes beside those of the level above, at its cell.
        scratch: usize,
        /// Number of samples that the lattices of the level above and of the level are ahead of those of windows.
        ahead: [i64; 2],
        /// Number of samples of the level above that are read beyond the halved window.
        reach: usize,
    },
    /// The planes of the level before, over at least a window grown by this number of samples. Planes beside those of
    /// the level have any values.
    Before(usize),
}

/// One run of a function over samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pass {
    /// The text that defines the function. It does not depend on parameters.
    pub code: &'static str,
    /// The name of the function.
    pub function: &'static str,
    /// A number that the function reads as `frame.step`, such as that of the iteration.
    pub step: u32,
    /// The samples for which it runs.
    pub over: Over,
    /// Number of samples that a call reads, about. The samples of an expensive pass are computed in parts, so that no
    /// driver ends it as a hang.
    pub reads: usize,
    /// Whether calls write to samples of other calls, or read what they write.
    pub is_shared: bool,
}

/// The samples for which a pass runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Over {
    /// Those of the planes without this number of columns and rows at each side, at most the halo.
    Planes([usize; 2]),
    /// The same of the planes of the level above.
    Above([usize; 2]),
    /// Those of the window, and this number of samples around it.
    Window(usize),
}

/// Default number of samples that a call reads.
const READS: usize = 20;

impl Passes {
    /// Passes that read these numbers, whose functions this text defines.
    #[must_use]
    pub fn new(code: &'static str, numbers: &[f32]) -> Passes {
        Passes {
            head: String::new(),
            words: numbers.iter().map(|number| number.to_bits()).collect(),
            extent: Extent::Halo(0),
            inputs: Vec::new(),
            layers: Vec::new(),
            planes: 0,
            is_chaotic: false,
            passes: Vec::new(),
            code,
        }
    }

    /// With these words after the others.
    #[must_use]
    pub fn with_words(mut self, words: impl IntoIterator<Item = u32>) -> Passes {
        self.words.extend(words);
        self
    }

    /// With these words after the others, each with a function `NAME(base)` that reads it.
    #[must_use]
    pub fn with_named_words<'a>(self, words: impl IntoIterator<Item = (&'a str, u32)>) -> Passes {
        words.into_iter().fold(self, |passes, (name, word)| {
            let at = passes.words.len();
            passes.with_reader(name, "u32", &format!("data[base + {at}u]"), [word])
        })
    }

    /// With these numbers after the words, each with a function `NAME(base)` that reads it.
    #[must_use]
    pub fn with_numbers<'a>(self, numbers: impl IntoIterator<Item = (&'a str, f32)>) -> Passes {
        numbers.into_iter().fold(self, |passes, (name, number)| {
            let at = passes.words.len();
            passes.with_reader(name, "f32", &format!("number(base, {at}u)"), [number.to_bits()])
        })
    }

    /// With these numbers of 64 bits after the words, each with a function `NAME(base)` that reads it, the lower part
    /// first.
    #[must_use]
    pub fn with_pairs<'a>(self, pairs: impl IntoIterator<Item = (&'a str, u64)>) -> Passes {
        pairs.into_iter().fold(self, |passes, (name, pair)| {
            let at = passes.words.len();
            let reads = format!("vec2<u32>(data[base + {at}u], data[base + {}u])", at + 1);
            passes.with_reader(name, "vec2<u32>", &reads, [pair as u32, (pair >> 32) as u32])
        })
    }

    /// With these words after the others, and a function `NAME(base, k)` that reads one of them.
    #[must_use]
    pub fn with_table(mut self, name: &str, words: impl IntoIterator<Item = u32>) -> Passes {
        let line =
            format!("fn {name}(base: u32, k: u32) -> u32 {{ return data[base + {}u + k]; }}\n", self.words.len());
        self.head += &line;
        self.with_words(words)
    }

    /// With words, and a function that reads them.
    fn with_reader(mut self, name: &str, kind: &str, reads: &str, words: impl IntoIterator<Item = u32>) -> Passes {
        self.head += &format!("fn {name}(base: u32) -> {kind} {{ return {reads}; }}\n");
        self.with_words(words)
    }

    /// With these constants in the head.
    #[must_use]
    pub fn with_constants<'a>(mut self, constants: impl IntoIterator<Item = (&'a str, u32)>) -> Passes {
        let lines = constants.into_iter().map(|(name, value)| format!("const {name} = {value};\n"));
        self.head.extend(lines);
        self
    }

    /// With planes for inputs and then for layers before the others.
    #[must_use]
    pub fn with_planes(mut self, extent: Extent, inputs: usize, wanted: &[bool]) -> Passes {
        self.extent = extent;
        self.inputs = (0..inputs).map(Some).collect();
        let layers = wanted.iter().enumerate().filter(|(_, wanted)| **wanted);
        self.layers = layers.map(|(k, _)| inputs + k).collect();
        self.planes += inputs + wanted.len();
        self
    }

    /// Passes whose result is other land, as real as that of the processor.
    #[must_use]
    pub fn chaotic(mut self) -> Passes {
        self.is_chaotic = true;
        self
    }

    /// With this number of planes more.
    #[must_use]
    pub fn with_scratch(mut self, planes: usize) -> Passes {
        self.planes += planes;
        self
    }

    /// With a run of a function after the others, which leaves out `inset` columns and rows at each side.
    #[must_use]
    pub fn then(mut self, function: &'static str, step: u32, inset: [usize; 2]) -> Passes {
        let over = Over::Planes(inset);
        self.passes.push(Pass { code: self.code, function, step, over, reads: READS, is_shared: false });
        self
    }

    /// With this number of samples that a call of the last pass reads, about.
    #[must_use]
    pub fn reading(mut self, reads: usize) -> Passes {
        if let Some(pass) = self.passes.last_mut() {
            pass.reads = reads.max(1);
        }
        self
    }

    /// With the last pass as one whose calls [share](Pass::is_shared) samples.
    #[must_use]
    pub fn shared(mut self) -> Passes {
        if let Some(pass) = self.passes.last_mut() {
            pass.is_shared = true;
        }
        self
    }
}

/// The planes that iterations read and write in turn, as the step of a pass: the plane that is read in the lower eight
/// bits, and the one that is written in the next eight. The first iteration reads `first`, the last one writes
/// `turns[0]`, the one before it `turns[1]`, and so on.
#[must_use]
pub fn alternating(iterations: u32, first: u32, turns: [u32; 2]) -> Vec<u32> {
    let written = |k: u32| if (iterations - k) % 2 == 1 { turns[0] } else { turns[1] };
    (0..iterations).map(|k| if k == 0 { first } else { written(k - 1) } | written(k) << 8).collect()
}
