//! Fog droplets: an analytic phase function by diameter, or published size distributions and Lorenz-Mie theory.

use super::{Constituent, ConstituentKind, DensityProfile};
use crate::control::Control;
use crate::names::{Named, named, written_by_name};
use crate::optics::PhaseFunction;
use crate::optics::mie::droplets::Drops;
use crate::optics::mie::{BulkOptics, MieError};
use crate::spectrum::SpectralCurve;

/// Diameters (micrometres) to which [`phase`] is fitted.
pub const DIAMETERS_UM: std::ops::RangeInclusive<f64> = 5.0..=50.0;

/// Analytic phase function of fog (Jendersie & d'Eon, "An approximate Mie scattering function for fog and cloud
/// rendering", SIGGRAPH 2023 Talks, eqs. 4-7): a Henyey-Greenstein function for the diffraction peak and a Draine
/// function for the rest, fitted to Lorenz-Mie theory for droplets of 5 to 50 micrometres; other diameters are clamped to
/// this range. Grey: the same at every wavelength.
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

/// Kinds of fog by typical droplet diameter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Droplets {
    /// Young radiation fog over land, smog: 5 micrometres.
    Fine,
    /// Radiation fog: 10 micrometres.
    #[default]
    Radiation,
    /// Advection fog, sea fog, cloud at the ground: 20 micrometres.
    Advection,
    /// Drizzling fog and mist of large droplets: 40 micrometres.
    Coarse,
}

named! { Droplets, "a droplet size", [
    ("fine", (Fine), "grey, of 5 um diameter"),
    ("radiation", (Radiation), "grey, of 10 um diameter"),
    ("advection", (Advection), "grey, of 20 um diameter"),
    ("coarse", (Coarse), "grey, of 40 um diameter"),
] }

impl Droplets {
    /// Typical droplet diameter, micrometres (rounded from the mode radii of Shettle & Fenn 1979, AFGL-TR-79-0214:
    /// radiation fog 2 to 4 micrometres with most volume in larger droplets, advection fog 8 to 10).
    pub fn diameter_um(self) -> f64 {
        match self {
            Self::Fine => 5.0,
            Self::Radiation => 10.0,
            Self::Advection => 20.0,
            Self::Coarse => 40.0,
        }
    }

    /// Phase function of this diameter.
    pub fn phase(self) -> PhaseFunction {
        phase(self.diameter_um())
    }
}

/// Scattering of fog droplets: analytic and grey, published size distributions by Lorenz-Mie theory (with fogbows, glories
/// and coronas), or isotropic, to compare with models that assume it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DropletKind {
    /// The analytic phase function of one diameter.
    Analytic(Droplets),
    /// Grey and isotropic, as in the height-fog note. No real droplets scatter like this.
    Isotropic,
    /// A published size distribution.
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

impl Named for DropletKind {
    const WHAT: &'static str = "a kind of droplets";

    const ALL: &'static [Self] = &[
        Self::Analytic(Droplets::Fine),
        Self::Analytic(Droplets::Radiation),
        Self::Analytic(Droplets::Advection),
        Self::Analytic(Droplets::Coarse),
        Self::Isotropic,
        Self::Published(Drops::HeavyAdvectionFog),
        Self::Published(Drops::ModerateAdvectionFog),
        Self::Published(Drops::HeavyRadiationFog),
        Self::Published(Drops::ModerateRadiationFog),
        Self::Published(Drops::CloudC1),
        Self::Published(Drops::CloudC2),
        Self::Published(Drops::CloudC3),
        Self::Published(Drops::HazeM),
        Self::Published(Drops::HazeL),
        Self::Published(Drops::HazeH),
        Self::Published(Drops::Rain),
    ];
    /// Mist is moderate radiation fog.
    const ALIASES: &'static [(&'static str, Self)] =
        &[("mist", Self::Published(Drops::ModerateRadiationFog))];

    fn name(self) -> &'static str {
        match self {
            Self::Analytic(droplets) => droplets.name(),
            Self::Isotropic => "isotropic",
            Self::Published(drops) => drops.name(),
        }
    }

    fn summary(self) -> &'static str {
        match self {
            Self::Analytic(droplets) => droplets.summary(),
            Self::Isotropic => {
                "grey and isotropic, as in published models; no real droplets scatter like this"
            }
            Self::Published(drops) => drops.summary(),
        }
    }
}

written_by_name!(DropletKind);

impl Constituent {
    /// A layer of fog with this extinction coefficient at 550 nm (1/m; see
    /// [`visibility::extinction_per_m`](super::visibility::extinction_per_m)), droplets and density profile. Published
    /// droplets are computed by Lorenz-Mie theory at `wavelengths_nm` (increasing) and interpolated between them; analytic
    /// droplets are grey and need no wavelengths.
    ///
    /// # Errors
    /// [`MieError`] for wavelengths that are not finite, positive and increasing.
    pub fn fog(
        extinction_per_m: f64,
        droplets: DropletKind,
        density: DensityProfile,
        wavelengths_nm: &[f64],
    ) -> Result<Self, MieError> {
        let control = Control::default();
        Self::fog_with(extinction_per_m, droplets, density, wavelengths_nm, control)
    }

    /// As [`Constituent::fog`], with cancellation of the computation of published droplets.
    ///
    /// # Errors
    /// As [`Constituent::fog`], and if the caller cancelled.
    pub fn fog_with(
        extinction_per_m: f64,
        droplets: DropletKind,
        density: DensityProfile,
        wavelengths_nm: &[f64],
        control: Control<'_>,
    ) -> Result<Self, MieError> {
        let grey = |phase| {
            let scattering = SpectralCurve::Constant(extinction_per_m);
            (scattering, SpectralCurve::Constant(0.0), phase)
        };
        let (scattering_per_m, absorption_per_m, phase) = match droplets {
            DropletKind::Analytic(kind) => grey(kind.phase()),
            DropletKind::Isotropic => grey(PhaseFunction::Isotropic),
            DropletKind::Published(drops) => {
                let table = drops.table_with(wavelengths_nm, control)?;
                let number = extinction_per_m / table.green.extinction_um2();
                let curve = |of: &dyn Fn(&BulkOptics) -> f64| {
                    let values = table.bulk.iter().map(|bulk| number * of(bulk)).collect();
                    SpectralCurve::table(wavelengths_nm.to_vec(), values)
                        .map_err(|_| MieError::Wavelength(f64::NAN))
                };
                (
                    curve(&|bulk| bulk.scattering_um2)?,
                    curve(&|bulk| bulk.absorption_um2)?,
                    PhaseFunction::Tabulated(table.phase.clone()),
                )
            }
        };
        Ok(Self {
            kind: ConstituentKind::Fog,
            density,
            scattering_per_m,
            absorption_per_m,
            phase,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique() {
        let all = DropletKind::ALL;
        assert_eq!(all.len(), Droplets::ALL.len() + 1 + Drops::ALL.len());
        for &kind in all {
            assert_eq!(kind.to_string().parse(), Ok(kind));
        }
        assert_eq!(
            "mist".parse(),
            Ok(DropletKind::Published(Drops::ModerateRadiationFog))
        );
    }

    /// Lorenz-Mie theory gives large water droplets a mean cosine of 0.85 to 0.88 in the visible (Hu & Stamnes 1993).
    #[test]
    fn the_mean_cosine_is_that_of_water_droplets() {
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
