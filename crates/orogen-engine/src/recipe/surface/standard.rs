//! The standard surfaces, for a recipe without any: grass, sand, scree, rock, snow and river beds by slope, height,
//! curvature and flow.
//!
//! | surface | where | fades over |
//! |---|---|---|
//! | grass | everywhere that no other surface covers | |
//! | sand | the floor of the sea | 2 m above it |
//! | scree | 30 to 40 degrees, fully in hollows, by half on convex ground | 6 degrees below, 4 above; curvature of 0.01 1/m |
//! | rock | above 40 degrees, and on convex edges (curvature above 0.02 1/m) from 25 degrees | 8 degrees; 0.01 1/m |
//! | snow | above 2600 m, except on slopes steeper than 45 degrees | 400 m below; 10 degrees |
//! | sand | up to 3 m above the sea, except on slopes steeper than 15 degrees | 5 m; 10 degrees |
//! | bed | drainage area above 1 km^2, on land, except on slopes steeper than 35 degrees | down to 0.2 km^2; 2 m; 10 degrees |

use super::document::{Along, Coloring, Condition, Quantity, Surface};
use orogen_io::palette::color::rgb;

/// The snow line in metres above the sea, about as in the Alps.
const SNOW_LINE: f64 = 2600.0;

/// Distance of the heights for curvature, in metres.
const SCALE: f64 = 50.0;

/// The surfaces, bottom to top.
pub fn surfaces() -> Vec<Surface> {
    let below = |of, max: f64, fade: f64| Condition::new(of, None, Some(max), [0.0, fade]);
    let above = |of, min: f64, fade: f64| Condition::new(of, Some(min), None, [fade, 0.0]);
    let curvature = || Quantity::Curvature { scale: SCALE };
    let surface = |name: &str, colors: &[u32], grain: f64, roughness: f64| Surface {
        name: name.to_string(),
        color: Coloring::Gradient(colors.iter().map(|hex| rgb(*hex)).collect(), Along::Noise(grain)),
        roughness,
        ..Surface::default()
    };
    let talus = Condition::new(Quantity::Slope, Some(30.0), Some(40.0), [6.0, 4.0]);
    vec![
        Surface {
            color: Coloring::Gradient(
                [0x4c_5c2e, 0x62_6c39, 0x7f_7a4f, 0x8f_8668].map(rgb).to_vec(),
                Along::Height([0.0, 2400.0]),
            ),
            ..surface("grass", &[], 0.0, 0.95)
        },
        Surface {
            all: vec![below(Quantity::Height, 0.0, 2.0)],
            ..surface("sand", &[0xa8_9c7c, 0xbd_b191], 600.0, 0.9)
        },
        Surface { all: vec![talus.clone()], opacity: 0.5, ..surface("scree", &[0x8a_8378, 0x9c_9487], 250.0, 0.95) },
        Surface {
            all: vec![talus, below(curvature(), 0.0, 0.01)],
            ..surface("scree", &[0x8a_8378, 0x9c_9487], 250.0, 0.95)
        },
        Surface {
            any: vec![
                vec![above(Quantity::Slope, 40.0, 8.0)],
                vec![above(curvature(), 0.02, 0.01), above(Quantity::Slope, 25.0, 8.0)],
            ],
            ..surface("rock", &[0x5a_554f, 0x6d_675f, 0x80_796e], 400.0, 0.8)
        },
        Surface {
            all: vec![above(Quantity::Height, SNOW_LINE, 400.0), below(Quantity::Slope, 45.0, 10.0)],
            ..surface("snow", &[0xe4_eaf0, 0xf2_f5f8], 500.0, 0.6)
        },
        Surface {
            all: vec![below(Quantity::Height, 3.0, 5.0), below(Quantity::Slope, 15.0, 10.0)],
            ..surface("sand", &[0xc2_b48c, 0xd3_c7a2], 300.0, 0.9)
        },
        Surface {
            all: vec![
                above(Quantity::Flow, 1e6, 0.7),
                below(Quantity::Slope, 35.0, 10.0),
                above(Quantity::Height, 0.0, 2.0),
            ],
            ..surface("bed", &[0x8d_8675, 0xa3_9c8b], 150.0, 0.85)
        },
    ]
}
