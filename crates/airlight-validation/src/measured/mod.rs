//! The sky measured at Ithaca, New York, on 27 May 2013: Kider, Knowlton, Newlin, Li & Greenberg, "A framework for the
//! experimental comparison of solar and skydome illumination", ACM Transactions on Graphics 33(6), 2014.
//!
//! 81 directions per scan; eight of the fifteen scans of the clear day; the 31 wavelengths from 360 to 712.5 nm. The metric is
//! that of E. Bruneton, "A qualitative and quantitative evaluation of 8 clear sky models", IEEE TVCG 23(12), 2017: the root
//! mean square difference over directions and wavelengths, then over scans, with equal weights.

mod air;
pub mod fit;

pub use air::{Aerosol, FOLDS, Fold, air_of_the_day};

use crate::check::{Check, Row, Suite, Unit};
use crate::solved::Solved;
use crate::table::Table;
use airlight::atmosphere::{Atmosphere, reference};
use airlight::sky::SkySettings;
use airlight::{Cancelled, Control};

/// Longest wavelength in the metric, nm.
const LONGEST_NM: f64 = 720.0;
/// Distance of the sun on that day, AU.
const SUN_DISTANCE_AU: f64 = 1.0131;

/// A measured scan of the sky, taken within minutes.
#[derive(Clone, Debug)]
pub struct Scan {
    /// Local time, such as `0930`.
    pub time: &'static str,
    /// Zenith angle of the sun, degrees.
    pub sun_zenith_deg: f64,
    /// Directions: zenith angle and azimuth relative to the sun, degrees.
    pub views: Vec<(f64, f64)>,
    /// Radiance of each direction at each wavelength, W m^-2 sr^-1 nm^-1.
    pub radiance: Vec<Vec<f64>>,
}

/// The wavelengths, nm, and the scans.
pub fn scans() -> (Vec<f64>, Vec<Scan>) {
    let table = Table::new(include_str!("../../data/kider_2013-05-27_sky_radiance.csv"));
    let mut columns = table.radiance_columns();
    columns.retain(|(_, nm)| *nm <= LONGEST_NM);
    let mut scans: Vec<Scan> = Vec::new();
    for line in table.lines() {
        let time = line.text("local_time");
        if scans.last().is_none_or(|scan| scan.time != time) {
            scans.push(Scan {
                time,
                sun_zenith_deg: line.number("sun_zenith_deg"),
                views: Vec::new(),
                radiance: Vec::new(),
            });
        }
        let Some(scan) = scans.last_mut() else { break };
        let azimuth = line.number("view_azimuth_deg") - line.number("sun_azimuth_deg_estimated");
        scan.views.push((line.number("view_zenith_deg"), azimuth));
        let values = columns.iter().map(|(column, _)| line.at(*column));
        scan.radiance.push(values.collect());
    }
    (columns.iter().map(|(_, nm)| *nm).collect(), scans)
}

/// Compares a model atmosphere with a scan.
///
/// # Errors
/// [`Cancelled`].
pub fn compare(
    air: &Atmosphere,
    wavelengths_nm: &[f64],
    scan: &Scan,
    sun_distance_au: f64,
    control: Control<'_>,
) -> Result<Vec<Row>, Cancelled> {
    let (zenith_deg, settings) = (scan.sun_zenith_deg, SkySettings::default());
    let solved = Solved::of_table(air, wavelengths_nm, zenith_deg, &settings, control)?
        .at_sun_distance(sun_distance_au);
    let mut rows = Vec::new();
    for (&(zenith, azimuth), measured) in scan.views.iter().zip(&scan.radiance) {
        let light = solved.look(zenith, azimuth);
        let lanes = light.all.iter().zip(measured).enumerate();
        rows.extend(lanes.map(|(lane, (&ours, &reference))| Row {
            at: solved.at(zenith, azimuth, lane),
            ours,
            reference,
            standard_error: 0.0,
        }));
    }
    Ok(rows)
}

/// All checks of the suite.
///
/// # Errors
/// [`Cancelled`].
pub fn checks(control: Control<'_>) -> Result<Vec<Check>, Cancelled> {
    let (wavelengths, scans) = scans();
    let csm = reference::csm();
    let mut rows = Vec::new();
    for scan in &scans {
        // As in the published comparison, which used the sun's mean distance.
        rows.extend(compare(&csm, &wavelengths, scan, 1.0, control)?);
    }
    let published_air = check("csm, as published models were run", rows, None);
    let mut real = Vec::new();
    let mut folds = Vec::new();
    for fold in &FOLDS {
        let air = air_of_the_day(&fold.aerosol);
        let scored = scans.iter().filter(|scan| fold.scored.contains(&scan.time));
        let mut rows: Vec<Row> = Vec::new();
        for scan in scored {
            rows.extend(compare(&air, &wavelengths, scan, SUN_DISTANCE_AU, control)?);
        }
        real.extend(rows.iter().copied());
        let what = format!("air of the day, scans {}", fold.scored.join(", "));
        folds.push(check(&what, rows, None));
    }
    let mut all = vec![
        published_air,
        check("air of the day, all scans", real, Some(9.0)),
    ];
    all.extend(folds);
    Ok(all)
}

/// A check whose claim is the root mean square, not each value.
fn check(what: &str, rows: Vec<Row>, limit_of_rms: Option<f64>) -> Check {
    Check {
        suite: Suite::Measured,
        what: what.into(),
        against: "measured sky, Ithaca, 27 May 2013".into(),
        unit: Unit::Milliwatts,
        limit: None,
        limit_of_rms,
        rows,
    }
}

/// Error of a published model on the same scans, mW m^-2 sr^-1 nm^-1.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Published {
    /// Name of the model and set of wavelengths.
    pub model: String,
    /// Root mean square error over the embedded scans.
    pub rmse: f64,
    /// Root mean square error over all fifteen scans, as published.
    pub rmse_all_scans: f64,
}

/// The models of Bruneton's comparison, best first.
pub fn published() -> Vec<Published> {
    let table = Table::new(include_str!("../../data/csm_rmse_vs_kider.csv"));
    let (_, scans) = scans();
    let mut models: Vec<Published> = table
        .lines()
        .map(|line| {
            let squares = scans.iter().map(|scan| line.number(scan.time).powi(2));
            Published {
                model: format!("{}, {}", line.text("model"), line.text("spectral_set")),
                rmse: (squares.sum::<f64>() / scans.len() as f64).sqrt(),
                rmse_all_scans: line.number("rmse_total_mW_m2_sr_nm"),
            }
        })
        .collect();
    models.sort_by(|a, b| a.rmse.total_cmp(&b.rmse));
    models
}
