//! Gases of the Earth's atmosphere: scattering molecules and absorbing ozone.

use super::{Constituent, ConstituentKind, DensityProfile, Interpolation};
use crate::optics::ozone::{self, DOBSON_UNIT_M2};
use crate::optics::{Depolarization, PhaseFunction, rayleigh};
use crate::spectrum::SpectralCurve;

/// Range of the tabulated scattering of air, nm, in steps of 1 nm; constant beyond.
const SHORTEST_NM: u32 = 250;
const LONGEST_NM: u32 = 1100;

/// Dry air with a given sea-level pressure (Pa): Rayleigh scattering from first principles
/// ([`rayleigh::cross_section_m2`], 420 ppm of carbon dioxide), depolarization by wavelength, density profile of the U.S.
/// Standard Atmosphere 1976.
///
/// Sampled every 1 nm from 250 to 1100 nm: the error of linear interpolation is below 4e-5.
pub fn air(sea_level_pressure_pa: f64) -> Constituent {
    let molecules =
        rayleigh::number_density_per_m3(sea_level_pressure_pa, rayleigh::STANDARD_TEMPERATURE_K);
    let (wavelengths, values) = (SHORTEST_NM..=LONGEST_NM)
        .map(|nm| {
            let nm = f64::from(nm);
            (
                nm,
                molecules * rayleigh::cross_section_m2(nm, rayleigh::CO2_PPM),
            )
        })
        .unzip();
    Constituent {
        kind: ConstituentKind::Molecules,
        density: DensityProfile::StandardAir1976,
        scattering_per_m: SpectralCurve::table(wavelengths, values)
            .unwrap_or(SpectralCurve::Constant(0.0)),
        absorption_per_m: SpectralCurve::Constant(0.0),
        phase: PhaseFunction::Rayleigh(Depolarization::Air),
    }
}

/// Altitude (km) and ozone molecules per cubic metre (1e18): the mid-latitude model that the U.S. Standard Atmosphere 1976
/// adopts (Krueger & Minzner, J. Geophys. Res. 81, 4477, 1976). Of its 37 samples, every 2 km from 2 to 74 km, these
/// suffice to stay within 4 % of the peak. Fewer samples mean fewer integration panels for a solver.
const OZONE_KM_1E18_PER_M3: [(f64, f64); 9] = [
    (2.0, 0.68),
    (8.0, 0.65),
    (12.0, 2.02),
    (20.0, 4.77),
    (22.0, 4.86),
    (26.0, 4.03),
    (32.0, 2.03),
    (36.0, 1.22),
    (74.0, 0.000_17),
];

/// Density of ozone relative to its peak at 22 km: linear in the logarithm between samples, constant below 2 km, 0 above
/// 74 km. Within 4 % of the peak of the published model.
pub(crate) fn ozone_profile() -> DensityProfile {
    let (altitudes, densities) = OZONE_KM_1E18_PER_M3
        .iter()
        .map(|(km, n)| (km * 1e3, n / 4.86))
        .unzip();
    DensityProfile::tabulated(altitudes, densities, Interpolation::LogLinear)
        .expect("the ozone table is valid")
}

/// Ozone with a vertical column (from sea level) in Dobson units: the mid-latitude profile of the U.S. Standard Atmosphere 1976, scaled, with the cross-section
/// measured at 233 K ([`ozone::cross_section_m2`]). Absorbs only.
pub fn ozone(column_du: f64) -> Constituent {
    let density = ozone_profile();
    let peak_per_m3 = column_du * DOBSON_UNIT_M2 / density.column_m(0.0, 80e3);
    Constituent {
        kind: ConstituentKind::Ozone,
        density,
        scattering_per_m: SpectralCurve::Constant(0.0),
        absorption_per_m: SpectralCurve::Table(ozone::curve().clone()).scaled(peak_per_m3),
        phase: PhaseFunction::Isotropic,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_standard_atmosphere_has_its_published_optical_depth() {
        let depth = |nm| air(101_325.0).optical_depth(0.0, 100e3, nm);
        assert!(
            (depth(550.0) / 0.0973 - 1.0).abs() < 0.01,
            "{}",
            depth(550.0)
        );
        // Bodhaine et al. (1999), eq. (30), sea level, 45 degrees, 360 ppm; tau over a column of equal mass.
        for nm in [350.0f64, 450.0, 550.0, 650.0, 800.0] {
            let l2 = (nm * 1e-3).powi(2);
            let fit = 0.002_152_0 * (1.045_599_6 - 341.290_61 / l2 - 0.902_308_50 * l2)
                / (1.0 + 0.002_705_988_9 / l2 - 85.968_563 * l2);
            assert!(
                (depth(nm) / fit - 1.0).abs() < 3e-3,
                "{nm}: {} against {fit}",
                depth(nm)
            );
        }
    }

    #[test]
    fn the_table_of_scattering_is_fine_enough() {
        let air = air(101_325.0);
        let molecules = rayleigh::number_density_per_m3(101_325.0, 288.15);
        for nm in [300.5, 440.5, 700.25] {
            let exact = molecules * rayleigh::cross_section_m2(nm, rayleigh::CO2_PPM);
            assert!((air.scattering_per_m.at(nm) / exact - 1.0).abs() < 4e-5);
        }
    }

    #[test]
    fn ozone_has_the_given_column() {
        let depth = ozone(300.0).optical_depth(0.0, 100e3, 603.0);
        let want = 300.0 * DOBSON_UNIT_M2 * ozone::cross_section_m2(603.0);
        assert!((depth / want - 1.0).abs() < 1e-12);
    }

    #[test]
    fn ozone_follows_the_published_model() {
        let model: [f64; 37] = [
            0.68, 0.58, 0.57, 0.65, 1.13, 2.02, 2.35, 2.95, 4.04, 4.77, 4.86, 4.54, 4.03, 3.24,
            2.52, 2.03, 1.58, 1.22, 0.873, 0.607, 0.398, 0.274, 0.169, 0.103, 0.0664, 0.0384,
            0.0255, 0.0161, 0.0112, 0.007_33, 0.004_81, 0.003_17, 0.001_72, 0.000_75, 0.000_54,
            0.000_22, 0.000_17,
        ];
        let profile = ozone_profile();
        for (i, density) in model.iter().enumerate() {
            let got = 4.86 * profile.at(2e3 * (i as f64 + 1.0));
            assert!(
                (got - density).abs() < 0.04 * 4.86,
                "sample {i}: {got} against {density}"
            );
        }
        // The column of the model is 345 Dobson units (U.S. Standard Atmosphere 1976, 0.345 atm-cm).
        let own = 4.86e18 * profile.column_m(0.0, 80e3) / DOBSON_UNIT_M2;
        assert!((own / 345.0 - 1.0).abs() < 0.02, "{own}");
    }
}
