//! A scene as named numbers and grids, for renderers on other devices.
//!
//! Everything that such a renderer shares with this one is defined only here, so that the two stay consistent:
//! constants, the numbers of the scene and of the camera, and the grids of the land. Names and lengths of constants and
//! numbers do not depend on the scene.
//!
//! Positions are relative to an origin near the camera, so that single precision suffices: the rounding error of a
//! position is proportional to its distance from the camera, like the width of a pixel.

use std::borrow::Cow;

use super::albedo::{
    BEDS, CLAY, DESERT_WAVES, FARMLAND, GRAVEL, LUSH, NATURAL_WAVES, OCTAVES, ROCK, SAND, SCREE, SCRUB, SHORE, SNOW,
    TREES, TUNDRA, Tones,
};
use super::camera::{Camera, folded};
use super::grain::{self, GrainMap};
use super::ground::{Colors, PAPER, no_height};
use super::lighting::Lighting;
use super::relief::DRY;
use super::scene::{Around, MIRRORS, Scene, spot};
use super::shade::{LEVEL, MEAN_ALBEDO, ROUGH_WATER, TABLE};
use super::sky::{self, Haze, SUN_RADIUS};
use super::tone::{CURVE, INPUT, OUTPUT};
use super::vector::Vector;
use super::water::{BENDS, BOTTOM, DARK, DEEP, LAKE_BOTTOM, LAKE_DEEP, LAKE_TAKES, SHALLOW, STRETCH, WAVES, Water};

/// A scene and a camera as numbers and grids.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct SceneData<'a> {
    /// Constants of the renderer: one number each, or three for a color.
    pub constants: Vec<(&'static str, Vec<f32>)>,
    /// Integer constants of the renderer.
    pub counts: Vec<(&'static str, u32)>,
    /// Numbers of the scene.
    pub numbers: Vec<(&'static str, Vec<f32>)>,
    /// Integers of the scene.
    pub integers: Vec<(&'static str, Vec<i32>)>,
    /// Grids of the scene, each as a sequence of parts to concatenate.
    pub grids: Vec<(&'static str, Vec<Cow<'a, [f32]>>)>,
}

/// Maximum number of levels of the pyramid.
const LEVELS: usize = 32;

/// Entries of each of the two ramps of the map's colors: up to the sea level, and above it.
const RAMP: usize = 4096;

/// Replaces infinity: a device may compute as if there were no infinite numbers.
const FAR: f64 = 1e30;

/// The origin of positions: a whole column and row, and a z.
#[derive(Debug, Clone, Copy)]
struct Origin {
    cell: [i32; 2],
    z: f64,
}

impl Origin {
    fn level(&self, z: f64) -> f32 {
        (z - self.z) as f32
    }
}

impl Scene {
    /// The scene as seen by a camera in a picture of this size, in numbers and grids.
    #[must_use]
    pub fn encode(&self, camera: &Camera, size: [usize; 2]) -> SceneData<'_> {
        let mut data = SceneData::default();
        data.constants();
        let origin = self.encode_camera(camera, size, &mut data);
        self.encode_land(&origin, &mut data);
        self.encode_light(&mut data);
        self.encode_ground(&origin, &mut data);
        data
    }

    fn encode_camera(&self, camera: &Camera, size: [usize; 2], data: &mut SceneData) -> Origin {
        let reach = self.relief.reach();
        let mut eye = camera.eye();
        let mut flip = [1.0; 2];
        if self.around == Around::Mirrors {
            (eye.x, flip[0]) = folded(eye.x, reach[0]);
            (eye.y, flip[1]) = folded(eye.y, reach[1]);
        }
        let cell = [0, 1].map(|axis| [eye.x, eye.y][axis].clamp(0.0, reach[axis]) as i32);
        // Rounded, so that heights near it are exact after it is subtracted.
        let z = f64::from(eye.z.clamp(0.0, self.relief.highest().max(0.0)) as f32);
        let origin = Origin { cell, z };
        let triple = |v: Vector| [v.x as f32, v.y as f32, v.z as f32];
        let place = Vector::new(eye.x - f64::from(cell[0]), eye.y - f64::from(cell[1]), eye.z - z);
        data.integer("ORIGIN", &cell);
        data.number("ORIGIN_Z", &[z as f32]);
        data.number("EYE", &triple(place));
        data.number("AHEAD", &triple(camera.ahead));
        data.number("RIGHT", &triple(camera.right));
        data.number("DOWN", &triple(camera.down));
        data.number("WIDE", &camera.wide.map(|side| side as f32));
        data.number("FLIP", &flip.map(|side| side as f32));
        data.number("PIXEL", &[camera.pixel(size[0]) as f32]);
        data.integer("SIZE", &size.map(|side| side as i32));
        data.integer("SAMPLES", &[self.samples as i32]);
        data.grid("SPOTS", [(0..self.samples).flat_map(|k| spot(k).map(|at| at as f32)).collect::<Vec<f32>>().into()]);
        origin
    }

    fn encode_land<'a>(&'a self, origin: &Origin, data: &mut SceneData<'a>) {
        let relief = &self.relief;
        data.integer("LAND", &relief.samples().map(|side| side as i32));
        data.number("CELL", &[relief.cell() as f32]);
        data.number("EXAGGERATION", &[relief.exaggeration() as f32]);
        data.number("ORIGIN_HEIGHT", &[relief.height_of(origin.z) as f32]);
        data.number("HIGHEST", &[origin.level(relief.highest())]);
        data.number("FLOOR", &[origin.level(self.floor), self.floor as f32]);
        let (kind, level) = match self.around {
            Around::Table(z) => (AROUND_TABLE, origin.level(z)),
            Around::Sea(z) => (AROUND_SEA, origin.level(z)),
            Around::Mirrors => (AROUND_MIRRORS, 0.0),
        };
        data.integer("AROUND", &[kind as i32]);
        data.number("AROUND_Z", &[level]);
        data.integer("HAS_SEA", &[i32::from(relief.sea().is_some())]);
        data.number("SEA", &[relief.sea().map_or(0.0, |sea| origin.level(sea))]);
        data.grid("BED", [relief.bed().into()]);
        data.integer("HAS_WATER", &[i32::from(!relief.water().is_empty())]);
        data.grid("WATER", [relief.water().into()]);
        // For each level of the pyramid, the index of its first node and its number of columns.
        let mut levels = vec![0; 2 * LEVELS];
        let mut start = 0;
        for (level, tops) in levels.chunks_exact_mut(2).zip(relief.tops()) {
            level.copy_from_slice(&[start, tops.columns as i32]);
            start += tops.highest.len() as i32;
        }
        data.integer("LEVELS", &levels);
        data.integer("TOP_LEVEL", &[relief.tops().len() as i32 - 1]);
        data.grid("TOPS", relief.tops().iter().map(|tops| tops.highest.as_slice().into()));
    }

    fn encode_light<'a>(&'a self, data: &mut SceneData<'a>) {
        self.lighting.encode(&self.haze, data);
        let light = &self.skylight;
        data.integer("SKYLIGHT_SIZE", &[light.columns, light.rows, light.stride].map(|count| count as i32));
        data.grid("SKYLIGHT", [light.shed.as_flattened().into()]);
    }

    fn encode_ground<'a>(&'a self, origin: &Origin, data: &mut SceneData<'a>) {
        let (ground, cell) = (&self.ground, self.relief.cell());
        let at = origin.cell.map(f64::from);
        let noise = |kind: u32, wavelength: f32, stretch: f64, steep: f32| {
            let scale = cell / f64::from(wavelength);
            grain_numbers(&GrainMap::new(kind, [scale, scale * stretch], at), [wavelength, steep])
        };
        let fine = ground.cell;
        let waves = match ground.colors {
            Colors::Desert => DESERT_WAVES,
            // The first two are not used.
            Colors::Surfaces => [2.0 * fine, 2.0 * fine, 2.0 * fine, 0.5 * fine],
            _ => NATURAL_WAVES,
        };
        let list = |numbers: Vec<[f32; 10]>| numbers.concat();
        data.number("NOISES", &list((0..4u32).zip(waves).map(|(kind, wave)| noise(kind, wave, 1.0, 0.0)).collect()));
        let halves = (0..u32::from(OCTAVES)).scan(2.0 * fine, |wave, octave| {
            let now = *wave;
            *wave *= 0.5;
            Some(noise(8 + octave, now, 1.0, 0.0))
        });
        data.number("OCTAVES", &list(halves.collect()));
        let waves = (1..).zip(WAVES).map(|(kind, (wave, steep))| noise(kind, wave, STRETCH, steep));
        data.number("WAVES", &list(waves.collect()));
        // Noises of kinds 4 to 7 are sampled over other quantities than positions.
        let plain = (4..8).map(|kind| grain_numbers(&GrainMap::new(kind, [1.0; 2], [0.0; 2]), [1.0, 0.0]));
        data.number("PLAIN", &list(plain.collect()));
        data.grid("GRAIN", [ground.grain.samples.as_flattened().into()]);
        data.integer("COLORS", &[ground.colors as i32]);
        data.number("BEDS", BEDS.as_flattened());
        data.number("SECTION_ROCK", ground.section_rock().as_flattened());
        data.integer("HAS_SOIL", &[i32::from(ground.section_soil().is_some())]);
        data.number("SOIL", &ground.section_soil().unwrap_or_default());
        data.number("NO_HEIGHT", &no_height());
        data.number("SNOW_LINE", &[ground.snow_line.min(FAR as f32)]);
        data.number("TREE_LINE", &[ground.tree_line.min(FAR as f32)]);
        data.integer("HAS_SHORE", &[i32::from(ground.sea.is_some())]);
        data.number("SHORE_HEIGHT", &[ground.sea.unwrap_or(0.0).max(-FAR as f32)]);
        data.number("SEA_TAKES", &self.water.takes);
        data.grid("SHAPE", [ground.shape.as_flattened().into()]);
        data.grid("COVER", [ground.cover.as_flattened().into()]);
        data.integer("HAS_BEDDING", &[i32::from(!ground.bedding.is_empty())]);
        data.grid("BEDDING", [ground.bedding.as_slice().into()]);
        data.integer("HAS_MISSING", &[i32::from(!ground.missing.is_empty())]);
        data.grid(
            "MISSING",
            [ground.missing.iter().map(|&gone| f32::from(u8::from(gone))).collect::<Vec<f32>>().into()],
        );
        let (low, high) = (self.relief.height_of(0.0) as f32, self.relief.height_of(self.relief.highest()) as f32);
        let split = ground.sea.unwrap_or(low).clamp(low, high);
        data.number("RAMP_ENDS", &[low, split, high]);
        let ramp = |from: f32, to: f32| {
            let share = |k: usize| k as f32 / (RAMP - 1) as f32;
            (0..RAMP).flat_map(move |k| ground.map_color(from + (to - from) * share(k))).collect::<Vec<f32>>().into()
        };
        match ground.colors {
            Colors::Map => data.grid("RAMP", [ramp(low, split), ramp(split.next_up(), high)]),
            _ => data.grid("RAMP", []),
        }
    }
}

impl Lighting {
    /// The light without any land, for renderers that draw their own: with haze of this density over a block with this
    /// diagonal and highest ground, and on the sea of land with this cell in metres.
    #[must_use]
    pub fn data(&self, haze: f64, [across, highest]: [f64; 2], cell: f64) -> SceneData<'_> {
        let mut data = SceneData::default();
        data.constants();
        self.encode(&Haze::of_block(haze, across, highest), &mut data);
        data.number("SEA_TAKES", &Water::new(cell).takes);
        data
    }

    fn encode<'a>(&'a self, haze: &Haze, data: &mut SceneData<'a>) {
        let sun = self.sky.sun();
        data.number("SUN", &[sun.x as f32, sun.y as f32, sun.z as f32]);
        data.number("SUNLIGHT", &self.sky.sunlight());
        data.number("SKY_AHEAD", &self.sky.ahead.map(|part| part as f32));
        data.grid("SKY", [self.sky.table.as_flattened().into()]);
        data.number("SUNWARDS", &self.sunwards.map(|part| part as f32));
        data.number("RIMS", &self.rims.map(|part| part as f32));
        data.number("LEVEL_SUN", &self.level_sun);
        data.number("LEVEL_SKY", &self.level_sky);
        data.number("EXPOSURE", &self.exposure);
        data.number("HAZE_DIMS", &haze.dims);
        data.number("HAZE_THINS", &[haze.thins]);
    }
}

/// Codes for the surroundings of the land, for shaders.
const AROUND_TABLE: u32 = 0;
const AROUND_SEA: u32 = 1;
const AROUND_MIRRORS: u32 = 2;

/// Number of words of a noise.
const NOISE_WORDS: usize = 10;

/// A noise: its wavelength in metres, matrix, offset, angle, and the steepness of its waves.
fn grain_numbers(map: &GrainMap, [wavelength, steep]: [f32; 2]) -> [f32; NOISE_WORDS] {
    let [[a, b], [c, d]] = map.matrix.map(|row| row.map(|part| part as f32));
    let ([u, v], [cos, sin]) = (map.offset.map(|part| part as f32), map.turn.map(|part| part as f32));
    [wavelength, a, b, c, d, u, v, cos, sin, steep]
}

impl<'a> SceneData<'a> {
    /// Number of samples of all grids.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.grids.iter().flat_map(|(_, parts)| parts).map(|part| part.len()).sum()
    }

    fn number(&mut self, name: &'static str, values: &[f32]) {
        self.numbers.push((name, values.to_vec()));
    }

    fn integer(&mut self, name: &'static str, values: &[i32]) {
        self.integers.push((name, values.to_vec()));
    }

    fn grid(&mut self, name: &'static str, parts: impl IntoIterator<Item = Cow<'a, [f32]>>) {
        self.grids.push((name, parts.into_iter().collect()));
    }

    fn constants(&mut self) {
        let one = |name, value: f32| (name, vec![value]);
        let color = |name, value: [f32; 3]| (name, value.to_vec());
        let tones = |[dark, light]: [&'static str; 2], tones: Tones| [color(dark, tones[0]), color(light, tones[1])];
        let radius = SUN_RADIUS.to_radians();
        let [above, less, square, linear, rest] = CURVE;
        self.constants = vec![
            one("FAR", FAR as f32),
            // The sentinel of patches without water must be below all water; a device may not support infinite numbers.
            one("DRY", DRY.max(-FAR as f32)),
            one("MEAN_ALBEDO", MEAN_ALBEDO),
            one("SEA_LEVEL_TOLERANCE", LEVEL as f32),
            one("ROUGH_WATER", ROUGH_WATER),
            one("PAPER", PAPER),
            one("SUN_HALF_SQUARE", (0.5 * radius * radius) as f32),
            one("SUN_DISC", (1.0 / (std::f64::consts::PI * radius * radius)) as f32),
            one("BENDS", BENDS),
            one("TONE_ABOVE", above),
            one("TONE_LESS", less),
            one("TONE_SQUARE", square),
            one("TONE_LINEAR", linear),
            one("TONE_REST", rest),
            color("TABLE", TABLE),
            color("DEEP", DEEP),
            color("BOTTOM", BOTTOM),
            color("LAKE_TAKES", LAKE_TAKES),
            color("LAKE_DEEP", LAKE_DEEP),
            color("LAKE_BOTTOM", LAKE_BOTTOM),
            color("SHALLOW", SHALLOW),
            color("DARK", DARK),
            color("GRAVEL", GRAVEL),
            color("SHORE", SHORE),
            color("SNOW", SNOW),
            color("SCRUB", SCRUB),
            color("CLAY", CLAY),
            color("TONE_IN_RED", INPUT[0]),
            color("TONE_IN_GREEN", INPUT[1]),
            color("TONE_IN_BLUE", INPUT[2]),
            color("TONE_OUT_RED", OUTPUT[0]),
            color("TONE_OUT_GREEN", OUTPUT[1]),
            color("TONE_OUT_BLUE", OUTPUT[2]),
        ];
        self.constants.extend(
            [
                tones(["ROCK_DARK", "ROCK_LIGHT"], ROCK),
                tones(["SCREE_DARK", "SCREE_LIGHT"], SCREE),
                tones(["LUSH_DARK", "LUSH_LIGHT"], LUSH),
                tones(["TUNDRA_DARK", "TUNDRA_LIGHT"], TUNDRA),
                tones(["TREES_DARK", "TREES_LIGHT"], TREES),
                tones(["FARMLAND_DARK", "FARMLAND_LIGHT"], FARMLAND),
                tones(["SAND_DARK", "SAND_LIGHT"], SAND),
            ]
            .concat(),
        );
        self.counts = vec![
            ("MIRRORS", MIRRORS as u32),
            ("AROUND_TABLE", AROUND_TABLE),
            ("AROUND_SEA", AROUND_SEA),
            ("AROUND_MIRRORS", AROUND_MIRRORS),
            ("NOISE", NOISE_WORDS as u32),
            ("SKY_COLUMNS", sky::AROUND as u32),
            ("SKY_ROWS", sky::UP as u32),
            ("GRAIN_SIDE", grain::SIDE as u32),
            ("RAMP_LENGTH", RAMP as u32),
            ("OCTAVE_COUNT", u32::from(OCTAVES)),
            ("WAVE_COUNT", WAVES.len() as u32),
            ("NATURAL", Colors::Natural as u32),
            ("DESERT", Colors::Desert as u32),
            ("SURFACES", Colors::Surfaces as u32),
            ("MAP", Colors::Map as u32),
        ];
    }
}
