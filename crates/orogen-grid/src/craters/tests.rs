use super::profiles::{Form, Row};
use super::*;

/// What craters make of positions along a line to the east.
fn line(craters: &Craters, count: usize, step: f64) -> Vec<Cratered> {
    let mut out = vec![Cratered::default(); count];
    let prepared = craters.prepare();
    prepared.each((0..count).map(|k| (k, [k as f64 * step, 0.375 * (k as f64 * step)])), |k, ground| out[k] = ground);
    out
}

fn fresh(density: f64) -> Craters {
    Craters::default().with_diffusion(0.0).with_density(density)
}

#[test]
fn profiles_have_the_depth_of_pike() {
    let depth = |form: Form, time: f64| {
        let row = Row::new(form, time);
        let rim = (0..400).map(|k| row.at(f64::from(k) / 200.0)).fold(0.0, f64::max);
        (rim - row.at(0.3), rim)
    };
    let (deep, rim) = depth(Form::Simple, 4e-4);
    assert!((0.8..1.0).contains(&deep) && (0.15..0.2).contains(&rim), "{deep} deep, rim {rim}");
    // Diffusion wears it: half of the depth is gone at .1, nearly all at 1.6.
    let depths: Vec<f64> = [4e-4, 0.01, 0.1, 0.4, 1.6].map(|time| depth(Form::Simple, time).0).to_vec();
    assert!(depths.windows(2).all(|pair| pair[1] < pair[0]), "{depths:?}");
    assert!(depths[2] < 0.75 && depths[4] < 0.1, "{depths:?}");
}

#[test]
fn profiles_are_smooth_between_their_nodes_and_at_their_end() {
    for form in [Form::Simple, Form::Narrow, Form::Wide] {
        for time in [4e-4, 0.003, 0.2] {
            let row = Row::new(form, time);
            let heights: Vec<f64> = (0..8400).map(|k| row.at(f64::from(k) / 2000.0)).collect();
            let steepest = heights.windows(2).map(|pair| (pair[1] - pair[0]).abs() * 2000.0).fold(0.0, f64::max);
            assert!(steepest < 6.0, "{form:?} at {time}: {steepest}");
            assert_eq!(heights[8000..].iter().copied().fold(0.0, f64::max), 0.0);
        }
    }
}

#[test]
fn a_position_does_not_depend_on_the_others() {
    let craters = Craters::default().with_diameters([100.0, 20_000.0]);
    let all = line(&craters, 3000, 37.0);
    let far = line(&craters, 30, 3700.0);
    for (k, ground) in far.iter().enumerate() {
        assert_eq!(*ground, all[k * 100], "{k}");
    }
    assert!(all.iter().any(|ground| ground.height < -100.0));
    let mut alone = Vec::new();
    craters.prepare().each([(7, [f64::NAN, 0.0])].into_iter(), |k, ground| alone.push((k, ground.height.is_nan())));
    assert_eq!(alone, [(7, true)]);
}

#[test]
fn small_craters_do_not_move_large_ones() {
    let large = line(&fresh(0.1).with_diameters([3000.0, 30_000.0]), 500, 400.0);
    let all = line(&fresh(0.1).with_diameters([1500.0, 30_000.0]), 500, 400.0);
    let near = large.iter().zip(&all).filter(|(a, b)| (a.height - b.height).abs() < 20.0).count();
    assert!(near > 150, "{near} of 500 are alike");
}

#[test]
fn depths_and_shares_are_those_of_the_density() {
    let covered = |density: f64| {
        let ground = line(&fresh(density), 20_000, 97.0);
        let inside = ground.iter().filter(|ground| ground.resurfaced > 0.99).count();
        let lowest = ground.iter().map(|ground| ground.height).fold(0.0, f64::min);
        assert!(ground.iter().all(|ground| (0.0..=1.0).contains(&ground.ejecta)));
        (inside as f64 / 20_000.0, lowest)
    };
    let (few, many) = (covered(0.002), covered(0.1));
    assert!(few.0 < 0.1 && many.0 > 0.4, "{few:?} {many:?}");
    assert!(many.1 > -5000.0 && many.1 < -1500.0, "{many:?}");
    assert_eq!(covered(0.0), (0.0, 0.0));
}

#[test]
fn steep_exponents_are_capped_at_saturation() {
    let craters = fresh(0.5).with_exponent(4.0).with_diameters([10.0, 100_000.0]);
    let ground = line(&craters, 300, 13.0);
    assert!(ground.iter().all(|ground| ground.height.is_finite() && ground.height.abs() < 10_000.0));
}
