//! Rayleigh scattering by air molecules from first principles: refractive index, anisotropy, number density.
//!
//! The cross-section is that of Bodhaine, Wood, Dutton & Slusser (J. Atmos. Oceanic Technol. 16, 1854, 1999), eq. (2),
//!
//! ```text
//! sigma = 24 pi^3 (n^2 - 1)^2 / (lambda^4 N_s^2 (n^2 + 2)^2) * F
//! ```
//!
//! with the refractive index `n` of Peck & Reeder (J. Opt. Soc. Am. 62, 958, 1972), its dependence on carbon dioxide
//! after Edlen (Bodhaine's eq. 19) and the King factor `F` of Bates (Bodhaine's eqs. 5, 6, 23). The air is dry:
//! water vapour changes the cross-section by less than 0.1 % at ordinary humidity.

use std::f64::consts::PI;

/// Boltzmann constant, J/K (exact in the SI of 2019).
pub(crate) const BOLTZMANN_J_PER_K: f64 = 1.380_649e-23;
/// Temperature for which the refractive index is stated, that of the standard atmosphere at sea level, K.
pub(crate) const STANDARD_TEMPERATURE_K: f64 = 288.15;
/// Standard pressure at sea level, Pa.
pub const STANDARD_PRESSURE_PA: f64 = 101_325.0;
/// Volume fraction of carbon dioxide in present-day air, parts per million.
pub const CO2_PPM: f64 = 420.0;

/// Number density of an ideal gas, molecules per cubic metre: `p / (k T)`.
pub(crate) fn number_density_per_m3(pressure_pa: f64, temperature_k: f64) -> f64 {
    pressure_pa / (BOLTZMANN_J_PER_K * temperature_k)
}

/// Refractivity `n - 1` of dry air at 288.15 K and 1013.25 hPa: Peck & Reeder (1972), two-term formula for 300 ppm of
/// carbon dioxide, times `1 + 0.54 (C - 0.0003)` (Bodhaine et al. 1999, eq. 19).
///
/// Fitted to measurements from 230 nm to 1690 nm, to about 1e-9 in `n`; used here from 200 nm on.
pub(crate) fn refractivity(wavelength_nm: f64, co2_ppm: f64) -> f64 {
    let s2 = (1e3 / wavelength_nm).powi(2);
    let at_300_ppm = 1e-8 * (8060.51 + 2_480_990.0 / (132.274 - s2) + 17_455.7 / (39.329_57 - s2));
    at_300_ppm * (1.0 + 0.54 * (co2_ppm - 300.0) * 1e-6)
}

/// King factor `F` of air: the ratio of scattering by anisotropic molecules to that by isotropic ones of the same mean
/// polarizability (Bodhaine et al. 1999, eqs. 5, 6 and 23; after Bates 1984).
pub fn king_factor(wavelength_nm: f64, co2_ppm: f64) -> f64 {
    let s2 = (1e3 / wavelength_nm).powi(2);
    let nitrogen = 1.034 + 3.17e-4 * s2;
    let oxygen = 1.096 + 1.385e-3 * s2 + 1.448e-4 * s2 * s2;
    let (argon, carbon_dioxide) = (1.0, 1.15);
    let co2_percent = co2_ppm * 1e-4;
    (78.084 * nitrogen + 20.946 * oxygen + 0.934 * argon + co2_percent * carbon_dioxide)
        / (78.084 + 20.946 + 0.934 + co2_percent)
}

/// Depolarization ratio `rho_n` for natural light of a King factor: inverse of `F = (6 + 3 rho) / (6 - 7 rho)`.
pub fn depolarization_of_king_factor(king_factor: f64) -> f64 {
    6.0 * (king_factor - 1.0) / (3.0 + 7.0 * king_factor)
}

/// Scattering cross-section of a molecule of dry air, m^2.
pub fn cross_section_m2(wavelength_nm: f64, co2_ppm: f64) -> f64 {
    let n = 1.0 + refractivity(wavelength_nm, co2_ppm);
    let molecules = number_density_per_m3(STANDARD_PRESSURE_PA, STANDARD_TEMPERATURE_K);
    // (n - 1)(n + 1) avoids the cancellation of n^2 - 1.
    let lorentz = refractivity(wavelength_nm, co2_ppm) * (n + 1.0) / (n * n + 2.0);
    let lambda = wavelength_nm * 1e-9;
    24.0 * PI.powi(3)
        * (lorentz / (molecules * lambda * lambda)).powi(2)
        * king_factor(wavelength_nm, co2_ppm)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cross_sections_match_bodhaine_1999() {
        // Bodhaine et al. (1999), eq. (29): their fit for 360 ppm, in 1e-28 cm^2, lambda in um.
        let mut nm: f64 = 250.0;
        while nm < 850.0 {
            let l2 = (nm * 1e-3).powi(2);
            let published = (1.045_599_6 - 341.290_61 / l2 - 0.902_308_50 * l2)
                / (1.0 + 0.002_705_988_9 / l2 - 85.968_563 * l2);
            let got = cross_section_m2(nm, 360.0) * 1e32;
            assert!(
                (got / published - 1.0).abs() < 3e-4,
                "{nm} nm: {got} against {published}"
            );
            nm += 10.0;
        }
    }

    #[test]
    fn air_depolarizes_by_less_than_three_percent() {
        let rho = depolarization_of_king_factor(king_factor(550.0, CO2_PPM));
        assert!((0.027..0.0295).contains(&rho), "{rho}");
    }
}
