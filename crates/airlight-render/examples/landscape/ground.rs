//! What grows on the terrain: woods of single crowns, fields and meadows with hedges, rock; and how high it stands.
//!
//! Everything finer than a pixel fades into its mean: `footprint` is the size in metres of what is looked at.

use crate::noise::{self, step};
use crate::terrain::{Grid, Terrain};
use glam::DVec3;

/// Metres above the terrain that nothing on it exceeds.
pub const TALLEST: f64 = 24.0;

/// Size of the squares that hold a tree each, metres.
const PLOT: f64 = 7.5;
/// Size of fields, metres.
const FIELD: [f64; 2] = [260.0, 170.0];
/// Floor of the woods above the terrain, as seen from above, metres.
const UNDERGROWTH: f64 = 4.0;
/// Mean height of the crowns of dense woods above that, metres.
const MEAN_CROWN: f64 = 5.0;

/// The terrain with what stands on it.
pub struct Ground {
    heights: Grid,
    /// 0 open to 1 wooded.
    woods: Grid,
    /// Part of the sky's light that reaches a level surface past the mountains around.
    sky: Grid,
    highest: f64,
}

/// What light meets at a point of the ground.
pub struct Medium {
    /// Unit vector away from the surface.
    pub normal: DVec3,
    /// Reflected part of light in linear sRGB.
    pub albedo: DVec3,
    /// Part of the sky's light that gets here.
    pub open_to_sky: f64,
    /// Part of the sun's light that gets past what is too fine to cast shadows of its own.
    pub open_to_sun: f64,
}

/// A tree's crown at a point: its height above the undergrowth, metres, and a number of its own in `[0, 1)`.
#[derive(Clone, Copy, Default)]
struct Crown {
    height: f64,
    own: f64,
}

impl Ground {
    /// Plants the terrain, but not within some hundred metres of `clearing`.
    pub fn new(terrain: Terrain, clearing: [f64; 2]) -> Self {
        let heights = terrain.heights;
        let likely = heights.map(|x, z| {
            let [east, south] = slope(&heights, x, z, 60.0);
            let mean = (0..8)
                .map(|k| {
                    let (sin, cos) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
                    heights.linear(x + 700.0 * cos, z + 700.0 * sin)
                })
                .sum::<f64>()
                / 8.0;
            let here = heights.linear(x, z);
            let steep = step(0.06, 0.16, east.hypot(south));
            let raised = step(10.0, 45.0, here - mean);
            let high = step(420.0, 520.0, here);
            (1.0 - (1.0 - steep) * (1.0 - raised) * (1.0 - 0.8 * high)) as f32
        });
        let woods = likely.finer(8, |x, z| {
            density(likely.linear(x, z), x, z, clearing) as f32
        });
        let sky = heights.map(|x, z| sky_seen(&heights, x, z) as f32);
        Self {
            highest: heights.highest() + TALLEST,
            heights,
            woods,
            sky,
        }
    }

    /// The bare terrain above sea level, metres.
    pub fn terrain(&self, x: f64, z: f64) -> f64 {
        self.heights.smooth(x, z)
    }

    /// Nothing stands higher: metres above sea level.
    pub fn highest(&self) -> f64 {
        self.highest
    }

    /// Height of the surface above the bare terrain, metres, for looks that take in `footprint` metres.
    pub fn cover(&self, x: f64, z: f64, footprint: f64) -> f64 {
        let density = self.woods.linear(x, z);
        let crown = crown(x, z, density, footprint);
        density * UNDERGROWTH + crown.height + roughness(x, z, footprint)
    }

    /// What is found where a look meets the surface.
    pub fn medium(&self, x: f64, z: f64, footprint: f64) -> Medium {
        let reach = (0.6 * footprint).max(0.25);
        let at = |dx: f64, dz: f64| {
            let (x, z) = (x + dx * reach, z + dz * reach);
            self.terrain(x, z) + self.cover(x, z, footprint)
        };
        let normal = DVec3::new(
            at(-1.0, 0.0) - at(1.0, 0.0),
            2.0 * reach,
            at(0.0, -1.0) - at(0.0, 1.0),
        );
        let density = self.woods.linear(x, z);
        let crown = crown(x, z, density, footprint);
        let [east, south] = slope(&self.heights, x, z, 20.0);
        // Big patches of woods differ in kind, trees in themselves.
        let kind = noise::smooth(x / 310.0, z / 310.0, 11) * 0.6
            + noise::smooth(x / 90.0, z / 90.0, 12) * 0.4;
        let fine = step(5.0, 1.5, footprint);
        let own = 0.5 + fine * (crown.own - 0.5);
        let leaf =
            1.0 + 0.7 * step(0.7, 0.2, footprint) * (noise::smooth(x / 0.7, z / 0.7, 14) - 0.5);
        let leaves = DVec3::new(0.022, 0.038, 0.014)
            .lerp(
                DVec3::new(0.060, 0.070, 0.020),
                0.5 * step(0.2, 0.8, kind) + 0.5 * own,
            )
            // The first trees of autumn.
            .lerp(
                DVec3::new(0.11, 0.065, 0.020),
                0.7 * step(0.86, 0.92, own + 0.15 * (kind - 0.5)),
            )
            * leaf
            * (0.8 + 0.4 * own);
        let stony = step(0.75, 1.0, east.hypot(south) + 0.3 * (kind - 0.5));
        let rock = DVec3::new(0.20, 0.18, 0.15) * (0.7 + 0.6 * noise::smooth(x / 7.0, z / 7.0, 13));
        let open = field(x, z).lerp(rock, stony);
        // Between crowns it is dark.
        let depth = (crown.height / MEAN_CROWN).min(1.0);
        let between = 1.0 - density * (1.0 - (0.35 + 0.65 * depth));
        let grown = step(0.15, 0.5, density);
        Medium {
            normal: normal.normalize(),
            albedo: open.lerp(leaves, grown),
            open_to_sky: self.sky.linear(x, z)
                * (1.0 - fine * (1.0 - between))
                * (1.0 - 0.25 * density * (1.0 - fine)),
            open_to_sun: 1.0 - 0.35 * density * (1.0 - fine),
        }
    }
}

/// How wooded a place is, 0 to 1: `likely` by its lie, and by chance.
fn density(likely: f64, x: f64, z: f64, clearing: [f64; 2]) -> f64 {
    let chance =
        0.6 * noise::smooth(x / 140.0, z / 140.0, 1) + 0.4 * noise::smooth(x / 45.0, z / 45.0, 2);
    let woods = step(-0.25, 0.25, likely - 0.1 - 0.8 * chance);
    let hedge = (1.0 - step(6.0, 12.0, hedge_distance(x, z))) * step(0.4, 0.6, chance);
    let from_eye = (x - clearing[0]).hypot(z - clearing[1]);
    woods.max(0.8 * hedge) * step(35.0, 95.0, from_eye + 50.0 * (chance - 0.5))
}

/// Rise a metre eastward and southward, over a length of `2 * reach`.
fn slope(heights: &Grid, x: f64, z: f64, reach: f64) -> [f64; 2] {
    [
        (heights.smooth(x + reach, z) - heights.smooth(x - reach, z)) / (2.0 * reach),
        (heights.smooth(x, z + reach) - heights.smooth(x, z - reach)) / (2.0 * reach),
    ]
}

/// The part of an evenly bright sky's light that reaches a level surface: the mean over directions of the squared
/// cosine of the horizon's elevation.
fn sky_seen(heights: &Grid, x: f64, z: f64) -> f64 {
    const AROUND: u32 = 16;
    let here = heights.linear(x, z);
    let open = |k: u32| {
        let (sin, cos) = (f64::from(k) / f64::from(AROUND) * std::f64::consts::TAU).sin_cos();
        let mut distance = 90.0;
        let mut steepest = 0.0f64;
        while distance < 6000.0 {
            let rise = heights.linear(x + distance * cos, z + distance * sin) - here;
            steepest = steepest.max(rise / distance);
            distance *= 1.35;
        }
        1.0 / (1.0 + steepest * steepest)
    };
    (0..AROUND).map(open).sum::<f64>() / f64::from(AROUND)
}

/// Unevenness of the soil, metres: about +-1 m, of waves from 3 to 50 m.
fn roughness(x: f64, z: f64, footprint: f64) -> f64 {
    let mut sum = 0.0;
    let (mut wave, mut height) = (50.0, 1.6);
    for salt in 0..5 {
        let seen = step(0.5, 0.2, footprint / wave);
        if seen == 0.0 {
            break;
        }
        sum += seen * height * (noise::smooth(x / wave, z / wave, 20 + salt) - 0.5);
        (wave, height) = (wave * 0.5, height * 0.45);
    }
    sum
}

/// The crown that stands highest over a point.
fn crown(x: f64, z: f64, density: f64, footprint: f64) -> Crown {
    let fine = step(5.0, 1.5, footprint);
    let mean = density * MEAN_CROWN;
    if fine == 0.0 || density == 0.0 {
        return Crown {
            height: mean,
            own: 0.5,
        };
    }
    let mut best = Crown::default();
    let mut body = 0.0;
    let (u, v) = (x / PLOT, z / PLOT);
    // No crown reaches farther than from its plot to the middle of the next.
    let near = |t: f64| {
        let first = (t - 0.5).floor() as i64;
        first..=first + 1
    };
    for j in near(v) {
        for i in near(u) {
            let chance = |salt: u32| noise::hash(i, j, salt);
            let beside = u - i as f64 - 0.25 - 0.5 * chance(4);
            let before = v - j as f64 - 0.25 - 0.5 * chance(5);
            let radius = 0.45 + 0.3 * chance(6);
            // Squared, in radii.
            let away = (beside * beside + before * before) / (radius * radius);
            if away < 1.0 {
                let there = (2.5 * (1.25 * density - chance(3))).clamp(0.0, 1.0);
                let dome = there * (1.0 - away).sqrt();
                let height = (2.0 + 8.0 * chance(7)) * dome;
                if height > best.height {
                    body = dome;
                    best = Crown {
                        height,
                        own: chance(8),
                    };
                }
            }
        }
    }
    if body > 0.0 {
        best.height = (best.height + body * leaves(x, z, footprint)).max(0.0);
    }
    best.height = mean + fine * (best.height - mean);
    best
}

/// Boughs and leaves: metres above or below a crown's smooth shape.
fn leaves(x: f64, z: f64, footprint: f64) -> f64 {
    let mut sum = 0.0;
    for (salt, wave, height) in [(60, 2.7, 2.4), (61, 1.2, 1.7), (62, 0.6, 0.9)] {
        let seen = step(0.5, 0.2, footprint / wave);
        if seen == 0.0 {
            break;
        }
        sum += seen * height * (noise::smooth(x / wave, z / wave, salt) - 0.5);
    }
    sum
}

/// Coordinates in which fields are squares of size 1.
fn field_coordinates(x: f64, z: f64) -> [f64; 2] {
    let bend = |salt: u32| 220.0 * (noise::smooth(x / 600.0, z / 600.0, salt) - 0.5);
    let (u, v) = (x + 0.35 * z + bend(30), z - 0.35 * x + bend(31));
    [u / FIELD[0], v / FIELD[1]]
}

/// Metres to the nearest edge of a field.
fn hedge_distance(x: f64, z: f64) -> f64 {
    let [u, v] = field_coordinates(x, z);
    let to_edge = |t: f64, size: f64| (t - t.round()).abs() * size;
    to_edge(u, FIELD[0]).min(to_edge(v, FIELD[1]))
}

/// Albedo of open land: each field its own crop.
fn field(x: f64, z: f64) -> DVec3 {
    let [u, v] = field_coordinates(x, z);
    let chance = noise::hash(u.floor() as i64, v.floor() as i64, 40);
    let shade = 0.8 + 0.4 * noise::smooth(x / 25.0, z / 25.0, 41);
    let crop = if chance < 0.55 {
        DVec3::new(0.060, 0.100, 0.030).lerp(DVec3::new(0.085, 0.110, 0.035), chance / 0.55)
    } else if chance < 0.85 {
        DVec3::new(0.150, 0.140, 0.065)
    } else {
        DVec3::new(0.110, 0.085, 0.060)
    };
    crop * shade
}
