//! Curves of the book's live figures, as the reader sets them.

use airlight::atmosphere::DensityProfile;
use airlight::axes;
use airlight::fog::visibility::{Contrast, extinction_per_m};
use airlight::fog::{DirectionalLight, FogLighting, FogScattering, Ground, RgbFog, RgbLayer};
use airlight::optics::PhaseFunction;

/// Mean cosine of the fog's phase function, that of fog droplets.
const FOG_MEAN_COSINE: f64 = 0.85;
/// Height of the eye in the fog, m.
const EYE_HEIGHT_M: f64 = 2.0;
/// Distance beyond all fog that matters, m.
const FAR_M: f64 = 1e5;
/// Illuminance on the ground by the sky relative to that by the sun across its rays.
const AMBIENT: f32 = 0.1;

/// Phase function of Draine with the parameters `g`, -1 to 1, and `alpha`, 0 to 1, 1/sr: at `count` scattering angles in equal steps from
/// 0 to 180 degrees. `alpha` = 0 is that of Henyey and Greenstein.
///
/// # Errors
/// A sentence for parameters out of range.
pub fn phase_function(g: f64, alpha: f64, count: usize) -> Result<Vec<f64>, String> {
    let phase = PhaseFunction::draine(g, alpha).map_err(|error| error.to_string())?;
    let degrees = 180.0 / (count.max(2) - 1) as f64;
    let at = |k| phase.evaluate((degrees * k as f64).to_radians().cos(), 550.0);
    Ok((0..count).map(at).collect())
}

/// Light of height fog in the sun's azimuth, relative to the irradiance by the sun, 1/sr: at `count` elevations in equal steps from -10 to
/// 90 degrees, first as Ishiyama (2018) prints it, then with the attenuation of sunlight by the fog, then with all orders of scattering.
///
/// # Errors
/// A sentence for a visibility, scale height or elevation out of range.
pub fn height_fog(
    visibility_m: f64,
    scale_height_m: f64,
    sun_elevation_deg: f64,
    count: usize,
) -> Result<Vec<f64>, String> {
    let phase = PhaseFunction::henyey_greenstein(FOG_MEAN_COSINE);
    let extinction = extinction_per_m(visibility_m, Contrast::default());
    let layer = RgbLayer {
        density: DensityProfile::exponential(scale_height_m),
        extinction_per_m: [extinction as f32; 3],
        single_scattering_albedo: [1.0; 3],
        phase: phase.map_err(|error| error.to_string())?,
    };
    let light = FogLighting {
        sun: Some(DirectionalLight {
            direction: axes::direction(0.0, sun_elevation_deg),
            irradiance: [1.0; 3],
        }),
        ambient: [AMBIENT / std::f32::consts::PI; 3],
        ground_albedo: [0.2; 3],
    };
    let degrees = 100.0 / (count.max(2) - 1) as f64;
    let mut values = Vec::with_capacity(3 * count);
    for scattering in [
        FogScattering::Undimmed,
        FogScattering::Single,
        FogScattering::Multiple,
    ] {
        let layers = std::slice::from_ref(&layer);
        let fog = RgbFog::new(layers, Ground::FLAT, &light, scattering);
        let fog = fog.map_err(|error| error.to_string())?;
        let seen = fog.seen_from(EYE_HEIGHT_M);
        let at = |k| {
            let elevation_deg = degrees * k as f64 - 10.0;
            let ground_m =
                EYE_HEIGHT_M / (-elevation_deg.to_radians().sin()).max(EYE_HEIGHT_M / FAR_M);
            let path = seen.path(axes::direction(0.0, elevation_deg), ground_m.min(FAR_M));
            f64::from(path.path_radiance[1])
        };
        values.extend((0..count).map(at));
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_those_of_the_models() {
        let phase = phase_function(0.5, 0.0, 181).unwrap();
        // Henyey and Greenstein, forwards and backwards.
        for (angle, value) in [(0, 0.75 / 0.125), (180, 0.75 / 3.375)] {
            let right = value / (4.0 * std::f64::consts::PI);
            assert!((phase[angle] / right - 1.0).abs() < 1e-12);
        }
        assert!(phase_function(1.5, 0.0, 10).is_err());
        let fog = height_fog(250.0, 15.0, 8.0, 101).unwrap();
        let [printed, single, all] = [0, 101, 202].map(|first| &fog[first..first + 101]);
        // Towards the sun the printed model is too bright, and a single scattering too dark.
        let sunwards = 18;
        assert!(single[sunwards] < all[sunwards] && all[sunwards] < printed[sunwards]);
        assert!(fog.iter().all(|value| value.is_finite() && *value >= 0.0));
        assert!(height_fog(-1.0, 15.0, 8.0, 101).is_err());
    }
}
