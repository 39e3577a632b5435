//! Integrals over directions by rings of constant elevation, dense at the horizon and around the sun.

use crate::math::quadrature::GaussRule;
use std::f64::consts::TAU;

/// A ring of directions of one elevation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ring {
    /// Elevation, rad.
    pub elevation_rad: f64,
    /// Solid angle for which the ring stands, sr.
    pub solid_angle: f64,
    /// Whether it passes through the glow of haze around the sun, where light changes within a degree of azimuth.
    pub beside_sun: bool,
}

impl Ring {
    /// Number of steps in azimuth that an integral around the ring needs, given that of a ring away from the sun.
    pub fn steps(&self, away_from_sun: usize) -> usize {
        /// Ratio of the two.
        const DENSER: usize = 8;
        match self.beside_sun {
            true => DENSER * away_from_sun,
            false => away_from_sun,
        }
    }
}

/// Rings between two elevations, rad, dense at the first of them and at the elevation of the sun if it lies between them; `nodes` on
/// each side of it.
pub(crate) fn rings((from_rad, to_rad): (f64, f64), sun_rad: f64, nodes: usize) -> Vec<Ring> {
    /// Angle from the sun beyond which no phase function is narrower than a few degrees of azimuth, rad.
    const GLOW_RAD: f64 = 0.25;
    if from_rad == to_rad {
        return Vec::new();
    }
    let rule = GaussRule::new(nodes);
    let dense_at_start = |start: f64, end: f64| {
        let span = end - start;
        rule.on(0.0, 1.0)
            .map(move |(x, weight)| (start + span * x * x, span * 2.0 * x * weight))
            .collect::<Vec<_>>()
    };
    let dense_at_both = |start: f64, end: f64| {
        let span = end - start;
        rule.on(0.0, 1.0)
            .map(move |(x, weight)| {
                let place = x * x * (3.0 - 2.0 * x);
                (start + span * place, span * 6.0 * x * (1.0 - x) * weight)
            })
            .collect::<Vec<_>>()
    };
    let sun_is_between = (from_rad - sun_rad) * (to_rad - sun_rad) < 0.0;
    let elevations = match sun_is_between {
        true => [
            dense_at_both(from_rad, sun_rad),
            dense_at_start(sun_rad, to_rad),
        ]
        .concat(),
        false => dense_at_start(from_rad, to_rad),
    };
    let ring = |(elevation_rad, weight): (f64, f64)| Ring {
        elevation_rad,
        solid_angle: TAU * elevation_rad.cos() * weight.abs(),
        beside_sun: (elevation_rad - sun_rad).abs() < GLOW_RAD,
    };
    elevations.into_iter().map(ring).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn rings_cover_their_part_of_the_sphere() {
        for (from, to, sun) in [
            (0.0, FRAC_PI_2, 0.7),
            (0.0, FRAC_PI_2, -0.1),
            (0.0, FRAC_PI_2, 1.56),
            (-0.05, -FRAC_PI_2, 0.3),
            (-0.35, -0.2, -0.25),
        ] {
            let whole: f64 = rings((from, to), sun, 16)
                .iter()
                .map(|r| r.solid_angle)
                .sum();
            let exact = TAU * (to.sin() - from.sin()).abs();
            assert!((whole / exact - 1.0).abs() < 1e-9, "{from} {to} {sun}");
        }
    }

    #[test]
    fn a_glow_around_the_sun_is_resolved() {
        // Radiance e^-(t / w) at the angle t from the sun integrates to 2 pi w^2.
        for width in [0.01f64, 0.03] {
            for sun in [0.2f64, 0.7, 1.3] {
                let mut sum = 0.0;
                for ring in rings((0.0, FRAC_PI_2), sun, 32) {
                    let steps = ring.steps(256);
                    let (sin, cos) = ring.elevation_rad.sin_cos();
                    for step in 0..steps {
                        let azimuth = TAU * (step as f64 + 0.5) / steps as f64;
                        let nu = sin * sun.sin() + cos * sun.cos() * azimuth.cos();
                        let angle = nu.clamp(-1.0, 1.0).acos();
                        sum += ring.solid_angle / steps as f64 * (-angle / width).exp();
                    }
                }
                let exact = 2.0 * PI * width * width;
                let error = sum / exact - 1.0;
                assert!(error.abs() < 0.01, "{width} {sun}: {error}");
            }
        }
    }
}
