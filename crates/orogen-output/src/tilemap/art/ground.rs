//! The grounds: the appearance of a terrain away from its borders, and of its borders.

use orogen_grid::random::Random;

use super::edge::{Border, BorderPoint};

type Ink = [u8; 3];

const fn ink(hex: u32) -> Ink {
    [(hex >> 16) as u8, (hex >> 8) as u8, hex as u8]
}

/// A mark on a ground: pixels as (column, row, ink) from its upper left corner, in pixels of the tile.
type Mark = &'static [(i8, i8, u8)];

/// The appearance of a terrain.
#[derive(Debug, Clone, Copy)]
pub struct Ground {
    /// The name of the terrain's class.
    pub name: &'static str,
    /// The inks: the ground itself, then the inks of its marks.
    inks: [Ink; 4],
    /// The marks, each with the number that are drawn on a plain tile of 16 x 16 pixels.
    marks: &'static [(Mark, u8)],
    /// Marks that are only in some tiles.
    rare: &'static [Mark],
    /// Whether the ground is a roof of trees.
    is_forest: bool,
    /// The line along the border.
    outline: Ink,
    /// The line next to the outline where the border faces the light, in the north.
    rim: Ink,
    /// A wall where the border faces south: its inks, and its height in pixels of a tile of 16.
    wall: Option<([Ink; 2], f64)>,
    /// Bands outside of the border, on the ground below, from the border outward: the ink and the outer edge of each,
    /// in pixels of a tile of 16.
    halo: &'static [(Ink, f64)],
    /// Its border.
    pub border: Border,
}

const WAVE: Mark = &[(0, 1, 1), (1, 0, 1), (2, 0, 1), (3, 1, 1), (4, 1, 1)];
const RIPPLE: Mark = &[(0, 0, 2), (1, 0, 2), (2, 0, 2)];
const GLINT: Mark = &[(0, 0, 3), (1, 0, 3)];
const DOT: Mark = &[(0, 0, 1)];
const SPECK: Mark = &[(0, 0, 2)];
const DUNE: Mark = &[(0, 1, 1), (1, 0, 1), (2, 0, 1), (3, 1, 1), (1, 1, 2), (2, 1, 2)];
const SHELL: Mark = &[(0, 0, 3), (1, 0, 3), (0, 1, 1)];
const TUFT: Mark = &[(0, 0, 1), (2, 0, 1), (1, 1, 1), (0, 1, 1)];
const BLADES: Mark = &[(0, 0, 2), (2, 0, 2), (1, 1, 2)];
const FLOWER: Mark = &[(1, 0, 3), (0, 1, 3), (2, 1, 3), (1, 2, 3), (1, 1, 2)];
const CRACK: Mark = &[(0, 0, 1), (1, 1, 1), (2, 1, 1), (3, 2, 1), (2, 0, 2), (3, 1, 2), (4, 2, 2)];
const LEDGE: Mark = &[
    (0, 1, 2),
    (1, 0, 3),
    (2, 0, 3),
    (3, 0, 2),
    (4, 1, 2),
    (5, 1, 2),
    (0, 2, 1),
    (1, 1, 1),
    (2, 1, 1),
    (3, 1, 1),
    (4, 2, 1),
    (5, 2, 1),
    (2, 2, 1),
];
const STONE: Mark = &[(0, 1, 2), (1, 0, 2), (2, 0, 2), (3, 1, 1), (1, 1, 3), (2, 1, 1), (1, 2, 1), (2, 2, 1)];
const DRIFT: Mark = &[(0, 0, 1), (1, 1, 1), (2, 1, 1), (3, 1, 1), (4, 0, 1)];
const SPARKLE: Mark = &[(0, 0, 2)];
const MOUND: Mark = &[(0, 1, 1), (1, 2, 1), (2, 2, 1), (3, 2, 1), (4, 1, 1), (2, 1, 3)];

const STILL: [f64; 8] = [0.0; 8];

/// The grounds, bottom to top.
pub const GROUNDS: [Ground; 6] = [
    Ground {
        name: "water",
        inks: [ink(0x3f_86bf), ink(0x62_a3d3), ink(0x38_79b0), ink(0x8c_c3e6)],
        marks: &[(WAVE, 2), (RIPPLE, 3)],
        rare: &[GLINT, WAVE],
        is_forest: false,
        outline: ink(0x38_79b0),
        rim: ink(0x62_a3d3),
        wall: None,
        halo: &[],
        border: Border { inset: 0.0, wave: STILL },
    },
    Ground {
        name: "sand",
        inks: [ink(0xea_d9a8), ink(0xd9_c48c), ink(0xf5_eac6), ink(0xff_f8e6)],
        marks: &[(DOT, 7), (SPECK, 5)],
        rare: &[DUNE, SHELL],
        is_forest: false,
        outline: ink(0xcf_b67c),
        rim: ink(0xf5_eac6),
        wall: None,
        halo: &[(ink(0xe4_f4f8), 1.0), (ink(0x8c_c8e4), 2.0), (ink(0x5b_a0d2), 4.0)],
        border: Border { inset: 3.5, wave: [0.0, 1.0, 1.0, 0.0, 0.0, -1.0, -1.0, 0.0] },
    },
    Ground {
        name: "grass",
        inks: [ink(0x7d_b955), ink(0x68_a346), ink(0x95_cb6c), ink(0xf6_efb4)],
        marks: &[(TUFT, 2), (BLADES, 2), (DOT, 3)],
        rare: &[FLOWER, TUFT],
        is_forest: false,
        outline: ink(0x55_8c3c),
        rim: ink(0x95_cb6c),
        wall: None,
        halo: &[],
        border: Border { inset: 3.0, wave: [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0] },
    },
    Ground {
        name: "forest",
        inks: [ink(0x2f_6e3f), ink(0x25_5833), ink(0x42_864a), ink(0x5f_a157)],
        marks: &[],
        rare: &[],
        is_forest: true,
        outline: ink(0x1f_4a2d),
        rim: ink(0x5f_a157),
        wall: Some(([ink(0x25_5833), ink(0x1b_4128)], 2.5)),
        halo: &[(ink(0x5f_9a45), 1.0)],
        border: Border { inset: 3.0, wave: [0.0, 1.0, 0.0, -1.0, -1.0, 0.0, 1.0, 0.0] },
    },
    Ground {
        name: "rock",
        inks: [ink(0x98_9088), ink(0x7a_726b), ink(0xb3_aca3), ink(0xc8_c2ba)],
        marks: &[(LEDGE, 2), (CRACK, 1), (DOT, 2), (SPECK, 2)],
        rare: &[STONE, STONE, LEDGE],
        is_forest: false,
        outline: ink(0x5c_554f),
        rim: ink(0xc4_beb6),
        wall: Some(([ink(0x7a_726b), ink(0x69_615b)], 4.0)),
        halo: &[],
        border: Border { inset: 3.0, wave: [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, -1.0, 0.0] },
    },
    Ground {
        name: "snow",
        inks: [ink(0xf1_f5f9), ink(0xdb_e6f0), ink(0xff_ffff), ink(0xff_ffff)],
        marks: &[(DRIFT, 1), (SPARKLE, 4)],
        rare: &[MOUND, DRIFT],
        is_forest: false,
        outline: ink(0xa9_bfd3),
        rim: ink(0xff_ffff),
        wall: Some(([ink(0xd0_deea), ink(0xc2_d3e2)], 2.0)),
        halo: &[],
        border: Border { inset: 3.5, wave: [0.0, 1.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0] },
    },
];

/// Weights of the variants of a full tile: the plain one, two with the same marks at other positions, and one with a
/// rare mark.
pub const VARIANTS: [f32; 4] = [6.0, 3.0, 3.0, 1.0];

/// Variation of the four trees of a tile: shift to the right, shift down and increase in size, relative to the distance
/// between trees.
const TREES: [[f64; 3]; 4] = [[0.06, 0.0, 0.04], [-0.1, 0.08, -0.06], [-0.08, -0.07, -0.03], [0.1, 0.03, 0.05]];

/// A ground drawn on a square tile.
#[derive(Debug, Clone)]
pub struct Texture {
    side: usize,
    pixels: Vec<Ink>,
}

impl Texture {
    /// Draws the texture of a ground for a variant.
    #[must_use]
    pub fn new(ground: &Ground, side: usize, variant: usize) -> Texture {
        let mut texture = Texture { side, pixels: vec![ground.inks[0]; side * side] };
        if ground.is_forest {
            texture.roof(ground, variant);
            return texture;
        }
        // Marks stay within the tile and apart from each other, so that variants join without a seam.
        let mut random =
            Random::new(variant as u64 + 1, ground.name.len() as u64 + u64::from(ground.name.as_bytes()[0]));
        let mut taken: Vec<[i64; 4]> = Vec::new();
        // The number of marks grows with the side of the tile, not with its area, so larger tiles look calmer.
        let more = (side / 16).max(1);
        let rare = if variant + 1 == VARIANTS.len() { ground.rare } else { Default::default() };
        let common =
            ground.marks.iter().flat_map(|(mark, count)| std::iter::repeat_n(*mark, usize::from(*count) * more));
        for mark in rare.iter().copied().chain(common) {
            let width = mark.iter().map(|(x, ..)| *x).max().unwrap_or_default() as i64 + 1;
            let height = mark.iter().map(|(_, y, _)| *y).max().unwrap_or_default() as i64 + 1;
            for _ in 0..40 {
                let at =
                    |length: i64, random: &mut Random| random.below((side as i64 - length - 1) as usize) as i64 + 1;
                let (x, y) = (at(width, &mut random), at(height, &mut random));
                let own = [x - 1, y - 1, x + width + 1, y + height + 1];
                let meets =
                    |other: &[i64; 4]| own[0] < other[2] && other[0] < own[2] && own[1] < other[3] && other[1] < own[3];
                if taken.iter().any(meets) {
                    continue;
                }
                taken.push([x, y, x + width, y + height]);
                for (dx, dy, ink) in mark {
                    let place = (y + i64::from(*dy)) as usize * side + (x + i64::from(*dx)) as usize;
                    texture.pixels[place] = ground.inks[usize::from(*ink)];
                }
                break;
            }
        }
        texture
    }

    /// Draws round tree tops in staggered rows, which continue across the tile's sides. Variants differ in which trees
    /// are light.
    fn roof(&mut self, ground: &Ground, variant: usize) {
        let step = self.side as f64 / 2.0;
        // From back to front, so that each row covers the row behind it.
        for row in -1..=3_i64 {
            for column in -2..=2_i64 {
                let tree = (row.rem_euclid(2) + 2 * column.rem_euclid(2)) as usize;
                let shift = if row.rem_euclid(2) == 0 { 0.0 } else { 0.5 };
                let [right, down, larger] = TREES[tree];
                let center = [(column as f64 + 0.5 + shift + right) * step, (row as f64 + 0.45 + down) * step];
                self.tree(ground, center, (0.58 + larger) * step, (tree + variant) % 3);
            }
        }
    }

    /// Draws a tree top; trees of kind 0 are lighter than the others.
    fn tree(&mut self, ground: &Ground, [cx, cy]: [f64; 2], radius: f64, kind: usize) {
        let lighter = if kind == 0 { 0.15 } else { -0.1 };
        for y in 0..self.side {
            for x in 0..self.side {
                let (dx, dy) = (x as f64 + 0.5 - cx, y as f64 + 0.5 - cy);
                let far = libm::hypot(dx, dy);
                if far > radius {
                    continue;
                }
                // The light comes from the north-west. Leaves break the border between two inks.
                let leaf = if (x + 2 * y) % 5 < 2 { 0.12 } else { 0.0 };
                let lit = (-0.6 * dx - 1.3 * dy) / radius + lighter + leaf;
                let ink = match lit {
                    _ if far > radius - 1.0 && lit < 0.5 => 1,
                    0.85.. => 3,
                    0.2.. => 2,
                    -0.55.. => 0,
                    _ => 1,
                };
                self.pixels[y * self.side + x] = ground.inks[ink];
            }
        }
    }

    /// The ink of a pixel.
    #[must_use]
    pub fn at(&self, x: usize, y: usize) -> Ink {
        self.pixels[y * self.side + x]
    }
}

impl Ground {
    /// The representative color of the ground.
    #[must_use]
    pub fn color(&self) -> Ink {
        self.inks[0]
    }

    /// The ink of a pixel at a position; `None` outside, where the ground below is visible. `column` is the pixel's
    /// column.
    #[must_use]
    pub fn ink(&self, place: BorderPoint, texture: Ink, column: usize) -> Option<Ink> {
        let BorderPoint { inside, south } = place;
        if inside < 0.0 {
            return self.halo.iter().find(|(_, end)| inside >= -end).map(|(ink, _)| *ink);
        }
        if inside < 1.0 {
            return Some(self.outline);
        }
        if let Some((inks, height)) = self.wall
            && south > 0.5
            && inside < height + 1.0
        {
            return Some(inks[usize::from(column % 4 == 1)]);
        }
        if inside < 2.0 && south < -0.3 {
            return Some(self.rim);
        }
        Some(texture)
    }
}
