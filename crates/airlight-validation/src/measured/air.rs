//! The atmosphere of the measured day.

use airlight::atmosphere::presets::Earth;
use airlight::atmosphere::{AerosolLoad, AngstromAerosol, Atmosphere, DensityProfile, reference};
use airlight::optics::{PhaseFunction, TabulatedPhase};
use airlight::spectrum::{SpectralCurve, solar};

/// The fitted properties of the day's aerosol.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aerosol {
    /// Optical depth at 550 nm.
    pub optical_depth_550: f64,
    /// Ångström exponent.
    pub angstrom_exponent: f64,
    /// Single-scattering albedo.
    pub single_scattering_albedo: f64,
}

/// An aerosol fitted to some scans, and the other scans on which it is evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fold {
    /// Local times of the fitted scans.
    pub fitted: [&'static str; 4],
    /// Local times of the evaluated scans.
    pub scored: [&'static str; 4],
    /// The fitted aerosol: `cargo run --release -p airlight-validation --example fit_measured_sky`.
    pub aerosol: Aerosol,
}

const ONE: [&str; 4] = ["0930", "1030", "1130", "1230"];
const OTHER: [&str; 4] = ["1000", "1100", "1200", "1330"];

/// Two-fold cross-validation: each scan is evaluated with an aerosol fitted to the other half.
pub const FOLDS: [Fold; 2] = [
    Fold {
        fitted: ONE,
        scored: OTHER,
        aerosol: Aerosol {
            optical_depth_550: 0.1168,
            angstrom_exponent: 1.463,
            single_scattering_albedo: 0.745,
        },
    },
    Fold {
        fitted: OTHER,
        scored: ONE,
        aerosol: Aerosol {
            optical_depth_550: 0.0972,
            angstrom_exponent: 1.342,
            single_scattering_albedo: 0.786,
        },
    },
];

/// Altitude of the site above sea level, m.
const ALTITUDE_M: f64 = 250.0;
/// Ozone column, Dobson units: climatological value for 42 degrees north in late May; a change by 30 changes the error by
/// less than 0.1 mW m^-2 sr^-1 nm^-1.
const OZONE_DU: f64 = 340.0;
/// Spectral resolution of the spectroradiometer, full width at half maximum, nm (specified by its manufacturer).
const RESOLUTION_NM: f64 = 3.0;

/// Atmosphere of the day: the Earth's air from first principles with the aerosol's phase function from AERONET inversions of
/// the same day at Egbert, Ontario, 330 km away (level 1.5; PI N. O'Neill, I. Abboud, V. Fioletov), over grass, with the solar
/// spectrum at the resolution of the instrument.
pub fn air_of_the_day(aerosol: &Aerosol) -> Atmosphere {
    let standard = Earth::with_aerosol(aerosol.optical_depth_550);
    let earth = Earth {
        sea_level_pressure_pa: standard.sea_level_pressure_pa * (-ALTITUDE_M / 8.4e3).exp(),
        ozone_du: OZONE_DU,
        aerosol: AngstromAerosol {
            load: AerosolLoad::OpticalDepth550(aerosol.optical_depth_550),
            angstrom_exponent: aerosol.angstrom_exponent,
            single_scattering_albedo: SpectralCurve::Constant(aerosol.single_scattering_albedo),
            density: DensityProfile::exponential(1.5e3),
            phase: aeronet_phase(),
        },
        ground_albedo: reference::csm().planet.ground_albedo,
    };
    let mut air = earth
        .atmosphere("27 May 2013")
        .expect("fitted aerosols are in their domains");
    air.solar_irradiance = blurred_sun();
    air
}

/// Mean of the day's five inversions.
fn aeronet_phase() -> PhaseFunction {
    let text = include_str!("../../data/aeronet-egbert-2013-05-27.pfn");
    let mut lines = text.lines().skip(3).map(|line| line.split(','));
    // Columns `ANGLE[NMnm]`, wavelength by wavelength, after date, time and day.
    let head: Vec<&str> = lines.next().into_iter().flatten().collect();
    let rows: Vec<Vec<&str>> = lines.map(Iterator::collect).collect();
    let (mut angles, mut wavelengths, mut values) = (Vec::new(), Vec::<f64>::new(), Vec::new());
    for (column, name) in head.iter().enumerate() {
        let Some((angle, nm)) = name.strip_suffix("nm]").and_then(|s| s.split_once('[')) else {
            continue;
        };
        let number = |text: &str| {
            text.parse::<f64>()
                .expect("the embedded inversions are numbers")
        };
        let (angle, nm) = (number(angle), number(nm));
        if wavelengths.last() != Some(&nm) {
            wavelengths.push(nm);
        }
        if wavelengths.len() == 1 {
            angles.push(angle);
        }
        let of_all = rows.iter().map(|row| number(row[column]));
        values.push(of_all.sum::<f64>() / rows.len() as f64);
    }
    let table = TabulatedPhase::new(angles, wavelengths, values);
    PhaseFunction::Tabulated(table.expect("the embedded inversions make a table"))
}

/// Solar spectrum convolved with a Gaussian of the instrument's resolution.
fn blurred_sun() -> SpectralCurve {
    const STEP_NM: f64 = 0.25;
    let sun = solar::extraterrestrial();
    let sigma = RESOLUTION_NM / (8.0 * 2f64.ln()).sqrt();
    let wavelengths: Vec<f64> = (0..=2400).map(|i| 300.0 + STEP_NM * f64::from(i)).collect();
    let blurred = |&nm: &f64| {
        let (mut sum, mut weight) = (0.0, 0.0);
        for i in -60..=60 {
            let offset = STEP_NM * f64::from(i);
            let w = (-0.5 * (offset / sigma).powi(2)).exp();
            sum += w * sun.at(nm + offset);
            weight += w;
        }
        sum / weight
    };
    let values = wavelengths.iter().map(blurred).collect();
    SpectralCurve::table(wavelengths, values).expect("a blurred spectrum is a curve")
}
