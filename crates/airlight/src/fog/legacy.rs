//! Fog factors of older graphics hardware: one colour, not physical.
//!
//! They do not compose: the optics of two consecutive segments are not those of the combined segment, as no medium attenuates
//! like this. They are for comparison with existing pictures and games.

use crate::transfer::RgbPathOptics;

/// Exponential-squared fog: `T = e^-(density d)^2`.
pub fn exponential_squared(density_per_m: f64, distance_m: f64, colour: [f32; 3]) -> RgbPathOptics {
    blend((-(density_per_m * distance_m).powi(2)).exp(), colour)
}

/// Density (1/m) of exponential-squared fog with this visibility, defined by a contrast threshold.
pub fn exponential_squared_density_per_m(visibility_m: f64, contrast: f64) -> f64 {
    (-contrast.ln()).sqrt() / visibility_m
}

/// Linear fog: clear up to `start_m`, opaque from `end_m`.
pub fn linear(start_m: f64, end_m: f64, distance_m: f64, colour: [f32; 3]) -> RgbPathOptics {
    // A step if both ends coincide.
    let part = if end_m > start_m {
        ((end_m - distance_m) / (end_m - start_m)).clamp(0.0, 1.0)
    } else {
        f64::from(distance_m < end_m)
    };
    blend(part, colour)
}

fn blend(transmittance: f64, colour: [f32; 3]) -> RgbPathOptics {
    RgbPathOptics {
        transmittance: [transmittance as f32; 3],
        path_radiance: colour.map(|value| value * (1.0 - transmittance) as f32),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_range_from_clear_to_the_fog_colour() {
        let colour = [0.5, 0.6, 0.7];
        for fog in [
            |d| exponential_squared(0.01, d, [0.5, 0.6, 0.7]),
            |d| linear(10.0, 500.0, d, [0.5, 0.6, 0.7]),
        ] {
            assert_eq!(fog(0.0), RgbPathOptics::CLEAR);
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
        assert_eq!(linear(5.0, 5.0, 4.9, colour), RgbPathOptics::CLEAR);
        assert_eq!(linear(5.0, 5.0, 5.0, colour).transmittance, [0.0; 3]);
    }
}
