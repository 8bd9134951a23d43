//! Lowering: the computation of ops on a graphics card. A field has a WGSL function, other ops have passes, in addition
//! to their computation on the processor.

/// The WGSL function `selected`, a range with smooth ends, which several ops use.
pub const SELECTION: &str = include_str!("lower/selection.wgsl");

/// The computation of a node on a graphics card.
#[derive(Debug, Clone, PartialEq)]
pub enum Lowering<T> {
    /// The shader or passes.
    Shader(T),
    /// The processor computes it, for this reason.
    Processor(&'static str),
    /// Not declared, so the processor computes it. Every built-in op declares one of the others.
    Missing,
}

impl<T> Lowering<T> {
    /// The shader or passes; `None` if the processor computes it.
    pub fn shader(self) -> Option<T> {
        match self {
            Lowering::Shader(shader) => Some(shader),
            Lowering::Processor(_) | Lowering::Missing => None,
        }
    }
}

/// A filter, a solver, a level of a levelled op, or the layers of a level, as passes over planes. Planes are grids over
/// the same window.
///
/// The planes are the inputs, the layers and scratch planes. Planes that have neither an input nor the result of
/// earlier passes start as zeros. The text of a pass defines a function `fn NAME(base: u32, at: vec2<i32>)`, which is
/// called for every sample of a part of the planes. It reads numbers with `number(base, i)`, or with a function of the
/// declared name. It reads samples with `plane(k, at)`, which clamps positions to the border, and writes samples with
/// `set_plane(k, at, value)`. `size()` is the number of columns and rows of the planes. A pass may run for all samples
/// at once: it must not read samples that another call writes. Calls of a [shared](Pass::is_shared) pass may do so if
/// the result does not depend on their order; they read and write planes as words, `word(k, cell)`. The common
/// functions of passes are in `planes.wgsl` of orogen-gpu.
#[derive(Debug, Clone, PartialEq)]
pub struct Passes {
    /// Declarations that precede the text of each pass: functions that read the numbers, and constants. They do not
    /// depend on parameters.
    pub head: String,
    /// The numbers that the functions read.
    pub words: Vec<u32>,
    /// The content of the planes before the passes, and their samples.
    pub extent: Extent,
    /// The plane of each input, if it has one.
    pub inputs: Vec<Option<usize>>,
    /// The planes of the wanted layers.
    pub layers: Vec<usize>,
    /// Number of planes.
    pub planes: usize,
    /// Whether rounding errors can change the courses of rivers; such passes are used only for drafts.
    pub is_chaotic: bool,
    /// The passes, in order.
    pub passes: Vec<Pass>,
    /// The text of the passes that follow.
    code: &'static str,
}

/// The content of the planes before the passes, and their samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Extent {
    /// For a filter: the inputs over a window grown by this number of samples.
    Halo(usize),
    /// For a solver: the inputs over the whole domain.
    Domain,
    /// For a level: the inputs and, in planes with half the columns and rows, the planes of the level above. Sample (i,
    /// j) of the level is in the cell of sample (i / 2, j / 2) of the level above. Functions also read `above(k, at)`
    /// and write `set_above(k, at, value)`. `above_size()` is the number of columns and rows of the level above.
    /// `first_column()` and `first_row()` are the position of the first sample on the lattice, as whole numbers of 64
    /// bits.
    Above {
        /// Number of scratch planes at the cell of the level above.
        scratch: usize,
        /// Number of samples by which the lattices of the level above and of the level are ahead of the lattices of
        /// windows.
        ahead: [i64; 2],
        /// Number of samples of the level above that are read beyond the halved window.
        reach: usize,
    },
    /// For layers: the planes of the level, over at least a window grown by this number of samples. Other planes have
    /// undefined values.
    Before(usize),
}

/// One run of a function over samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pass {
    /// The text that defines the function. It does not depend on parameters.
    pub code: &'static str,
    /// The name of the function.
    pub function: &'static str,
    /// A number that the function reads as `frame.step`, such as the number of the iteration.
    pub step: u32,
    /// The samples for which it runs.
    pub over: Over,
    /// Approximate number of samples that a call reads. The samples of an expensive pass are computed in several parts,
    /// so that the driver does not abort it after a timeout.
    pub reads: usize,
    /// Whether calls write samples of other calls, or read samples that other calls write.
    pub is_shared: bool,
}

/// The samples for which a pass runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Over {
    /// The samples of the planes without this number of columns and rows at each side, at most the halo.
    Planes([usize; 2]),
    /// The samples of the planes of the level above, without this number of columns and rows at each side.
    Above([usize; 2]),
    /// The samples of the window and this number of samples around it.
    Window(usize),
}

/// Default number of samples that a call reads.
const READS: usize = 20;

impl Passes {
    /// Passes with these numbers. The functions of the passes added later are in `code`.
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

    /// Appends words.
    #[must_use]
    pub fn with_words(mut self, words: impl IntoIterator<Item = u32>) -> Passes {
        self.words.extend(words);
        self
    }

    /// Appends words, each with a function `NAME(base)` that reads it.
    #[must_use]
    pub fn with_named_words<'a>(self, words: impl IntoIterator<Item = (&'a str, u32)>) -> Passes {
        words.into_iter().fold(self, |passes, (name, word)| {
            let at = passes.words.len();
            passes.with_reader(name, "u32", &format!("data[base + {at}u]"), [word])
        })
    }

    /// Appends numbers, each with a function `NAME(base)` that reads it.
    #[must_use]
    pub fn with_numbers<'a>(self, numbers: impl IntoIterator<Item = (&'a str, f32)>) -> Passes {
        numbers.into_iter().fold(self, |passes, (name, number)| {
            let at = passes.words.len();
            passes.with_reader(name, "f32", &format!("number(base, {at}u)"), [number.to_bits()])
        })
    }

    /// Appends numbers of 64 bits, the lower part first, each with a function `NAME(base)` that reads it.
    #[must_use]
    pub fn with_pairs<'a>(self, pairs: impl IntoIterator<Item = (&'a str, u64)>) -> Passes {
        pairs.into_iter().fold(self, |passes, (name, pair)| {
            let at = passes.words.len();
            let reads = format!("vec2<u32>(data[base + {at}u], data[base + {}u])", at + 1);
            passes.with_reader(name, "vec2<u32>", &reads, [pair as u32, (pair >> 32) as u32])
        })
    }

    /// Appends words, with a function `NAME(base, k)` that reads word `k` of them.
    #[must_use]
    pub fn with_table(mut self, name: &str, words: impl IntoIterator<Item = u32>) -> Passes {
        let line =
            format!("fn {name}(base: u32, k: u32) -> u32 {{ return data[base + {}u + k]; }}\n", self.words.len());
        self.head += &line;
        self.with_words(words)
    }

    /// Appends words, with a function that reads them.
    fn with_reader(mut self, name: &str, kind: &str, reads: &str, words: impl IntoIterator<Item = u32>) -> Passes {
        self.head += &format!("fn {name}(base: u32) -> {kind} {{ return {reads}; }}\n");
        self.with_words(words)
    }

    /// Adds constants to the head.
    #[must_use]
    pub fn with_constants<'a>(mut self, constants: impl IntoIterator<Item = (&'a str, u32)>) -> Passes {
        let lines = constants.into_iter().map(|(name, value)| format!("const {name} = {value};\n"));
        self.head.extend(lines);
        self
    }

    /// Adds planes for inputs, then for the wanted layers, before all other planes.
    #[must_use]
    pub fn with_planes(mut self, extent: Extent, inputs: usize, wanted: &[bool]) -> Passes {
        self.extent = extent;
        self.inputs = (0..inputs).map(Some).collect();
        let layers = wanted.iter().enumerate().filter(|(_, wanted)| **wanted);
        self.layers = layers.map(|(k, _)| inputs + k).collect();
        self.planes += inputs + wanted.len();
        self
    }

    /// Marks the passes as [chaotic](Passes::is_chaotic): their terrain differs from the processor's, but is as
    /// realistic.
    #[must_use]
    pub fn chaotic(mut self) -> Passes {
        self.is_chaotic = true;
        self
    }

    /// Adds scratch planes.
    #[must_use]
    pub fn with_scratch(mut self, planes: usize) -> Passes {
        self.planes += planes;
        self
    }

    /// Appends a pass that runs a function for the planes without `inset` columns and rows at each side.
    #[must_use]
    pub fn then(mut self, function: &'static str, step: u32, inset: [usize; 2]) -> Passes {
        let over = Over::Planes(inset);
        self.passes.push(Pass { code: self.code, function, step, over, reads: READS, is_shared: false });
        self
    }

    /// Sets the approximate number of samples that a call of the last pass reads.
    #[must_use]
    pub fn reading(mut self, reads: usize) -> Passes {
        if let Some(pass) = self.passes.last_mut() {
            pass.reads = reads.max(1);
        }
        self
    }

    /// Marks the last pass as one whose calls [share](Pass::is_shared) samples.
    #[must_use]
    pub fn shared(mut self) -> Passes {
        if let Some(pass) = self.passes.last_mut() {
            pass.is_shared = true;
        }
        self
    }
}

/// The planes that iterations read and write in turn, as the step of a pass: the lower eight bits are the plane that is
/// read, the next eight bits the plane that is written. The first iteration reads `first`, the last one writes
/// `turns[0]`, the one before it `turns[1]`, and so on.
#[must_use]
pub fn alternating(iterations: u32, first: u32, turns: [u32; 2]) -> Vec<u32> {
    let written = |k: u32| if (iterations - k) % 2 == 1 { turns[0] } else { turns[1] };
    (0..iterations).map(|k| if k == 0 { first } else { written(k - 1) } | written(k) << 8).collect()
}
