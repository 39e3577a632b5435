//! Published size distributions of fog, cloud, haze and rain drops.
//!
//! - D. Deirmendjian, *Electromagnetic Scattering on Spherical Polydispersions*, Elsevier 1969, table 4: hazes M, L, H; clouds
//!   C.1, C.2, C.3.
//! - E. P. Shettle & R. W. Fenn, *Models for the Aerosols of the Lower Atmosphere and the Effects of Humidity Variations on
//!   Their Optical Properties*, AFGL-TR-79-0214, 1979, table 5: heavy and moderate fogs.
//! - G. Feingold & Z. Levin, *The lognormal fit to raindrop spectra from frontal convective clouds in Israel*, J. Climate
//!   Appl. Meteor. 25, 1346, 1986: rain of 1 mm an hour.
//!
//! All but the rain are modified gamma distributions, `n(r) ~ r^alpha exp(-(alpha / gamma) (r / r_c)^gamma)`.

use super::SizeDistribution;
use crate::names::named;

/// A published size distribution of drops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Drops {
    /// Heavy advection fog, Shettle & Fenn's fog 1: mode radius 10 micrometres, 0.37 g of water per cubic metre.
    HeavyAdvectionFog,
    /// Moderate advection fog, Shettle & Fenn's fog 2: mode radius 8 micrometres, 0.19 g/m^3.
    ModerateAdvectionFog,
    /// Heavy radiation fog, Shettle & Fenn's fog 3: mode radius 4 micrometres, 0.06 g/m^3.
    HeavyRadiationFog,
    /// Moderate radiation fog and mist, Shettle & Fenn's fog 4: mode radius 2 micrometres, 0.02 g/m^3.
    ModerateRadiationFog,
    /// Fair-weather cumulus, Deirmendjian's cloud C.1: mode radius 4 micrometres.
    CloudC1,
    /// Cloud with coronas, Deirmendjian's cloud C.2: mode radius 4 micrometres, narrow.
    CloudC2,
    /// Mother-of-pearl cloud, Deirmendjian's cloud C.3: mode radius 2 micrometres, narrow.
    CloudC3,
    /// Maritime and coastal haze, Deirmendjian's haze M: mode radius 0.05 micrometres.
    HazeM,
    /// Continental haze, Deirmendjian's haze L: mode radius 0.07 micrometres.
    HazeL,
    /// Stratospheric haze, Deirmendjian's haze H: mode radius 0.1 micrometres.
    HazeH,
    /// Rain of 1 mm per hour, Feingold & Levin: median radius 360 micrometres.
    Rain,
}

named! { Drops, "a published drop distribution", [
    ("heavy-advection-fog", (HeavyAdvectionFog), "Lorenz-Mie theory, mode radius 10 um, effective radius 20 um (Shettle & Fenn 1979, fog 1)"),
    ("moderate-advection-fog", (ModerateAdvectionFog), "Lorenz-Mie theory, mode radius 8 um, effective radius 16 um (Shettle & Fenn 1979, fog 2)"),
    ("heavy-radiation-fog", (HeavyRadiationFog), "Lorenz-Mie theory, mode radius 4 um, effective radius 6 um (Shettle & Fenn 1979, fog 3)"),
    ("moderate-radiation-fog", (ModerateRadiationFog), "Lorenz-Mie theory, mode radius 2 um, effective radius 3 um (Shettle & Fenn 1979, fog 4)"),
    ("cloud-c1", (CloudC1), "Lorenz-Mie theory, mode radius 4 um, effective radius 6 um (Deirmendjian 1969, cloud C.1)"),
    ("cloud-c2", (CloudC2), "Lorenz-Mie theory, mode radius 4 um, effective radius 4.3 um, narrow (Deirmendjian 1969, cloud C.2)"),
    ("cloud-c3", (CloudC3), "Lorenz-Mie theory, mode radius 2 um, effective radius 2.2 um, narrow (Deirmendjian 1969, cloud C.3)"),
    ("haze-m", (HazeM), "Lorenz-Mie theory, mode radius 0.05 um, effective radius 0.9 um (Deirmendjian 1969, haze M)"),
    ("haze-l", (HazeL), "Lorenz-Mie theory, mode radius 0.07 um, effective radius 0.48 um (Deirmendjian 1969, haze L)"),
    ("haze-h", (HazeH), "Lorenz-Mie theory, mode radius 0.1 um, effective radius 0.25 um (Deirmendjian 1969, haze H)"),
    ("rain", (Rain), "Lorenz-Mie theory, median radius 360 um, effective radius 496 um (Feingold & Levin 1986)"),
] }

impl Drops {
    /// The size distribution.
    pub fn sizes(self) -> SizeDistribution {
        let (alpha, gamma, mode_radius_um) = match self {
            Self::HeavyAdvectionFog => (3.0, 1.0, 10.0),
            Self::ModerateAdvectionFog => (3.0, 1.0, 8.0),
            Self::HeavyRadiationFog => (6.0, 1.0, 4.0),
            Self::ModerateRadiationFog => (6.0, 1.0, 2.0),
            Self::CloudC1 => (6.0, 1.0, 4.0),
            Self::CloudC2 => (8.0, 3.0, 4.0),
            Self::CloudC3 => (8.0, 3.0, 2.0),
            Self::HazeM => (1.0, 0.5, 0.05),
            Self::HazeL => (2.0, 0.5, 0.07),
            Self::HazeH => (2.0, 1.0, 0.1),
            Self::Rain => return SizeDistribution::log_normal(360.0, 1.43),
        };
        SizeDistribution::ModifiedGamma {
            alpha,
            gamma,
            mode_radius_um,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::names::Named;
    use crate::optics::mie::{MieError, Particles};

    /// Table 5 of Shettle & Fenn: drops per cubic centimetre, grams of water per cubic metre, and the parameter
    /// `b = alpha / r_c`; Deirmendjian's `b = alpha / (gamma r_c^gamma)`.
    #[test]
    fn distributions_have_the_published_water_content() {
        for (drops, number, grams, b) in [
            (Drops::HeavyAdvectionFog, 20.0, 0.37, 0.3),
            (Drops::ModerateAdvectionFog, 20.0, 0.19, 0.375),
            (Drops::HeavyRadiationFog, 100.0, 0.06, 1.5),
            (Drops::ModerateRadiationFog, 200.0, 0.02, 3.0),
            (Drops::CloudC1, 100.0, 0.063, 1.5),
            (Drops::CloudC2, 100.0, 0.030, 1.0 / 24.0),
            (Drops::CloudC3, 100.0, 0.0038, 1.0 / 3.0),
        ] {
            let SizeDistribution::ModifiedGamma {
                alpha,
                gamma,
                mode_radius_um,
            } = drops.sizes()
            else {
                panic!("{drops:?}")
            };
            assert!((alpha / (gamma * mode_radius_um.powf(gamma)) / b - 1.0).abs() < 1e-12);
            let got = 1e-6 * number * drops.sizes().mean_volume_um3();
            let rounding = if grams < 0.025 { 0.25 } else { 0.06 };
            assert!((got / grams - 1.0).abs() < rounding, "{drops:?}: {got}");
        }
    }

    #[test]
    fn summaries_state_the_effective_radius() {
        for drops in Drops::ALL {
            let (_, after) = drops.summary().split_once("effective radius ").unwrap();
            let stated: f64 = after.split(' ').next().unwrap().parse().unwrap();
            let computed = drops.sizes().effective_radius_um();
            assert!(
                (stated / computed - 1.0).abs() < 0.03,
                "{drops}: {computed}"
            );
        }
    }

    /// The extinction efficiency of large drops is 2: heavy advection fog of 0.37 g/m^3 has a visibility of 100 m.
    #[test]
    fn extinction_of_fog_follows_its_water_content() -> Result<(), MieError> {
        let fog = Particles::water(Drops::HeavyAdvectionFog.sizes())?;
        let bulk = fog.bulk(550.0)?;
        let by_mass = bulk.extinction_per_m_by_mass(0.3723, 1.0);
        let by_number = bulk.extinction_per_m(20.0);
        assert!(
            (by_mass / by_number - 1.0).abs() < 1e-3,
            "{by_mass} {by_number}"
        );
        // 3 / (2 r_eff) for each g/m^3, plus a few percent from edge effects.
        let simple = 1.5 * 0.3723 / fog.sizes().effective_radius_um();
        assert!(
            (1.02..1.06).contains(&(by_mass / simple)),
            "{by_mass} {simple}"
        );
        assert!(bulk.single_scattering_albedo() > 0.999_99);
        Ok(())
    }
}
