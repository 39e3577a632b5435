//! Fog factors of older graphics hardware: looks, not physics.
//!
//! Both take a fog colour and the distance. Neither composes: two stretches in a row are not the stretch they make up, as
//! no medium attenuates like this. They are here because pictures and games were made with them.

use crate::spectrum::Spectrum;
use crate::transfer::PathOptics;

/// Exponential-squared fog: `T = e^-(density d)^2`.
pub fn exponential_squared<const N: usize>(
    density_per_m: f64,
    distance_m: f64,
    colour: Spectrum<N>,
) -> PathOptics<N> {
    blend((-(density_per_m * distance_m).powi(2)).exp(), colour)
}

/// The density (1/m) of exponential-squared fog that leaves a contrast at a visibility.
pub fn exponential_squared_density_per_m(visibility_m: f64, contrast: f64) -> f64 {
    (-contrast.ln()).sqrt() / visibility_m
}

/// Linear fog: nothing up to `start_m`, all from `end_m`.
pub fn linear<const N: usize>(
    start_m: f64,
    end_m: f64,
    distance_m: f64,
    colour: Spectrum<N>,
) -> PathOptics<N> {
    // Where both ends coincide the fog is a wall.
    let part = if end_m > start_m {
        ((end_m - distance_m) / (end_m - start_m)).clamp(0.0, 1.0)
    } else {
        f64::from(distance_m < end_m)
    };
    blend(part, colour)
}

fn blend<const N: usize>(transmittance: f64, colour: Spectrum<N>) -> PathOptics<N> {
    PathOptics {
        transmittance: Spectrum::splat(transmittance as f32),
        path_radiance: colour * (1.0 - transmittance) as f32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_looks_run_from_clear_to_the_fog_colour() {
        let colour = Spectrum([0.5, 0.6, 0.7]);
        for fog in [
            |d| exponential_squared(0.01, d, Spectrum([0.5, 0.6, 0.7])),
            |d| linear(10.0, 500.0, d, Spectrum([0.5, 0.6, 0.7])),
        ] {
            assert_eq!(fog(0.0), PathOptics::CLEAR);
            assert_eq!(fog(f64::INFINITY).path_radiance, colour);
            let mut before = 1.0;
            for k in 1..100 {
                let now = fog(10.0 * f64::from(k)).transmittance[0];
                assert!((0.0..=before).contains(&now));
                before = now;
            }
        }
        let density = exponential_squared_density_per_m(200.0, 0.05);
        let at = exponential_squared(density, 200.0, colour).transmittance[0];
        assert!((at - 0.05).abs() < 1e-6);
        assert_eq!(linear(5.0, 5.0, 4.9, colour), PathOptics::CLEAR);
        assert_eq!(linear(5.0, 5.0, 5.0, colour).transmittance, Spectrum::ZERO);
    }
}
