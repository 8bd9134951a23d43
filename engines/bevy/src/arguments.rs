//! Arguments of the command line.

use std::path::PathBuf;

/// What is shown.
pub struct Arguments {
    /// A preset, a recipe or a file of heights.
    pub world: String,
    /// Metres east and south of the world's origin where the ball starts.
    pub at: [f64; 2],
    /// Distance between the finest samples, in metres.
    pub cell: f64,
    /// Frames that are made without a window, at 60 per second; 0 opens a window.
    pub frames: u32,
    /// The picture of the last frame.
    pub screenshot: Option<PathBuf>,
}

/// Text for `--help`.
pub const HELP: &str = "\
orogen-bevy [WORLD] [--at X,Y] [--cell METRES] [--frames N] [--screenshot FILE.png]

A ball rolls on the land. WORLD is a preset (default: hills), a recipe or a file of heights.
W, A, S and D push the ball; Space lifts it.

--at X,Y      metres east and south of the origin where the ball starts [default: 2545,11914]
--cell M      distance between the finest samples, in metres [default: 2]
--frames N    make N frames of a sixtieth of a second without a window, push the ball to the north-east,
              print where it is and what rays hit, and end
--screenshot  write a picture of the last frame
";

impl Arguments {
    /// The arguments of this process.
    pub fn of_process() -> Result<Arguments, String> {
        Arguments::parse(std::env::args().skip(1))
    }

    fn parse(given: impl IntoIterator<Item = String>) -> Result<Arguments, String> {
        let mut arguments =
            Arguments { world: "hills".into(), at: [2545.0, 11914.0], cell: 2.0, frames: 0, screenshot: None };
        let mut given = given.into_iter();
        while let Some(argument) = given.next() {
            let mut value = || given.next().ok_or_else(|| format!("{argument} needs a value"));
            match argument.as_str() {
                "--help" | "-h" => return Err(HELP.into()),
                "--at" => arguments.at = point(&value()?)?,
                "--cell" => arguments.cell = number(&value()?)?,
                "--frames" => arguments.frames = number(&value()?)?,
                "--screenshot" => arguments.screenshot = Some(value()?.into()),
                option if option.starts_with('-') => return Err(format!("there is no option {option}; see --help")),
                _ => arguments.world = argument,
            }
        }
        Ok(arguments)
    }
}

fn number<T: std::str::FromStr>(text: &str) -> Result<T, String> {
    text.trim().parse().map_err(|_| format!("{text} is not a valid number"))
}

fn point(text: &str) -> Result<[f64; 2], String> {
    let (x, y) = text.split_once(',').ok_or_else(|| format!("{text} is not a position; give it as X,Y"))?;
    Ok([number(x)?, number(y)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_read_and_faults_explained() {
        let parse = |line: &str| Arguments::parse(line.split_whitespace().map(str::to_string));
        let read = parse("hills --at 10,-20.5 --frames 3 --screenshot a.png").unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((read.world.as_str(), read.at, read.frames), ("hills", [10.0, -20.5], 3));
        assert_eq!(read.screenshot, Some(PathBuf::from("a.png")));
        for (line, message) in [("--at 3", "X,Y"), ("--frames", "needs a value"), ("--size 3", "no option --size")] {
            assert!(parse(line).err().is_some_and(|error| error.contains(message)), "{line}");
        }
    }
}
