//! The layer `hillshade`.

use super::layer::{Derived, LoweredRows, Made, Nature, RowLayer, none, nothing};
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::lower::{HORN, Passes};
use orogen_grid::analysis::hillshade::{Light, hillshade};
use std::sync::LazyLock;

/// Option for the direction of the light.
const AZIMUTH: OptionSpec = OptionSpec::new(
    "azimuth",
    "DEG",
    ValueKind::Number(-360.0, 360.0),
    "Direction that the light of a hillshade comes from, in degrees clockwise from north [default: 315]",
);

/// Option for the height of the light.
const ALTITUDE: OptionSpec = OptionSpec::new(
    "altitude",
    "DEG",
    ValueKind::Number(0.0, 90.0),
    "Height of the light of a hillshade above the horizon, in degrees; 90 is straight above [default: 45]",
);

/// Option for vertical exaggeration.
const Z_FACTOR: OptionSpec = OptionSpec::new(
    "z-factor",
    "K",
    ValueKind::Number(0.0, 1e6),
    "Factor of the heights before a hillshade is computed [default: 1]",
);

/// The light of the options.
fn light(options: &Options) -> Light {
    let number = |option: &OptionSpec, default: f64| options.number(option.name).unwrap_or(default);
    Light::new(number(&AZIMUTH, 315.0), number(&ALTITUDE, 45.0), number(&Z_FACTOR, 1.0))
}

/// The layer.
pub static LAYER: Derived = Derived {
    name: "hillshade",
    about: "hillshade: light from the north-west at 45 degrees altitude (--azimuth, --altitude), slope by Horn's method; 1 is full light, 0 none",
    palette: "grey",
    options: &[AZIMUTH, ALTITUDE, Z_FACTOR],
    made: Made::Rows(RowLayer {
        unit: "",
        nature: Nature::Numbers,
        channels: |_| vec!["hillshade".into()],
        prepare: nothing,
        layers: none,
        reach: |_| 1,
        make: |around, window| vec![hillshade(&around.bordered(window), &light(around.options))],
        lowered: Some(LoweredRows { passes, heights: |around, window| around.bordered(window) }),
    }),
};

/// The passes of a graphics card.
fn passes(cell: f64, options: &Options) -> Passes {
    static CODE: LazyLock<String> = LazyLock::new(|| format!("{HORN}{}", include_str!("hillshade.wgsl")));
    let [east, north, up, z_factor] = light(options).numbers();
    Passes::new(&CODE, &[(1.0 / (8.0 * cell)) as f32, east, north, up, z_factor]).then("hillshade", 0, [1; 2])
}
