//! Prepared noises return the same bits as direct ones.

use orogen_noise::{
    Basis, Classic, Depth, Fade, Feature, Fractal, Kind, OpenSimplex2, Perlin, Points, Prepared, Simplex, Smoothness,
    Value, White, Worley,
};

const XS: [f64; 9] = [-310.0, -3.5, 0.0, 1.25, 17.0, 40.0, 90.0, 1e6, -2e9];
const YS: [f64; 4] = [-77.0, 0.0, 3.25, 5e5];

/// Values in two, three and four dimensions: on a lattice, at scattered points, and at single points.
macro_rules! values {
    ($noise:expr) => {{
        let (noise, lattice) = (&$noise, Points::Lattice { xs: &XS, ys: &YS });
        let scattered = Points::Scattered { x: &XS, y: &XS };
        let depths = [Depth::Slice(2.5), Depth::Slice(-1.5)];
        let mut all = vec![0.0; 3 * lattice.len() + 3 * XS.len()];
        let (on_lattice, elsewhere) = all.split_at_mut(3 * lattice.len());
        for (dims, to) in on_lattice.chunks_mut(lattice.len()).enumerate() {
            match dims {
                0 => noise.fill(&lattice, to).unwrap(),
                1 => noise.fill3(&lattice, &depths[0], to).unwrap(),
                _ => noise.fill4(&lattice, &depths, to).unwrap(),
            }
        }
        for (dims, to) in elsewhere.chunks_mut(XS.len()).enumerate() {
            match dims {
                0 => noise.fill(&scattered, to).unwrap(),
                1 => noise.fill3(&scattered, &depths[1], to).unwrap(),
                _ => noise.fill4(&scattered, &depths, to).unwrap(),
            }
        }
        for x in XS {
            all.extend([noise.sample(x, 3.5), noise.sample3(x, 3.5, 2.0), noise.sample4(x, 3.5, 2.0, -9.0)]);
        }
        all.into_iter().map(f32::to_bits).collect::<Vec<u32>>()
    }};
}

fn gradients(fill: impl Fn(&Points, [&mut [f32]; 3])) -> Vec<u32> {
    let lattice = Points::Lattice { xs: &XS, ys: &YS };
    let mut columns = [0; 3].map(|_| vec![0.0; lattice.len()]);
    fill(&lattice, columns.each_mut().map(Vec::as_mut_slice));
    columns.into_iter().flatten().map(f32::to_bits).collect()
}

#[test]
fn prepared_noises_have_the_bits_of_the_direct_ones() {
    let mut count = 0;
    macro_rules! check {
        ($($noise:expr),* $(,)?) => {$({
            let (direct, prepared): (_, Prepared) = ($noise, $noise.prepare());
            assert_eq!(values!(direct), values!(prepared), "{direct:?}");
            count += 1;
        })*};
    }
    for wavelength in [0.7, 31.0] {
        check!(
            White::new(3, wavelength),
            Value::new(3, wavelength).with_fade(Fade::Cubic),
            Perlin::new(3, wavelength),
            Classic::new(3, wavelength),
            Simplex::new(3, wavelength),
            OpenSimplex2::new(3, wavelength).with_smoothness(Smoothness::Smooth),
            Worley::new(3, wavelength).with_feature(Feature::Edge),
        );
        for &basis in Basis::all() {
            for kind in [Kind::Fbm, Kind::Ridged, Kind::Hybrid { offset: 0.7 }, Kind::Swiss { warp: 0.15 }] {
                check!(Fractal::new(3, wavelength).with_basis(basis).with_kind(kind).with_octaves(3));
            }
        }
    }
    assert_eq!(count, 2 * (7 + 4 * Basis::all().len()));
}

#[test]
fn prepared_slopes_have_the_bits_of_the_direct_ones() {
    let noise = Fractal::new(9, 40.0).with_kind(Kind::Billow);
    let prepared = noise.prepare();
    let direct = gradients(|at, [value, dx, dy]| noise.fill_with_gradient(at, value, dx, dy).unwrap());
    let again = gradients(|at, [value, dx, dy]| prepared.fill_with_gradient(at, value, dx, dy).unwrap());
    assert_eq!(direct, again);
}

#[test]
fn a_prepared_noise_is_shared_by_threads() {
    let prepared = Fractal::new(5, 40.0).prepare();
    let expected = values!(prepared);
    std::thread::scope(|scope| {
        let threads = [(); 4].map(|()| scope.spawn(|| values!(prepared)));
        for thread in threads {
            assert_eq!(thread.join().unwrap(), expected);
        }
    });
}
