//! A layer of 3 x 3 convolutions. The values of a node are contiguous, one for each channel.

use orogen_simd::{Body, F32Lanes, Simd};

/// Nodes that a value reads: 3 x 3.
pub const TAPS: usize = 9;
/// What is left of values below 0.
pub const LEAK: f32 = 0.1;
/// Nodes whose sums are kept in registers at a time.
const NODES: usize = 6;

/// The weights of a layer, by tap from the north-west, input and output.
#[derive(Debug, Clone, PartialEq)]
pub struct Convolution {
    pub inputs: usize,
    pub outputs: usize,
    pub weights: Vec<f32>,
    /// What is added to each output.
    pub offsets: Vec<f32>,
}

/// A row of the layer above three rows of its inputs, which are wider by one node on each side. The outputs are
/// max(y, 0.1 y) of the sums y; `is_residual` adds the middle inputs to them.
pub struct Row<'a> {
    pub layer: &'a Convolution,
    pub inputs: [&'a [f32]; 3],
    pub is_residual: bool,
    pub out: &'a mut [f32],
}

impl Body for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(mut self, simd: S) {
        let outputs = self.layer.outputs;
        let nodes = self.out.len() / outputs;
        let mut channel = 0;
        while channel < outputs {
            let is_pair = channel + 2 * S::LANES <= outputs;
            let mut node = 0;
            while node < nodes {
                let is_block = node + NODES <= nodes;
                match (is_pair, is_block) {
                    (true, true) => simd.run(Block::<'_, '_, 2, NODES> { row: &mut self, node, channel }),
                    (true, false) => simd.run(Block::<'_, '_, 2, 1> { row: &mut self, node, channel }),
                    (false, true) => simd.run(Block::<'_, '_, 1, NODES> { row: &mut self, node, channel }),
                    (false, false) => simd.run(Block::<'_, '_, 1, 1> { row: &mut self, node, channel }),
                }
                node += if is_block { NODES } else { 1 };
            }
            channel += if is_pair { 2 * S::LANES } else { S::LANES };
        }
    }
}

/// The sums of `N` nodes from `node`, for `G` vectors of outputs from `channel`.
struct Block<'a, 'b, const G: usize, const N: usize> {
    row: &'a mut Row<'b>,
    node: usize,
    channel: usize,
}

impl<const G: usize, const N: usize> Body for Block<'_, '_, G, N> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Block { row, node, channel } = self;
        let Convolution { inputs, outputs, ref weights, ref offsets } = *row.layer;
        let mut sums = [[simd.f32(0.0); G]; N];
        for sums in &mut sums {
            for (vector, sum) in sums.iter_mut().enumerate() {
                *sum = simd.load(&offsets[channel + vector * S::LANES..]);
            }
        }
        let mut weights = weights.chunks_exact(outputs);
        for line in row.inputs {
            for column in 0..3 {
                let first = (node + column) * inputs;
                let read: [&[f32]; N] = std::array::from_fn(|at| &line[first + at * inputs..][..inputs]);
                for (input, weights) in (0..inputs).zip(&mut weights) {
                    let mut vectors = [simd.f32(0.0); G];
                    for (vector, value) in vectors.iter_mut().enumerate() {
                        *value = simd.load(&weights[channel + vector * S::LANES..]);
                    }
                    for (sums, read) in sums.iter_mut().zip(&read) {
                        let value = simd.f32(read[input]);
                        for (sum, weight) in sums.iter_mut().zip(vectors) {
                            *sum = *sum + weight * value;
                        }
                    }
                }
            }
        }
        for (at, sums) in sums.into_iter().enumerate() {
            for (vector, sum) in sums.into_iter().enumerate() {
                let channel = channel + vector * S::LANES;
                let mut value = sum.max(sum * simd.f32(LEAK));
                if row.is_residual {
                    value = value + simd.load(&row.inputs[1][(node + at + 1) * inputs + channel..]);
                }
                value.store(&mut row.out[(node + at) * outputs + channel..][..S::LANES]);
            }
        }
    }
}
