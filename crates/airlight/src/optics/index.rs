//! Refractive indices as functions of wavelength.

use crate::spectrum::{SpectralCurve, embedded_table};
use num_complex::Complex64;
use std::sync::LazyLock;

/// Complex refractive index `n + i k` by wavelength, absorbing for `k > 0`.
#[derive(Clone, Debug, PartialEq)]
pub struct RefractiveIndex {
    /// Real part `n`.
    pub real: SpectralCurve,
    /// Imaginary part `k`.
    pub imaginary: SpectralCurve,
}

impl RefractiveIndex {
    /// An index that does not depend on wavelength.
    pub fn constant(index: Complex64) -> Self {
        Self {
            real: SpectralCurve::Constant(index.re),
            imaginary: SpectralCurve::Constant(index.im),
        }
    }

    /// Liquid water at 10 degrees Celsius, 200 nm to 4000 nm, constant beyond.
    ///
    /// `n` up to 2400 nm is the IAPWS formulation (`water_real`); `n` above and `k` are from Segelstein, *The Complex
    /// Refractive Index of Water*, M.S. thesis, University of Missouri-Kansas City, 1981. (Segelstein's `n` falls from 400 nm
    /// to 700 nm half as much again as measured, which would spread the colours of rainbows; at 2400 nm the two sources differ
    /// by 1e-3.)
    pub fn water() -> Self {
        static WATER: LazyLock<RefractiveIndex> = LazyLock::new(|| {
            let table = embedded_table::<3>(include_str!("../../data/optics/water_index.txt"));
            let row = |[nm, n, k]: [f64; 3]| match nm < 2400.0 {
                true => [nm, water_real(nm, 283.15, 999.70), k],
                false => [nm, n, k],
            };
            RefractiveIndex::of_rows(table.into_iter().map(row).collect())
        });
        WATER.clone()
    }

    /// Index from the rows of an embedded table: wavelength (nm), `n`, `k`.
    pub(crate) fn of_rows(rows: Vec<[f64; 3]>) -> Self {
        let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<_>>();
        let curve = |i| SpectralCurve::table(column(0), column(i));
        Self {
            real: curve(1).expect("embedded tables are in order"),
            imaginary: curve(2).expect("embedded tables are in order"),
        }
    }

    /// Complex index at a wavelength in nm.
    pub fn at(&self, wavelength_nm: f64) -> Complex64 {
        Complex64::new(
            self.real.at(wavelength_nm),
            self.imaginary.at(wavelength_nm),
        )
    }
}

/// Real refractive index of water relative to vacuum, at a wavelength (200 nm to 1100 nm, usable to 2400 nm), temperature
/// (K) and density (kg/m^3).
///
/// IAPWS, *Release on the Refractive Index of Ordinary Water Substance as a Function of Wavelength, Temperature and
/// Pressure*, R9-97, 1997, eq. 1. Error below 1e-4 in the visible.
pub fn water_real(wavelength_nm: f64, temperature_k: f64, density_kg_m3: f64) -> f64 {
    const ULTRAVIOLET: f64 = 0.229_202_0;
    const INFRARED: f64 = 5.432_937;
    let wave = (wavelength_nm / 589.0).powi(2);
    let temperature = temperature_k / 273.15;
    let density = density_kg_m3 / 1000.0;
    let refraction = 0.244_257_733 + 9.746_344_76e-3 * density - 3.732_349_96e-3 * temperature
        + 2.686_784_72e-4 * wave * temperature
        + 1.589_205_70e-3 / wave
        + 2.459_342_59e-3 / (wave - ULTRAVIOLET * ULTRAVIOLET)
        + 0.900_704_920 / (wave - INFRARED * INFRARED)
        - 1.666_262_19e-2 * density * density;
    let z = density * refraction;
    ((1.0 + 2.0 * z) / (1.0 - z)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sodium D line at 20 degrees Celsius: 1.33299 relative to air, whose index is 1.00027. The hydrogen lines C
    /// (656.3 nm) and F (486.1 nm): 1.33115 and 1.33712 (CRC Handbook of Chemistry and Physics, index of refraction of water).
    #[test]
    fn refractive_index_of_water_matches_measurements() {
        for (nm, want) in [(589.3, 1.33299), (656.3, 1.33115), (486.1, 1.33712)] {
            let got = water_real(nm, 293.15, 998.2) / 1.00027;
            assert!((got - want).abs() < 1e-4, "{nm}: {got}");
        }
        let water = RefractiveIndex::water();
        assert!((water.at(2395.0).re - water.at(2405.0).re).abs() < 4e-3);
        assert!(
            (water.at(589.3).re - 1.3341).abs() < 2e-4,
            "{}",
            water.at(589.3)
        );
    }

    #[test]
    fn water_absorbs_red_more_than_blue() {
        let water = RefractiveIndex::water();
        // The absorption coefficient 4 pi k / lambda is 0.2 to 0.3 per metre at 600 nm (Pope & Fry 1997: 0.222).
        let absorption = |nm: f64| 4e9 * std::f64::consts::PI * water.at(nm).im / nm;
        assert!(
            (0.15..0.3).contains(&absorption(600.0)),
            "{}",
            absorption(600.0)
        );
        assert!(absorption(450.0) < 0.03 && absorption(700.0) > 0.4);
    }
}
