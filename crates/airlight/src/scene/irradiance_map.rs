//! [`IrradianceMap`]: irradiance of surfaces by their normal; irradiance of a horizontal surface by the sky.

use crate::axes;
use crate::math::interpolation::{Place, lerp};
use crate::math::parallel;
use crate::math::rings::rings;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Numbers of tabulated normals from the nadir to the zenith, and in azimuth.
const ROWS: usize = 25;
const COLUMNS: usize = 36;
/// Number of bands of equal solid angle in which radiance is sampled, and of directions in each.
const BANDS: usize = 64;
const AROUND: usize = 128;
/// Angle from the sun within which directions are denser, rad; number of rings there, and of directions in each.
const CAP_RAD: f64 = 0.15;
const RINGS: usize = 32;
const SPOKES: usize = 24;

/// Irradiance of surfaces at one place, by their normal, from all directions except the sun's disc.
///
/// A table of 25 by 36 normals with bilinear interpolation: accurate to 1 % of the irradiance if radiance is smooth over 3
/// degrees, and near the sun over half a degree (tested).
#[derive(Clone, Debug)]
pub struct IrradianceMap {
    channels: usize,
    /// `[row][column][channel]`, W m^-2 nm^-1 (or the unit of the radiance times sr).
    irradiance: Vec<f32>,
}

impl IrradianceMap {
    /// Integrates radiance over all directions (unit vectors away from the place), with `channels` values each. Directions are
    /// denser around the unit vector `sun`, where radiance may increase steeply.
    pub fn new(
        sun: DVec3,
        channels: usize,
        radiance: impl Fn(&[DVec3], &mut [f32]) + Sync,
    ) -> Self {
        /// Number of directions in one call of `radiance`.
        const CALL: usize = 64;
        let (directions, solid_angles): (Vec<DVec3>, Vec<f64>) =
            directions(sun).into_iter().unzip();
        let mut arriving = vec![0.0f32; directions.len() * channels];
        parallel::for_each_chunk(&mut arriving, CALL * channels, |call, out| {
            let first = call * CALL;
            let count = out.len() / channels;
            radiance(&directions[first..first + count], out);
            let solid_angles = &solid_angles[first..first + count];
            for (values, solid_angle) in out.chunks_exact_mut(channels).zip(solid_angles) {
                values.iter_mut().for_each(|v| *v *= *solid_angle as f32);
            }
        });
        let mut irradiance = vec![0.0f32; ROWS * COLUMNS * channels];
        parallel::for_each_chunk(&mut irradiance, channels, |i, sum| {
            let elevation_deg = 180.0 * (i / COLUMNS) as f64 / (ROWS - 1) as f64 - 90.0;
            let azimuth_deg = 360.0 * (i % COLUMNS) as f64 / COLUMNS as f64;
            let normal = axes::direction(azimuth_deg, elevation_deg);
            for (direction, values) in directions.iter().zip(arriving.chunks_exact(channels)) {
                let cosine = direction.dot(normal) as f32;
                if cosine > 0.0 {
                    sum.iter_mut()
                        .zip(values)
                        .for_each(|(s, v)| *s += v * cosine);
                }
            }
        });
        Self {
            channels,
            irradiance,
        }
    }

    /// Irradiance of a surface with this unit normal, one value for each channel, W m^-2 nm^-1 (or the unit of radiance times
    /// sr).
    pub fn irradiance(&self, normal: DVec3, out: &mut [f32]) {
        let row = Place::evenly((axes::elevation_deg(normal) + 90.0) / 180.0, ROWS);
        let column = axes::azimuth_deg(normal) / 360.0 * COLUMNS as f64;
        let (above, left) = (row.below, column as usize % COLUMNS);
        let (down, right) = (row.fraction as f32, column.fract() as f32);
        let at = |row: usize, column: usize, channel: usize| {
            self.irradiance[(row * COLUMNS + column % COLUMNS) * self.channels + channel]
        };
        for (channel, out) in out.iter_mut().enumerate().take(self.channels) {
            let line = |row| lerp(at(row, left, channel), at(row, left + 1, channel), right);
            *out = lerp(line(above), line(above + 1), down);
        }
    }
}

/// Directions over the whole sphere with their solid angles: equal ones in bands that are rotated against each other, and
/// rings around the sun that are denser towards it.
fn directions(sun: DVec3) -> Vec<(DVec3, f64)> {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let even = (0..BANDS * AROUND).map(|i| {
        let (band, place) = (i / AROUND, i % AROUND);
        let up = 2.0 * (band as f64 + 0.5) / BANDS as f64 - 1.0;
        let turn = TAU * ((place as f64 + 0.5) / AROUND as f64 + golden * band as f64);
        let level = (1.0 - up * up).sqrt();
        DVec3::new(level * turn.sin(), up, -level * turn.cos())
    });
    let cap = CAP_RAD.cos();
    let beyond: Vec<DVec3> = even.filter(|direction| direction.dot(sun) < cap).collect();
    let weight = TAU * (1.0 + cap) / beyond.len() as f64;
    let mut all: Vec<(DVec3, f64)> = beyond.into_iter().map(|d| (d, weight)).collect();
    let across = sun.any_orthonormal_vector();
    let along = sun.cross(across);
    for ring in 0..RINGS {
        let edge = |ring: usize| CAP_RAD * (ring as f64 / RINGS as f64).powi(2);
        let (inner, outer) = (edge(ring), edge(ring + 1));
        let weight = TAU * (inner.cos() - outer.cos()) / SPOKES as f64;
        let (sin, cos) = (0.5 * (inner + outer)).sin_cos();
        for spoke in 0..SPOKES {
            let turn = TAU * (spoke as f64 + golden * ring as f64) / SPOKES as f64;
            let direction = sun * cos + (across * turn.cos() + along * turn.sin()) * sin;
            all.push((direction, weight));
        }
    }
    all
}

/// Irradiance of a horizontal surface by the upper hemisphere, `channels` values, from rings of equal weight with equally spaced
/// directions, the first of which is half a step after `from_azimuth_deg`.
///
/// `add` adds the radiances along the directions of a ring to a sum.
pub(crate) fn horizontal_irradiance(
    (rings, spokes): (usize, usize),
    from_azimuth_deg: f64,
    channels: usize,
    add: impl Fn(&[DVec3], &mut [f64]) + Sync,
) -> Vec<f64> {
    let sums = parallel::map(rings, |ring| {
        // Equal steps of the squared sine have equal weight on a horizontal surface.
        let elevation = ((ring as f64 + 0.5) / rings as f64).sqrt().asin();
        let directions: Vec<DVec3> = (0..spokes)
            .map(|spoke| {
                let azimuth_deg = from_azimuth_deg + 360.0 * (spoke as f64 + 0.5) / spokes as f64;
                axes::direction(azimuth_deg, elevation.to_degrees())
            })
            .collect();
        let mut sum = vec![0.0; channels];
        add(&directions, &mut sum);
        sum
    });
    let mut whole = vec![0.0; channels];
    for sum in sums {
        whole.iter_mut().zip(sum).for_each(|(whole, v)| *whole += v);
    }
    let weight = PI / (rings * spokes) as f64;
    whole.iter_mut().for_each(|v| *v *= weight);
    whole
}

/// As [`horizontal_irradiance`], without preference for an azimuth, of a radiance that is evaluated direction by direction.
pub(super) fn horizontal_irradiance_of(
    directions: (usize, usize),
    out: &mut [f32],
    radiance: impl Fn(DVec3, &mut [f32]) + Sync,
) {
    let sum = horizontal_irradiance(directions, 0.0, out.len(), |directions, sum| {
        let mut values = vec![0.0; sum.len()];
        for &direction in directions {
            radiance(direction, &mut values);
            sum.iter_mut()
                .zip(&values)
                .for_each(|(sum, v)| *sum += f64::from(*v));
        }
    });
    out.iter_mut()
        .zip(sum)
        .for_each(|(out, sum)| *out = sum as f32);
}

/// Irradiance of a horizontal surface by the upper hemisphere, for a radiance that increases towards the unit vector `sun` within a degree.
pub(super) fn horizontal_irradiance_around(
    sun: DVec3,
    out: &mut [f32],
    radiance: impl Fn(DVec3, &mut [f32]) + Sync,
) {
    /// Number of elevations on each side of the sun, and of azimuths away from it.
    const NODES: usize = 16;
    const STEPS: usize = 48;
    let rings = rings((0.0, FRAC_PI_2), axes::elevation_rad(sun), NODES);
    let sums = parallel::map(rings.len(), |index| {
        let ring = &rings[index];
        let (steps, elevation_deg) = (ring.steps(STEPS), ring.elevation_rad.to_degrees());
        let mut values = vec![0.0; out.len()];
        let mut sum = vec![0.0; out.len()];
        for step in 0..steps {
            let azimuth_deg = 360.0 * (step as f64 + 0.5) / steps as f64;
            radiance(axes::direction(azimuth_deg, elevation_deg), &mut values);
            let each = sum.iter_mut().zip(&values);
            each.for_each(|(sum, v)| *sum += f64::from(*v));
        }
        let projected = ring.solid_angle * ring.elevation_rad.sin() / steps as f64;
        sum.iter().map(|v| v * projected).collect::<Vec<f64>>()
    });
    for (channel, out) in out.iter_mut().enumerate() {
        *out = sums.iter().map(|sum| sum[channel]).sum::<f64>() as f32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUN: DVec3 = DVec3::new(0.6, 0.64, 0.48);

    /// The map of a radiance in one channel.
    fn of(radiance: impl Fn(DVec3) -> f64 + Sync) -> IrradianceMap {
        IrradianceMap::new(SUN, 1, |directions, out| {
            let pairs = directions.iter().zip(out);
            pairs.for_each(|(direction, out)| *out = radiance(*direction) as f32);
        })
    }

    fn on(map: &IrradianceMap, normal: DVec3) -> f64 {
        let mut irradiance = [0.0];
        map.irradiance(normal, &mut irradiance);
        f64::from(irradiance[0])
    }

    fn normals() -> impl Iterator<Item = DVec3> {
        (0..200).map(|i| axes::direction(137.5 * f64::from(i), 0.9 * f64::from(i) - 89.5))
    }

    #[test]
    fn uniform_radiance_gives_pi_times_its_value() {
        let even = of(|_| 2.0);
        for normal in normals() {
            let ratio = on(&even, normal) / (2.0 * PI);
            assert!((ratio - 1.0).abs() < 3e-3, "{normal}: {ratio}");
        }
    }

    #[test]
    fn the_horizontal_receives_pi_times_the_mean_weighted_by_the_sine() {
        // Radiance 1 + s . d, with the exact irradiance pi + 2 pi / 3 s . y.
        let side = axes::direction(60.0, 20.0);
        let got = horizontal_irradiance((48, 96), 10.0, 2, |directions, sum| {
            for direction in directions {
                sum[0] += 1.0;
                sum[1] += 1.0 + side.dot(*direction);
            }
        });
        let exact = PI + 2.0 * PI / 3.0 * side.y;
        assert!((got[0] / PI - 1.0).abs() < 1e-14, "{got:?}");
        assert!((got[1] / exact - 1.0).abs() < 2e-4, "{got:?} {exact}");
    }

    #[test]
    fn irradiance_by_a_uniform_sky_decreases_with_tilt() {
        let sky = of(|d| if d.y > 0.0 { 1.0 } else { 0.0 });
        for normal in normals() {
            let exact = 0.5 * PI * (1.0 + normal.y);
            let got = on(&sky, normal);
            assert!((got - exact).abs() < 0.01 * PI, "{normal}: {got} {exact}");
        }
    }

    #[test]
    fn linear_radiance_is_integrated_exactly() {
        // Radiance 1 + s . d, with the exact irradiance pi + 2 pi / 3 s . n.
        let side = axes::direction(60.0, 20.0);
        let sky = of(|d| 1.0 + side.dot(d));
        for normal in normals() {
            let exact = PI + 2.0 * PI / 3.0 * side.dot(normal);
            let got = on(&sky, normal);
            assert!((got / exact - 1.0).abs() < 0.01, "{normal}: {got} {exact}");
        }
    }

    #[test]
    fn a_narrow_aureole_reaches_the_horizontal() {
        for width in [0.01f64, 0.03] {
            let mut got = [0.0];
            horizontal_irradiance_around(SUN, &mut got, |d, out| {
                let angle = 2.0 * (0.5 * (d - SUN).length()).asin();
                out[0] = (-angle / width).exp() as f32;
            });
            let exact = TAU * width * width * SUN.y;
            let off = f64::from(got[0]) / exact - 1.0;
            assert!(off.abs() < 0.015, "{width}: {got:?} {exact}");
        }
    }

    #[test]
    fn a_narrow_aureole_is_integrated_accurately() {
        // Radiance e^-(t / w) at the angle t from the sun integrates to 2 pi w^2.
        for width in [0.004f64, 0.01, 0.03] {
            let glow = of(|d| {
                let angle = 2.0 * (0.5 * (d - SUN).length()).asin();
                (-angle / width).exp()
            });
            for normal in normals().filter(|n| n.dot(SUN) > 0.3) {
                let exact = TAU * width * width * SUN.dot(normal);
                let got = on(&glow, normal);
                let off = got / exact - 1.0;
                assert!(off.abs() < 0.015, "{width} {normal}: {got} {exact}");
            }
        }
    }
}
