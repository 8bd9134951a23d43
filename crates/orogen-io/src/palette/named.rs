//! Built-in palettes.
//!
//! Palettes from other sources are interpolated between a few of their colors in Oklab; no channel differs by more
//! than 3 of 255 from the 256 colors of the original. Sources: viridis, magma and inferno by S. van der Walt and N.
//! Smith (CC0); turbo by A. Mikhailov, Copyright 2019 Google LLC (Apache-2.0); batlow and oleron by F. Crameri,
//! "Scientific color maps", Copyright (c) 2023 Fabio Crameri (MIT); topo by K. Thyng and others, cmocean, Copyright
//! (c) 2015 Kristen M. Thyng (MIT). All others are this project's own.

use super::color::rgb;
use super::palette::{Palette, Position, Stop};

/// The scale of a palette's positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Span {
    /// 0 is the lowest value, 1 the highest.
    Range,
    /// -1 is the deepest sea, 0 the shore, 1 the highest land.
    Sea,
    /// Degrees, for layers of slope or aspect.
    Degrees,
}

/// A built-in palette with its name.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Named {
    /// The name.
    pub name: &'static str,
    /// Description and author.
    pub about: &'static str,
    /// The scale of the positions.
    pub span: Span,
    /// Whether color-blind readers can distinguish its heights: with full protanopia, deuteranopia or tritanopia
    /// (after G. Machado, M. Oliveira and L. Fernandes, 2009), any two of twelve heights differ by at least 0.04 in
    /// Oklab.
    pub safe: bool,
    stops: &'static [(f64, u32)],
}

/// The default palette of maps.
pub const DEFAULT: &str = "hypsometric";

const ALL: &[Named] = &[
    Named {
        name: "hypsometric",
        about: "green lowlands to brown, grey and white; sea darkens with depth; adapts to the relief",
        span: Span::Sea,
        safe: false,
        stops: &[
            (-1.0, 0x1f487a),
            (-0.64, 0x31679e),
            (-0.36, 0x4a8abc),
            (-0.1225, 0x71afd2),
            (-0.0144, 0xa0cedf),
            (0.0, 0xbedee5),
            (0.0, 0x659567),
            (0.1, 0x82aa6f),
            (0.22, 0xa8c07e),
            (0.34, 0xd1d199),
            (0.46, 0xd9c58c),
            (0.58, 0xc9a673),
            (0.7, 0xad8662),
            (0.82, 0x9a8173),
            (0.92, 0xc4bdb8),
            (1.0, 0xfafbfc),
        ],
    },
    Named {
        name: "terrain",
        about: "strong greens, yellow, brown and white over blue water",
        span: Span::Sea,
        safe: false,
        stops: &[
            (-1.0, 0x0b2e59),
            (-0.5, 0x1f5f9e),
            (-0.1, 0x5aa5d6),
            (0.0, 0x9fd3ea),
            (0.0, 0x2e7d3a),
            (0.2, 0x7fb24a),
            (0.4, 0xe3d77a),
            (0.6, 0xb08a4f),
            (0.8, 0x86644a),
            (1.0, 0xffffff),
        ],
    },
    Named {
        name: "swiss",
        about: "pale, for use with strong shading: cool lowlands, warm light heights",
        span: Span::Sea,
        safe: false,
        stops: &[
            (-1.0, 0x86aecb),
            (0.0, 0xd2e6ef),
            (0.0, 0xafc4b2),
            (0.25, 0xc8d8bb),
            (0.5, 0xe6e6c6),
            (0.75, 0xf5ecd4),
            (1.0, 0xfffdf8),
        ],
    },
    Named {
        name: "temperate",
        about: "aerial view: meadows and forest to rock and snow",
        span: Span::Sea,
        safe: false,
        stops: &[
            (-1.0, 0x050f26),
            (-0.3, 0x0c2a4f),
            (-0.05, 0x1c5478),
            (0.0, 0x3a7f8f),
            (0.0, 0xb7a77c),
            (0.02, 0x6d7f4a),
            (0.2, 0x47693a),
            (0.42, 0x355431),
            (0.56, 0x56603f),
            (0.66, 0x786c5c),
            (0.8, 0x928b82),
            (0.86, 0xd8dadc),
            (1.0, 0xffffff),
        ],
    },
    Named {
        name: "desert",
        about: "sand, ochre and red rock",
        span: Span::Sea,
        safe: false,
        stops: &[
            (-1.0, 0x0f3d5c),
            (0.0, 0x4fa3b5),
            (0.0, 0xecd6a4),
            (0.2, 0xdfb67c),
            (0.4, 0xcb9058),
            (0.6, 0xb06a41),
            (0.8, 0x8a4a35),
            (1.0, 0xe6cdb8),
        ],
    },
    Named {
        name: "arctic",
        about: "bare ground, ice and snow over dark water",
        span: Span::Sea,
        safe: false,
        stops: &[
            (-1.0, 0x0a1c33),
            (-0.3, 0x14395c),
            (0.0, 0x4f8aa8),
            (0.0, 0x67736b),
            (0.12, 0x8a958b),
            (0.28, 0xb3c1c8),
            (0.55, 0xd5e3ec),
            (0.8, 0xeef6fb),
            (1.0, 0xffffff),
        ],
    },
    Named {
        name: "volcanic",
        about: "black ash to glowing rock",
        span: Span::Sea,
        safe: false,
        stops: &[
            (-1.0, 0x0a1f33),
            (0.0, 0x2f6f86),
            (0.0, 0x1b1a1d),
            (0.25, 0x322b2c),
            (0.45, 0x553631),
            (0.62, 0x833b2a),
            (0.77, 0xb84d2a),
            (0.89, 0xe8862f),
            (1.0, 0xffe08a),
        ],
    },
    Named {
        name: "moon",
        about: "grey dust",
        span: Span::Range,
        safe: true,
        stops: &[(0.0, 0x232326), (0.35, 0x5a595a), (0.7, 0x9c9a96), (1.0, 0xe9e6df)],
    },
    Named {
        name: "mars",
        about: "rust and dust",
        span: Span::Range,
        safe: true,
        stops: &[(0.0, 0x33170f), (0.2, 0x672c1c), (0.45, 0xa9532f), (0.7, 0xcf8250), (0.9, 0xe6b98a), (1.0, 0xf8ecdd)],
    },
    Named {
        name: "parchment",
        about: "colors of an old map",
        span: Span::Sea,
        safe: false,
        stops: &[(-1.0, 0x9aa690), (0.0, 0xd5d5b6), (0.0, 0xf3e8c9), (0.4, 0xe3cf9f), (0.7, 0xc8a674), (1.0, 0x94704a)],
    },
    Named {
        name: "whittaker",
        about: "biomes by elevation, rain forest to ice, in discrete steps (after R. Whittaker)",
        span: Span::Sea,
        safe: false,
        stops: &[
            (-1.0, 0x1d4e79),
            (0.0, 0x7fb6d6),
            (0.0, 0x1f6f3a),
            (0.12, 0x1f6f3a),
            (0.12, 0x8fb33f),
            (0.25, 0x8fb33f),
            (0.25, 0x3f8f5f),
            (0.37, 0x3f8f5f),
            (0.37, 0x8dbf83),
            (0.5, 0x8dbf83),
            (0.5, 0xcdbf6a),
            (0.62, 0xcdbf6a),
            (0.62, 0xe6d3a0),
            (0.73, 0xe6d3a0),
            (0.73, 0x5b7f6c),
            (0.84, 0x5b7f6c),
            (0.84, 0xa9b7ae),
            (0.94, 0xa9b7ae),
            (0.94, 0xf7fafc),
            (1.0, 0xf7fafc),
        ],
    },
    Named {
        name: "slope",
        about: "slope in degrees: pale flats to dark cliffs",
        span: Span::Degrees,
        safe: false,
        stops: &[
            (0.0, 0xf7fbf4),
            (5.0, 0xc9e5b5),
            (15.0, 0xfbe58a),
            (25.0, 0xf6a64b),
            (35.0, 0xdd4b36),
            (45.0, 0x9c1d5a),
            (60.0, 0x4a1259),
            (90.0, 0x1a0726),
        ],
    },
    Named {
        name: "aspect",
        about: "directions: blue north, green east, yellow south, red west",
        span: Span::Degrees,
        safe: false,
        stops: &[(0.0, 0x4a7fd1), (90.0, 0x53b48a), (180.0, 0xe8c24a), (270.0, 0xc75a7a), (360.0, 0x4a7fd1)],
    },
    Named {
        name: "grey",
        about: "black to white",
        span: Span::Range,
        safe: true,
        stops: &[(0.0, 0x000000), (1.0, 0xffffff)],
    },
    Named {
        name: "viridis",
        about: "dark blue through green to yellow (S. van der Walt and N. Smith, CC0)",
        span: Span::Range,
        safe: true,
        stops: &[
            (0.0, 0x440154),
            (0.0902, 0x482173),
            (0.1882, 0x424086),
            (0.3176, 0x32648e),
            (0.4667, 0x23888e),
            (0.5451, 0x1e9b8a),
            (0.6, 0x22a884),
            (0.6275, 0x28ae80),
            (0.6941, 0x40bd72),
            (0.7686, 0x67cc5c),
            (0.8471, 0x98d83e),
            (0.9137, 0xc5e021),
            (0.949, 0xdde318),
            (1.0, 0xfde725),
        ],
    },
    Named {
        name: "magma",
        about: "black through purple to cream (S. van der Walt and N. Smith, CC0)",
        span: Span::Range,
        safe: true,
        stops: &[
            (0.0, 0x000004),
            (0.0784, 0x0e0b2b),
            (0.1529, 0x271258),
            (0.1882, 0x36106b),
            (0.2431, 0x4e117b),
            (0.3098, 0x681c81),
            (0.4157, 0x932b80),
            (0.5059, 0xb83779),
            (0.6118, 0xe24d66),
            (0.6745, 0xf2645c),
            (0.7412, 0xfb835f),
            (0.8353, 0xfeb078),
            (1.0, 0xfcfdbf),
        ],
    },
    Named {
        name: "inferno",
        about: "black through red to pale yellow (S. van der Walt and N. Smith, CC0)",
        span: Span::Range,
        safe: true,
        stops: &[
            (0.0, 0x000004),
            (0.0824, 0x110a30),
            (0.1569, 0x2f0a5b),
            (0.2275, 0x4d0d6c),
            (0.3137, 0x71196e),
            (0.3765, 0x8a226a),
            (0.4941, 0xb93556),
            (0.5804, 0xd74b3f),
            (0.6275, 0xe45a31),
            (0.6784, 0xef6e21),
            (0.7137, 0xf57d15),
            (0.7412, 0xf8890c),
            (0.7804, 0xfb9b06),
            (0.8, 0xfca50a),
            (0.8196, 0xfcae12),
            (0.851, 0xfbbe23),
            (0.8706, 0xf9c72f),
            (0.9137, 0xf4dd4f),
            (0.9529, 0xf1ef75),
            (1.0, 0xfcffa4),
        ],
    },
    Named {
        name: "turbo",
        about: "rainbow with even brightness steps (A. Mikhailov, Google, Apache-2.0)",
        span: Span::Range,
        safe: false,
        stops: &[
            (0.0, 0x30123b),
            (0.0392, 0x3b2f80),
            (0.0863, 0x4451bf),
            (0.1333, 0x4771e9),
            (0.1804, 0x448ffe),
            (0.2275, 0x33adf7),
            (0.2824, 0x1ccdd8),
            (0.3294, 0x19e3b9),
            (0.3686, 0x2cf09e),
            (0.4, 0x46f884),
            (0.4392, 0x6dfe62),
            (0.4745, 0x8fff49),
            (0.5059, 0xa7fc3a),
            (0.5569, 0xc8ef34),
            (0.6392, 0xf2c93a),
            (0.7098, 0xfe9e2f),
            (0.7882, 0xf36315),
            (0.8353, 0xe4450a),
            (0.9059, 0xc12302),
            (0.9451, 0xa71401),
            (1.0, 0x7a0403),
        ],
    },
    Named {
        name: "batlow",
        about: "dark blue through olive to pink (F. Crameri, MIT)",
        span: Span::Range,
        safe: true,
        stops: &[
            (0.0, 0x011959),
            (0.0235, 0x07225b),
            (0.0628, 0x0d315d),
            (0.2549, 0x236060),
            (0.3333, 0x3c6d56),
            (0.4078, 0x5a7745),
            (0.4824, 0x798035),
            (0.5373, 0x93872c),
            (0.5882, 0xad8c2d),
            (0.6549, 0xcd923f),
            (0.702, 0xe19752),
            (0.7686, 0xf6a077),
            (0.8235, 0xfdaa97),
            (1.0, 0xfaccfa),
        ],
    },
    Named {
        name: "oleron",
        about: "violet sea, green to cream land (F. Crameri, MIT)",
        span: Span::Sea,
        safe: true,
        stops: &[
            (-1.0, 0x1a2659),
            (-0.3465, 0xa6b3e5),
            (-0.252, 0xbac7f3),
            (0.0, 0xe6f2ff),
            (0.0, 0x1a4c00),
            (0.1417, 0x445900),
            (0.252, 0x63640a),
            (0.3465, 0x7e7423),
            (0.4488, 0x9b8640),
            (0.6929, 0xe0ba89),
            (0.7874, 0xf2d0a7),
            (1.0, 0xfdfde6),
        ],
    },
    Named {
        name: "topo",
        about: "dark sea to pale shore, dark green to cream land (cmocean, K. Thyng, MIT)",
        span: Span::Sea,
        safe: false,
        stops: &[
            (-1.0, 0x281a2c),
            (-0.8583, 0x3d3562),
            (-0.748, 0x404d8c),
            (-0.6378, 0x3e6b96),
            (-0.3543, 0x58b3a4),
            (-0.2913, 0x67c3a4),
            (-0.252, 0x76cda3),
            (-0.1339, 0xb5e4aa),
            (0.0, 0xfbfdcb),
            (0.0, 0x0d2514),
            (0.1732, 0x214c1e),
            (0.2205, 0x305520),
            (0.3701, 0x646c3a),
            (0.6299, 0xbf953f),
            (0.7087, 0xcca961),
            (0.8976, 0xe6dfb6),
            (1.0, 0xf9fde4),
        ],
    },
    Named {
        name: "bands",
        about: "blue, yellow, green, brown and white in discrete steps at .3, .4, .7 and .9",
        span: Span::Range,
        safe: false,
        stops: &[
            (0.0, 0x2f6fb5),
            (0.3, 0x2f6fb5),
            (0.3, 0xe8d57a),
            (0.4, 0xe8d57a),
            (0.4, 0x4f9a45),
            (0.7, 0x4f9a45),
            (0.7, 0x8a6239),
            (0.9, 0x8a6239),
            (0.9, 0xffffff),
            (1.0, 0xffffff),
        ],
    },
    Named {
        name: "planet",
        about: "deep blue through gold and grey-brown to white",
        span: Span::Range,
        safe: false,
        stops: &[
            (0.0, 0x081d58),
            (0.05, 0x0f3b82),
            (0.1, 0x2c6fb0),
            (0.15, 0xe3c265),
            (0.45, 0xc79a3c),
            (0.55, 0xa98346),
            (0.625, 0x8a7355),
            (0.8, 0x7d746a),
            (0.85, 0x9b9b9b),
            (1.0, 0xffffff),
        ],
    },
    Named {
        name: "meadow",
        about: "light blue, green, yellow, orange",
        span: Span::Range,
        safe: false,
        stops: &[(0.0, 0x9fd4ee), (0.3333, 0x6aa84f), (0.6667, 0xf4e06a), (1.0, 0xe8912d)],
    },
];

/// All built-in palettes.
#[must_use]
pub fn all() -> &'static [Named] {
    ALL
}

/// The palette with this name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Named> {
    ALL.iter().find(|named| named.name == name)
}

impl Named {
    /// Converts it to a palette.
    #[must_use]
    pub fn palette(&self) -> Palette {
        let place = match self.span {
            Span::Range => Position::Share,
            Span::Sea => Position::Sea,
            Span::Degrees => Position::Value,
        };
        let stops = self.stops.iter().map(|&(at, color)| Stop { at: place(at), color: rgb(color) }).collect();
        let mut palette = Palette::new(self.name, stops);
        palette.follows_relief = self.name == DEFAULT;
        palette
    }

    /// The ends of the scale of the positions.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        [self.stops.first(), self.stops.last()].map(|stop| stop.map_or(0.0, |stop| stop.0))
    }
}

#[cfg(test)]
mod tests {
    use super::super::color::{Light, oklab};
    use super::super::fitted::Fitted;
    use super::*;

    #[test]
    fn names_are_single_and_stops_in_order() {
        for (k, named) in ALL.iter().enumerate() {
            assert!(ALL[..k].iter().all(|other| other.name != named.name));
            assert!(named.stops.is_sorted_by(|a, b| a.0 <= b.0), "{}", named.name);
            let ends = match named.span {
                Span::Range => [0.0, 1.0],
                Span::Sea => [-1.0, 1.0],
                Span::Degrees => [0.0, named.ends()[1]],
            };
            assert_eq!(named.ends(), ends, "{}", named.name);
            // A step separates sea and land.
            let shores = named.stops.iter().filter(|stop| stop.0 == 0.0).count();
            assert_eq!(shores, if named.span == Span::Sea { 2 } else { 1 }, "{}", named.name);
        }
    }

    #[test]
    fn the_textbooks_ramps_have_their_stops() {
        let steps = |name: &str| find(name).unwrap().stops.iter().map(|stop| stop.0).collect::<Vec<f64>>();
        assert_eq!(steps("bands"), [0.0, 0.3, 0.3, 0.4, 0.4, 0.7, 0.7, 0.9, 0.9, 1.0]);
        // Designed for noise from -1 to 1.
        let planet: Vec<f64> = steps("planet").iter().map(|at| ((2.0 * at - 1.0) * 1000.0).round() / 1000.0).collect();
        assert_eq!(planet, [-1.0, -0.9, -0.8, -0.7, -0.1, 0.1, 0.25, 0.6, 0.7, 1.0]);
        assert_eq!(steps("meadow").len(), 4);
    }

    /// Full protanopia, deuteranopia and tritanopia, on linear light.
    const BLIND: [[[f32; 3]; 3]; 3] = [
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
    ];

    fn least_difference(named: &Named) -> f32 {
        let fitted =
            Fitted::new(&named.palette(), -1000.0, 1000.0, if named.span == Span::Sea { 0.0 } else { -1000.0 });
        let heights: Vec<f32> = match named.span {
            Span::Sea => {
                (0..6).map(|k| -1000.0 + 200.0 * k as f32).chain((0..9).map(|k| 0.001 + 124.9 * k as f32)).collect()
            }
            _ => (0..12).map(|k| -1000.0 + 2000.0 * k as f32 / 11.0).collect(),
        };
        let seen = |how: &[[f32; 3]; 3], [r, g, b]: Light| {
            oklab(how.map(|row| (row[0] * r + row[1] * g + row[2] * b).max(0.0)))
        };
        let mut least = f32::MAX;
        for how in &BLIND {
            let colors: Vec<[f32; 3]> = heights.iter().map(|height| seen(how, fitted.at(*height))).collect();
            for (k, a) in colors.iter().enumerate() {
                for b in &colors[k + 1..] {
                    let apart: f32 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
                    least = least.min(apart.sqrt());
                }
            }
        }
        least
    }

    #[test]
    fn those_marked_safe_are_and_no_others() {
        for named in ALL.iter().filter(|named| named.span != Span::Degrees) {
            let least = least_difference(named);
            assert_eq!(named.safe, least >= 0.04, "{}: {least}", named.name);
        }
    }
}
