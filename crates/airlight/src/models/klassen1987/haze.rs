//! Optical properties of the haze at the model's wavelengths: figures 2 and 3 as tables.

use super::lanes::{Lanes, wavelengths_nm};
use super::settings::{Haze, HazePhase, Klassen1987Error, Klassen1987Settings};
use crate::atmosphere::REFERENCE_NM;
use crate::control::Control;
use crate::math::interpolation::Place;
use crate::optics::mie::droplets::Drops;
use crate::optics::mie::{BulkOptics, MieError, Particles};
use crate::optics::{PhaseFunction, TabulatedPhase};
use crate::spectrum::{SampledCurve, SpectralCurve};
use std::f64::consts::PI;
use std::sync::{Arc, Mutex, PoisonError};

/// Number of samples of the angular scattering function, uniform in the square root of the angle and so dense in the forward
/// peak. Linear interpolation is accurate to 0.05 % (test `tables_follow_the_function`).
const SAMPLES: usize = 2048;

/// Wavelengths at which drops are computed, nm; interpolated between.
const MIE_NM: [f64; 9] = [
    380.0, 420.0, 460.0, 500.0, 540.0, 580.0, 620.0, 660.0, 700.0,
];
/// Size steps relative to those of fog drops, and tolerance of `ln p`: hazes are broad distributions.
const STEP_FACTOR: f64 = 10.0;
const TOLERANCE: f64 = 0.03;

/// Optical properties of the haze at each wavelength.
pub(super) struct HazeTables {
    /// `beta_p`, m^-1.
    pub extinction_per_m: Lanes,
    /// `beta_sc(psi)` by angle, m^-1 sr^-1.
    scattering: Vec<Lanes>,
}

impl HazeTables {
    /// Tables for checked settings.
    pub fn new(
        settings: &Klassen1987Settings,
        control: Control<'_>,
    ) -> Result<Self, Klassen1987Error> {
        let (extinction, albedo, phase) = settings.haze.optics(control)?;
        let at_reference = extinction.at(REFERENCE_NM);
        let mut extinction_per_m = Lanes::ZERO;
        let mut scattering_per_m = Vec::with_capacity(extinction_per_m.0.len());
        for (lane, nm) in wavelengths_nm().enumerate() {
            let relative = in_range(
                extinction.at(nm) / at_reference,
                1e6,
                "the haze's extinction relative to that at 550 nm",
            )?;
            let albedo = in_range(
                albedo.at(nm),
                1.0 + 1e-9,
                "the haze's single-scattering albedo",
            )?;
            let beta = settings.haze_extinction_per_m * relative;
            extinction_per_m.0[lane] = beta as f32;
            scattering_per_m.push(beta * albedo);
        }
        let function = |cos: f64, nm: f64| match settings.phase {
            HazePhase::Particles => phase.evaluate(cos, nm),
            HazePhase::HenyeyGreenstein { g } => {
                PhaseFunction::HenyeyGreenstein { g }.evaluate(cos, nm)
            }
            HazePhase::Printed { g } => {
                let corrected = PhaseFunction::HenyeyGreenstein { g }.evaluate(cos, nm);
                corrected * 4.0 * PI * (1.0 - g) / (1.0 + g)
            }
        };
        let nm: Vec<f64> = wavelengths_nm().collect();
        let scattering = (0..=SAMPLES)
            .map(|i| {
                let cos = (PI * (i as f64 / SAMPLES as f64).powi(2)).cos();
                Lanes::from_fn(|lane| (scattering_per_m[lane] * function(cos, nm[lane])) as f32)
            })
            .collect();
        Ok(Self {
            extinction_per_m,
            scattering,
        })
    }

    /// `beta_sc(psi)` by the cosine of the scattering angle, m^-1 sr^-1.
    pub fn scattered(&self, cos_angle: f64) -> Lanes {
        let half_sine = (0.5 * (1.0 - cos_angle)).clamp(0.0, 1.0).sqrt();
        let root = (2.0 / PI * half_sine.asin()).sqrt();
        Place::evenly(root, SAMPLES + 1).value_in_f32(&self.scattering)
    }
}

fn in_range(got: f64, most: f64, what: &'static str) -> Result<f64, Klassen1987Error> {
    match got >= 0.0 && got <= most {
        true => Ok(got),
        false => Err(Klassen1987Error::Number {
            what,
            right: "finite and not negative, and an albedo not above 1",
            got,
        }),
    }
}

impl Haze {
    /// Extinction on an arbitrary scale, single-scattering albedo and phase function.
    pub(super) fn optics(&self, control: Control<'_>) -> Result<Optics, MieError> {
        match self {
            Self::Drops(drops) => drop_optics(*drops, control),
            Self::Given {
                extinction,
                single_scattering_albedo,
                phase,
            } => Ok((
                extinction.clone(),
                single_scattering_albedo.clone(),
                phase.clone(),
            )),
        }
    }
}

/// Extinction, albedo and phase function.
pub(super) type Optics = (SpectralCurve, SpectralCurve, PhaseFunction);

/// Optical properties of water drops, computed once in a process and cached.
fn drop_optics(drops: Drops, control: Control<'_>) -> Result<Optics, MieError> {
    type Known = Vec<(Drops, Arc<(TabulatedPhase, Vec<BulkOptics>)>)>;
    static KNOWN: Mutex<Known> = Mutex::new(Vec::new());
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let kept = known()
        .iter()
        .find(|entry| entry.0 == drops)
        .map(|entry| Arc::clone(&entry.1));
    let table = match kept {
        Some(table) => table,
        None => {
            // Computed without the lock, so that other threads can compute other kinds.
            let water = Particles::water(drops.sizes())?;
            let table = Arc::new(water.broad_table(&MIE_NM, STEP_FACTOR, TOLERANCE, control)?);
            known().push((drops, Arc::clone(&table)));
            table
        }
    };
    let (phase, bulk) = &*table;
    let curve = |of: fn(&BulkOptics) -> f64| {
        SampledCurve::new(MIE_NM.to_vec(), bulk.iter().map(of).collect())
            .map_or(SpectralCurve::Constant(1.0), SpectralCurve::Table)
    };
    Ok((
        curve(BulkOptics::extinction_um2),
        curve(BulkOptics::single_scattering_albedo),
        PhaseFunction::Tabulated(phase.clone()),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_follow_the_function() -> Result<(), Klassen1987Error> {
        let settings = Klassen1987Settings::default();
        let haze = HazeTables::new(&settings, Control::default())?;
        let (extinction, albedo, phase) = drop_optics(Drops::HazeL, Control::default())?;
        for (lane, nm) in wavelengths_nm().enumerate() {
            let beta = 5e-5 * extinction.at(nm) / extinction.at(550.0);
            assert!((f64::from(haze.extinction_per_m.0[lane]) / beta - 1.0).abs() < 1e-6);
            for step in 0..=1000 {
                let cos = (PI * (f64::from(step) / 1000.0).powi(2)).cos();
                let want = beta * albedo.at(nm) * phase.evaluate(cos, nm);
                let error = f64::from(haze.scattered(cos).0[lane]) / want - 1.0;
                assert!(error.abs() < 5e-4, "{nm} nm, cosine {cos}: {error}");
            }
        }
        Ok(())
    }

    /// Figure 3: scattering efficiency falls with wavelength for such small drops, which do not absorb.
    #[test]
    fn wet_haze_scatters_blue_slightly_more() -> Result<(), MieError> {
        let (extinction, albedo, _) = drop_optics(Drops::HazeL, Control::default())?;
        let ratio = extinction.at(450.0) / extinction.at(650.0);
        assert!((1.0..2.0).contains(&ratio), "{ratio}");
        assert!(albedo.at(550.0) > 0.9999);
        Ok(())
    }

    /// Integral of eq. 1 as printed.
    #[test]
    fn printed_phase_function_is_not_normalised() -> Result<(), Klassen1987Error> {
        for g in [0.0, 0.5, 0.8] {
            let with = |phase| {
                let settings = Klassen1987Settings {
                    phase,
                    ..Klassen1987Settings::default()
                };
                HazeTables::new(&settings, Control::default())
            };
            let (printed, corrected) = (
                with(HazePhase::Printed { g })?,
                with(HazePhase::HenyeyGreenstein { g })?,
            );
            let integral = |haze: &HazeTables| {
                let steps = 20_000;
                let sum: f64 = (0..steps)
                    .map(|i| {
                        let cos = 2.0 * (f64::from(i) + 0.5) / f64::from(steps) - 1.0;
                        f64::from(haze.scattered(cos).0[17])
                    })
                    .sum();
                4.0 * PI * sum / f64::from(steps) / f64::from(haze.extinction_per_m.0[17])
            };
            let want = 4.0 * PI * (1.0 - g) / (1.0 + g);
            assert!((integral(&printed) / want - 1.0).abs() < 2e-3, "{g}");
            assert!((integral(&corrected) - 1.0).abs() < 2e-3, "{g}");
        }
        Ok(())
    }
}
