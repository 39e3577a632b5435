//! Scattering cross-sections of molecules from refractive indices and King factors.

use crate::optics::rayleigh::number_density_per_m3;
use std::f64::consts::PI;

/// Scattering cross-section, m^2, of a molecule of a gas with this refractivity at 273.15 K and 101325 Pa and this King factor.
fn cross_section_m2(wavelength_nm: f64, refractivity: f64, king_factor: f64) -> f64 {
    let n = 1.0 + refractivity;
    let molecules = number_density_per_m3(101_325.0, 273.15);
    let lambda = wavelength_nm * 1e-9;
    let lorentz = refractivity * (n + 1.0) / (n * n + 2.0);
    24.0 * PI.powi(3) * (lorentz / (molecules * lambda * lambda)).powi(2) * king_factor
}

/// Scattering cross-section of the carbon dioxide molecule, m^2: refractive index of Bideau-Mehu et al. (Opt. Commun. 9,
/// 432, 1973) at 273.15 K and 101325 Pa, King factor `1.1364 + 25.3e-12 nu^2` (nu in cm^-1) of Sneep & Ubachs (J. Quant.
/// Spectrosc. Radiat. Transfer 92, 293, 2005). Within 0.5 % of measurements at 532 and 660 nm.
pub(super) fn carbon_dioxide_m2(wavelength_nm: f64) -> f64 {
    let s2 = (1e3 / wavelength_nm).powi(2);
    let refractivity = 6.99100e-2 / (166.175 - s2)
        + 1.44720e-3 / (79.609 - s2)
        + 6.42941e-5 / (56.3064 - s2)
        + 5.21306e-5 / (46.0196 - s2)
        + 1.46847e-6 / (0.058_473_8 - s2);
    cross_section_m2(wavelength_nm, refractivity, 1.1364 + 2.53e-3 * s2)
}

/// Scattering cross-section of the nitrogen molecule, m^2: refractive index of Peck & Khanna (J. Opt. Soc. Am. 56, 1059, 1966) at
/// 273.15 K and 101325 Pa, King factor `1.034 + 3.17e-12 nu^2` of Bates (Planet. Space Sci. 32, 785, 1984).
pub(super) fn nitrogen_m2(wavelength_nm: f64) -> f64 {
    let s2 = (1e3 / wavelength_nm).powi(2);
    let refractivity = 1e-8 * (6_855.200 + 3_243_157.0 / (144.0 - s2));
    cross_section_m2(wavelength_nm, refractivity, 1.034 + 3.17e-4 * s2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::rayleigh;

    #[test]
    fn cross_sections_of_carbon_dioxide_match_measurements() {
        // He et al., Atmos. Chem. Phys. 21, 14927, 2021.
        for (nm, measured) in [(532.0, 13.32e-31), (660.0, 5.516e-31)] {
            let got = carbon_dioxide_m2(nm);
            assert!((got / measured - 1.0).abs() < 6e-3, "{nm}: {got}");
        }
    }

    /// Air is nitrogen, and 21 % of oxygen and argon, whose refractivities are 9 and 6 % smaller.
    #[test]
    fn nitrogen_scatters_a_little_more_than_air() {
        for nm in [400.0, 550.0, 700.0] {
            let ratio = nitrogen_m2(nm) / rayleigh::cross_section_m2(nm, 400.0);
            assert!((1.02..1.04).contains(&ratio), "{nm}: {ratio}");
        }
    }
}
