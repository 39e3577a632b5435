//! Fog of water droplets in N lanes.

pub use crate::atmosphere::droplets::*;

use super::layer::Medium;
use crate::optics::PhaseFunction;
use crate::optics::mie::{BulkOptics, DropTable, MieError};
use crate::spectrum::rgb::DOMINANT_NM;
use crate::spectrum::{RgbSpace, Spectrum};

impl Droplets {
    /// Fog of such drops: an extinction (1/m) the same at all wavelengths, and no absorption.
    pub fn medium<const N: usize>(self, extinction_per_m: f64) -> Medium<N> {
        Medium {
            extinction_per_m: Spectrum::splat(extinction_per_m as f32),
            single_scattering_albedo: Spectrum::ONE,
            phase: self.phase(),
        }
    }
}

impl DropletKind {
    /// Fog of such drops at wavelengths (nm, in any order), by its extinction at 550 nm (1/m), the wavelength that
    /// visibility is meant at. Published drops take and absorb at each wavelength as they do; their tables are built once
    /// ([`Drops::table`]).
    ///
    /// # Errors
    /// [`MieError`] for wavelengths that are none.
    pub fn at_wavelengths<const N: usize>(
        self,
        extinction_per_m: f64,
        wavelengths_nm: &[f64; N],
    ) -> Result<Medium<N>, MieError> {
        let drops = match self {
            Self::Analytic(droplets) => return Ok(droplets.medium(extinction_per_m)),
            Self::Isotropic => return Ok(isotropic(extinction_per_m)),
            Self::Published(drops) => drops,
        };
        let mut rising = wavelengths_nm.to_vec();
        rising.sort_by(f64::total_cmp);
        rising.dedup();
        let table = drops.table(&rising)?;
        Ok(medium(&table, extinction_per_m, |lane| {
            wavelengths_nm[lane]
        }))
    }

    /// The same in red, green and blue: phase functions by channel are taken at [`DOMINANT_NM`].
    ///
    /// # Errors
    /// As [`DropletKind::at_wavelengths`].
    pub fn in_rgb(self, extinction_per_m: f64, space: RgbSpace) -> Result<Medium<3>, MieError> {
        match self {
            Self::Analytic(droplets) => Ok(droplets.medium(extinction_per_m)),
            Self::Isotropic => Ok(isotropic(extinction_per_m)),
            Self::Published(drops) => {
                let table = drops.rgb_table(space)?;
                Ok(medium(&table, extinction_per_m, |lane| DOMINANT_NM[lane]))
            }
        }
    }
}

/// Fog that scatters equally in all directions, and does not absorb.
fn isotropic<const N: usize>(extinction_per_m: f64) -> Medium<N> {
    Medium {
        extinction_per_m: Spectrum::splat(extinction_per_m as f32),
        single_scattering_albedo: Spectrum::ONE,
        phase: PhaseFunction::Isotropic,
    }
}

/// Drops of a table, by their extinction at 550 nm (1/m), with the wavelength of each lane, which the table has.
fn medium<const N: usize>(
    table: &DropTable,
    extinction_per_m: f64,
    wavelength_nm: impl Fn(usize) -> f64,
) -> Medium<N> {
    let number = extinction_per_m / table.green.extinction_um2();
    let lanes = |of: &dyn Fn(&BulkOptics) -> f64| {
        Spectrum::from_fn(|lane| {
            let nm = wavelength_nm(lane);
            let at = table.bulk.partition_point(|bulk| bulk.wavelength_nm < nm);
            of(&table.bulk[at.min(table.bulk.len() - 1)]) as f32
        })
    };
    Medium {
        extinction_per_m: lanes(&|bulk| number * bulk.extinction_um2()),
        single_scattering_albedo: lanes(&BulkOptics::single_scattering_albedo),
        phase: PhaseFunction::Tabulated(table.phase.clone()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::mie::droplets::Drops;

    /// Mist, whose table is soon built: visibility means 550 nm; in RGB it is the mean of what the wavelengths say.
    #[test]
    fn published_drops_take_light_by_wavelength() {
        let mist = DropletKind::from(Drops::HazeH);
        let green = mist.at_wavelengths(0.01, &[550.0]).unwrap();
        assert!((green.extinction_per_m[0] / 0.01 - 1.0).abs() < 1e-6);
        let medium = mist.at_wavelengths(0.01, &[650.0, 450.0, 450.0]).unwrap();
        medium.validate().unwrap();
        let [red, blue, again] = medium.extinction_per_m.0;
        assert!(
            red < 0.0095 && blue > 0.0105 && again == blue,
            "{red} {blue}"
        );
        assert!(medium.single_scattering_albedo[0] > 0.9999);
        let rgb = mist.in_rgb(0.01, RgbSpace::Srgb).unwrap();
        rgb.validate().unwrap();
        let [red, green, blue] = rgb.extinction_per_m.0;
        assert!(red < green && green < blue, "{red} {green} {blue}");
        assert!((green / 0.01 - 1.0).abs() < 0.02, "{green}");
        // Red and blue through the eyes of sRGB lie within what the wavelengths of their bands scatter.
        let at = |nm: f64, mu: f64| {
            let single = mist.at_wavelengths(0.01, &[nm]).unwrap();
            single.phase.evaluate(mu, nm)
        };
        for mu in [-1.0, -0.5, 0.5, 0.99] {
            let p = rgb.phase_lanes(mu, &DOMINANT_NM);
            for (lane, [from, to]) in [(0, [570.0, 680.0]), (2, [420.0, 490.0])] {
                let ends = [at(from, mu), at(to, mu)];
                let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                let got = f64::from(p[lane]);
                assert!(
                    got > 0.98 * low && got < 1.02 * high,
                    "{mu} {lane}: {got} {ends:?}"
                );
            }
        }
        assert!(mist.at_wavelengths(0.01, &[f64::NAN]).is_err());
    }
}
