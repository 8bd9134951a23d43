//! Every level gives the same bits as the scalar rules.

use crate::*;

struct Rng(u64);

impl Rng {
    fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }
    /// A bit pattern of an f32: any pattern, or an edge case.
    fn pattern(&mut self) -> u32 {
        let word = self.word();
        let special = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            0.5,
            1.5,
            -2.5,
            8_388_608.0,
            8_388_607.5,
            4_194_304.5,
            -4_194_304.5,
            2_147_483_648.0,
            -2_147_483_648.0,
            2_147_483_520.0,
            f32::MAX,
            f32::MIN_POSITIVE,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::NAN,
            f32::from_bits(1),
            f32::from_bits(0x807F_FFFF),
        ];
        match word >> 62 {
            0 => special[(word % special.len() as u64) as usize].to_bits(),
            1 => ((word as i32 as f32) / 65_536.0).to_bits(),
            _ => word as u32,
        }
    }
}

/// All results of one round of 32 lanes, in which all NaNs have the same bits.
type Results = Vec<(&'static str, Vec<u64>)>;

struct Round {
    a: [u32; 32],
    b: [u32; 32],
    c: [u32; 32],
    x: [f64; 32],
    y: [f64; 32],
}

fn quiet(bits: u32) -> u64 {
    if f32::from_bits(bits).is_nan() { 0x7FC0_0000 } else { u64::from(bits) }
}

impl Body for Round {
    type Output = Results;

    #[inline(always)]
    fn run<S: Simd>(self, s: S) -> Results {
        let mut results: Results = Vec::new();
        let mut float = |name: &'static str, lanes: S::F32| {
            let mut out = [0.0; 32];
            lanes.store(&mut out);
            keep(&mut results, name, out[..S::LANES].iter().map(|x| quiet(x.to_bits())).collect());
        };
        for at in (0..32).step_by(S::LANES) {
            let a = s.load_u32(&self.a[at..]).as_f32();
            let b = s.load_u32(&self.b[at..]).as_f32();
            let c = s.load_u32(&self.c[at..]).as_f32();
            float("add", a + b);
            float("sub", a - b);
            float("mul", a * b);
            float("div", a / b);
            float("neg", -a);
            float("abs", a.abs());
            float("sqrt", a.sqrt());
            float("floor", a.floor());
            float("min", a.min(b));
            float("max", a.max(b));
            float("mul_add", a.mul_add(b, c));
            float("neg_mul_add", a.neg_mul_add(b, c));
            float("select lt", c.select(a.lt(b), a));
            float("select le", c.select(a.le(b), a));
            float("select eq", c.select(a.eq(b) | !b.eq(b), a));
            float("from i32", a.bits().i32_to_f32());
            let table: [f32; 16] = std::array::from_fn(|i| i as f32 * 1.5);
            let half: [f32; 8] = std::array::from_fn(|i| i as f32 - 2.5);
            float("lookup16", s.lookup16(s.table16(&table), b.bits()));
            float("lookup8", s.lookup8(s.table8(&half), b.bits()));
            float("gather", s.gather(&table[..11], b.bits().shr(27)));
            float("gather far", s.gather(&table[..11], b.bits()));
            float("gather none", s.gather(&[], b.bits()));
            float("narrow", s.load_f64(&self.x[at..]).narrow());
            float("partial", s.load_partial(&table[..3 + at.min(1)], 9.0).select(a.lt(a), a));
        }
        let mut word = |name: &'static str, lanes: S::U32| {
            let mut out = [0; 32];
            lanes.store(&mut out);
            keep(&mut results, name, out[..S::LANES].iter().map(|&x| u64::from(x)).collect());
        };
        for at in (0..32).step_by(S::LANES) {
            let (a, b, c) = (s.load_u32(&self.a[at..]), s.load_u32(&self.b[at..]), s.load_u32(&self.c[at..]));
            word("add", a + b);
            word("sub", a - b);
            word("mul", a * b);
            word("and", a & b);
            word("or", a | b);
            word("xor", a ^ b);
            word("not", !a);
            for count in [0, 1, 15, 31, 32, 33] {
                word("shl", a.shl(count));
                word("shr", a.shr(count));
                word("sar", a.sar(count));
            }
            word("select eq", c.select(a.eq(b), a));
            word("select lt", c.select(a.lt_i32(b), a));
            word("to i32", a.as_f32().to_i32());
            word("gather", s.gather_u32(&[5, 6, 7, 8, 9], b.shr(29)));
            let (x, y) = (s.load_f64(&self.x[at..]), s.load_f64(&self.y[at..]));
            let near = (x - x.floor()).max(s.f64(0.0)).min(s.f64(1.0)) + y.max(s.f64(-1e15)).min(s.f64(1e15));
            let (whole, low, high) = s.whole(near);
            word("f64 whole low", low);
            word("f64 whole high", high);
            for (name, lanes) in [
                ("f64 whole", whole + s.f64(0.0)),
                ("f64 add", x + y),
                ("f64 sub", x - y),
                ("f64 mul", x * y),
                ("f64 min", x.min(y)),
                ("f64 max", x.max(y)),
                ("f64 floor", x.floor()),
            ] {
                // A NaN in f64 is normalized here, because its low word is unspecified, too.
                let mut out = [0.0; 32];
                lanes.store(&mut out);
                let out = out.map(|x: f64| if x.is_nan() { f64::NAN } else { x });
                let (low, high) = s.load_f64(&out).words();
                word(name, low);
                word(name, high);
            }
        }
        results
    }
}

/// The body with two registers together.
struct Twice<B>(B);

impl<B: Body> Body for Twice<B> {
    type Output = B::Output;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> B::Output {
        Double(simd).run(self.0)
    }
}

fn keep(results: &mut Results, name: &'static str, lanes: Vec<u64>) {
    match results.iter_mut().find(|(known, _)| *known == name) {
        Some((_, kept)) => kept.extend(lanes),
        None => results.push((name, lanes)),
    }
}

#[test]
fn every_level_gives_the_same_bits() {
    let mut rng = Rng(1);
    for _ in 0..3000 {
        let mut pattern = || std::array::from_fn(|_| rng.pattern());
        let (a, b, c) = (pattern(), pattern(), pattern());
        let mut wide = || {
            std::array::from_fn(|_| {
                let word = rng.word();
                match word & 3 {
                    0 => f64::from_bits(word),
                    1 => (word as i64 >> (word >> 58)) as f64 / 8.0,
                    2 => f64::from(f32::from_bits(word as u32)),
                    _ => f64::from((word >> 32) as i32) / 1024.0,
                }
            })
        };
        let (x, y) = (wide(), wide());
        let round = || Round { a, b, c, x, y };
        // One call with 16 lanes corresponds to several calls with fewer lanes. The reference is 16 emulated lanes.
        let expected = Scalar::<16>.run(round());
        let mut found = vec![("4", Scalar::<4>.run(round())), ("8", Scalar::<8>.run(round()))];
        for level in Level::available() {
            found.push((level.name(), dispatch_at(level, round()).unwrap()));
            found.push((level.name(), dispatch_at(level, Twice(round())).unwrap()));
        }
        for (level, found) in found {
            for ((name, expected), (_, mut found)) in expected.iter().zip(found) {
                let mut expected = expected.clone();
                if name.starts_with("f64") || ["add", "sub", "mul", "shl", "shr", "sar"].contains(name) {
                    // Several results have the same name and are in a different order.
                    expected.sort_unstable();
                    found.sort_unstable();
                }
                assert_eq!(expected, found, "{name} at level {level}");
            }
        }
    }
}

#[test]
fn permute_reads_its_own_lanes() {
    struct Permute;
    impl Body for Permute {
        type Output = Vec<f32>;
        #[inline(always)]
        fn run<S: Simd>(self, s: S) -> Vec<f32> {
            let mut out = [0.0; 32];
            let reversed = s.u32(S::LANES as u32 - 1) - s.iota();
            let lanes = s.iota().i32_to_f32().permute(reversed + s.u32(5 * S::LANES as u32));
            lanes.store(&mut out);
            let mut words = [0; 32];
            s.iota().permute(reversed).store(&mut words);
            assert!(words[..S::LANES].iter().zip(&out).all(|(&word, &lane)| word as f32 == lane));
            assert_eq!(s.iota().lt_i32(s.u32(3)).to_bits(), 7);
            assert_eq!(
                s.f32(1.5).widen().narrow().bits().eq(s.f32(1.5).bits()).to_bits(),
                ((1_u64 << S::LANES) - 1) as u32
            );
            out[..S::LANES].to_vec()
        }
    }
    for level in Level::available() {
        let expected: Vec<f32> = (0..level.lanes()).rev().map(|i| i as f32).collect();
        assert_eq!(dispatch_at(level, Permute), Ok(expected));
        let expected: Vec<f32> = (0..2 * level.lanes()).rev().map(|i| i as f32).collect();
        assert_eq!(dispatch_at(level, Twice(Permute)), Ok(expected));
    }
    assert_eq!(Scalar::<4>.run(Permute), [3.0, 2.0, 1.0, 0.0]);
}

#[test]
fn tails_are_read_and_written_whole() {
    struct Copy<'a>(&'a [f32], &'a mut [f32]);
    impl Body for Copy<'_> {
        type Output = ();
        #[inline(always)]
        fn run<S: Simd>(self, s: S) {
            for (from, to) in self.0.chunks(S::LANES).zip(self.1.chunks_mut(S::LANES)) {
                s.load_partial(from, f32::NAN).store_partial(to);
            }
        }
    }
    for level in Level::available() {
        for length in 0..50 {
            let from: Vec<f32> = (0..length).map(|i| i as f32).collect();
            let mut to = vec![-1.0; length];
            dispatch_at(level, Copy(&from, &mut to)).unwrap();
            assert_eq!(from, to);
            to.fill(-1.0);
            dispatch_at(level, Twice(Copy(&from, &mut to))).unwrap();
            assert_eq!(from, to);
        }
    }
}

/// `a * b + c` rounded once, computed with wide integers.
fn exact_fma(a: f32, b: f32, c: f32) -> f32 {
    if !(a.is_finite() && b.is_finite() && c.is_finite()) {
        // Infinities and NaN need no rounding: f64 gives the right class.
        return (f64::from(a) * f64::from(b) + f64::from(c)) as f32;
    }
    let parts = |x: f32| {
        let bits = x.to_bits();
        let (exponent, mantissa) = ((bits >> 23 & 255) as i32, i128::from(bits & 0x7F_FFFF));
        let (mantissa, exponent) =
            if exponent == 0 { (mantissa, -149) } else { (mantissa | 0x80_0000, exponent - 150) };
        (if bits >> 31 == 1 { -mantissa } else { mantissa }, exponent)
    };
    let ((ma, ea), (mb, eb), (mc, ec)) = (parts(a), parts(b), parts(c));
    let (product, ep) = (ma * mb, ea + eb);
    // If one term is so much larger than the other that both do not fit in 128 bits, the smaller one only breaks ties,
    // so a minimal term replaces it.
    let (mut high, mut eh, mut low, mut el) = if ep >= ec { (product, ep, mc, ec) } else { (mc, ec, product, ep) };
    if high == 0 {
        (high, eh, low, el) = (low, el, 0, el);
    }
    let mut gap = eh - el;
    if low != 0 && gap > 70 {
        (low, gap) = (low.signum(), 70);
        el = eh - 70;
    } else if low == 0 {
        gap = 0;
        el = eh;
    }
    let sum = (high << gap) + low;
    if sum == 0 {
        return a * b + c; // the signs of zeros: the product of zeros, or an exact cancellation, is exact in f32
    }
    // Round |sum| * 2^el to 24 bits, or fewer where subnormal.
    let (size, negative) = (sum.unsigned_abs(), sum < 0);
    let top = 127 - size.leading_zeros() as i32;
    let unit = (top - 23).max(-149 - el);
    let rounded = if unit <= 0 {
        size << (-unit).min(100)
    } else if unit > 127 {
        0
    } else {
        let (whole, rest, half) = (size >> unit, size & ((1 << unit) - 1), 1_u128 << (unit - 1));
        whole + u128::from(rest > half || (rest == half && whole & 1 == 1))
    };
    // At most 2^24 times a power of two, which is exact in f64, and infinite in f32 if it overflows.
    let exponent = el + unit;
    let mut value = rounded as f64;
    for _ in 0..exponent.unsigned_abs() {
        value *= if exponent > 0 { 2.0 } else { 0.5 };
    }
    (if negative { -value } else { value }) as f32
}

#[test]
fn the_scalar_fma_is_exact() {
    let same = |a: f32, b: f32, c: f32| {
        let (found, expected) = (fma(a, b, c), exact_fma(a, b, c));
        assert!(
            found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan(),
            "{a:e} * {b:e} + {c:e}: {found:e} is not {expected:e}"
        );
    };
    let mut rng = Rng(2);
    for _ in 0..200_000 {
        let [a, b, c] = [0; 3].map(|_| f32::from_bits(rng.pattern()));
        same(a, b, c);
        // Sums that nearly cancel, and ties that are broken by a distant term.
        let near = f32::from_bits((-(a * b)).to_bits().wrapping_add((rng.word() % 5) as u32).wrapping_sub(2));
        same(a, b, near);
        let scale = f32::from_bits(((rng.word() % 254 + 1) as u32) << 23);
        same(a, scale, c);
        // Subnormal results.
        let [p, q] = [0; 2].map(|_| f32::from_bits((rng.word() as u32 & 0x807F_FFFF) | (63 << 23)));
        same(p * 1e-4, q * 1e-4, f32::from_bits(rng.word() as u32 & 0x807F_FFFF));
    }
    // Rounding the sum to f64 and then to f32 would round twice here.
    let tie = 1.0 + f32::EPSILON;
    same(tie, 1.0 + f32::EPSILON / 2.0, f32::from_bits(1));
    same(4097.0 / 4096.0, 4097.0 / 4096.0, f32::MIN_POSITIVE);
    same(f32::MAX, f32::MAX, -f32::INFINITY);
    same(f32::INFINITY, 0.0, 1.0);
    same(-0.0, 1.0, 0.0);
}

/// Tests one number at a time, together with numbers that are in range, for whether it is in range.
struct Placed<'a> {
    numbers: &'a [f64],
    from: f64,
    found: &'a mut Vec<Option<(f64, u32)>>,
}

impl Body for Placed<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, s: S) {
        for (i, &number) in self.numbers.iter().enumerate() {
            let lane = i % S::LANES;
            let mut lanes = [self.from + 3.5; 32];
            lanes[lane] = number;
            let (whole, place, elsewhere) = s.place(s.load_f64(&lanes), self.from, 16);
            let (mut wholes, mut places) = ([0.0; 32], [0; 32]);
            whole.store(&mut wholes);
            place.store(&mut places);
            let all = !(!elsewhere.eq(s.u32(0))).any();
            self.found.push(all.then_some((wholes[lane], places[lane])));
        }
    }
}

#[test]
fn numbers_are_placed_where_they_are_and_nowhere_else() {
    let mut rng = Rng(5);
    for from in [0.0, -7.0, 4_294_967_290.0, -4_294_967_301.0, 562_949_953_421_000.0, -562_949_953_421_000.0] {
        let mut numbers = vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, -0.0, 5e-324, -5e-324];
        for size in [1.0, 16.0, 1e3, 4_294_967_296.0, 1e15, 4.5e15, 9e15, 1e19, 1e300] {
            numbers.extend([from + size, from - size, size, -size]);
        }
        // Numbers that would be in range if only their low bits were compared.
        numbers.extend([
            from + 4_294_967_296.0 * 3.0 + 2.0,
            from - 2_251_799_813_685_248.0,
            from - 6_755_399_441_055_744.0,
        ]);
        for _ in 0..500 {
            numbers.push(from + (rng.pattern() % 4000) as f64 / 128.0 - 7.0);
        }
        for level in Level::available() {
            let (mut found, mut twice) = (Vec::new(), Vec::new());
            dispatch_at(level, Placed { numbers: &numbers, from, found: &mut found }).unwrap();
            dispatch_at(level, Twice(Placed { numbers: &numbers, from, found: &mut twice })).unwrap();
            assert_eq!(found, twice, "{level}");
            for (&number, found) in numbers.iter().zip(found) {
                let here = number >= from && number < from + 16.0;
                let expected = here.then(|| (number.floor(), (number.floor() - from) as u32));
                assert_eq!(found, expected, "{number} from {from} at level {level}");
            }
        }
    }
}
