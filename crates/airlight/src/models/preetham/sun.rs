//! Attenuation of sunlight for a turbidity: Preetham, Shirley and Smits 1999, appendix A.1, after Iqbal, "An Introduction to
//! Solar Radiation", 1983.

use crate::math::interpolation::{interval_by_key, lerp};
use crate::spectrum::WavelengthGrid;
use crate::sun::SunDisc;
use glam::DVec3;

/// Column of ozone, cm.
const OZONE_CM: f64 = 0.35;
/// Precipitable water, cm.
const WATER_CM: f64 = 2.0;

/// Absorption by ozone (1/cm) by wavelength (nm), table 2 of the paper.
#[rustfmt::skip]
const OZONE: [(f64, f64); 64] = [
    (300.0, 10.0), (305.0, 4.8), (310.0, 2.7), (315.0, 1.35), (320.0, 0.8), (325.0, 0.38), (330.0, 0.16), (335.0, 0.075),
    (340.0, 0.04), (345.0, 0.019), (350.0, 0.007), (355.0, 0.0), (445.0, 0.003), (450.0, 0.003), (455.0, 0.004),
    (460.0, 0.006), (465.0, 0.008), (470.0, 0.009), (475.0, 0.012), (480.0, 0.014), (485.0, 0.017), (490.0, 0.021),
    (495.0, 0.025), (500.0, 0.03), (505.0, 0.035), (510.0, 0.04), (515.0, 0.045), (520.0, 0.048), (525.0, 0.057),
    (530.0, 0.063), (535.0, 0.07), (540.0, 0.075), (545.0, 0.08), (550.0, 0.085), (555.0, 0.095), (560.0, 0.103),
    (565.0, 0.11), (570.0, 0.12), (575.0, 0.122), (580.0, 0.12), (585.0, 0.118), (590.0, 0.115), (595.0, 0.12),
    (600.0, 0.125), (605.0, 0.13), (610.0, 0.12), (620.0, 0.105), (630.0, 0.09), (640.0, 0.079), (650.0, 0.067),
    (660.0, 0.057), (670.0, 0.048), (680.0, 0.036), (690.0, 0.028), (700.0, 0.023), (710.0, 0.018), (720.0, 0.014),
    (730.0, 0.011), (740.0, 0.01), (750.0, 0.009), (760.0, 0.007), (770.0, 0.004), (780.0, 0.0), (790.0, 0.0),
];
/// Absorption by mixed gases (1/km).
const GASES: [(f64, f64); 4] = [(759.0, 0.0), (760.0, 3.0), (770.0, 0.21), (771.0, 0.0)];
/// Absorption by water vapour (1/cm).
#[rustfmt::skip]
const WATER: [(f64, f64); 13] = [
    (689.0, 0.0), (690.0, 0.016), (700.0, 0.024), (710.0, 0.0125), (720.0, 1.0), (730.0, 0.87), (740.0, 0.061),
    (750.0, 0.001), (760.0, 1e-5), (770.0, 1e-5), (780.0, 6e-4), (790.0, 0.0175), (800.0, 0.036),
];

/// Limb-darkened sun, attenuated at its centre.
pub struct DimmedSun {
    sun: DVec3,
    disc: SunDisc,
    grid: WavelengthGrid,
    /// Irradiance on a surface that faces the sun at the wavelengths of the grid, W m^-2 nm^-1.
    irradiance: Vec<f64>,
}

impl DimmedSun {
    /// Sun through air of a turbidity (at least 1), in the direction of a unit vector.
    pub fn new(turbidity: f64, sun: DVec3) -> Self {
        let grid = WavelengthGrid::standard();
        let zenith_rad = sun.angle_between(DVec3::Y);
        let irradiance = grid
            .wavelengths_nm()
            .iter()
            .zip(grid.solar_irradiance())
            .map(|(&nm, e)| e * transmittance(turbidity, zenith_rad, nm))
            .collect();
        Self {
            sun,
            disc: SunDisc::default(),
            grid,
            irradiance,
        }
    }

    /// XYZ of the disc along a unit vector, Y in cd/m^2; black outside the disc and below the horizon.
    pub fn xyz(&self, direction: DVec3) -> [f64; 3] {
        let angle = direction.angle_between(self.sun);
        if direction.y < 0.0 || angle >= self.disc.angular_radius_rad {
            return [0.0; 3];
        }
        let spectrum: Vec<f32> = self
            .irradiance
            .iter()
            .zip(self.grid.wavelengths_nm())
            .map(|(e, &nm)| (e * self.disc.radiance_per_irradiance(angle, nm)) as f32)
            .collect();
        self.grid.to_xyz(&spectrum)
    }
}

/// Transmittance to the ground at a wavelength (nm) for the sun at a zenith angle (rad); 0 from 93.8 degrees on, where the
/// air-mass formula ends. Tables are linear between their entries and 0 beyond the ends.
pub fn transmittance(turbidity: f64, sun_zenith_rad: f64, wavelength_nm: f64) -> f64 {
    let Some(m) = optical_mass(sun_zenith_rad) else {
        return 0.0;
    };
    let um = wavelength_nm * 1e-3;
    let beta = 0.04608 * turbidity - 0.04586;
    let (gases, water) = (
        interpolated(&GASES, wavelength_nm) * m,
        interpolated(&WATER, wavelength_nm) * WATER_CM * m,
    );
    let depth = 0.008735 * um.powf(-4.08) * m
        + beta * um.powf(-1.3) * m
        + interpolated(&OZONE, wavelength_nm) * OZONE_CM * m
        + 1.41 * gases / (1.0 + 118.93 * gases).powf(0.45)
        + 0.2385 * water / (1.0 + 20.07 * water).powf(0.45);
    (-depth).exp()
}

/// Relative optical mass (Kasten's formula as in the paper); `None` beyond 93.8 degrees.
fn optical_mass(sun_zenith_rad: f64) -> Option<f64> {
    let deg = sun_zenith_rad.to_degrees();
    (deg < 93.8).then(|| 1.0 / (sun_zenith_rad.cos() + 0.15 * (93.885 - deg).powf(-1.253)))
}

/// Linear interpolation of a table, 0 beyond its ends.
fn interpolated(table: &[(f64, f64)], x: f64) -> f64 {
    if x < table[0].0 || x >= table[table.len() - 1].0 {
        return 0.0;
    }
    let below = interval_by_key(table, x, |entry| entry.0);
    let ((x0, y0), (x1, y1)) = (table[below], table[below + 1]);
    lerp(y0, y1, (x - x0) / (x1 - x0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn optical_depths_match_the_formulas() {
        // Zenith, 550 nm, turbidity 2: molecules 0.008735 * 0.55^-4.08, haze 0.0463 * 0.55^-1.3, ozone 0.085 * 0.35.
        let m = 1.0 / (1.0 + 0.15 * 93.885f64.powf(-1.253));
        let want = m * (0.008735 * 11.4637 + 0.0463 * 2.17533 + 0.02975);
        let got = -transmittance(2.0, 0.0, 550.0).ln();
        assert!((got / want - 1.0).abs() < 1e-4, "{got} {want}");
    }

    #[test]
    fn air_mass_is_one_overhead_and_ends_below_the_horizon() {
        assert!((optical_mass(0.0).unwrap() - 0.9995).abs() < 1e-4);
        assert!((optical_mass(90f64.to_radians()).unwrap() - 36.5).abs() < 0.2);
        assert_eq!(optical_mass(94f64.to_radians()), None);
        assert_eq!(transmittance(2.0, 2.0, 550.0), 0.0);
    }

    #[test]
    fn tables_increase_and_end_in_zero() {
        for table in [&OZONE[..], &GASES, &WATER] {
            assert!(table.windows(2).all(|w| w[0].0 < w[1].0));
        }
        assert_eq!(interpolated(&OZONE, 299.0), 0.0);
        assert_eq!(interpolated(&OZONE, 900.0), 0.0);
        assert!((interpolated(&OZONE, 302.5) - 7.4).abs() < 1e-12);
    }
}
