//! Solids for 3D printing: closed, facing outwards, and of the stated size.

use crate::meshes::{V3, cross, dot, f32s, land, minus, shapes, surface, wide};
use orogen::output::mesh::solid::Print;
use orogen::output::mesh::{Shape, Solid, Surface, adaptive, stl};
use orogen::{Grid, Progress, Window};
use std::collections::BTreeMap;

/// Checks that a solid, as stored in an .stl file, is closed and faces outwards; returns its volume and its bounds.
fn closed(solid: &Solid) -> (f64, [V3; 2]) {
    let mut bytes = Vec::new();
    stl::write(&mut bytes, solid, &Progress::none()).unwrap();
    let count = u32::from_le_bytes(bytes[80..84].try_into().unwrap()) as usize;
    assert_eq!(bytes.len(), 84 + 50 * count);
    let mut edges: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
    let (mut volume, mut least, mut greatest) = (0.0, [f64::MAX; 3], [f64::MIN; 3]);
    for facet in bytes[84..].chunks_exact(50) {
        let numbers = f32s(&facet[..48]);
        let corners: [[f32; 3]; 3] = std::array::from_fn(|k| numbers[3 + 3 * k..6 + 3 * k].try_into().unwrap());
        for k in 0..3 {
            let [from, to] = [corners[k], corners[(k + 1) % 3]].map(|corner| corner.map(f32::to_bits));
            *edges.entry([from, to]).or_default() += 1;
            least = std::array::from_fn(|i| least[i].min(f64::from(corners[k][i])));
            greatest = std::array::from_fn(|i| greatest[i].max(f64::from(corners[k][i])));
        }
        let [a, b, c] = corners.map(wide);
        let normal = cross(minus(b, a), minus(c, a));
        assert!(dot(normal, wide(numbers[..3].try_into().unwrap())) > 0.0);
        volume += dot(a, cross(b, c)) / 6.0;
    }
    for ([from, to], times) in &edges {
        assert_eq!((*times, edges.get(&[*to, *from])), (1, Some(&1)), "an edge is shared by two");
    }
    assert_eq!(solid.bounds().map(wide), [least, greatest]);
    (volume, [least, greatest])
}

#[test]
fn a_solid_is_closed_and_faces_outwards() {
    for (width, height) in [(37, 23), (2, 2), (2, 40), (120, 100)] {
        let grid = land(width, height);
        for shape in shapes(&grid) {
            let exaggerated = Surface { exaggeration: 2.0, ..surface(&grid, &shape) };
            let print = Print::new(150.0).with_base(3.0);
            let solid = Solid::new(&exaggerated, &print).unwrap();
            let (volume, [least, greatest]) = closed(&solid);
            let scale = 150.0 / (12.5 * (width.max(height) - 1) as f64);
            let sides = [width, height].map(|samples| (samples - 1) as f64 * 12.5 * scale);
            assert!((0..2).all(|i| (greatest[i] - sides[i]).abs() < 1e-4), "{greatest:?}");
            assert_eq!(least, [0.0; 3]);
            let relief = exaggerated.bounds()[1][1] - exaggerated.bounds()[0][1];
            assert!((greatest[2] - 3.0 - f64::from(relief) * scale).abs() < 1e-4);
            // The mean height above the base, by the trapezoidal rule on the grid.
            if shape == Shape::lattice(&grid, 1).unwrap() && width * height > 1000 {
                let lowest = grid.data().iter().copied().fold(f32::MAX, f32::min);
                let mean = grid.data().iter().map(|&z| f64::from(z - lowest)).sum::<f64>() / grid.data().len() as f64;
                let expect = sides[0] * sides[1] * (3.0 + 2.0 * scale * mean);
                assert!((volume / expect - 1.0).abs() < 0.02, "{volume} {expect}");
            }
            assert!(volume > 3.0 * sides[0] * sides[1]);
        }
    }
}

/// Two hills with a pass at 10 m between them, on level ground of 0 m, in cells of 10 m divided by `fineness`.
fn two_hills(fineness: u16) -> Grid {
    let (across, down) = (60 * usize::from(fineness) + 1, 40 * usize::from(fineness) + 1);
    let mut grid = Grid::filled(Window::new(across, down, 10.0 / f64::from(fineness)), 0.0);
    for j in 0..down {
        for i in 0..across {
            let [east, south] = [i, j].map(|k| k as f32 / f32::from(fineness));
            let hill = |x: f32| 40.0 - 3.0 * libm::hypotf(east - x, south - 20.0);
            grid.row_mut(j)[i] = hill(20.0).max(hill(40.0)).max(0.0);
        }
    }
    grid
}

#[test]
fn land_above_a_cut_has_its_outline_and_a_base_there() {
    let grid = two_hills(1);
    for shape in shapes(&grid) {
        let surface = Surface { exaggeration: 2.0, ..surface(&grid, &shape) };
        let cut = |level: f64| Solid::new(&surface, &Print::new(120.0).with_base(2.0).with_cut(level));
        // 120 mm are 600 m; the hills are cones of radius 13.3 samples at 0 m, and of 6.7 at 20 m.
        let (volume, [least, greatest]) = closed(&cut(20.0).unwrap());
        let near = |a: f64, b: f64, off: f64| assert!((a - b).abs() < off, "{a} {b}");
        let coarse = if shape == Shape::lattice(&grid, 1).unwrap() { 0.3 } else { 4.0 };
        near(least[0], 2.0 * (20.0 - 6.67), coarse);
        near(greatest[0], 2.0 * (40.0 + 6.67), coarse);
        near(greatest[2], 2.0 + 2.0 * 20.0 * 0.2, coarse);
        assert_eq!(least[2], 0.0);
        if coarse < 1.0 {
            // Two cones of 8 mm on cylinders of 2 mm with a radius of 13.3 mm.
            near(volume, 2.0 * std::f64::consts::PI * 13.33 * 13.33 * (2.0 + 8.0 / 3.0), 60.0);
        }
        // At the level of the ground and at that of the pass, where vertices are on the cut; through the hills; and
        // below everything.
        for level in [0.0, 10.0, 25.0, -5.0] {
            closed(&cut(level).unwrap());
        }
        let below = closed(&cut(-5.0).unwrap()).1;
        near(below[1][2], 2.0 + 2.0 * 45.0 * 0.2, coarse);
        assert_eq!(below[0], [0.0; 3]);
        let why = cut(40.0).unwrap_err().to_string();
        assert!(why.contains("its level is 40 m, and the highest sample is at 40 m"), "{why}");
    }
    // White noise: many small parts, holes, and land that touches the border.
    let mut noise = Grid::filled(Window::new(57, 43, 1.0), 0.0);
    for k in 0..57 * 43 {
        noise.row_mut(k / 57)[k % 57] = (k * 7919 % 101) as f32;
    }
    let shape = Shape::lattice(&noise, 1).unwrap();
    for level in [10.0, 50.0, 90.0] {
        closed(&Solid::new(&surface(&noise, &shape), &Print::new(100.0).with_cut(level)).unwrap());
    }
}

#[test]
fn a_hollow_solid_has_walls_and_a_ceiling_everywhere() {
    for (width, height) in [(37, 23), (12, 90), (120, 100)] {
        let grid = land(width, height);
        for shape in [Shape::lattice(&grid, 1).unwrap(), adaptive(&grid, 1.5).unwrap()] {
            let surface = surface(&grid, &shape);
            let full = Solid::new(&surface, &Print::new(150.0)).unwrap();
            let hollow = Solid::new(&surface, &Print::new(150.0).with_hollow(2.0)).unwrap();
            let ((all, bounds), (left, hollow_bounds)) = (closed(&full), closed(&hollow));
            assert_eq!(bounds, hollow_bounds);
            assert!(left < 0.85 * all, "{left} {all}");
            // Vertices of the cavity are all vertices that are not below, on or next to the surface.
            let top = full.corners.len() - 1;
            let inside =
                |[x, y, _]: [f32; 3]| x > 0.0 && y > 0.0 && f64::from(x) < bounds[1][0] && f64::from(y) < bounds[1][1];
            let outer = &full.corners[..top];
            let mut ceilings = 0;
            for corner in hollow.corners[shape.corners()..].iter().filter(|corner| inside(**corner) && corner[2] > 0.0)
            {
                let near = outer.iter().map(|other| {
                    let apart = minus(wide(*other), wide(*corner));
                    dot(apart, apart).sqrt()
                });
                assert!(near.fold(f64::MAX, f64::min) > 2.0 - 1e-4, "{corner:?}");
                assert!((0..2).all(|i| (2.0 - 1e-4..=bounds[1][i] - 2.0 + 1e-4).contains(&f64::from(corner[i]))));
                ceilings += 1;
            }
            assert!(ceilings > 100, "{ceilings}");
        }
    }
    let grid = land(60, 40);
    let shape = Shape::lattice(&grid, 1).unwrap();
    let refused = |print: Print| Solid::new(&surface(&grid, &shape), &print).unwrap_err().to_string();
    let why = refused(Print::new(150.0).with_hollow(3.0));
    assert!(why.contains("walls of 3 mm need a base that is thicker than 3 mm"), "{why}");
    let why = refused(Print::new(15.0).with_base(9.0).with_hollow(4.0));
    assert!(why.contains("a solid of 15 x 9.9 mm is too small for walls of 4 mm"), "{why}");
}

#[test]
fn letters_stand_out_of_the_southern_wall() {
    let grid = land(60, 40);
    let shape = Shape::lattice(&grid, 1).unwrap();
    let print = Print::new(150.0).with_base(10.0);
    let plain = Solid::new(&surface(&grid, &shape), &print).unwrap();
    let (before, _) = closed(&plain);
    let mut solid = plain.clone();
    // Eight of the ten millimetres of the base.
    assert!((solid.letter("L").unwrap() - 8.0).abs() < 0.01);
    let (volume, [least, _]) = closed(&solid);
    assert!((least[1] + 0.6).abs() < 1e-6);
    let letter: Vec<V3> = solid.corners[plain.corners.len()..].iter().copied().map(wide).collect();
    let range = |axis: usize| {
        letter.iter().fold([f64::MAX, f64::MIN], |[low, high], at| [low.min(at[axis]), high.max(at[axis])])
    };
    let ([west, east], [south, north], [low, high]) = (range(0), range(1), range(2));
    assert!(west > 70.0 && east < 80.0 && (north - 0.4).abs() < 1e-6 && (south + 0.6).abs() < 1e-6, "{west} {east}");
    // A capital is about 0.72 em high; its middle is at the middle of the base.
    assert!((high - low - 0.72 * 8.0).abs() < 0.3 && (high + low - 10.0).abs() < 0.6, "{low} {high}");
    // The stem of an L is in the west, and its arm is at the bottom.
    let stem = letter.iter().filter(|at| at[2] > 6.0).all(|at| at[0] < 0.5 * (west + east));
    let arm = letter.iter().filter(|at| at[0] > 0.5 * (west + east)).all(|at| at[2] < 5.0);
    assert!(stem && arm);
    let area = volume - before;
    assert!((5.0..20.0).contains(&area), "{area}");
    // Letters with holes, several letters, and a letter of several parts.
    for text in ["BØ8%&", "Alpine 2026", "i"] {
        closed(&{
            let mut solid = plain.clone();
            solid.letter(text).unwrap();
            solid
        });
    }
    let refused = |print: Print, text: &str| {
        let mut solid = Solid::new(&surface(&grid, &shape), &print).unwrap();
        solid.letter(text).unwrap_err().to_string()
    };
    assert!(refused(print, "the 山").contains("the built-in font has no letter for `山` of --text"));
    assert!(refused(print, "  ").contains("--text must have 1 to 200 letters"));
    let why = refused(Print::new(5000.0), "a");
    assert!(why.contains("would have a size of 2.4 mm on a model of 5000 mm"), "{why}");
}

#[test]
fn each_part_of_land_above_a_cut_is_hollow() {
    // 0.5 mm on a model of 120 mm.
    let grid = two_hills(4);
    let shape = Shape::lattice(&grid, 1).unwrap();
    let surface = Surface { exaggeration: 2.0, ..surface(&grid, &shape) };
    let print = Print::new(120.0).with_base(2.5).with_cut(20.0);
    let (full, hollow) =
        (Solid::new(&surface, &print).unwrap(), Solid::new(&surface, &print.with_hollow(1.5)).unwrap());
    let ((all, bounds), (left, hollow_bounds)) = (closed(&full), closed(&hollow));
    assert_eq!(bounds, hollow_bounds);
    assert!(left < 0.75 * all, "{left} {all}");
    // The upper half of the vertices is the land; other vertices above the ground belong to the cavity.
    let top = &full.corners[..full.corners.len() / 2];
    assert_eq!(top, &hollow.corners[..top.len()]);
    let outline: Vec<[f32; 3]> = top.iter().copied().filter(|corner| corner[2] == 2.5).collect();
    let ceiling: Vec<[f32; 3]> = hollow.corners[top.len()..].iter().copied().filter(|corner| corner[2] > 0.0).collect();
    assert!(outline.len() > 100 && ceiling.len() > 500, "{} {}", outline.len(), ceiling.len());
    for corner in &ceiling {
        let least = |others: &[[f32; 3]], up: f64| {
            let away = others.iter().map(|other| {
                let [x, y, z] = minus(wide(*other), wide(*corner));
                dot([x, y, up * z], [x, y, up * z]).sqrt()
            });
            away.fold(f64::MAX, f64::min)
        };
        assert!(least(top, 1.0) > 1.5 - 1e-4 && least(&outline, 0.0) > 1.5 - 1e-4, "{corner:?}");
    }
    // Both hills have a cavity.
    assert!(ceiling.iter().any(|corner| corner[0] < 55.0) && ceiling.iter().any(|corner| corner[0] > 65.0));
    // Land with capes and holes that touches the sides, at several levels.
    let grid = land(120, 100);
    let [low, high] = grid.data().iter().fold([f32::MAX, f32::MIN], |[low, high], z| [low.min(*z), high.max(*z)]);
    let shape = Shape::lattice(&grid, 1).unwrap();
    let mut cavities = 0;
    for share in [0.2, 0.4, 0.5, 0.6] {
        let print = Print::new(150.0).with_base(6.0).with_cut(f64::from(low + share * (high - low)));
        let surface = crate::meshes::surface(&grid, &shape);
        let full = closed(&Solid::new(&surface, &print).unwrap()).0;
        if let Ok(hollow) = Solid::new(&surface, &print.with_hollow(2.0)) {
            assert!(closed(&hollow).0 < full);
            cavities += 1;
        }
    }
    assert!(cavities > 1, "{cavities}");
    // Solids without room, and meshes without a vertex at every sample, are refused.
    let refused = |shape: &Shape, grid: &Grid, print: Print| {
        Solid::new(&crate::meshes::surface(grid, shape), &print).unwrap_err().to_string()
    };
    let coarse = two_hills(1);
    let [whole, few] = [Shape::lattice(&coarse, 1).unwrap(), adaptive(&coarse, 1.0).unwrap()];
    let print = Print::new(60.0).with_base(9.0).with_cut(20.0).with_hollow(8.0);
    let why = refused(&whole, &coarse, print);
    assert!(why.contains("no part of the land above the cut has room for a cavity within walls of 8 mm"), "{why}");
    let why = refused(&few, &coarse, print);
    assert!(why.contains("has a vertex at every sample; leave out --max-error"), "{why}");
}

#[test]
fn letters_stand_on_the_straight_side_of_land_above_a_cut() {
    // A ridge across the southern side in its western half, and a lower, narrower one in its eastern half.
    let mut grid = Grid::filled(Window::new(121, 61, 10.0), 0.0);
    for j in 0..61 {
        for (i, height) in grid.row_mut(j).iter_mut().enumerate() {
            let ridge = |x: f32, top: f32| top - (i as f32 - x).abs();
            *height = ridge(40.0, 40.0).max(ridge(100.0, 25.0)).max(0.0);
        }
    }
    let shape = Shape::lattice(&grid, 1).unwrap();
    let print = Print::new(120.0).with_base(6.0).with_cut(15.0);
    let plain = Solid::new(&surface(&grid, &shape), &print).unwrap();
    let mut solid = plain.clone();
    let size = solid.letter("N").unwrap();
    closed(&solid);
    assert!((size - 4.8).abs() < 0.01, "{size}");
    let [west, east] = solid.corners[plain.corners.len()..]
        .iter()
        .fold([f32::MAX, f32::MIN], |[west, east], corner| [west.min(corner[0]), east.max(corner[0])]);
    assert!((0.5 * (west + east) - 40.0).abs() < 0.5 && east - west < 6.0, "{west} {east}");
    let hills = two_hills(1);
    let shape = Shape::lattice(&hills, 1).unwrap();
    let why = Solid::new(&surface(&hills, &shape), &print).unwrap().letter("N").unwrap_err().to_string();
    assert!(why.contains("the land above the cut does not reach the southern side of the window"), "{why}");
}

#[test]
fn letters_are_engraved_in_the_southern_wall() {
    let grid = land(60, 40);
    for shape in [Shape::lattice(&grid, 1).unwrap(), adaptive(&grid, 1.5).unwrap()] {
        for (hollow, depth) in [(None, 0.6), (Some(1.0), 0.5)] {
            let mut print = Print::new(150.0).with_base(10.0);
            print.hollow = hollow;
            let plain = Solid::new(&surface(&grid, &shape), &print).unwrap();
            let (before, bounds) = closed(&plain);
            let [mut raised, mut engraved] = [plain.clone(), plain.clone()];
            let sizes = [raised.letter("L").unwrap(), engraved.engrave("L", hollow).unwrap()];
            assert!((sizes[0] - sizes[1]).abs() < 0.2, "{sizes:?}");
            let ((more, _), (less, same)) = (closed(&raised), closed(&engraved));
            assert_eq!(bounds, same);
            // Raised letters are bodies 1 mm thick.
            let scale = sizes[1] / sizes[0];
            let expect = (more - before) * depth * scale * scale;
            assert!((before - less - expect).abs() < 0.01 * expect, "{before} {less} {expect}");
            for text in ["BØ8%& Alpine", "Äg", "i"] {
                let mut solid = plain.clone();
                solid.engrave(text, hollow).unwrap();
                let deepest = solid.corners[plain.corners.len()..].iter().fold(0.0, |most: f32, at| most.max(at[1]));
                assert!((f64::from(deepest) - depth).abs() < 1e-6, "{deepest}");
                closed(&solid);
            }
        }
    }
    // Ground that falls away from a high edge limits the letters.
    let mut cliff = land(60, 40);
    cliff.row_mut(39).fill(2000.0);
    let shape = Shape::lattice(&cliff, 1).unwrap();
    let print = Print::new(30.0).with_base(10.0);
    let solid = Solid::new(&surface(&cliff, &shape), &print).unwrap();
    let wall = |letter: fn(&mut Solid) -> f64| letter(&mut solid.clone());
    let sizes = [wall(|solid| solid.letter("L").unwrap()), wall(|solid| solid.engrave("L", None).unwrap())];
    assert!(sizes[0] == 12.0 && sizes[1] < 12.0, "{sizes:?}");
}
