//! Whole sheets: everything is on the page, parts can be omitted, and the result does not depend on the number of
//! threads.

use super::draw::{self, Sheet};
use super::geometry::{Point, Rect, Size};
use super::options::{Coloring, Labels, Page, Parts, Resolution, Shading, SheetOptions, SurfaceCover, SurfaceEntry};
use super::scene::{Item, Scene, Step};
use super::{pdf, raster, vector};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_io::palette::named;

fn draw(heights: &Grid, options: &SheetOptions) -> Result<Sheet> {
    draw::draw(heights, options, &Progress::none())
}

fn options() -> SheetOptions {
    SheetOptions {
        about: "Of hills".into(),
        ..SheetOptions::new(named::all()[0].palette())
            .with_title("A test")
            .with_page(Page::Fitted(100.0))
            .with_resolution(Resolution::Inch(60.0))
            .with_sea_level(0.0)
    }
}

fn hills(width: usize, height: usize) -> Grid {
    let mut grid = Grid::filled(Window::new(width, height, 50.0), 0.0);
    for j in 0..height {
        for i in 0..width {
            let (x, y) = (i as f64 / 9.0, j as f64 / 7.0);
            let hills = libm::sin(x) * libm::cos(y) + 0.4 * libm::sin(2.3 * x + y) + 0.03 * x;
            grid.row_mut(j)[i] = (700.0 * hills + 300.0) as f32;
        }
    }
    grid
}

fn places(scene: &Scene) -> Vec<Point> {
    let of = |item: &Item| match item {
        Item::Picture { area, .. } => vec![area.corner(), Point::new(area.right(), area.bottom())],
        Item::Lines { lines, .. } => lines.concat(),
        Item::Area { outline, .. } => outline
            .iter()
            .map(|step| match *step {
                Step::Move(place) | Step::Line(place) | Step::Curve(_, _, place) => place,
            })
            .collect(),
    };
    scene.items.iter().flat_map(of).collect()
}

#[test]
fn all_is_on_the_page_whatever_the_world() {
    let mut holed = hills(90, 70);
    for j in 20..40 {
        holed.row_mut(j)[30..50].fill(f32::NAN);
    }
    let flat = Grid::filled(Window::new(50, 50, 10.0), 12.0);
    let deep = Grid::from_data(Window::new(90, 70, 50.0), hills(90, 70).data().iter().map(|h| h - 5000.0).collect());
    let worlds = [hills(90, 70), holed, flat, deep.unwrap(), hills(2, 2), hills(400, 8), hills(8, 400)];
    for (k, heights) in worlds.iter().enumerate() {
        for page in [Page::Fitted(100.0), Page::Paper([210.0, 148.0]), Page::Paper([60.0, 60.0])] {
            let sheet = draw(heights, &SheetOptions { page, ..options() }).unwrap();
            let Size { width, height } = sheet.scene.size;
            let small = page == Page::Paper([60.0; 2]);
            for Point { x, y } in places(&sheet.scene) {
                // The content below the map may be more than this small paper can hold.
                let inside = (0.0..=width).contains(&x) && (0.0..=height).contains(&y) || small;
                assert!(x.is_finite() && y.is_finite() && inside, "{k} {page:?}: {x} {y} of {width} x {height}");
            }
        }
    }
    let none = Grid::filled(Window::new(5, 5, 1.0), f32::NAN);
    assert!(draw(&none, &options()).err().unwrap().to_string().contains("a map needs at least 2 x 2"));
    assert!(draw(&hills(1, 9), &options()).is_err());
}

#[test]
fn parts_are_left_out_one_by_one() {
    let heights = hills(120, 90);
    let all = draw(&heights, &options()).unwrap();
    assert!(all.interval.is_some_and(|interval| interval > 0.0));
    // Paper with space for a profile.
    let paper = || SheetOptions { page: Page::Paper([150.0, 270.0]), ..options() };
    let all = draw(&heights, &paper()).unwrap();
    let count = |change: fn(&mut Parts)| {
        let mut options = paper();
        change(&mut options.parts);
        places(&draw(&heights, &options).unwrap().scene).len()
    };
    let most = places(&all.scene).len();
    let without: [fn(&mut Parts); 11] = [
        |parts| parts.title = false,
        |parts| parts.axes = false,
        |parts| parts.contours = false,
        |parts| parts.labels = false,
        |parts| parts.summits = false,
        |parts| parts.rivers = false,
        |parts| parts.legend = false,
        |parts| parts.colors = false,
        |parts| parts.scale = false,
        |parts| parts.north = false,
        |parts| parts.profile = false,
    ];
    for (k, change) in without.into_iter().enumerate() {
        assert_ne!(count(change), most, "part {k}");
    }
}

#[test]
fn every_kind_of_file_has_the_same_on_any_number_of_threads() {
    let written = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let sheet = draw(&hills(80, 60), &options()).unwrap();
            let (mut svg, mut page) = (Vec::new(), Vec::new());
            vector::write(&mut svg, &sheet.scene).unwrap();
            pdf::write(&mut page, &sheet.scene).unwrap();
            (raster::draw(&sheet.scene, sheet.dpi), svg, page)
        })
    };
    let (one, three) = (written(1), written(3));
    assert!(one == three);
    let text = String::from_utf8(one.1).unwrap();
    assert!(text.starts_with("<svg") && text.ends_with("</svg>\n") && one.2.starts_with(b"%PDF-1.4"));
}

#[test]
fn pixels_are_as_many_as_asked() {
    let wide = SheetOptions { resolution: Resolution::Longer(700), ..options() };
    let sheet = draw(&hills(120, 40), &wide).unwrap();
    let [width, height] = raster::pixels(&sheet.scene, sheet.dpi);
    assert!(width.max(height) == 700, "{width} x {height}");
}

#[test]
fn surfaces_color_the_map_and_stand_in_the_legend() {
    let heights = hills(120, 90);
    let albedo = [0.02, 0.3, 0.02].map(|part| Grid::filled(*heights.window(), part));
    let entry =
        |name: &str, colors: &[[u8; 3]]| SurfaceEntry { name: name.into(), colors: colors.to_vec(), share: 0.5 };
    let entries = vec![entry("grass", &[[76, 92, 46], [143, 134, 104]]), entry("rock", &[[109, 103, 95]])];
    let covered = SheetOptions {
        coloring: Coloring::Surfaces(SurfaceCover { albedo, entries }),
        sea_level: None,
        shading: Shading::None,
        page: Page::Paper([210.0, 297.0]),
        ..options()
    };
    let sheet = draw(&heights, &covered).unwrap();
    let pictures: Vec<(&Rect, &Vec<u8>)> = (sheet.scene.items.iter())
        .filter_map(|item| match item {
            Item::Picture { area, pixels, .. } => Some((area, pixels)),
            _ => None,
        })
        .collect();
    // The map first, then a swatch for each surface; the profile shows rock.
    assert!(pictures[0].1.chunks_exact(3).all(|pixel| pixel[1] > pixel[0] && pixel[1] > pixel[2]));
    let swatches: Vec<&Vec<u8>> =
        pictures.iter().filter(|(area, _)| area.height == 3.0).map(|picture| picture.1).collect();
    assert_eq!(swatches.len(), 2);
    assert_eq!((&swatches[0][..3], &swatches[0][189..]), (&[76, 92, 46][..], &[143, 134, 104][..]));
    assert!(swatches[1].chunks_exact(3).all(|pixel| *pixel == [109, 103, 95]));
}

#[test]
fn sheets_with_one_range_agree_along_their_common_edge() {
    let window = Window::new(160, 60, 50.0);
    let whole = Grid::from_data(window, (0..window.len()).map(|at| 10.0 * (at % 160) as f32).collect()).unwrap();
    let halves = [0, 79].map(|x| whole.crop(&Window::new(81, 60, 50.0).at(x, 0)).unwrap());
    let edge = |half: &Grid, column: usize, range: Option<[f32; 2]>| {
        let options = SheetOptions { range, shading: Shading::None, sea_level: None, ..options() };
        let sheet = draw(half, &options).unwrap();
        let picture = sheet.scene.items.iter().find_map(|item| match item {
            Item::Picture { width, pixels, .. } => Some((*width, pixels.clone())),
            _ => None,
        });
        let (width, pixels) = picture.unwrap();
        let column = if column == 0 { 0 } else { width - 1 };
        pixels.chunks_exact(3 * width).map(|row| i32::from(row[3 * column])).collect::<Vec<i32>>()
    };
    let apart = |range| {
        let (west, east) = (edge(&halves[0], 1, range), edge(&halves[1], 0, range));
        west.iter().zip(&east).map(|(a, b)| (a - b).abs()).max().unwrap()
    };
    let (fixed, fitted) = (apart(Some([-500.0, 1500.0])), apart(None));
    assert!(fixed <= 6 && fitted > 30, "{fixed} {fitted}");
}

#[test]
fn all_contours_of_a_slope_have_labels_that_do_not_touch() {
    // A cone: a ring for each level.
    let mut cone = Grid::filled(Window::new(161, 161, 10.0), 0.0);
    for j in 0..161 {
        for i in 0..161 {
            cone.row_mut(j)[i] = (800.0 - 10.0 * libm::hypot(i as f64 - 80.0, j as f64 - 80.0)) as f32;
        }
    }
    let mut plain = SheetOptions { sea_level: None, interval: Some(50.0), ..options() };
    (plain.parts.summits, plain.parts.rivers, plain.parts.lakes) = (false, false, false);
    let labels = |labels: Option<Labels>, levels: Option<Vec<f64>>| {
        let some =
            SheetOptions { labels, interval: plain.interval.filter(|_| levels.is_none()), levels, ..plain.clone() };
        let mut none = some.clone();
        none.parts.labels = false;
        let boxes = |options: &SheetOptions| -> Vec<[f32; 4]> {
            let items = draw(&cone, options).unwrap().scene.items;
            let of = |item: &Item| match item {
                Item::Area { outline, .. } => {
                    let ends = [f32::MAX, f32::MAX, f32::MIN, f32::MIN];
                    let add = |[l, t, r, b]: [f32; 4], Point { x, y }: Point| [l.min(x), t.min(y), r.max(x), b.max(y)];
                    Some(outline.iter().fold(ends, |ends, step| match *step {
                        Step::Move(place) | Step::Line(place) | Step::Curve(_, _, place) => add(ends, place),
                    }))
                }
                _ => None,
            };
            items.iter().filter_map(of).collect()
        };
        let without = boxes(&none);
        boxes(&some).into_iter().filter(|area| !without.contains(area)).collect::<Vec<_>>()
    };
    let apart = |a: &[f32; 4], b: &[f32; 4]| a[2] < b[0] || b[2] < a[0] || a[3] < b[1] || b[3] < a[1];
    let index = labels(None, None);
    let all = labels(Some(Labels::All), None);
    assert!(index.len() < all.len() && all.len() >= 12, "{} {}", index.len(), all.len());
    for (k, a) in all.iter().enumerate() {
        assert!(all[..k].iter().all(|b| apart(a, b)), "{a:?}");
    }
    assert_eq!(labels(None, Some(vec![300.0, 512.5])).len(), labels(Some(Labels::All), Some(vec![300.0, 512.5])).len());
    assert!(labels(None, Some(vec![300.0, 512.5])).len() >= 2);
}
