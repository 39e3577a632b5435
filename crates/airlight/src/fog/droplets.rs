//! Water droplets: how fog scatters, by the diameter of its drops.

use super::matter::Matter;
use crate::optics::PhaseFunction;
use crate::spectrum::Spectrum;

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
    pub fn matter<const N: usize>(self, extinction_per_m: f64) -> Matter<N> {
        Matter {
            extinction_per_m: Spectrum::splat(extinction_per_m as f32),
            single_scattering_albedo: Spectrum::ONE,
            phase: self.phase(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
