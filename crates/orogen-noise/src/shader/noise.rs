//! Noises as WGSL functions. The text depends only on the kind of lattice and on the kind of sum; all parameters are
//! words.

use super::function::{Shader, Undisplaced};
use super::lattice::{Lattice, PLACE};
use crate::choices::{ClassicVariant, Distance, Fade, Falloff, Feature, Smoothness};
use crate::kernel::open_simplex::{Open, WIDE_REACH, WIDE_SCALE};
use crate::kernel::simplex::{Corners, Plain, REACH, SKEW};
use crate::program::{Combine, Program, Shape, Source};
use crate::tables::reference;
use std::sync::OnceLock;

/// The hash of lattice points.
pub(super) const HASH: &str = include_str!("hash.wgsl");

shader_constants! {
    /// How octaves are stored and displaced.
    OCTAVES = "octaves.wgsl",
    // Indices of words before the octaves, after the number of octaves.
    NOISE_SOURCE_WORDS = 1, NOISE_SKEW = 2, NOISE_PARAMETERS = 3, NOISE_OCTAVES = 6,
    // Indices of the words of an octave, after the words of the hash.
    NOISE_AMPLITUDE = 4, NOISE_SLOPE = 5, NOISE_GAIN = 6, NOISE_SHIFT = 7, NOISE_PER_RATIO = 8, NOISE_OCTAVE = 9
}

// Words of sources.
shader_constants! { CLASSIC = "source/classic.wgsl", CLASSIC_TABLE = 1, CLASSIC_GRADIENTS = 65 }
shader_constants! { SIMPLEX = "source/simplex.wgsl", SIMPLEX_REACH = 1, SIMPLEX_SCALE = 2, SIMPLEX_DIRECTIONS = 3 }
shader_constants! {
    WORLEY = "source/worley.wgsl",
    WORLEY_JITTER = 0, WORLEY_REST = 1, WORLEY_DISTANCE = 2, WORLEY_FEATURE = 3, WORLEY_SCALE = 4
}

/// The prefix of a source's functions, and their text.
struct Family {
    name: &'static str,
    code: &'static [&'static str],
    /// Whether the functions need only the keys of two cells along each axis.
    is_keyed: bool,
}

const GRADIENTS: &str = include_str!("source/gradients.wgsl");
const FAMILIES: [Family; 5] = [
    Family { name: "value", code: &[include_str!("source/value.wgsl")], is_keyed: true },
    Family { name: "perlin", code: &[GRADIENTS, include_str!("source/perlin.wgsl")], is_keyed: true },
    Family { name: "classic", code: &[GRADIENTS, CLASSIC], is_keyed: false },
    Family { name: "simplex", code: &[SIMPLEX], is_keyed: false },
    Family { name: "worley", code: &[WORLEY], is_keyed: false },
];

/// The names of the sums and their texts. `SOURCE` in a text stands for the name of the source's family.
const SUMS: [[&str; 2]; 8] = [
    ["sum", include_str!("combine/sum.wgsl")],
    ["sizes", include_str!("combine/sizes.wgsl")],
    ["weighted", include_str!("combine/weighted.wgsl")],
    ["ping_pong", include_str!("combine/ping_pong.wgsl")],
    ["hybrid", include_str!("combine/hybrid.wgsl")],
    ["hetero", include_str!("combine/hetero.wgsl")],
    ["swiss", include_str!("combine/swiss.wgsl")],
    ["jordan", include_str!("combine/jordan.wgsl")],
];

/// Number of sums, from the first on, whose octaves do not displace samples.
const UNDISPLACED_SUMS: usize = 6;

/// The name of a function and its text.
type Text = OnceLock<[String; 2]>;

/// The texts of each sum over each family, without and with tables of keys. They are created at the first use.
static TEXTS: [[[Text; 2]; FAMILIES.len()]; SUMS.len()] =
    [const { [const { [const { OnceLock::new() }; 2] }; FAMILIES.len()] }; SUMS.len()];

/// The function of a sum over a family, created at the first use.
fn text_of(sum: usize, family: usize, is_keyed: bool) -> &'static [String; 2] {
    TEXTS[sum][family][usize::from(is_keyed)].get_or_init(|| {
        let ([sum, text], name) = (SUMS[sum], FAMILIES[family].name);
        match is_keyed {
            true => {
                let name = format!("{name}_keyed");
                [format!("{sum}_{name}"), text.replace("SOURCE", &name).replace("cell_at(", "keyed_at(")]
            }
            false => [format!("{sum}_{name}"), text.replace("SOURCE", name)],
        }
    })
}

impl Program {
    /// The noise in the plane as a WGSL function.
    pub(crate) fn shader(&self) -> Shader {
        let (family, of_source, skew) = self.source.encoded();
        let (sum, parameters) = self.combine.encoded();
        let skew_factor = skew as f32;
        let octaves = self.octaves();
        let [count, source_words] = [octaves.len(), of_source.len()].map(|count| count as u32);
        let head = [(0, count), (NOISE_SOURCE_WORDS, source_words), (NOISE_SKEW, skew_factor.to_bits())];
        let mut words = placed(&head, NOISE_PARAMETERS);
        words.extend(parameters);
        words.resize(NOISE_OCTAVES, 0);
        for octave in octaves {
            words.extend(octave.words[..2].iter().flatten());
            let shift = match self.combine {
                Combine::Shaped { shape: Shape::Swiss { warp }, .. } => warp * octave.ratio as f32,
                Combine::Shaped { shape: Shape::Jordan { warp, .. }, .. } => warp,
                _ => 0.0,
            };
            let numbers = [
                (NOISE_AMPLITUDE, octave.amplitude),
                (NOISE_SLOPE, octave.slope),
                (NOISE_GAIN, octave.gain),
                (NOISE_SHIFT, shift),
                (NOISE_PER_RATIO, (1.0 / octave.ratio) as f32),
            ];
            let numbers = numbers.map(|(at, number)| (at - NOISE_AMPLITUDE, number.to_bits()));
            words.extend(placed(&numbers, NOISE_OCTAVE - NOISE_AMPLITUDE));
        }
        words.extend(of_source);
        let lattices = octaves.iter().map(|octave| {
            let [along, across] = [octave.frequency * (1.0 + skew), octave.frequency * skew];
            let [x, y, ..] = octave.offset;
            let shared = (x + y) * skew;
            Lattice { matrix: [[along, across], [across, along]], offset: [x + shared, y + shared], limit: self.limit }
        });
        let Family { code, is_keyed, .. } = FAMILIES[family];
        let [name, text] = text_of(sum, family, false);
        let mut parts = vec![PLACE, HASH, OCTAVES];
        parts.extend_from_slice(code);
        parts.push(text);
        let undisplaced = (is_keyed && sum < UNDISPLACED_SUMS).then(|| {
            let [name, code] = text_of(sum, family, true);
            let hashes = octaves.iter().map(|octave| [octave.words[0], octave.words[1]]);
            Undisplaced { name, code, hashes: hashes.collect() }
        });
        Shader { name, code: parts, words, lattices: lattices.collect(), undisplaced }
    }
}

impl Source {
    /// Index of the family, words of the source, and skew of its lattice.
    fn encoded(self) -> (usize, Vec<u32>, f64) {
        let slanted = |corners: u32, reach: f32, scale: f32, directions: u32| {
            let [reach, scale] = [reach, scale].map(f32::to_bits);
            let words =
                [(0, corners), (SIMPLEX_REACH, reach), (SIMPLEX_SCALE, scale), (SIMPLEX_DIRECTIONS, directions)];
            (3, placed(&words, words.len()), SKEW[0])
        };
        match self {
            Source::Value(fade) => {
                let fade = match fade {
                    Fade::Step => 0,
                    Fade::Linear => 1,
                    Fade::Cubic => 2,
                    Fade::Quintic => 3,
                };
                (0, vec![fade], 0.0)
            }
            Source::Perlin => (1, Vec::new(), 0.0),
            Source::Classic(variant) => (2, classic(variant), 0.0),
            Source::Simplex => slanted(3, REACH, Plain::SCALE[0], 0),
            Source::OpenSimplex2(Smoothness::Fast) => slanted(3, REACH, Open::SCALE[0], 1),
            Source::OpenSimplex2(Smoothness::Smooth) => slanted(5, WIDE_REACH[0], WIDE_SCALE[0], 1),
            Source::Worley(cellular) => {
                let distance = match cellular.distance {
                    Distance::Euclidean => 0,
                    Distance::Manhattan => 1,
                    Distance::Chebyshev => 2,
                };
                let feature = match cellular.feature {
                    Feature::F1 => 0,
                    Feature::F2 => 1,
                    Feature::Difference => 2,
                    Feature::Product => 3,
                    Feature::Value => 4,
                    Feature::Edge => 5,
                };
                let [jitter, rest] = [cellular.jitter, 0.5 - 0.5 * cellular.jitter].map(f32::to_bits);
                let words = [
                    (WORLEY_JITTER, jitter),
                    (WORLEY_REST, rest),
                    (WORLEY_DISTANCE, distance),
                    (WORLEY_FEATURE, feature),
                    (WORLEY_SCALE, (2.0 / cellular.bound(2)).to_bits()),
                ];
                (4, placed(&words, words.len()), 0.0)
            }
        }
    }
}

/// A list of `count` words with the given words at their indices.
fn placed(words: &[(usize, u32)], count: usize) -> Vec<u32> {
    let mut placed = vec![0; count];
    words.iter().for_each(|(at, word)| placed[*at] = *word);
    placed
}

/// The mask of hashes, the permutation, and the gradients of the masked hashes.
fn classic(variant: ClassicVariant) -> Vec<u32> {
    let (mask, gradient): (usize, fn(usize) -> [f32; 2]) = match variant {
        ClassicVariant::Diagonal => (7, |hash| [reference::DIAGONAL_X[hash], reference::DIAGONAL_Y[hash]]),
        ClassicVariant::Eight => (7, |hash| [reference::EIGHT_X[hash], reference::EIGHT_Y[hash]]),
        ClassicVariant::Angle => (255, |hash| [reference::SINE[(hash + 64) & 255], reference::SINE[hash]]),
    };
    let mut words = placed(&[(0, mask as u32)], CLASSIC_TABLE);
    let packed = |bytes: &[u32]| bytes.iter().rev().fold(0, |word, byte| word << 8 | byte);
    words.extend(reference::TABLE.chunks(4).map(packed));
    words.resize(CLASSIC_GRADIENTS, 0);
    words.extend((0..=mask).flat_map(gradient).map(f32::to_bits));
    words
}

impl Combine {
    /// Index of the sum, and its parameters.
    fn encoded(self) -> (usize, [u32; 3]) {
        let numbers = |numbers: [f32; 2]| [numbers[0].to_bits(), numbers[1].to_bits(), 0];
        match self {
            Combine::Sum => (0, [0; 3]),
            Combine::Sizes { sign } => (1, numbers([sign, 0.0])),
            Combine::Weighted { k, falloff, .. } => {
                let falloff = match falloff {
                    Falloff::Reciprocal => 0,
                    Falloff::Exponential => 1,
                    Falloff::SquareRoot => 2,
                    Falloff::Smoothstep => 3,
                };
                (2, [k.to_bits(), falloff, 0])
            }
            Combine::Shaped { shape, scale, .. } => match shape {
                Shape::PingPong { strength } => (3, numbers([strength, scale])),
                Shape::Hybrid { offset } => (4, numbers([offset, scale])),
                Shape::Hetero { offset } => (5, numbers([offset, scale])),
                Shape::Swiss { .. } => (6, numbers([0.0, scale])),
                Shape::Jordan { damp, .. } => (7, numbers([damp, scale])),
            },
        }
    }
}
