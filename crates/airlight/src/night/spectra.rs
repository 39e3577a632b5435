//! Spectra of the night's lights on a wavelength grid, and magnitudes.

use crate::spectrum::WavelengthGrid;

/// Luminance of magnitude 0 per square arcsecond, cd/m^2, of light with the sun's colour.
const MAGNITUDE_0_CD_M2: f64 = 1.08e5;

/// Surface brightness in V magnitudes per square arcsecond of a luminance in cd/m^2, for light with the sun's colour:
/// `-2.5 log10(L / 1.08e5 cd/m^2)`. 22 is 1.7e-4 cd/m^2.
pub fn magnitude_per_square_arcsec(luminance_cd_m2: f64) -> f64 {
    -2.5 * (luminance_cd_m2 / MAGNITUDE_0_CD_M2).log10()
}

/// Luminance of a surface brightness in V magnitudes per square arcsecond, cd/m^2: the inverse of
/// [`magnitude_per_square_arcsec`].
pub(crate) fn luminance_of_magnitude(magnitude: f64) -> f64 {
    MAGNITUDE_0_CD_M2 * 10f64.powf(-0.4 * magnitude)
}

/// Relative spectral radiance of a black body at the wavelengths of a grid, scaled to a luminance of 1 cd/m^2.
pub fn black_body(grid: &WavelengthGrid, temperature_k: f64) -> Vec<f64> {
    /// Second radiation constant, nm K.
    const SECOND_RADIATION_CONSTANT: f64 = 1.438_777e7;
    let planck = |&nm: &f64| {
        (nm / 550.0).powi(-5) / (SECOND_RADIATION_CONSTANT / (nm * temperature_k)).exp_m1()
    };
    let spectrum = grid.wavelengths_nm().iter().map(planck).collect();
    with_luminance(grid, spectrum, 1.0)
}

/// A spectrum (W m^-2 sr^-1 nm^-1 at the wavelengths of a grid) scaled to a luminance in cd/m^2.
pub(super) fn with_luminance(
    grid: &WavelengthGrid,
    mut spectrum: Vec<f64>,
    luminance_cd_m2: f64,
) -> Vec<f64> {
    let values: Vec<f32> = spectrum.iter().map(|&v| v as f32).collect();
    let scale = luminance_cd_m2 / grid.to_xyz(&values)[1];
    // A grid on which the observer sees nothing has no luminance to scale to.
    if scale.is_finite() && scale > 0.0 {
        spectrum.iter_mut().for_each(|v| *v *= scale);
    }
    spectrum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn magnitudes_of_known_skies() {
        assert!((magnitude_per_square_arcsec(1.71e-4) - 22.0).abs() < 0.01);
        for magnitude in [16.0, 21.6] {
            let back = magnitude_per_square_arcsec(luminance_of_magnitude(magnitude));
            assert!((back - magnitude).abs() < 1e-12);
        }
    }

    #[test]
    fn black_bodies_have_a_luminance_of_1_and_their_colour() {
        // Chromaticity of Planckian radiators, CIE 1931 x: 3000 K 0.4369, 5000 K 0.3451, 10000 K 0.2807.
        for (kelvin, x) in [(3000.0, 0.4369), (5000.0, 0.3451), (10_000.0, 0.2807)] {
            let grid = WavelengthGrid::standard();
            let values: Vec<f32> = black_body(&grid, kelvin)
                .iter()
                .map(|&v| v as f32)
                .collect();
            let xyz = grid.to_xyz(&values);
            assert!((xyz[1] - 1.0).abs() < 1e-5);
            let got = xyz[0] / xyz.iter().sum::<f64>();
            assert!((got - x).abs() < 0.006, "{kelvin}: {got}");
        }
    }
}
