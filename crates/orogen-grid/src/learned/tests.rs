use super::weights::Weights;
use super::{Drained, Draw, Network};
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::progress::Progress;

const FILE: &[u8] = include_bytes!("land.network");

/// Hilly land: a plane with waves and a lake.
fn land(window: Window) -> Grid {
    let mut grid = Grid::filled(window, 0.0);
    for j in 0..window.height {
        let y = window.y as f64 + j as f64;
        for (i, height) in grid.row_mut(j).iter_mut().enumerate() {
            let x = window.x as f64 + i as f64;
            let wave =
                120.0 * libm::sin(x * 0.31) * libm::cos(y * 0.23 + x * 0.11) + 40.0 * libm::sin(x * 0.9 + y * 0.7);
            *height = (500.0 + 6.0 * x + wave).max(350.0) as f32;
        }
    }
    grid
}

fn fine(coarse: &Grid, window: &Window, noise: f32) -> Result<Grid> {
    Network::built_in()?.refine(coarse, window, &Draw { seed: 7, level: 1, noise }, &Progress::none())
}

fn coarse() -> Grid {
    land(Window::new(90, 90, 90.0).at(-20, -30))
}

fn inside() -> Window {
    Window::new(120, 100, 45.0).at(-5, -11)
}

#[test]
fn a_part_has_the_bits_of_the_whole() -> Result<()> {
    let whole = fine(&coarse(), &inside(), 1.0)?;
    for part in
        [Window::new(17, 9, 45.0).at(0, 3), Window::new(1, 1, 45.0).at(-5, -11), Window::new(40, 2, 45.0).at(1, 0)]
    {
        let alone = fine(&coarse(), &part, 1.0)?;
        assert_eq!(Some(alone), whole.crop(&part), "{part:?}");
    }
    Ok(())
}

#[test]
fn detail_is_added_about_the_coarse_heights() -> Result<()> {
    let (coarse, window) = (coarse(), inside());
    let [likely, draw] = [fine(&coarse, &window, 0.0)?, fine(&coarse, &window, 1.0)?];
    let (mut apart, mut at_nodes) = (0.0, 0.0);
    for j in 0..window.height {
        for i in 0..window.width {
            apart += f64::from((likely.row(j)[i] - draw.row(j)[i]).abs());
            let (x, y) = (window.x + i as i64, window.y + j as i64);
            if x % 2 == 0 && y % 2 == 0 {
                let [i, j] = [x / 2 - coarse.window().x, y / 2 - coarse.window().y].map(|at| at as usize);
                at_nodes += 4.0
                    * f64::from((draw.row((y - window.y) as usize)[(x - window.x) as usize] - coarse.row(j)[i]).abs());
            }
        }
    }
    let samples = window.len() as f64;
    assert!((1.0..15.0).contains(&(apart / samples)), "draws differ from the likely heights by {} m", apart / samples);
    assert!(
        (0.5..15.0).contains(&(at_nodes / samples)),
        "samples differ from the coarse ones by {} m",
        at_nodes / samples
    );
    Ok(())
}

#[test]
fn standing_water_stays_level() -> Result<()> {
    let coarse = Grid::filled(Window::new(60, 60, 90.0), 12.0);
    let made = fine(&coarse, &Window::new(40, 40, 45.0).at(30, 30), 1.0)?;
    assert!(made.data().iter().all(|height| *height == 12.0));
    Ok(())
}

/// Land that falls to the south-west along its receivers, with a river in the south and a lake in it.
struct Valley {
    height: Grid,
    flow: Grid,
    receiver: Grid,
    lake: Grid,
}

const CELL: f64 = 60.0;
const RIVERS: u32 = 16;

impl Valley {
    fn of(window: Window) -> Valley {
        let mut height = land(Window { cell: CELL, ..window });
        let mut flow = Grid::filled(window, (CELL * CELL) as f32);
        let mut receiver = Grid::filled(window, 3.0);
        let mut lake = Grid::filled(window, 0.0);
        for j in 0..window.height {
            for i in 0..window.width {
                let [x, y] = [window.x + i as i64, window.y + j as i64];
                // Steep enough that each sample is above its receiver, except on the waves.
                height.row_mut(j)[i] += (20 * (x - y)) as f32;
                if y.rem_euclid(12) == 0 {
                    (flow.row_mut(j)[i], receiver.row_mut(j)[i]) = (1e6, 4.0);
                    height.row_mut(j)[i] = (40 * x) as f32;
                    lake.row_mut(j)[i] = f32::from(u8::from(x.rem_euclid(31) == 0));
                }
            }
        }
        Valley { height, flow, receiver, lake }
    }

    fn made(&self, window: &Window) -> Result<Grid> {
        let land = Drained { height: &self.height, flow: &self.flow, receiver: &self.receiver, lake: Some(&self.lake) };
        let draw = Draw { seed: 7, level: 1, noise: 1.0 };
        Network::built_in_of_rivers()?.hillslopes(&land, window, RIVERS, &draw, &Progress::none())
    }
}

#[test]
fn hillslopes_keep_rivers_and_drain_to_them() -> Result<()> {
    let network = Network::built_in_of_rivers()?;
    let inside = Window::new(70, 60, CELL).at(-5, -11);
    let valley = Valley::of(inside.grown(network.halo_of_hillslopes(RIVERS)));
    let made = valley.made(&inside)?;
    let before = valley.height.crop(&inside).unwrap_or_else(|| Grid::filled(inside, 0.0));
    let mut changed = 0;
    for j in 1..inside.height - 1 {
        for i in 1..inside.width {
            let is_river = (inside.y + j as i64).rem_euclid(12) == 0;
            if is_river {
                assert_eq!(made.row(j)[i], before.row(j)[i], "river at {i}, {j}");
            } else {
                changed += usize::from((made.row(j)[i] - before.row(j)[i]).abs() > 0.1);
                assert!(made.row(j)[i] > made.row(j + 1)[i - 1], "{i}, {j} is not above its receiver");
            }
        }
    }
    assert!(changed * 10 > inside.len() * 8, "only {changed} samples were changed");
    for part in [Window::new(17, 9, CELL).at(0, 3), Window::new(1, 1, CELL).at(-5, -11), Window::new(40, 2, CELL)] {
        let needed = Valley::of(part.grown(network.halo_of_hillslopes(RIVERS)));
        assert_eq!(Some(needed.made(&part)?), made.crop(&part), "{part:?}");
    }
    Ok(())
}

#[test]
fn a_network_is_used_for_what_it_has_learned() -> Result<()> {
    let valley = Valley::of(Window::new(200, 200, CELL));
    let land = Drained { height: &valley.height, flow: &valley.flow, receiver: &valley.receiver, lake: None };
    let draw = Draw { seed: 7, level: 1, noise: 1.0 };
    let window = Window::new(4, 4, CELL).at(98, 98);
    let refused = |made: Result<Grid>| made.err().map(|error| error.to_string()).unwrap_or_default();
    let made = Network::built_in()?.hillslopes(&land, &window, RIVERS, &draw, &Progress::none());
    assert!(refused(made).contains("reads no rivers: use it in `learned`"));
    let made = Network::built_in_of_rivers()?.refine(&coarse(), &inside(), &draw, &Progress::none());
    assert!(refused(made).contains("keeps rivers: use it in `hillslopes`"));
    Ok(())
}

#[test]
fn a_file_that_was_changed_is_refused() {
    let message = |file: &[u8]| Weights::parse(file).err().map(|error| error.to_string()).unwrap_or_default();
    assert_eq!(message(FILE), "");
    let body = FILE.windows(2).position(|pair| pair == b"\n\n").unwrap_or_default() + 2;
    let changed = |at: usize, to: u8| {
        let mut file = FILE.to_vec();
        file[at] = to;
        message(&file)
    };
    assert!(message(b"").contains("it has no header"));
    assert!(message(&FILE[..FILE.len() - 4]).contains("bytes of weights instead of"));
    assert!(changed(0, b'O').contains("its first line is not `orogen network 1`"));
    assert!(changed(body + 5, FILE[body + 5] ^ 1).contains("the SHA-256 of its weights is"));
    let text = String::from_utf8_lossy(&FILE[..body]).into_owned();
    let with = |from: &str, to: &str| message(&[text.replace(from, to).as_bytes(), &FILE[body..]].concat());
    assert!(with("channels 32", "channels 40").contains("not a multiple of 16"));
    assert!(with("channels 32", "channels 1000000").contains("not a number from 1 to 256"));
    assert!(with("layers 4", "layers 0").contains("not a number from 1 to 16"));
    assert!(with("cells 60 180", "cells 60 180\nrivers no").contains("`rivers no` is not `rivers yes`"));
    assert!(with("cells 60 180", "cells 60 180\nrivers yes").contains("bytes of weights instead of"));
    assert!(with("cells 60 180", "cells 60").contains("two cells in metres"));
    assert!(with("sha256", "sha512").contains("no line `sha256`"));
    // Any header is read or refused.
    for at in 0..body {
        for byte in [0, b'\n', b' ', b'9', 0xFF] {
            let _ = changed(at, byte);
        }
    }
}
