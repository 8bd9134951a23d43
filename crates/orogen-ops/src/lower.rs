//! How ops are computed on a graphics card: each field has a function of WGSL, and each filter has passes, beside its
//! computation on the processor.

/// The function `selected` of WGSL, which several ops have: a range with smooth ends.
pub const SELECTION: &str = include_str!("lower/selection.wgsl");

/// The function `gradient` of WGSL, and what is made of it: slopes by Horn's method.
pub const HORN: &str = include_str!("lower/horn.wgsl");

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

/// A filter as passes over planes: grids over its window grown by the halo, all in the same place.
///
/// The first planes are its inputs, one for each that is declared (zeros if it is not given). The next are its layers,
/// and then come `scratch` planes. Planes other than inputs start as zeros. The text defines one function `fn
/// NAME(base: u32, at: vec2<i32>)` for each pass, which is called for every sample of the planes, except for a border
/// that no later pass reads. It reads numbers with `number(base, i)` and samples with `plane(k, at)`, where positions
/// beyond the border are those of the border, and writes samples with `set_plane(k, at, value)`; `size()` is the number
/// of columns and rows of the planes. A pass may run for all samples at once: it must not read samples that another
/// call writes.
///
/// Those of a solver read and write the planes otherwise, as words: see `solvers.wgsl` of orogen-gpu. Calls of a
/// [shared](Pass::is_shared) pass may read what others write, if the result does not depend on their order.
#[derive(Debug, Clone, PartialEq)]
pub struct Passes {
    /// The text that defines the functions of the passes. It does not depend on parameters.
    pub code: &'static str,
    /// The numbers that they read.
    pub words: Vec<u32>,
    /// Number of layers, for solvers. A filter is told which of its layers are wanted.
    pub layers: usize,
    /// Number of planes beside inputs and layers.
    pub scratch: usize,
    /// Whether differences of the last digits grow, so that the result is other land, as real as that of the processor:
    /// for drafts.
    pub is_chaotic: bool,
    /// The passes, in order.
    pub passes: Vec<Pass>,
}

/// One run of a function over samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pass {
    /// The name of the function.
    pub function: &'static str,
    /// A number that the function reads as `frame.step`, such as that of the iteration.
    pub step: u32,
    /// Columns and rows at each side of the planes that it leaves out, at most the halo.
    pub inset: [usize; 2],
    /// Number of samples that a call reads, about. The samples of an expensive pass are computed in parts, so that no
    /// driver ends it as a hang.
    pub reads: usize,
    /// Whether calls write to samples of other calls, or read what they write: only in solvers.
    pub is_shared: bool,
}

/// A level of a levelled op as passes over planes, of the level and of the level above.
///
/// Planes of the level begin with those that it has; then come `scratch` planes, which start as zeros like these, and
/// the inputs. Planes of the level above have half the columns and rows: sample (i, j) of the level is in the cell of
/// sample (i / 2, j / 2) of the level above. They begin with those of the level above, and `scratch_above` planes
/// follow. The functions of passes are those of [`Passes`], which also read `above(k, at)`, write `set_above(k, at,
/// value)`, and have the number `above_size()` of columns and rows of the level above, and the position of the first
/// sample on the lattice as whole numbers of 64 bits, `first_column()` and `first_row()`.
#[derive(Debug, Clone, PartialEq)]
pub struct LevelPasses {
    /// The numbers that the functions read.
    pub words: Vec<u32>,
    /// Number of planes of the level.
    pub planes: usize,
    /// Number of planes beside these and the inputs.
    pub scratch: usize,
    /// Number of planes beside those of the level above, at its cell.
    pub scratch_above: usize,
    /// The indices of the op's inputs that are planes, in the order of the planes.
    pub inputs: Vec<usize>,
    /// Number of samples that the lattices of the level above and of the level are ahead of those of windows.
    pub ahead: [i64; 2],
    /// Number of samples of the level above that are read beyond the halved window.
    pub reach: usize,
    /// The passes, in order.
    pub passes: Vec<LevelPass>,
}

/// One run of a function over samples of a level or of the level above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelPass {
    /// The text that defines the function. It does not depend on parameters.
    pub code: &'static str,
    /// Whether it runs for the samples of the level above.
    pub is_above: bool,
    /// The run. It leaves out samples of the planes that it runs for.
    pub pass: Pass,
}

/// The layers of a levelled op as passes over the planes of its last level.
///
/// Planes beside those of the level have any values before the passes. The functions are those of [`Passes`].
#[derive(Debug, Clone, PartialEq)]
pub struct LayerPasses {
    /// The numbers that the functions read. After them come the first column and row, and the number of columns and
    /// rows, of the samples of the layers among those of the planes.
    pub words: Vec<u32>,
    /// Number of planes beside those of the level.
    pub scratch: usize,
    /// The planes of the wanted layers.
    pub layers: Vec<usize>,
    /// The passes, in order.
    pub passes: Vec<LayerPass>,
}

/// One run of a function over the samples of layers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerPass {
    /// The text that defines the function. It does not depend on parameters.
    pub code: &'static str,
    /// The name of the function.
    pub function: &'static str,
    /// Samples of the level around those of the layers for which it also runs.
    pub around: usize,
    /// That of [`Pass::reads`].
    pub reads: usize,
    /// That of [`Pass::is_shared`]: then the code declares the planes as words, and functions that read samples are not
    /// called.
    pub is_shared: bool,
}

/// Default number of samples that a call reads.
const READS: usize = 20;

impl Passes {
    /// Passes that read these numbers.
    #[must_use]
    pub fn new(code: &'static str, numbers: &[f32]) -> Passes {
        let words = numbers.iter().map(|number| number.to_bits()).collect();
        Passes { code, words, layers: 0, scratch: 0, is_chaotic: false, passes: Vec::new() }
    }

    /// With these words after the others.
    #[must_use]
    pub fn with_words(mut self, words: impl IntoIterator<Item = u32>) -> Passes {
        self.words.extend(words);
        self
    }

    /// With this number of layers.
    #[must_use]
    pub fn with_layers(mut self, layers: usize) -> Passes {
        self.layers = layers;
        self
    }

    /// Passes whose result is other land, as real as that of the processor.
    #[must_use]
    pub fn chaotic(mut self) -> Passes {
        self.is_chaotic = true;
        self
    }

    /// With this number of planes beside inputs and layers.
    #[must_use]
    pub fn with_scratch(mut self, planes: usize) -> Passes {
        self.scratch = planes;
        self
    }

    /// With a run of a function after the others, which leaves out `inset` columns and rows at each side.
    #[must_use]
    pub fn then(mut self, function: &'static str, step: u32, inset: [usize; 2]) -> Passes {
        self.passes.push(Pass { function, step, inset, reads: READS, is_shared: false });
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
