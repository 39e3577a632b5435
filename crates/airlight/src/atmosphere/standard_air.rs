//! Number density of the U.S. Standard Atmosphere, 1976 (NOAA-S/T 76-1562), computed by the formulas of the standard.

use crate::optics::rayleigh::{STANDARD_PRESSURE_PA, STANDARD_TEMPERATURE_K};
#[cfg(feature = "ephemeris")]
use crate::sun::RefractingAir;

/// Effective radius of the Earth for geopotential altitude, m (table 2 of the standard).
const GEOPOTENTIAL_RADIUS_M: f64 = 6_356_766.0;
/// Sea-level gravity, m/s^2; molar mass of air, kg/mol; gas constant of the standard, J/(mol K).
const GRAVITY: f64 = 9.806_65;
const MOLAR_MASS: f64 = 0.028_964_4;
const GAS_CONSTANT: f64 = 8.314_32;

/// A layer in which temperature is linear in geopotential altitude: base (geopotential m), temperature at the base (K),
/// lapse rate (K/m) and pressure at the base (Pa). Table 4 of the standard; pressures by eqs. 33a and 33b.
struct Layer {
    base_m: f64,
    temperature_k: f64,
    lapse_k_per_m: f64,
    pressure_pa: f64,
}

const LAYERS: [Layer; 7] = [
    layer(0.0, STANDARD_TEMPERATURE_K, -6.5e-3, STANDARD_PRESSURE_PA),
    layer(11_000.0, 216.65, 0.0, 22_632.06),
    layer(20_000.0, 216.65, 1.0e-3, 5_474.889),
    layer(32_000.0, 228.65, 2.8e-3, 868.018_7),
    layer(47_000.0, 270.65, 0.0, 110.906_3),
    layer(51_000.0, 270.65, -2.8e-3, 66.938_87),
    layer(71_000.0, 214.65, -2.0e-3, 3.956_420),
];

const fn layer(base_m: f64, temperature_k: f64, lapse_k_per_m: f64, pressure_pa: f64) -> Layer {
    Layer {
        base_m,
        temperature_k,
        lapse_k_per_m,
        pressure_pa,
    }
}

/// Top of the layers, above which molecular diffusion dominates, geometric m.
pub(super) const HOMOPAUSE_M: f64 = 86_000.0;
/// Above 86 km the density falls as in table VIII of the standard between 86 km (1.447e20 m^-3) and 100 km
/// (1.189e19 m^-3): scale height 14 km / ln(1.447e20 / 1.189e19).
const UPPER_SCALE_HEIGHT_M: f64 = 5_602.6;

/// Pressure (Pa) and temperature (K) at a geometric altitude (m) up to 86 km; the lowest layer extends below sea level.
pub(super) fn pressure_and_temperature(altitude_m: f64) -> (f64, f64) {
    // The lower bound keeps the base of the power law positive.
    let z = altitude_m.clamp(-30_000.0, HOMOPAUSE_M);
    let geopotential = GEOPOTENTIAL_RADIUS_M * z / (GEOPOTENTIAL_RADIUS_M + z);
    let index = LAYERS.partition_point(|l| l.base_m <= geopotential).max(1) - 1;
    let layer = &LAYERS[index];
    let rise = geopotential - layer.base_m;
    let temperature = layer.temperature_k + layer.lapse_k_per_m * rise;
    let hydrostatic = GRAVITY * MOLAR_MASS / GAS_CONSTANT;
    let pressure = if layer.lapse_k_per_m == 0.0 {
        layer.pressure_pa * (-hydrostatic * rise / layer.temperature_k).exp()
    } else {
        layer.pressure_pa
            * (layer.temperature_k / temperature).powf(hydrostatic / layer.lapse_k_per_m)
    };
    (pressure, temperature)
}

/// Refracting air at the eye's geometric altitude, m; vacuum above 86 km. Pressure is clamped to 2000 hPa.
#[cfg(feature = "ephemeris")]
pub(crate) fn refracting_air(altitude_m: f64) -> RefractingAir {
    let (pressure_pa, temperature_k) = pressure_and_temperature(altitude_m);
    RefractingAir {
        pressure_pa: match altitude_m > HOMOPAUSE_M {
            true => 0.0,
            false => pressure_pa.min(200_000.0),
        },
        temperature_c: temperature_k - 273.15,
    }
}

/// Number density of air relative to sea level at a geometric altitude, m.
pub(super) fn relative_density(altitude_m: f64) -> f64 {
    let (pressure, temperature) = pressure_and_temperature(altitude_m);
    let below = pressure / temperature / (STANDARD_PRESSURE_PA / STANDARD_TEMPERATURE_K);
    match altitude_m > HOMOPAUSE_M {
        true => below * (-(altitude_m - HOMOPAUSE_M) / UPPER_SCALE_HEIGHT_M).exp(),
        false => below,
    }
}

/// Geometric altitudes at which the temperature gradient changes, m.
pub(super) fn kinks_m() -> impl Iterator<Item = f64> {
    LAYERS
        .iter()
        .map(|l| GEOPOTENTIAL_RADIUS_M * l.base_m / (GEOPOTENTIAL_RADIUS_M - l.base_m))
        .chain([HOMOPAUSE_M])
}

/// Altitude above which density is neglected where a profile must end, m: 25 scale heights above the homopause.
pub(super) const END_M: f64 = HOMOPAUSE_M + 25.0 * UPPER_SCALE_HEIGHT_M;

/// Intervals of altitude from 5 km below sea level to [`END_M`], m, in each of which the density is smooth and falls by
/// less than a factor of e.
pub(super) fn ramps_m() -> Vec<[f64; 2]> {
    const DEPTH_M: f64 = -5e3;
    const WIDEST_M: f64 = 3e3;
    let edges: Vec<f64> = [DEPTH_M]
        .into_iter()
        .chain(kinks_m())
        .chain([END_M])
        .collect();
    edges
        .windows(2)
        .flat_map(|w| {
            let count = ((w[1] - w[0]) / WIDEST_M).ceil();
            let edge = move |i: u32| w[0] + (w[1] - w[0]) * f64::from(i) / count;
            (0..count as u32).map(move |i| [edge(i), edge(i + 1)])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::rayleigh::number_density_per_m3;

    #[cfg(feature = "ephemeris")]
    #[test]
    fn refraction_fades_with_the_air() {
        let at = |m| refracting_air(m).pressure_pa;
        assert!((at(0.0) - 101_325.0).abs() < 1e-9);
        assert!((refracting_air(0.0).temperature_c - 15.0).abs() < 1e-9);
        assert!((at(5000.0) / 54_020.0 - 1.0).abs() < 1e-3);
        assert_eq!(at(400e3), 0.0);
        assert_eq!(at(-12e3), 200_000.0);
    }

    #[test]
    fn densities_match_the_tables_of_the_standard() {
        // Table I (number density from density, table I: rho / rho0) of the standard.
        for (km, ratio) in [
            (-5.0, 1.5760),
            (5.0, 6.0117e-1),
            (11.0, 2.9780e-1),
            (20.0, 7.2580e-2),
            (32.0, 1.1065e-2),
            (50.0, 8.3827e-4),
            (80.0, 1.5067e-5),
        ] {
            let got = relative_density(km * 1e3);
            assert!(
                (got / ratio - 1.0).abs() < 1e-3,
                "{km} km: {got} against {ratio}"
            );
        }
        // Table VIII, m^-3.
        let sea_level_per_m3 = number_density_per_m3(STANDARD_PRESSURE_PA, STANDARD_TEMPERATURE_K);
        for (km, density) in [(86.0, 1.447e20), (90.0, 7.12e19), (100.0, 1.189e19)] {
            let got = relative_density(km * 1e3) * sea_level_per_m3;
            assert!((got / density - 1.0).abs() < 0.01, "{km} km: {got}");
        }
    }

    #[test]
    fn only_the_tropopause_is_a_significant_kink() {
        for (i, z) in kinks_m().enumerate().skip(1) {
            let slope = |d: f64| (relative_density(z + d) / relative_density(z)).ln() / d;
            let change = (slope(1.0) / slope(-1.0) - 1.0).abs();
            // Less than 1e-5 of the air lies above 86 km.
            assert_eq!(i == 1, change > 0.10 && z < 80e3, "{z} m: {change}");
        }
    }

    #[test]
    fn density_is_continuous_between_layers() {
        for z in kinks_m() {
            let (below, above) = (relative_density(z - 1e-3), relative_density(z + 1e-3));
            assert!((below / above - 1.0).abs() < 2e-6, "{z}: {below} {above}");
        }
    }
}
