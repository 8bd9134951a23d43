use super::*;
use crate::random::Random;

fn line(points: &[[f64; 2]]) -> Outline {
    Outline::of_points(&points.iter().map(|[x, y]| [*x, *y, 0.0]).collect::<Vec<_>>())
}

/// Random lines, some closed, with long and short segments.
fn scribble(random: &mut Random, lines: usize, points: usize, extent: f64) -> Vec<Outline> {
    let outlines = (0..lines).map(|k| {
        let mut at = [random.share() * extent, random.share() * extent];
        let reach = if k % 2 == 0 { extent } else { 0.02 * extent };
        let points: Vec<[f64; 2]> = (0..points)
            .map(|_| {
                at = at.map(|v| v + (random.share() - 0.5) * reach);
                at
            })
            .collect();
        line(&points).closed()
    });
    outlines.collect()
}

#[test]
fn distances_are_those_to_segments_and_their_ends() {
    let drawing = Segments::new(&[line(&[[0.0, 0.0], [30.0, 40.0], [30.0, 100.0]])], 1.0);
    for (at, distance, chainage, position) in [
        ([0.0, 0.0], 0.0, 0.0, 0.0),
        ([-3.0, -4.0], 5.0, 0.0, 0.0),
        ([30.0, 110.0], 10.0, 110.0, 1.0),
        // Next to the middle of the first segment, of length 50.
        ([15.0 + 8.0, 20.0 - 6.0], 10.0, 25.0, 25.0 / 110.0),
        ([40.0, 70.0], 10.0, 80.0, 80.0 / 110.0),
    ] {
        let nearest = drawing.nearest(at, f64::INFINITY).unwrap();
        assert!((nearest.distance() - distance).abs() < 1e-12, "{at:?}: {}", nearest.distance());
        assert!((nearest.chainage() - chainage).abs() < 1e-12, "{at:?}: {}", nearest.chainage());
        assert!((nearest.position() - position).abs() < 1e-12, "{at:?}: {}", nearest.position());
    }
    assert!(drawing.nearest([-3.0, -4.0], 4.9).is_none() && drawing.nearest([-3.0, -4.0], 5.0).is_some());
    assert!(drawing.nearest([f64::NAN, 0.0], f64::INFINITY).is_none());
    assert!(drawing.nearest([0.0, f64::INFINITY], f64::INFINITY).is_none());
}

#[test]
fn heights_are_interpolated_along_the_line() {
    let points = [[0.0, 0.0, 100.0], [10.0, 0.0, 50.0], [10.0, 10.0, 60.0]];
    let drawing = Segments::new(&[Outline::of_points(&points)], 1.0);
    for (at, height) in [([5.0, 1.0], 75.0), ([-9.0, 0.0], 100.0), ([10.0, 5.0], 55.0), ([11.0, 40.0], 60.0)] {
        assert_eq!(drawing.nearest(at, f64::INFINITY).unwrap().height(), height, "{at:?}");
    }
}

#[test]
fn of_equal_distances_the_first_segment_counts() {
    // A square ring with a different height on each side, and the same ring again.
    let ring = Outline::of_points(&[[0.0, 0.0, 1.0], [8.0, 0.0, 2.0], [8.0, 8.0, 3.0], [0.0, 8.0, 4.0]]).closed();
    let drawing = Segments::new(&[ring.clone(), ring], 1.0);
    let nearest = drawing.nearest([4.0, 4.0], f64::INFINITY).unwrap();
    assert_eq!((nearest.distance(), nearest.chainage(), nearest.height()), (4.0, 4.0, 1.5));
    // The corner where the ring begins and ends counts as its beginning.
    assert_eq!(drawing.nearest([-1.0, -1.0], f64::INFINITY).unwrap().position(), 0.0);
}

#[test]
fn the_tree_finds_what_a_search_of_all_segments_finds() {
    let mut random = Random::new(7, 0);
    for (lines, points, extent) in [(1, 2, 10.0), (1, 300, 1000.0), (40, 7, 1e6), (300, 3, 1e4), (5, 80, 1.0)] {
        let outlines = scribble(&mut random, lines, points, extent);
        let drawing = Segments::new(&outlines, 1.0);
        for k in 0..400 {
            let mut at = [0, 1].map(|_| (random.share() * 1.5 - 0.25) * extent);
            // Also at points of the drawing, and at their y.
            let vertex = drawing.segments[k % drawing.len()].ends[0];
            match k % 4 {
                0 => at[1] = vertex[1],
                1 => at = [vertex[0], vertex[1]],
                _ => {}
            }
            let all = drawing.segments.iter().map(|segment| distance(segment.flat(), at));
            let best = all.enumerate().min_by(|a, b| a.1.0.total_cmp(&b.1.0).then(a.0.cmp(&b.0))).unwrap();
            let nearest = drawing.nearest(at, f64::INFINITY).unwrap();
            let apart = (nearest.distance() - best.1.0.sqrt()).abs();
            assert!(apart <= 1e-12 * extent, "{at:?}: {} and {}", nearest.distance(), best.1.0.sqrt());
            let crossed = drawing.segments.iter().filter(|segment| crosses(segment.flat(), at)).count();
            assert_eq!(drawing.is_inside(at), crossed % 2 == 1, "{at:?}");
        }
    }
}

#[test]
fn the_inside_of_a_star_with_a_hole() {
    // A five-pointed star drawn in one stroke. By the even-odd rule its middle is outside.
    let tips: Vec<[f64; 2]> = (0..5)
        .map(|k| {
            let angle = std::f64::consts::TAU * f64::from(2 * k) / 5.0;
            [100.0 * libm::sin(angle), -100.0 * libm::cos(angle)]
        })
        .collect();
    let stroke = Segments::new(&[line(&tips).closed()], 1.0);
    assert!(!stroke.is_inside([0.0, 0.0]) && stroke.is_inside([0.0, -80.0]) && !stroke.is_inside([0.0, 60.0]));
    // A star as an outline of ten points, with a square hole.
    let outline: Vec<[f64; 2]> = (0..10)
        .map(|k| {
            let angle = std::f64::consts::TAU * f64::from(k) / 10.0;
            let radius = if k % 2 == 0 { 100.0 } else { 40.0 };
            [radius * libm::sin(angle), -radius * libm::cos(angle)]
        })
        .collect();
    let hole = [[-10.0, -10.0], [10.0, -10.0], [10.0, 10.0], [-10.0, 10.0]];
    for rings in [[line(&outline), line(&hole)], [line(&hole), line(&outline)]] {
        let star = Segments::new(&rings.map(Outline::closed), 1.0);
        for (at, inside) in [
            ([0.0, 0.0], false),
            ([0.0, -9.9], false),
            ([0.0, -10.1], true),
            ([25.0, 0.0], true),
            ([0.0, -99.0], true),
            ([0.0, 60.0], false),
            ([-200.0, 0.0], false),
            ([200.0, 0.0], false),
        ] {
            assert_eq!(star.is_inside(at), inside, "{at:?}");
        }
    }
}

#[test]
fn far_segments_are_not_visited() {
    let mut random = Random::new(3, 0);
    let near = line(&[[0.0, 0.0], [500.0, 200.0], [900.0, 100.0], [400.0, -600.0]]).closed();
    // Far away, but at the same y as the window on both sides, and one ring around everything.
    let mut outlines = vec![near.clone()];
    for k in 0..2500 {
        let [x, y] = [1e5 + 1e5 * random.share(), (random.share() - 0.5) * 3000.0];
        let x = if k % 2 == 0 { x } else { -x };
        outlines.push(line(&[[x, y], [x + 30.0, y], [x + 30.0, y + 50.0], [x, y + 50.0]]).closed());
    }
    let few = Segments::new(&[near], 1.0);
    let many = Segments::new(&outlines, 1.0);
    assert_eq!((few.len(), many.len()), (4, 10_004));
    let (mut visits_few, mut visits_many, mut samples) = (0, 0, 0);
    for j in -20..=20 {
        for i in -20..=40 {
            let at = [f64::from(i) * 25.0, f64::from(j) * 25.0];
            let nearest = |drawing: &Segments, visits: &mut usize| {
                (drawing.nearest_counted(at, f64::INFINITY, visits), drawing.is_inside_counted(at, visits))
            };
            let (a, b) = (nearest(&few, &mut visits_few), nearest(&many, &mut visits_many));
            assert_eq!((a.0.map(|a| a.distance()), a.1), (b.0.map(|b| b.distance()), b.1));
            samples += 1;
        }
    }
    assert!(visits_many <= visits_few, "{visits_many} segments were visited, {visits_few} without the far ones");
    assert!(visits_many <= 8 * samples, "{visits_many} for {samples} samples");
    // Beyond the maximum distance of a mask no segment is visited.
    let mut visits = 0;
    assert!(many.nearest_counted([0.0, 20_000.0], 100.0, &mut visits).is_none());
    assert!(visits <= LEAF, "{visits}");
}

#[test]
fn positions_far_from_the_origin_are_as_good() {
    let points = [[0.0, 0.0], [300.0, 40.0], [350.0, 400.0], [10.0, 220.0]];
    let here = Segments::new(&[line(&points).closed().smoothed()], 0.01);
    let there = points.map(|[x, y]| [x + 1e6, y - 1e6]);
    let there = Segments::new(&[line(&there).closed().smoothed()], 0.01);
    for k in 0..500 {
        let at = [f64::from(k % 25) * 17.0 - 20.0, f64::from(k / 25) * 23.0 - 20.0];
        let far = [at[0] + 1e6, at[1] - 1e6];
        let [a, b] = [(&here, at), (&there, far)].map(|(drawing, at)| drawing.nearest(at, f64::INFINITY).unwrap());
        assert!((a.distance() - b.distance()).abs() < 1e-6, "{at:?}: {} {}", a.distance(), b.distance());
        assert_eq!(here.is_inside(at), there.is_inside(far), "{at:?}");
    }
}

#[test]
fn drawings_of_any_kind_do_no_harm() {
    let nothing = Segments::new(&[], 1.0);
    assert!(
        nothing.nearest([0.0, 0.0], f64::INFINITY).is_none() && !nothing.is_inside([0.0, 0.0]) && nothing.is_empty()
    );
    let point = Segments::new(&[line(&[[3.0, 4.0], [3.0, 4.0]]).closed()], 1.0);
    let nearest = point.nearest([0.0, 0.0], f64::INFINITY).unwrap();
    assert_eq!((nearest.distance(), nearest.position(), nearest.chainage()), (5.0, 0.0, 0.0));
    assert!(!point.is_inside([3.0, 4.0]));
    let odd = Segments::new(&[line(&[[f64::NAN, 0.0], [1.0, 2.0], [f64::INFINITY, 3.0]])], 1.0);
    assert!(odd.nearest([0.0, 0.0], f64::INFINITY).is_none_or(|nearest| nearest.distance().is_finite()));
    // A curve so large that its tolerance would need more segments than the maximum.
    let curve = line(&[[0.0, 0.0], [1e9, 5e8], [2e9, -1e9], [-1e9, 7e8]]).closed().smoothed();
    let many: Vec<Outline> = (0..100).map(|_| curve.clone()).collect();
    let many = Segments::new(&many, 1e-3);
    assert!(many.len() <= MAX_SEGMENTS && many.len() > MAX_SEGMENTS / 8, "{}", many.len());
    assert!(many.memory() > 50 * many.len() as u64);
}

#[test]
fn of_long_segments_side_by_side_only_those_nearby_are_visited() {
    type Shape = fn(f64, bool) -> [f64; 2];
    let shapes: [(&str, Shape); 4] = [
        ("across", |t, there| [t, if there { 480.0 } else { 0.0 }]),
        ("diagonal", |t, there| if there { [t, t + 50.0] } else { [t + 50.0, t] }),
        ("slanted", |t, there| if there { [t, 0.0] } else { [t + 300.0, 480.0] }),
        ("fan", |t, there| if there { [t, 480.0] } else { [480.0, t] }),
    ];
    let count = 20_000;
    for (name, shape) in shapes {
        for smooth in [false, true] {
            let points: Vec<[f64; 3]> = (0..count)
                .map(|k| {
                    let [x, y] = shape(f64::from(k) * 480.0 / f64::from(count), k % 2 == 0);
                    [x, y, 0.0]
                })
                .collect();
            let open = Outline::of_points(&points);
            let drawing = Segments::new(&[if smooth { open.smoothed() } else { open }.closed()], 1e-3);
            let (mut visits, samples) = (0, 100);
            for k in 0..samples {
                let at = [f64::from(k % 10) * 61.0 - 40.7, f64::from(k / 10) * 48.0 + 5.1];
                let nearest = drawing.nearest_counted(at, f64::INFINITY, &mut visits).unwrap();
                let inside = drawing.is_inside_counted(at, &mut visits);
                if k % 9 == 0 {
                    let squares = drawing.segments.iter().map(|segment| distance(segment.flat(), at).0);
                    assert_eq!(nearest.distance(), squares.fold(f64::MAX, f64::min).sqrt(), "{name} {at:?}");
                    let crossed = drawing.segments.iter().filter(|segment| crosses(segment.flat(), at)).count();
                    assert_eq!(inside, crossed % 2 == 1, "{name} {at:?}");
                }
            }
            let most = drawing.len() as u32 / 40;
            assert!(
                visits as u32 / samples < most,
                "{name} {smooth}: {} of {}",
                visits as u32 / samples,
                drawing.len()
            );
        }
    }
}
