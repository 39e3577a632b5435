//! Haze: an aerosol that follows Angstrom's law, with an amount given by optical depth, turbidity or visibility.

use super::visibility::{self, Contrast};
use super::{ClearAir, Constituent, ConstituentKind, DensityProfile};
use crate::optics::{PhaseError, PhaseFunction};
use crate::spectrum::{SampledCurve, SpectralCurve};

/// Wavelength of all aerosol loads, nm.
pub const REFERENCE_NM: f64 = 550.0;

/// Amount of aerosol.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
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
        /// The visibility, m.
        range_m: f64,
        /// Contrast that remains at this distance; 5 % defines the meteorological optical range.
        contrast: Contrast,
    },
}

/// An aerosol whose extinction follows `lambda^-exponent`.
#[derive(Clone, Debug, PartialEq)]
pub struct AngstromAerosol {
    /// Amount, at 550 nm.
    pub load: AerosolLoad,
    /// Angstrom exponent of the extinction.
    pub angstrom_exponent: f64,
    /// Ratio of scattering to extinction, by wavelength.
    pub single_scattering_albedo: SpectralCurve,
    /// Relative density by height.
    pub density: DensityProfile,
    /// Phase function.
    pub phase: PhaseFunction,
}

/// Why an aerosol is invalid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AerosolError {
    /// A negative or infinite optical depth.
    #[error("expected a finite aerosol optical depth at 550 nm of at least 0, got {0}")]
    OpticalDepth(f64),
    /// A turbidity below 1.
    #[error("expected a finite turbidity of at least 1 (1 is air without aerosol), got {0}")]
    Turbidity(f64),
    /// A visibility that is not positive, or longer than that of air without aerosol.
    #[error(
        "expected a visibility above 0 and at most {clearest_m:.0} m, that of air without aerosol, got {got_m} m"
    )]
    Visibility {
        /// The visibility given, m.
        got_m: f64,
        /// Visibility without aerosol, m.
        clearest_m: f64,
    },
    /// An Angstrom exponent out of range.
    #[error("expected an Angstrom exponent from -4 to 8, got {0}")]
    AngstromExponent(f64),
    /// A single-scattering albedo out of range.
    #[error("expected a single-scattering albedo in [0, 1], got {0}")]
    SingleScatteringAlbedo(f64),
    /// A density profile that does not allow the load.
    #[error(
        "expected a density profile with aerosol between the ground and the top of the atmosphere, and at the ground if \
         its amount is a visibility; got one that is 0 there"
    )]
    EmptyProfile,
    /// An invalid phase function.
    #[error("{0}")]
    Phase(#[from] PhaseError),
}

impl AerosolLoad {
    /// Vertical optical depth at 550 nm. `column_m` is the integral of the relative density from the ground to the top,
    /// divided by its value at the ground.
    ///
    /// # Errors
    /// [`AerosolError`] if the load is out of range.
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
    /// The constituent of kind [`ConstituentKind::Aerosol`] of an atmosphere between two altitudes, m.
    ///
    /// # Errors
    /// [`AerosolError`] if a number is out of range.
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

    /// Scattering and absorption spectra: exact for a constant albedo, otherwise sampled every 2 nm from 250 to 1100 nm.
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

/// Extinction coefficient (1/m) at 550 nm and relative density 1 for a load in a profile between two altitudes, m.
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
        // A layer above the ground has no extinction at the ground, which visibility defines.
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
pub(crate) fn continental_phase() -> PhaseFunction {
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

    fn visibility(range_m: f64) -> AerosolLoad {
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
    fn loads_define_the_optical_depth() {
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

        let by_visibility = build(visibility(23e3));
        let total = by_visibility.extinction_per_m(550.0) + clear().ground_extinction_per_m;
        assert!(((-total * 23e3).exp() / 0.05 - 1.0).abs() < 1e-12);
        let range = visibility_of_extinction_m(by_visibility.extinction_per_m(550.0), clear());
        assert!((range / 23e3 - 1.0).abs() < 1e-12);
        // Visibility of air without aerosol is about 260 km.
        let clearest = visibility_of_extinction_m(0.0, clear());
        assert!((255e3..265e3).contains(&clearest), "{clearest}");
        let by_contrast = build(AerosolLoad::Visibility {
            range_m: 23e3,
            contrast: Contrast::TwoPercent,
        });
        let total = by_contrast.extinction_per_m(550.0) + clear().ground_extinction_per_m;
        assert!(((-total * 23e3).exp() / 0.02 - 1.0).abs() < 1e-12);
        let none = build(visibility(clearest));
        assert!(none.extinction_per_m(550.0) < 1e-15);
    }

    #[test]
    fn a_spectral_albedo_divides_the_extinction() {
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
    fn invalid_numbers_are_rejected() {
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
                refuse(&aerosol(visibility(range))),
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
        let mut elevated = aerosol(visibility(20e3));
        elevated.density = DensityProfile::Layer {
            bottom_m: 2e3,
            top_m: 3e3,
        };
        assert_eq!(refuse(&elevated), AerosolError::EmptyProfile);
    }
}
