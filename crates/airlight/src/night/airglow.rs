//! Airglow: light of a thin layer 90 km above the ground.

use super::spectra::with_luminance;
use crate::spectrum::{SampledCurve, WavelengthGrid, embedded_table};
use std::sync::LazyLock;

/// Bottom and top of the layer above sea level, m. The green line of oxygen, sodium and hydroxyl shine at 85 to 98 km; the
/// red line at 250 km is counted among them.
const LAYER_M: (f64, f64) = (80e3, 100e3);
/// Solar radio flux of the tabulated spectrum, in solar flux units (1e-22 W m^-2 Hz^-1).
const TABLE_SFU: f64 = 130.0;

/// Radiance of the airglow at the zenith at sea level, W m^-2 sr^-1 nm^-1, for a solar radio flux of 130 sfu: mean over all
/// nights of the Cerro Paranal Advanced Sky Model (Noll et al. 2012). Single nights differ by 20 % and more.
fn zenith_radiance() -> &'static SampledCurve {
    static CURVE: LazyLock<SampledCurve> = LazyLock::new(|| {
        let rows = embedded_table::<2>(include_str!("../../data/night/airglow.txt"));
        let (nm, radiance) = rows.into_iter().map(|[nm, l]| (nm, l)).unzip();
        SampledCurve::new(nm, radiance).expect("the embedded airglow is a curve")
    });
    &CURVE
}

/// Spectrum at the zenith at the wavelengths of a grid, W m^-2 sr^-1 nm^-1. Emission lines are spread over neighbouring
/// wavelengths; the luminance is that of the tabulated spectrum.
pub fn spectrum(grid: &WavelengthGrid, solar_flux_sfu: f64) -> Vec<f64> {
    let curve = zenith_radiance();
    /// Luminance of the tabulated spectrum, cd/m^2.
    static LUMINANCE: LazyLock<f64> = LazyLock::new(|| {
        let fine = WavelengthGrid::fine();
        let nm = fine.wavelengths_nm().iter();
        let radiance: Vec<f32> = nm.map(|&nm| zenith_radiance().at(nm) as f32).collect();
        fine.to_xyz(&radiance)[1]
    });
    let nm = grid.wavelengths_nm();
    // Mean over a triangle that reaches to the neighbours.
    let mean = |k: usize| {
        let reach = 10.0;
        let low = if k > 0 { nm[k - 1] } else { nm[k] - reach };
        let high = nm.get(k + 1).copied().unwrap_or(nm[k] + reach);
        let (mut sum, mut weights) = (0.0, 0.0);
        let mut at = low + 0.5;
        while at < high {
            let weight = match at < nm[k] {
                true => (at - low) / (nm[k] - low),
                false => (high - at) / (high - nm[k]),
            };
            sum += weight * curve.at(at);
            weights += weight;
            at += 1.0;
        }
        if weights > 0.0 {
            sum / weights
        } else {
            curve.at(nm[k])
        }
    };
    let activity = (0.2 + 0.006_14 * solar_flux_sfu) / (0.2 + 0.006_14 * TABLE_SFU);
    with_luminance(
        grid,
        (0..nm.len()).map(mean).collect(),
        activity * *LUMINANCE,
    )
}

/// Lengths of a ray in the layer relative to its thickness: the part before the lower air, and the part behind it. `radius_m` is
/// the distance of the eye from the planet's centre, `mu` the sine of the ray's elevation, `sea_level_m` the radius at sea level.
///
/// From the ground the second part is the function of van Rhijn (1921), 1 at the zenith and 6 at the horizon.
pub fn relative_lengths(
    radius_m: f64,
    mu: f64,
    sea_level_m: f64,
    meets_ground: bool,
) -> (f64, f64) {
    let (bottom, top) = (sea_level_m + LAYER_M.0, sea_level_m + LAYER_M.1);
    let thickness = top - bottom;
    // Distances along the ray, from the point nearest to the planet's centre, of the eye and of the spheres.
    let nearest_squared = radius_m * radius_m * (1.0 - mu * mu);
    let half = |radius: f64| (radius * radius - nearest_squared).max(0.0).sqrt();
    let eye = radius_m * mu;
    let (outer, inner) = (half(top), half(bottom));
    let overlap = |from: f64, to: f64| (to.min(outer) - from.max(eye)).max(0.0);
    if inner == 0.0 {
        // The ray passes above the lower air.
        return (overlap(-outer, outer) / thickness, 0.0);
    }
    let before = overlap(-outer, -inner);
    let behind = if meets_ground {
        0.0
    } else {
        overlap(inner, outer)
    };
    (before / thickness, behind / thickness)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEA: f64 = 6_371e3;

    #[test]
    fn luminance_is_that_of_the_table_on_every_grid() {
        for grid in [
            WavelengthGrid::rgb(),
            WavelengthGrid::standard(),
            WavelengthGrid::one_nanometre(),
        ] {
            let values: Vec<f32> = spectrum(&grid, TABLE_SFU)
                .iter()
                .map(|&v| v as f32)
                .collect();
            let luminance = grid.to_xyz(&values)[1];
            // Plain sum over the 0.5 nm spectrum of SkyCalc with a Gaussian for the eye: 1.80e-4 cd/m^2.
            assert!((luminance / 1.8e-4 - 1.0).abs() < 0.05, "{luminance}");
        }
        let grid = WavelengthGrid::standard();
        let quiet = spectrum(&grid, 70.0)[5] / spectrum(&grid, TABLE_SFU)[5];
        assert!((quiet - 0.63).abs() < 0.01);
    }

    #[test]
    fn colour_is_the_same_on_coarse_and_fine_grids() {
        let color = |grid: &WavelengthGrid| {
            let values: Vec<f32> = spectrum(grid, 100.0).iter().map(|&v| v as f32).collect();
            let xyz = grid.to_xyz(&values);
            let sum: f64 = xyz.iter().sum();
            (xyz[0] / sum, xyz[1] / sum)
        };
        let (fine, coarse) = (
            color(&WavelengthGrid::one_nanometre()),
            color(&WavelengthGrid::standard()),
        );
        assert!(
            (fine.0 - coarse.0).abs() < 0.012 && (fine.1 - coarse.1).abs() < 0.012,
            "{fine:?} {coarse:?}"
        );
    }

    #[test]
    fn lengths_follow_van_rhijn_on_the_ground() {
        let at = |deg: f64| relative_lengths(SEA, deg.to_radians().sin(), SEA, false);
        assert!((at(90.0).1 - 1.0).abs() < 1e-12 && at(90.0).0 == 0.0);
        for deg in [80.0, 45.0, 20.0, 5.0] {
            let zenith = f64::to_radians(90.0 - deg);
            let ratio = SEA / (SEA + 90e3) * zenith.sin();
            let van_rhijn = 1.0 / (1.0 - ratio * ratio).sqrt();
            assert!((at(deg).1 / van_rhijn - 1.0).abs() < 5e-3, "{deg}");
        }
    }

    #[test]
    fn lengths_are_continuous_across_the_layer_and_the_limb() {
        let at =
            |height: f64, mu: f64, ground: bool| relative_lengths(SEA + height, mu, SEA, ground);
        // From inside the layer, half of it is above.
        assert!((at(90e3, 1.0, false).1 - 0.5).abs() < 1e-9);
        // From above, looking down to the ground: once through the layer.
        let down = at(400e3, -1.0, true);
        assert!((down.0 - 1.0).abs() < 1e-9 && down.1 == 0.0);
        assert_eq!(at(400e3, 0.3, false), (0.0, 0.0));
        // The limb is brighter than the zenith from the ground, and both crossings together are continuous.
        let mut before = None;
        for i in 0..20_000 {
            let mu = -0.40 + 0.2 * f64::from(i) / 20_000.0;
            let (near, far) = at(400e3, mu, false);
            let sum = near + far;
            if let Some(before) = before {
                assert!(f64::abs(sum - before) < 3.0, "{mu}: {before} {sum}");
            }
            before = Some(sum);
        }
    }
}
