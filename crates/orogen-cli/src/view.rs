//! From `--size` and `--cell` to the window that is looked at. Neither changes the world, only the samples taken of it.

use orogen::{Window, World};

use crate::failure::Failure;
use crate::options::View;
use crate::size::Size;

/// Samples along each side of what is looked at in a world without bounds, if nobody says.
const UNBOUNDED: usize = 1024;

/// The window of the whole world that `view` asks for: a world of length L has round(L / cell) samples. Of a world without
/// bounds, so many samples at the recipe's cell from the origin.
pub fn whole(world: &World, view: &View) -> Result<Window, Failure> {
    let spec = &world.recipe().world;
    let Some(size) = spec.size else {
        let cell = view.cell.unwrap_or(spec.cell);
        return Ok(match view.size {
            None => Window::new(UNBOUNDED, UNBOUNDED, cell),
            Some(Size::Longer(n)) => Window::new(n, n, cell),
            Some(Size::Both(width, height)) => Window::new(width, height, cell),
        });
    };
    match view.size {
        None => Ok(world.whole(view.cell.unwrap_or(spec.cell))?),
        Some(Size::Longer(n)) => Ok(world.across(n)?),
        Some(Size::Both(width, height)) => {
            let [fitting_width, fitting_height] = [width as f64 * size[1] / size[0], height as f64 * size[0] / size[1]];
            let cell = if size[0] >= size[1] { size[0] / width as f64 } else { size[1] / height as f64 };
            let fits = match size[0] >= size[1] {
                true => (fitting_width.round() as usize).max(1) == height,
                false => (fitting_height.round() as usize).max(1) == width,
            };
            match fits {
                true => Ok(Window::new(width, height, cell)),
                false => Err(Failure::Usage(format!(
                    "--size {width}x{height} has another aspect than the world of {} x {} m; the nearest that fit are \
                     {width}x{} and {}x{height}",
                    size[0],
                    size[1],
                    (fitting_width.round() as usize).max(1),
                    (fitting_height.round() as usize).max(1)
                ))),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::Recipe;

    fn look(size: &str, view: View) -> Result<(usize, usize, f64), String> {
        let text = format!(
            "orogen = 1\n[world]\n{size}\ncell = 10\n[nodes.a]\nop = \"constant\"\n[outputs]\nheight = \"a\"\n"
        );
        let world = World::open(Recipe::parse(&text, "test").unwrap()).unwrap();
        match whole(&world, &view) {
            Ok(window) => Ok((window.width, window.height, window.cell)),
            Err(Failure::Usage(sentence)) => Err(sentence),
            Err(Failure::Engine(error)) => Err(error.to_string()),
            Err(other) => panic!("{other:?}"),
        }
    }

    fn view(size: Option<&str>, cell: Option<f64>) -> View {
        View { seed: None, size: size.map(|text| text.parse().unwrap()), cell }
    }

    #[test]
    fn windows_of_a_bounded_world() {
        let world = "size = [8000, 4000]";
        for (size, cell, expect) in [
            (None, None, (800, 400, 10.0)),
            (None, Some(20.0), (400, 200, 20.0)),
            (None, Some(7.0), (1143, 571, 7.0)),
            (Some("1000"), None, (1000, 500, 8.0)),
            (Some("1000x500"), None, (1000, 500, 8.0)),
            (Some("3"), None, (3, 2, 8000.0 / 3.0)),
            (Some("1"), None, (1, 1, 8000.0)),
        ] {
            assert_eq!(look(world, view(size, cell)), Ok(expect), "{size:?} {cell:?}");
        }
        assert_eq!(look("size = [4000, 8000]", view(Some("500x1000"), None)), Ok((500, 1000, 8.0)));
    }

    #[test]
    fn what_does_not_fit_is_a_sentence() {
        let world = "size = [8000, 4000]";
        let error = look(world, view(Some("1000x1000"), None)).unwrap_err();
        assert!(error.contains("1000x500 and 2000x1000"), "{error}");
        assert!(look(world, view(None, Some(9000.0))).unwrap_err().contains("smaller cell"));
        assert!(look(world, view(None, Some(1e-9))).unwrap_err().contains("larger cell"));
    }

    #[test]
    fn windows_of_a_world_without_bounds() {
        for (size, cell, expect) in [
            (None, None, (1024, 1024, 10.0)),
            (None, Some(3.0), (1024, 1024, 3.0)),
            (Some("50"), None, (50, 50, 10.0)),
            (Some("50x70"), None, (50, 70, 10.0)),
        ] {
            assert_eq!(look("", view(size, cell)), Ok(expect), "{size:?} {cell:?}");
        }
    }
}
