//! Every function has the bits of the original. NaNs are equal to each other: their sign and payload are not defined.

const RANDOM: usize = 200_000;

/// 2^e, where that is a normal number.
fn two_to(e: i64) -> f64 {
    f64::from_bits(((e + 1023) as u64) << 52)
}

/// Arguments that need care: limits of the format and of the functions, and what is next to them.
fn special_f64() -> Vec<f64> {
    let mut values =
        vec![0.0, f64::INFINITY, f64::NAN, f64::MAX, f64::from_bits(1), f64::from_bits(0x000f_ffff_ffff_ffff)];
    // Every power of two, and about every power of ten.
    values.extend((1..2047).map(|e: u64| f64::from_bits(e << 52)));
    values.extend((0..52).map(|bit| f64::from_bits(1 << bit)));
    values.extend(std::iter::successors(Some(1e-300), |x| Some(x * 10.0)).take(600));
    values.extend((1..400).map(|k| f64::from(k) * 0.5));
    // Multiples of a quarter of pi, also where the reduction of arguments changes its way.
    values.extend((1..200).map(|k| f64::from(k) * std::f64::consts::FRAC_PI_4));
    values.extend((0..60).map(|e| two_to(e) * std::f64::consts::FRAC_PI_2));
    // The double closest to a multiple of pi / 2.
    values.push(6_381_956_970_095_103.0 * two_to(797));
    // Where results overflow, become subnormal or vanish.
    values.extend([709.782_712_893_384, 708.396_418_532_264_1, 745.133_219_101_941_1, 56.0 * std::f64::consts::LN_2]);
    values.extend([
        1022.0,
        1024.0,
        1075.0,
        1.5f64.sqrt(),
        3f64.sqrt(),
        2f64.sqrt(),
        0.5f64.sqrt(),
        0.975,
        0.4375,
        0.6875,
        1.1875,
        2.4375,
    ]);
    with_neighbors(&values, |x, step| f64::from_bits(x.to_bits().wrapping_add_signed(step)))
}

fn special_f32() -> Vec<f32> {
    let mut values = vec![0.0, f32::INFINITY, f32::NAN, f32::MAX, f32::from_bits(1), f32::from_bits(0x007f_ffff)];
    values.extend((1..255).map(|e: u32| f32::from_bits(e << 23)));
    values.extend((0..23).map(|bit| f32::from_bits(1 << bit)));
    values.extend(std::iter::successors(Some(1e-37f32), |x| Some(x * 10.0)).take(75));
    values.extend((1..400).map(|k| k as f32 * 0.5));
    values.extend((1..200).map(|k| (f64::from(k) * std::f64::consts::FRAC_PI_4) as f32));
    values.extend((0..60).map(|e| (two_to(e) * std::f64::consts::FRAC_PI_2) as f32));
    values.push(16_367_173.0 * two_to(72) as f32);
    values.extend([
        88.722_84,
        87.336_55,
        103.972_08,
        126.0,
        128.0,
        149.0,
        150.0,
        1.224_744_9,
        1.732_050_8,
        0.4375,
        0.6875,
        1.1875,
        2.4375,
    ]);
    with_neighbors(&values, |x, step| f32::from_bits(x.to_bits().wrapping_add_signed(step as i32)))
}

fn with_neighbors<T: Copy + std::ops::Neg<Output = T>>(values: &[T], step: impl Fn(T, i64) -> T) -> Vec<T> {
    let around = values.iter().flat_map(|&x| [-1, 0, 1].map(|by| step(x, by)));
    around.flat_map(|x| [x, -x]).collect()
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Of all magnitudes (any bits at all), in -1 .. 1, in -1000 .. 1000, or near 1, in turn.
    fn next_f64(&mut self) -> f64 {
        let bits = self.bits();
        let unit = (bits >> 11) as f64 * two_to(-53);
        match bits % 4 {
            0 => f64::from_bits(self.bits()),
            1 => 2.0 * unit - 1.0,
            2 => 2000.0 * unit - 1000.0,
            _ => 1.0 + (unit - 0.5) * two_to(-(self.bits() as i64 & 31)),
        }
    }

    fn next_f32(&mut self) -> f32 {
        match self.bits() % 2 {
            0 => f32::from_bits(self.bits() as u32),
            _ => self.next_f64() as f32,
        }
    }
}

/// Calls `compare` with every special value and with random ones.
fn each_f64(mut compare: impl FnMut((f64,))) {
    special_f64().into_iter().for_each(|x| compare((x,)));
    let mut random = Random(1);
    (0..RANDOM).for_each(|_| compare((random.next_f64(),)));
}

fn each_f32(mut compare: impl FnMut((f32,))) {
    special_f32().into_iter().for_each(|x| compare((x,)));
    let mut random = Random(2);
    (0..RANDOM).for_each(|_| compare((random.next_f32(),)));
}

/// Pairs: a share of the special values with each other, and random ones.
fn each_pair_f64(mut compare: impl FnMut((f64, f64))) {
    let special = special_f64();
    let some: Vec<f64> = special[..36].iter().copied().chain(special.iter().copied().skip(36).step_by(41)).collect();
    some.iter().for_each(|&x| some.iter().for_each(|&y| compare((x, y))));
    let mut random = Random(3);
    (0..RANDOM).for_each(|_| compare((random.next_f64(), random.next_f64())));
}

fn each_pair_f32(mut compare: impl FnMut((f32, f32))) {
    let special = special_f32();
    let some: Vec<f32> = special[..36].iter().copied().chain(special.iter().copied().skip(36).step_by(17)).collect();
    some.iter().for_each(|&x| some.iter().for_each(|&y| compare((x, y))));
    let mut random = Random(4);
    (0..RANDOM).for_each(|_| compare((random.next_f32(), random.next_f32())));
}

/// The bits of a result, all NaNs alike.
trait Bits {
    fn same(self, other: Self) -> bool;
}

impl Bits for f64 {
    fn same(self, other: f64) -> bool {
        self.to_bits() == other.to_bits() || self.is_nan() && other.is_nan()
    }
}

impl Bits for f32 {
    fn same(self, other: f32) -> bool {
        self.to_bits() == other.to_bits() || self.is_nan() && other.is_nan()
    }
}

impl<T: Bits> Bits for (T, T) {
    fn same(self, other: (T, T)) -> bool {
        self.0.same(other.0) && self.1.same(other.1)
    }
}

macro_rules! same_bits {
    ($each:ident $args:tt: $($name:ident)+) => {
        $(#[test]
        fn $name() {
            $each(|$args| {
                let (ours, theirs) = (orogen_libm::$name $args, upstream::$name $args);
                assert!(ours.same(theirs), "{}{:?} = {ours:?}, upstream {theirs:?}", stringify!($name), $args);
            });
        })+
    };
}

same_bits!(each_f64(x,): acos asin atan cos exp expm1 log log10 log2 sin sincos sinh sqrt tan tanh);
same_bits!(each_f32(x,): acosf asinf atanf cbrtf cosf exp2f expf log10f log2f logf sincosf sinf tanf tanhf);
same_bits!(each_pair_f64(x, y): atan2 hypot pow);
same_bits!(each_pair_f32(x, y): atan2f hypotf powf);
