//! The layer `viewshed`.

use super::layer::{Derived, Made, NodeLayer};
use crate::options::{OptionSpec, ValueKind};
use orogen_engine::solver::Viewshed;
use orogen_grid::error::{Error, ErrorKind};

/// Option for the position of the observer.
const OBSERVER: OptionSpec = OptionSpec::new("observer", "X,Y", ValueKind::Point)
    .with_about("Position of the observer of a viewshed: metres east and south of the world's north-west corner");

/// Option for the height of the eye.
const OBSERVER_HEIGHT: OptionSpec = OptionSpec::new("observer-height", "M", ValueKind::Number(0.0, 1e6))
    .with_about("Height of the observer's eye above the ground, in metres [default: 1.75]");

/// Option for the height of the target.
const TARGET_HEIGHT: OptionSpec = OptionSpec::new("target-height", "M", ValueKind::Number(0.0, 1e6))
    .with_about("Height of the target above the ground, in metres [default: 0]");

/// Option for the range of sight.
const RADIUS: OptionSpec = OptionSpec::new("radius", "M", ValueKind::Number(0.0, 1e9))
    .with_about("Maximum distance of a viewshed, in metres [default: the whole world]");

/// Option for the curvature of the earth and refraction.
const REFRACTION: OptionSpec = OptionSpec::new("refraction", "K", ValueKind::Number(0.0, 1.0)).with_about(
    "Take the earth's curvature into account, with this refraction coefficient, such as 0.13 [default: a flat \
             earth]",
);

/// The layer.
pub static LAYER: Derived = Derived {
    name: "viewshed",
    about: "viewshed: 1 where the observer (--observer) sees the ground, else 0",
    palette: "grey",
    options: || &[OBSERVER, OBSERVER_HEIGHT, TARGET_HEIGHT, RADIUS, REFRACTION],
    made: Made::Nodes(NodeLayer::new(|to| {
            let (options, defaults) = (to.options(), Viewshed::default());
            let number = |option: &OptionSpec, default: f64| options.number(option.name).unwrap_or(default);
            let size = to.recipe().world.size.unwrap_or_default();
            let Some(observer) = options.pair(OBSERVER.name) else {
                let message = format!(
                    "the layer viewshed needs --observer X,Y, in metres east and south of the world's north-west corner; the world is {} x {} m",
                    size[0], size[1]
                );
                return Err(Error::new(ErrorKind::Request, message));
            };
            if !(0..2).all(|axis| (0.0..=size[axis]).contains(&observer[axis])) {
                let message = format!(
                    "the observer at {},{} is outside the world, which is {} x {} m",
                    observer[0], observer[1], size[0], size[1]
                );
                return Err(Error::new(ErrorKind::Request, message));
            }
            let source = to.heights();
            let node = Viewshed {
                source,
                observer,
                observer_height: number(&OBSERVER_HEIGHT, defaults.observer_height),
                target_height: number(&TARGET_HEIGHT, defaults.target_height),
                radius: number(&RADIUS, defaults.radius),
                curvature: options.has(REFRACTION.name),
                refraction: number(&REFRACTION, defaults.refraction),
                ..defaults
            };
            Ok(to.add(node).layer("visible"))
        }).bounded()),
};
