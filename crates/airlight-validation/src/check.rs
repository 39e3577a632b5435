//! Comparisons of values with references, and their statistics.

use serde::Serialize;
use std::fmt;

/// A family of checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Suite {
    /// Skies compared with tables of a Monte Carlo, SASKTRAN2 and libRadtran.
    Tables,
    /// Skies by day and in twilight compared with Airlight's Monte Carlo.
    MonteCarlo,
    /// Skies around the sun, polarised, and of thick air compared with Airlight's Monte Carlo and discrete ordinates.
    Limits,
    /// Skies of random airs, suns, eyes and views compared with Airlight's Monte Carlo.
    RandomAirs,
    /// The skies of the suites above with the fine settings.
    Fine,
    /// Other sky models compared with Airlight: differences, without a reference.
    Peers,
    /// The sky measured on 27 May 2013.
    Measured,
    /// Whole frames of a graphics device, and of published real-time models, compared with the solver in one atmosphere.
    Gpu,
    /// The same in four atmospheres.
    GpuAll,
    /// Whole frames of a graphics device compared with Airlight's Monte Carlo.
    GpuMonteCarlo,
}

airlight::named! { Suite, "a set of comparisons", [
    ("tables", (Tables), "skies against tables of an independent Monte Carlo, SASKTRAN2 and libRadtran"),
    ("monte-carlo", (MonteCarlo), "skies in daylight and twilight against Airlight's Monte Carlo solver"),
    ("limits", (Limits), "the sky around the sun, polarised light and optically thick air against Monte Carlo and discrete ordinates; energy and reciprocity"),
    ("random-airs", (RandomAirs), "skies of random airs, suns, eyes and views against Airlight's Monte Carlo"),
    ("fine", (Fine), "the radiances of these with the fine settings: within 0.5 % (minutes)"),
    ("peers", (Peers), "published sky models against the default solver"),
    ("measured", (Measured), "the sky measured on 27 May 2013 against the solver and published models"),
    ("gpu", (Gpu), "frames of airlight-gpu and of published real-time models in hazy air against the fine solver (a minute; needs a graphics device)"),
    ("gpu-all", (GpuAll), "the same in four atmospheres (minutes)"),
    ("gpu-monte-carlo", (GpuMonteCarlo), "frames of airlight-gpu against Airlight's Monte Carlo solver (minutes; needs a graphics device)"),
] }

impl Suite {
    /// The suites that need neither a graphics device nor minutes.
    pub const USUAL: [Self; 6] = [
        Self::Tables,
        Self::MonteCarlo,
        Self::Limits,
        Self::RandomAirs,
        Self::Peers,
        Self::Measured,
    ];

    /// Title in reports.
    pub fn title(self) -> &'static str {
        match self {
            Self::Tables => "Skies against tables of other solvers",
            Self::MonteCarlo => "Skies by day and in twilight against Airlight's Monte Carlo",
            Self::Limits => "Skies around the sun, polarised, and of optically thick air",
            Self::RandomAirs => "Skies of random airs against Airlight's Monte Carlo",
            Self::Fine => "Skies solved with the fine settings",
            Self::Peers => "Differences to other models of the sky (without a reference)",
            Self::Measured => "The sky measured at Ithaca on 27 May 2013",
            Self::Gpu => {
                "Frames of airlight-gpu and of real-time models in hazy air against the solver"
            }
            Self::GpuAll => {
                "Frames of airlight-gpu and of real-time models in four atmospheres against the solver"
            }
            Self::GpuMonteCarlo => "Frames of airlight-gpu against Airlight's Monte Carlo",
        }
    }
}

/// Unit of errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Unit {
    /// `ours / reference - 1`, percent.
    Percent,
    /// `ours - reference`, mW m^-2 sr^-1 nm^-1 (values in W m^-2 sr^-1 nm^-1).
    Milliwatts,
    /// `ours - reference` of fractions, percentage points.
    Points,
    /// Colour difference of `ours` from the reference.
    Ciede2000,
}

impl Unit {
    /// Error of a row, in this unit.
    pub fn error(self, row: &Row) -> f64 {
        match self {
            Self::Percent => 100.0 * (row.ours / row.reference - 1.0),
            Self::Milliwatts => 1e3 * (row.ours - row.reference),
            Self::Points => 100.0 * (row.ours - row.reference),
            Self::Ciede2000 => row.ours - row.reference,
        }
    }

    /// Standard error of a row, in this unit.
    pub fn noise(self, row: &Row) -> f64 {
        match self {
            Self::Percent => 100.0 * row.standard_error / row.reference,
            Self::Milliwatts => 1e3 * row.standard_error,
            Self::Points => 100.0 * row.standard_error,
            Self::Ciede2000 => row.standard_error,
        }
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Percent => "%",
            Self::Milliwatts => "mW/(m2 sr nm)",
            Self::Points => "percentage points",
            Self::Ciede2000 => "CIEDE2000",
        })
    }
}

/// Identifies a value: a view direction and a wavelength. Angles in degrees; relative azimuth 0 is towards the sun.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct At {
    /// Name of the atmosphere, where a check has several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub air: Option<&'static str>,
    /// Altitude of the eye, m.
    pub altitude_m: f64,
    /// Zenith angle of the sun, degrees.
    pub sun_zenith_deg: f64,
    /// Zenith angle of the view, degrees.
    pub view_zenith_deg: f64,
    /// Azimuth of the view relative to the sun, degrees.
    pub relative_azimuth_deg: f64,
    /// Distance of what is seen through the air, m; `None` for the whole ray.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance_m: Option<f64>,
    /// Wavelength, nm; `None` for luminance and colour.
    pub wavelength_nm: Option<f64>,
}

impl At {
    /// Angle between view and sun, degrees.
    pub fn from_sun_deg(&self) -> f64 {
        let [s, v, a] = [
            self.sun_zenith_deg,
            self.view_zenith_deg,
            self.relative_azimuth_deg,
        ]
        .map(f64::to_radians);
        let cosine = s.cos() * v.cos() + s.sin() * v.sin() * a.cos();
        cosine.clamp(-1.0, 1.0).acos().to_degrees()
    }
}

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(air) = self.air {
            write!(f, "{air}, ")?;
        }
        if self.altitude_m > 0.0 {
            write!(f, "eye at {:.0} m, ", self.altitude_m)?;
        }
        write!(
            f,
            "sun zenith {:.1}, view zenith {:.1}, azimuth {:.1} from the sun",
            self.sun_zenith_deg, self.view_zenith_deg, self.relative_azimuth_deg,
        )?;
        if let Some(distance_m) = self.distance_m {
            write!(f, ", at {distance_m:.0} m")?;
        }
        match self.wavelength_nm {
            Some(nm) => write!(f, ", {nm} nm"),
            None => Ok(()),
        }
    }
}

/// A value and its reference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Direction and wavelength.
    #[serde(flatten)]
    pub at: At,
    /// Value computed by Airlight.
    pub ours: f64,
    /// Reference value.
    pub reference: f64,
    /// Standard error of the difference, in the unit of the values; 0 if not stated.
    pub standard_error: f64,
}

/// Comparison of many values with one reference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// Suite of the check.
    pub suite: Suite,
    /// What is compared: light and atmosphere.
    pub what: String,
    /// Name of the reference.
    pub against: String,
    /// Unit of errors.
    pub unit: Unit,
    /// Claimed bound on the error of each row, beyond three standard errors; `None` without a claim.
    pub limit: Option<f64>,
    /// Claimed bound on the root-mean-square error; `None` without a claim.
    pub limit_of_rms: Option<f64>,
    /// Values and references.
    #[serde(skip)]
    pub rows: Vec<Row>,
}

/// Statistics of the errors of a check, in its unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Statistics {
    /// Number of values.
    pub count: usize,
    /// Mean error.
    pub mean: f64,
    /// Root mean square error.
    pub rms: f64,
    /// 95th percentile of the absolute error.
    pub percentile_95: f64,
    /// Error with the largest absolute value.
    pub worst: f64,
    /// Direction and wavelength of the worst error.
    pub worst_at: At,
    /// Root mean square of the standard errors: noise of the reference.
    pub noise: f64,
}

impl Check {
    /// Error of a row.
    pub fn error(&self, row: &Row) -> f64 {
        self.unit.error(row)
    }

    /// Standard error of a row, in the unit of errors.
    pub fn noise(&self, row: &Row) -> f64 {
        self.unit.noise(row)
    }

    /// Statistics of all rows; `None` without rows.
    pub fn statistics(&self) -> Option<Statistics> {
        let worst_row = self
            .rows
            .iter()
            .max_by(|a, b| self.error(a).abs().total_cmp(&self.error(b).abs()))?;
        let n = self.rows.len() as f64;
        let mean_of = |of: &dyn Fn(&Row) -> f64| self.rows.iter().map(of).sum::<f64>() / n;
        let mut sizes: Vec<f64> = self.rows.iter().map(|row| self.error(row).abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let index = (0.95 * n).ceil() as usize;
        Some(Statistics {
            count: self.rows.len(),
            mean: mean_of(&|row| self.error(row)),
            rms: mean_of(&|row| self.error(row).powi(2)).sqrt(),
            percentile_95: sizes[index.clamp(1, sizes.len()) - 1],
            worst: self.error(worst_row),
            worst_at: worst_row.at,
            noise: mean_of(&|row| self.noise(row).powi(2)).sqrt(),
        })
    }

    /// True if the check makes a claim.
    pub fn claims(&self) -> bool {
        self.limit.is_some() || self.limit_of_rms.is_some()
    }

    /// True if all claims hold.
    pub fn holds(&self) -> bool {
        let rms = |limit| self.statistics().is_some_and(|s| s.rms <= limit);
        self.broken().is_none() && self.limit_of_rms.is_none_or(rms)
    }

    /// The row that exceeds the claimed bound by most, if any.
    pub fn broken(&self) -> Option<&Row> {
        let limit = self.limit?;
        let excess = |row: &Row| self.error(row).abs() - limit - 3.0 * self.noise(row);
        self.rows
            .iter()
            .filter(|row| excess(row) > 0.0 || excess(row).is_nan())
            .max_by(|a, b| excess(a).total_cmp(&excess(b)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(values: &[(f64, f64, f64)], unit: Unit) -> Check {
        let at = At {
            sun_zenith_deg: 60.0,
            view_zenith_deg: 0.0,
            wavelength_nm: Some(550.0),
            ..Default::default()
        };
        Check {
            suite: Suite::Tables,
            what: "sky".into(),
            against: "truth".into(),
            unit,
            limit: Some(1.0),
            limit_of_rms: None,
            rows: values
                .iter()
                .map(|&(ours, reference, standard_error)| Row {
                    at,
                    ours,
                    reference,
                    standard_error,
                })
                .collect(),
        }
    }

    #[test]
    fn errors_are_counted_in_their_unit() {
        let values = [(1.01, 1.0, 0.0), (1.98, 2.0, 0.02)];
        let percent = check(&values, Unit::Percent);
        let s = percent.statistics().unwrap();
        assert!(s.mean.abs() < 1e-9 && (s.rms - 1.0).abs() < 1e-9);
        assert!((s.noise - 0.5f64.sqrt()).abs() < 1e-9);
        let absolute = check(&values, Unit::Milliwatts).statistics().unwrap();
        assert!((absolute.mean + 5.0).abs() < 1e-9 && (absolute.worst + 20.0).abs() < 1e-9);
    }

    #[test]
    fn claims_allow_for_noise_and_reject_nan() {
        assert!(
            check(&[(1.02, 1.0, 0.004)], Unit::Percent)
                .broken()
                .is_none()
        );
        assert!(
            check(&[(1.02, 1.0, 0.003)], Unit::Percent)
                .broken()
                .is_some()
        );
        assert!(
            check(&[(f64::NAN, 1.0, 0.1)], Unit::Percent)
                .broken()
                .is_some()
        );
        assert!(check(&[], Unit::Percent).statistics().is_none());
    }
}
