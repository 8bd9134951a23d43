//! Light from the surfaces that rays meet.

use super::ground::GroundPoint;
use super::march::{Ray, Surface};
use super::scene::{Met, Scene, Seen};
use super::vector::Vector;
use super::water::{self, Kind};
use orogen_io::palette::color::Light;

/// Mean albedo of the ground, which lights ground that sees little sky.
pub(super) const MEAN_ALBEDO: f32 = 0.16;

/// Albedo of the table below a block.
pub(super) const TABLE: Light = [0.62, 0.61, 0.59];

/// Water within this distance of the sea level, in cells, belongs to the sea.
pub(super) const LEVEL: f64 = 1e-4;

/// Variation of the water's slopes within a pixel.
pub(super) const ROUGH_WATER: f32 = 0.09;

impl Scene {
    /// The light after passing through the haze.
    pub(super) fn through_haze(&self, ray: &Ray, met: &Met, light: Light) -> Light {
        let left = self.haze.left(ray.from.z, met.place.z, met.distance);
        let level = Vector { z: ray.along.z.max(0.0) + 0.015, ..ray.along }.unit();
        let air = self.lighting.sky.light(level);
        std::array::from_fn(|c| light[c] * left[c] + air[c] * (1.0 - left[c]))
    }

    /// The light from an intersection. With `mirrors`, water reflects.
    pub(super) fn shade(&self, met: &Met, pixel: f64, mirrors: bool) -> Light {
        match met.surface {
            Seen::Land(Surface::GroundCover) => self.shade_ground(met, pixel),
            Seen::Land(Surface::Water) => self.shade_water(met, pixel, mirrors),
            Seen::Land(surface) => self.shade_side(met, surface),
            Seen::Table => self.shade_table(met),
        }
    }

    /// Width of a pixel in metres at an intersection; `cosine` is the cosine of the viewing angle.
    fn footprint(&self, met: &Met, pixel: f64, cosine: f64) -> f32 {
        // The geometric mean of length and width.
        (met.distance * pixel * self.relief.cell() / cosine.clamp(0.04, 1.0).sqrt() * 0.7) as f32
    }

    /// The visible share of the sun from a point, ignoring obstacles within `nearest` cells.
    fn sun_seen(&self, place: Vector, flip: [f64; 2], nearest: f64) -> f32 {
        let [low, high] = self.lighting.rims;
        if high <= 0.0 {
            return 0.0;
        }
        let towards = [self.lighting.sunwards[0] * flip[0], self.lighting.sunwards[1] * flip[1]];
        let rise = self.relief.steepest(place, towards, nearest, low, high);
        let hidden = ((rise - low) / (high - low)).clamp(0.0, 1.0) as f32;
        1.0 - hidden * hidden * (3.0 - 2.0 * hidden)
    }

    fn sun(&self, flip: [f64; 2]) -> Vector {
        let sun = self.lighting.sky.sun();
        Vector { x: sun.x * flip[0], y: sun.y * flip[1], z: sun.z }
    }

    fn shade_ground(&self, met: &Met, pixel: f64) -> Light {
        let Vector { x, y, z } = met.place;
        let slant = -met.along.z + 0.3;
        let site =
            GroundPoint { x, y, height: self.relief.height_of(z) as f32, footprint: self.footprint(met, pixel, slant) };
        let look = self.ground.look(&site);
        let normal = Vector::new(-f64::from(look.slope[0]), -f64::from(look.slope[1]), 1.0).unit();
        let facing = normal.dot(self.sun(met.flip)) as f32;
        let direct = if facing > 0.0 { facing * self.sun_seen(met.place, met.flip, 0.75) } else { 0.0 };
        let shed = self.skylight.at(x, y);
        let sunlight = self.lighting.sky.sunlight();
        std::array::from_fn(|c| {
            let bounced = MEAN_ALBEDO
                * (0.7 * self.lighting.level_sun[c] + self.lighting.level_sky[c])
                * (1.0 - shed[3]).max(0.0);
            look.albedo[c] * std::f32::consts::FRAC_1_PI * (sunlight[c] * direct + shed[c] + bounced)
        })
    }

    fn shade_water(&self, met: &Met, pixel: f64, mirrors: bool) -> Light {
        let Vector { x, y, z } = met.place;
        let footprint = self.footprint(met, pixel, -met.along.z);
        let normal = self.water.normal(self.ground.grain(), x, y, footprint);
        let to_eye = -met.along;
        let cosine = (normal.dot(to_eye) as f32).max(0.02);
        let mirrored = water::mirrored(cosine);
        let depth = match self.inside(met.place) {
            true => z - self.relief.ground(x, y),
            false => f64::INFINITY,
        };
        let depth = (depth * self.relief.cell() / self.relief.exaggeration()).min(1e6) as f32;
        let sun = self.sun(met.flip);
        let seen = if sun.z > 0.0 { self.sun_seen(met.place, met.flip, 0.25) } else { 0.0 };
        let is_sea = !self.inside(met.place) || self.relief.sea().is_some_and(|sea| (z - sea).abs() < LEVEL);
        let kind = if is_sea { Kind::Sea } else { Kind::Lake };
        let body = self.water.body(kind, depth, cosine, sun.z.max(0.0) as f32);
        let mut away = met.along.mirrored(normal);
        away.z = away.z.max(0.004);
        let away = away.unit();
        let reflected = Ray { from: met.place, along: away };
        let behind = if mirrors { self.relief.hit(&reflected, 0.1) } else { None };
        let behind = match behind.filter(|hit| hit.surface == Surface::GroundCover) {
            Some(hit) => {
                let there = Met {
                    distance: met.distance + hit.distance,
                    place: reflected.at(hit.distance),
                    along: away,
                    flip: met.flip,
                    surface: Seen::Land(Surface::GroundCover),
                    normal: Vector::UP,
                };
                let light = self.shade_ground(&there, pixel * 2.0);
                self.through_haze(&reflected, &Met { distance: hit.distance, ..there }, light)
            }
            None => self.lighting.sky.light(Vector { x: away.x * met.flip[0], y: away.y * met.flip[1], z: away.z }),
        };
        let glitter = seen * water::glitter(normal, to_eye, sun, ROUGH_WATER);
        let sunlight = self.lighting.sky.sunlight();
        std::array::from_fn(|c| {
            let within = body[c]
                * std::f32::consts::FRAC_1_PI
                * (self.lighting.level_sun[c] * seen + self.lighting.level_sky[c]);
            within * (1.0 - mirrored) + behind[c] * mirrored + sunlight[c] * glitter
        })
    }

    fn shade_side(&self, met: &Met, surface: Surface) -> Light {
        let Vector { x, y, z } = met.place;
        let metres = |cells: f64| (cells * self.relief.cell() / self.relief.exaggeration()) as f32;
        let albedo = match surface {
            Surface::WaterSide => self.water.section(metres(self.relief.top(x, y) - z)),
            _ => {
                let along = if met.normal.x == 0.0 { x } else { y };
                let thickness = metres(-self.floor).max(1.0);
                self.ground.section(
                    along,
                    [x, y],
                    self.relief.height_of(z) as f32,
                    metres(self.relief.ground(x, y) - z),
                    thickness,
                )
            }
        };
        let facing = met.normal.dot(self.lighting.sky.sun()).max(0.0) as f32;
        let sunlight = self.lighting.sky.sunlight();
        // The side sees half sky, half table, which is darker at its foot.
        let foot = 0.55 + 0.45 * ((z - self.floor) / -self.floor).clamp(0.0, 1.0) as f32;
        std::array::from_fn(|c| {
            let table = TABLE[c] * (0.5 * self.lighting.level_sun[c] + self.lighting.level_sky[c]);
            let soft = foot * 0.5 * (self.lighting.level_sky[c] + table);
            albedo[c] * std::f32::consts::FRAC_1_PI * (sunlight[c] * facing + soft)
        })
    }

    fn shade_table(&self, met: &Met) -> Light {
        let place = met.place;
        let seen = self.sun_seen(place, [1.0; 2], 1e-3);
        let [east, south] = self.relief.reach();
        let (x, y) = (place.x.clamp(0.0, east), place.y.clamp(0.0, south));
        let off = ((place.x - x) * (place.x - x) + (place.y - y) * (place.y - y)).sqrt();
        let high = self.relief.top(x, y) - place.z;
        let open = (0.5 + 0.5 * off / (off * off + high * high).sqrt().max(1e-9)) as f32;
        let near: Light = std::array::from_fn(|c| {
            TABLE[c]
                * std::f32::consts::FRAC_1_PI
                * (self.lighting.level_sun[c] * seen + self.lighting.level_sky[c] * open)
        });
        // The table fades into the horizon far behind the land.
        let across = (east * east + south * south).sqrt();
        let far = libm::expf(-((off / (1.3 * across)) as f32));
        let level = Vector { z: 0.02, ..met.along }.unit();
        let edge = self.lighting.sky.light(level);
        std::array::from_fn(|c| near[c] * far + edge[c] * (1.0 - far))
    }
}
