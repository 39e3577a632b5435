//! Water droplets: how fog scatters, by the diameter of its drops or as Lorenz-Mie theory says of published ones.

use super::layer::Medium;
use crate::optics::PhaseFunction;
use crate::optics::mie::droplets::Drops;
use crate::optics::mie::{BulkOptics, DropTable, MieError};
use crate::spectrum::rgb::DOMINANT_NM;
use crate::spectrum::{RgbSpace, Spectrum};

/// The diameters (micrometres) for which [`phase`] was fitted.
pub const DIAMETERS_UM: std::ops::RangeInclusive<f64> = 5.0..=50.0;

/// The analytic phase function of fog (Jendersie & d'Eon, "An approximate Mie scattering function for fog and cloud
/// rendering", SIGGRAPH 2023 Talks, eqs. 4-7): a Henyey-Greenstein function for the diffraction peak and a Draine
/// function for the rest, fitted to Lorenz-Mie theory for droplets of 5 to 50 micrometres; diameters outside are held at
/// the ends. Grey: the same at every wavelength.
pub fn phase(diameter_um: f64) -> PhaseFunction {
    let d = diameter_um.clamp(*DIAMETERS_UM.start(), *DIAMETERS_UM.end());
    let peak = (-0.0990567 / (d - 1.67154)).exp();
    let wide = (-2.20679 / (d + 3.91029) - 0.428934).exp();
    let alpha = (3.62489 - 8.29288 / (d + 5.52825)).exp();
    let weight = (-0.599085 / (d - 0.641583) - 0.665888).exp();
    PhaseFunction::Mixture(vec![
        (1.0 - weight, PhaseFunction::HenyeyGreenstein { g: peak }),
        (weight, PhaseFunction::Draine { g: wide, alpha }),
    ])
}

/// Kinds of fog by the typical diameter of its drops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Droplets {
    /// Young radiation fog over land, smog: 5 micrometres.
    Fine,
    /// Radiation fog: 10 micrometres.
    #[default]
    Radiation,
    /// Advection fog, sea fog, cloud at the ground: 20 micrometres.
    Advection,
    /// Drizzling fog and mist of large drops: 40 micrometres.
    Coarse,
}

impl Droplets {
    /// All kinds with their names.
    pub const ALL: [(&'static str, Self); 4] = [
        ("fine", Self::Fine),
        ("radiation", Self::Radiation),
        ("advection", Self::Advection),
        ("coarse", Self::Coarse),
    ];

    /// Typical diameter of a drop, micrometres (rounded from the mode radii of Shettle & Fenn 1979, AFGL-TR-79-0214:
    /// radiation fog 2 to 4 micrometres with volume in larger drops, advection fog 8 to 10).
    pub fn diameter_um(self) -> f64 {
        match self {
            Self::Fine => 5.0,
            Self::Radiation => 10.0,
            Self::Advection => 20.0,
            Self::Coarse => 40.0,
        }
    }

    /// Its phase function.
    pub fn phase(self) -> PhaseFunction {
        phase(self.diameter_um())
    }

    /// Fog of such drops: an extinction (1/m) the same at all wavelengths, and no absorption.
    pub fn medium<const N: usize>(self, extinction_per_m: f64) -> Medium<N> {
        Medium {
            extinction_per_m: Spectrum::splat(extinction_per_m as f32),
            single_scattering_albedo: Spectrum::ONE,
            phase: self.phase(),
        }
    }
}

/// Drops of any kind, by name: analytic and grey, or published sizes by Lorenz-Mie theory, with bows, glories and coronas; or
/// none, to compare with models of fog that scatters equally in all directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DropletKind {
    /// The analytic phase function of one diameter.
    Analytic(Droplets),
    /// Grey, scattering equally in all directions, as the fog note has it. No drops do.
    Isotropic,
    /// Published sizes.
    Published(Drops),
}

impl Default for DropletKind {
    fn default() -> Self {
        Self::Analytic(Droplets::default())
    }
}

impl From<Droplets> for DropletKind {
    fn from(droplets: Droplets) -> Self {
        Self::Analytic(droplets)
    }
}

impl From<Drops> for DropletKind {
    fn from(drops: Drops) -> Self {
        Self::Published(drops)
    }
}

impl DropletKind {
    /// All kinds with their names.
    pub fn all() -> impl Iterator<Item = (&'static str, Self)> {
        let analytic = Droplets::ALL.map(|(name, kind)| (name, kind.into()));
        let published = Drops::ALL.map(|(name, kind)| (name, kind.into()));
        let isotropic = [("isotropic", Self::Isotropic)];
        analytic.into_iter().chain(isotropic).chain(published)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::all()
            .find(|(_, kind)| *kind == self)
            .map_or("", |(name, _)| name)
    }

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

    #[test]
    fn every_kind_has_a_name_of_its_own() {
        let names: std::collections::BTreeSet<_> =
            DropletKind::all().map(|(name, _)| name).collect();
        assert_eq!(names.len(), DropletKind::all().count());
        for (name, kind) in DropletKind::all() {
            assert_eq!(kind.name(), name);
        }
    }

    /// Lorenz-Mie theory gives large water drops a mean cosine of 0.85 to 0.88 in the visible (Hu & Stamnes 1993).
    #[test]
    fn fog_scatters_forward_as_water_drops_do() {
        let mut before = 0.0;
        for d in [5.0, 10.0, 20.0, 50.0] {
            let phase = phase(d);
            phase.validate().unwrap();
            let g = phase.asymmetry(550.0);
            assert!((0.80..0.90).contains(&g) && g > before, "{d} um: {g}");
            before = g;
        }
        assert_eq!(phase(1.0), phase(5.0));
    }
}
