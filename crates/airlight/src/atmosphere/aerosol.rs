//! Haze: an aerosol after Angstrom's law, set by optical depth, turbidity or visibility.

use super::visibility::{self, Contrast};
use super::{ClearAir, Constituent, ConstituentKind, DensityProfile};
use crate::optics::{PhaseError, PhaseFunction};
use crate::spectrum::{SampledCurve, SpectralCurve};

/// The wavelength that loads are stated at, nm.
pub const REFERENCE_NM: f64 = 550.0;

/// How much aerosol there is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AerosolLoad {
    /// Vertical optical depth of the aerosol at 550 nm.
    OpticalDepth550(f64),
    /// Turbidity at 550 nm: the vertical optical depth of molecules and aerosol over that of the molecules
    /// (the definition of Preetham, Shirley & Smits, SIGGRAPH 1999, at one wavelength). At least 1.
    ///
    /// `tau_aerosol = (T - 1) tau_molecules`
    Turbidity(f64),
    /// Visibility at the ground, at 550 nm.
    ///
    /// `extinction_aerosol = ln(1 / contrast) / range - extinction_molecules`
    Visibility {
        /// How far one sees, m.
        range_m: f64,
        /// The contrast that is left there: 5 % makes it the meteorological optical range.
        contrast: Contrast,
    },
}

/// An aerosol whose extinction follows `lambda^-exponent`.
#[derive(Clone, Debug, PartialEq)]
pub struct AngstromAerosol {
    /// How much.
    pub load: AerosolLoad,
    /// Angstrom exponent of the extinction.
    pub angstrom_exponent: f64,
    /// Scattering over extinction, by wavelength.
    pub single_scattering_albedo: SpectralCurve,
    /// Where it is.
    pub density: DensityProfile,
    /// Where it scatters to.
    pub phase: PhaseFunction,
}

/// Why numbers do not make an aerosol.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AerosolError {
    /// The optical depth is negative or not finite.
    #[error("the aerosol optical depth at 550 nm must be finite and not negative, got {0}")]
    OpticalDepth(f64),
    /// The turbidity is below 1.
    #[error("turbidity must be finite and at least 1 (1 is air without aerosol), got {0}")]
    Turbidity(f64),
    /// The visibility is not positive, or farther than clear air allows.
    #[error(
        "visibility must lie above 0 and not above {clearest_m:.0} m, that of air without aerosol, got {got_m} m"
    )]
    Visibility {
        /// What was asked for, m.
        got_m: f64,
        /// What air without aerosol has, m.
        clearest_m: f64,
    },
    /// The Angstrom exponent is out of range.
    #[error("the Angstrom exponent must lie between -4 and 8, got {0}")]
    AngstromExponent(f64),
    /// The single-scattering albedo is out of range.
    #[error("the single-scattering albedo must lie in [0, 1], got {0}")]
    SingleScatteringAlbedo(f64),
    /// The profile holds nothing between ground and top.
    #[error(
        "the aerosol's density profile is empty between the ground and the top of the atmosphere"
    )]
    EmptyProfile,
    /// The phase function is refused.
    #[error("{0}")]
    Phase(#[from] PhaseError),
}

impl AerosolLoad {
    /// Vertical optical depth at 550 nm; `column_m` is the integral of the relative density from the ground up, over
    /// its value at the ground (see [`AngstromAerosol::constituent`]).
    ///
    /// # Errors
    /// [`AerosolError`] where the load is out of its domain.
    pub fn optical_depth_550(self, clear: ClearAir, column_m: f64) -> Result<f64, AerosolError> {
        match self {
            Self::OpticalDepth550(depth) if depth.is_finite() && depth >= 0.0 => Ok(depth),
            Self::OpticalDepth550(depth) => Err(AerosolError::OpticalDepth(depth)),
            Self::Turbidity(turbidity) if turbidity.is_finite() && turbidity >= 1.0 => {
                Ok((turbidity - 1.0) * clear.optical_depth_550)
            }
            Self::Turbidity(turbidity) => Err(AerosolError::Turbidity(turbidity)),
            Self::Visibility { range_m, contrast } => {
                let clearest_m = visibility::visibility_m(clear.ground_extinction_per_m, contrast);
                let whole_per_m = visibility::extinction_per_m(range_m, contrast);
                match range_m > 0.0 && range_m <= clearest_m {
                    true => Ok((whole_per_m - clear.ground_extinction_per_m).max(0.0) * column_m),
                    false => Err(AerosolError::Visibility {
                        got_m: range_m,
                        clearest_m,
                    }),
                }
            }
        }
    }
}

/// Turbidity at 550 nm of air with this vertical aerosol optical depth.
pub fn turbidity_of_optical_depth(aerosol_optical_depth_550: f64, clear: ClearAir) -> f64 {
    1.0 + aerosol_optical_depth_550 / clear.optical_depth_550
}

/// Meteorological optical range (m, 5 % contrast, 550 nm) of air with this aerosol extinction at the ground, m^-1.
pub fn visibility_of_extinction_m(aerosol_extinction_550_per_m: f64, clear: ClearAir) -> f64 {
    let whole_per_m = aerosol_extinction_550_per_m + clear.ground_extinction_per_m;
    visibility::visibility_m(whole_per_m, Contrast::FivePercent)
}

impl AngstromAerosol {
    /// The aerosol as a constituent named "aerosol" of an atmosphere between two altitudes, m.
    ///
    /// # Errors
    /// [`AerosolError`] where a number is out of its domain.
    pub fn constituent(
        &self,
        clear: ClearAir,
        ground_altitude_m: f64,
        top_altitude_m: f64,
    ) -> Result<Constituent, AerosolError> {
        let exponent = self.angstrom_exponent;
        if !(-4.0..=8.0).contains(&exponent) {
            return Err(AerosolError::AngstromExponent(exponent));
        }
        self.phase.validate()?;
        let extinction_per_m = extinction_at_density_1(
            self.load,
            &self.density,
            clear,
            ground_altitude_m,
            top_altitude_m,
        )?;
        let extinction = SpectralCurve::PowerLaw {
            value_at_550_nm: extinction_per_m,
            exponent,
        };
        let (scattering_per_m, absorption_per_m) = self.split(extinction)?;
        Ok(Constituent {
            kind: ConstituentKind::Aerosol,
            density: self.density.clone(),
            scattering_per_m,
            absorption_per_m,
            phase: self.phase.clone(),
        })
    }

    /// Scattering and absorption: exact for a constant albedo, else sampled every 2 nm from 250 to 1100 nm.
    fn split(
        &self,
        extinction: SpectralCurve,
    ) -> Result<(SpectralCurve, SpectralCurve), AerosolError> {
        let check = |albedo: f64| match (0.0..=1.0).contains(&albedo) {
            true => Ok(albedo),
            false => Err(AerosolError::SingleScatteringAlbedo(albedo)),
        };
        if let SpectralCurve::Constant(albedo) = self.single_scattering_albedo {
            let albedo = check(albedo)?;
            return Ok((
                extinction.clone().scaled(albedo),
                extinction.scaled(1.0 - albedo),
            ));
        }
        let wavelengths: Vec<f64> = (125..=550).map(|i| 2.0 * f64::from(i)).collect();
        let mut scattering = Vec::with_capacity(wavelengths.len());
        let mut absorption = Vec::with_capacity(wavelengths.len());
        for &nm in &wavelengths {
            let albedo = check(self.single_scattering_albedo.at(nm))?;
            scattering.push(albedo * extinction.at(nm));
            absorption.push((1.0 - albedo) * extinction.at(nm));
        }
        let table =
            |values| SampledCurve::new(wavelengths.clone(), values).map(SpectralCurve::Table);
        match (table(scattering), table(absorption)) {
            (Ok(scattering), Ok(absorption)) => Ok((scattering, absorption)),
            _ => Err(AerosolError::SingleScatteringAlbedo(f64::NAN)),
        }
    }
}

/// Extinction (1/m) at 550 nm and relative density 1 of so much aerosol in a profile between two altitudes, m.
pub(super) fn extinction_at_density_1(
    load: AerosolLoad,
    density: &DensityProfile,
    clear: ClearAir,
    ground_altitude_m: f64,
    top_altitude_m: f64,
) -> Result<f64, AerosolError> {
    let column_m = density.column_m(ground_altitude_m, top_altitude_m);
    if !(column_m.is_finite() && column_m > 0.0) {
        return Err(AerosolError::EmptyProfile);
    }
    let at_ground = density.at(ground_altitude_m);
    let depth = match load {
        // A layer aloft has no extinction at the ground that visibility could set.
        AerosolLoad::Visibility { .. } if at_ground <= 0.0 => {
            return Err(AerosolError::EmptyProfile);
        }
        load => load.optical_depth_550(clear, column_m / at_ground)?,
    };
    Ok(depth / column_m)
}

/// The phase function of a continental aerosol: three Henyey-Greenstein lobes fitted to the mean of five AERONET
/// almucantar inversions (level 1.5, version 2) at Egbert, Ontario, on 27 May 2013 (principal investigators N. O'Neill,
/// I. Abboud, V. Fioletov), 442 and 675 nm together; mean cosine 0.634, 11 % root mean square in `ln p` over all angles.
pub fn continental_phase() -> PhaseFunction {
    let lobe = |g| PhaseFunction::HenyeyGreenstein { g };
    PhaseFunction::Mixture(vec![
        (0.085, lobe(0.945)),
        (0.905, lobe(0.62)),
        (0.01, lobe(-0.73)),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::gases;

    const GROUND: f64 = 0.0;
    const TOP: f64 = 100e3;

    fn seen(range_m: f64) -> AerosolLoad {
        AerosolLoad::Visibility {
            range_m,
            contrast: Contrast::FivePercent,
        }
    }

    fn clear() -> ClearAir {
        let air = gases::air(101_325.0);
        ClearAir {
            optical_depth_550: air.optical_depth(GROUND, TOP, 550.0),
            ground_extinction_per_m: air.extinction_per_m(550.0),
        }
    }

    fn aerosol(load: AerosolLoad) -> AngstromAerosol {
        AngstromAerosol {
            load,
            angstrom_exponent: 1.3,
            single_scattering_albedo: SpectralCurve::Constant(0.9),
            density: DensityProfile::exponential(1.5e3),
            phase: continental_phase(),
        }
    }

    #[test]
    fn each_load_gives_what_it_says() {
        let build = |load| aerosol(load).constituent(clear(), GROUND, TOP).unwrap();
        let by_depth = build(AerosolLoad::OpticalDepth550(0.12));
        assert!((by_depth.optical_depth(GROUND, TOP, 550.0) / 0.12 - 1.0).abs() < 1e-12);
        let ratio =
            by_depth.optical_depth(GROUND, TOP, 440.0) / by_depth.optical_depth(GROUND, TOP, 880.0);
        assert!((ratio / 2f64.powf(1.3) - 1.0).abs() < 1e-12);
        assert!(
            (by_depth.scattering_per_m.at(470.0) / by_depth.extinction_per_m(470.0) - 0.9).abs()
                < 1e-12
        );

        let by_turbidity = build(AerosolLoad::Turbidity(3.0));
        let depth = by_turbidity.optical_depth(GROUND, TOP, 550.0);
        assert!((depth / (2.0 * clear().optical_depth_550) - 1.0).abs() < 1e-12);
        assert!((turbidity_of_optical_depth(depth, clear()) - 3.0).abs() < 1e-12);

        let by_visibility = build(seen(23e3));
        let total = by_visibility.extinction_per_m(550.0) + clear().ground_extinction_per_m;
        assert!(((-total * 23e3).exp() / 0.05 - 1.0).abs() < 1e-12);
        let range = visibility_of_extinction_m(by_visibility.extinction_per_m(550.0), clear());
        assert!((range / 23e3 - 1.0).abs() < 1e-12);
        // Clear air is seen through for some 260 km.
        let clearest = visibility_of_extinction_m(0.0, clear());
        assert!((255e3..265e3).contains(&clearest), "{clearest}");
        let by_contrast = build(AerosolLoad::Visibility {
            range_m: 23e3,
            contrast: Contrast::TwoPercent,
        });
        let total = by_contrast.extinction_per_m(550.0) + clear().ground_extinction_per_m;
        assert!(((-total * 23e3).exp() / 0.02 - 1.0).abs() < 1e-12);
        let none = build(seen(clearest));
        assert!(none.extinction_per_m(550.0) < 1e-15);
    }

    #[test]
    fn a_spectral_albedo_splits_the_extinction() {
        let mut dust = aerosol(AerosolLoad::OpticalDepth550(0.5));
        dust.single_scattering_albedo =
            SpectralCurve::table(vec![400.0, 700.0], vec![0.7, 0.97]).unwrap();
        let dust = dust.constituent(clear(), GROUND, TOP).unwrap();
        for (nm, albedo) in [(400.0, 0.7), (550.0, 0.835), (800.0, 0.97)] {
            assert!(
                (dust.scattering_per_m.at(nm) / dust.extinction_per_m(nm) - albedo).abs() < 1e-9
            );
        }
    }

    #[test]
    fn bad_numbers_are_refused() {
        let refuse = |a: &AngstromAerosol| a.constituent(clear(), GROUND, TOP).unwrap_err();
        assert_eq!(
            refuse(&aerosol(AerosolLoad::OpticalDepth550(-0.1))),
            AerosolError::OpticalDepth(-0.1)
        );
        assert_eq!(
            refuse(&aerosol(AerosolLoad::Turbidity(0.9))),
            AerosolError::Turbidity(0.9)
        );
        for range in [0.0, -5.0, f64::NAN, 1e7] {
            assert!(matches!(
                refuse(&aerosol(seen(range))),
                AerosolError::Visibility { .. }
            ));
        }
        let mut bad = aerosol(AerosolLoad::OpticalDepth550(0.1));
        bad.single_scattering_albedo = SpectralCurve::Constant(1.1);
        assert_eq!(refuse(&bad), AerosolError::SingleScatteringAlbedo(1.1));
        bad.single_scattering_albedo =
            SpectralCurve::table(vec![400.0, 700.0], vec![0.9, 1.2]).unwrap();
        assert!(matches!(
            refuse(&bad),
            AerosolError::SingleScatteringAlbedo(_)
        ));
        bad.angstrom_exponent = f64::NAN;
        assert!(matches!(refuse(&bad), AerosolError::AngstromExponent(_)));
        let mut aloft = aerosol(seen(20e3));
        aloft.density = DensityProfile::Layer {
            bottom_m: 2e3,
            top_m: 3e3,
        };
        assert_eq!(refuse(&aloft), AerosolError::EmptyProfile);
    }
}
