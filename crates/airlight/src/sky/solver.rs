//! The prepared sky and its settings.

use super::block::{self, Block};
use super::coverage::SunCoverage;
use super::harmonics::Harmonics;
use super::orders::{Directions, OrderSettings};
use super::view::View;
use crate::atmosphere::{Atmosphere, AtmosphereError};
use crate::control::{Cancelled, Control};
use crate::spectrum::WavelengthGrid;
use crate::transfer::shell::{MAX_CONSTITUENTS, Shell};
use glam::DVec3;
use std::fmt;
use std::sync::Arc;

/// Orders of scattering that are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scattering {
    /// Sunlight scattered once, and the ground lit by direct sunlight.
    Single,
    /// All orders of scattering and reflection.
    All,
}

/// Settings of the sky solver.
#[derive(Clone, Debug, PartialEq)]
pub struct SkySettings {
    /// Sun elevations and observer altitudes to prepare for.
    pub suns: SunCoverage,
    /// Orders of scattering that are computed.
    pub scattering: Scattering,
    /// Number of altitudes at which the light inside the atmosphere is solved for, 2 to 200.
    pub altitudes: usize,
    /// Resolution and convergence of the orders of scattering.
    pub orders: OrderSettings,
}

impl Default for SkySettings {
    /// All orders, for all sun elevations, with the accuracy stated in the book: within 1 % of Monte Carlo for the sun above
    /// 10 degrees, 2 % near the horizon.
    fn default() -> Self {
        Self {
            suns: SunCoverage::All,
            scattering: Scattering::All,
            altitudes: 20,
            orders: OrderSettings {
                degree: 8,
                peak_degree: 10,
                rescattered_degree: 4,
                first: Directions {
                    zenith_nodes: [7, 5, 8],
                    azimuths: 12,
                    panel_nodes: 2,
                },
                later: Directions {
                    zenith_nodes: [4, 4, 5],
                    azimuths: 7,
                    panel_nodes: 2,
                },
                tolerance: 0.03,
                max_orders: 40,
            },
        }
    }
}

impl SkySettings {
    /// Settings for hazy air and low suns: twice the altitudes, more directions and moments; about five times slower.
    pub fn fine() -> Self {
        let mut settings = Self {
            altitudes: 40,
            ..Self::default()
        };
        let orders = &mut settings.orders;
        (orders.degree, orders.peak_degree, orders.rescattered_degree) = (12, 12, 8);
        orders.later.zenith_nodes = [8, 8, 10];
        (orders.first.panel_nodes, orders.later.panel_nodes) = (3, 3);
        settings
    }

    /// Checks the ranges of all settings.
    ///
    /// # Errors
    /// [`SkyError::Setting`] for the first setting out of range.
    pub fn validate(&self) -> Result<(), SkyError> {
        let orders = &self.orders;
        let directions = |d: &Directions| {
            d.azimuths >= 1
                && (1..=4).contains(&d.panel_nodes)
                && d.zenith_nodes.iter().all(|&n| (1..=64).contains(&n))
        };
        let finite = match self.suns {
            SunCoverage::All => true,
            SunCoverage::Near {
                sun_elevation_deg,
                observer_altitude_m,
            } => sun_elevation_deg.is_finite() && observer_altitude_m.is_finite(),
        };
        let checks = [
            (finite, "a finite elevation and altitude in suns"),
            (
                (2..=200).contains(&self.altitudes),
                "altitudes from 2 to 200",
            ),
            (
                orders.degree <= Harmonics::MAX_DEGREE,
                "orders.degree of at most 16",
            ),
            (
                orders.peak_degree >= orders.degree && orders.peak_degree <= 64,
                "orders.peak_degree from orders.degree to 64",
            ),
            (
                orders.rescattered_degree <= orders.degree,
                "orders.rescattered_degree of at most orders.degree",
            ),
            (
                directions(&orders.first) && directions(&orders.later),
                "1 to 64 zenith nodes, 1 to 4 panel nodes and at least 1 azimuth in orders.first and orders.later",
            ),
            (orders.tolerance > 0.0, "an orders.tolerance above 0"),
        ];
        match checks.into_iter().find(|(holds, _)| !holds) {
            Some((_, expected)) => Err(SkyError::Setting(expected)),
            None => Ok(()),
        }
    }
}

/// Error of [`Sky::prepare`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SkyError {
    /// The atmosphere has more constituents than the solver supports.
    #[error(
        "expected at most {MAX_CONSTITUENTS} constituents in an atmosphere, got {0}; try merging some"
    )]
    TooManyConstituents(usize),
    /// A setting is out of range; says what is expected.
    #[error("sky setting out of range: expected {0}")]
    Setting(&'static str),
    /// The atmosphere is invalid.
    #[error(transparent)]
    Atmosphere(#[from] AtmosphereError),
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The solved light inside an atmosphere at the wavelengths of a grid. A handle: cheap to clone and to share between
/// threads.
#[derive(Clone)]
pub struct Sky(Arc<Solution>);

/// State shared by all clones of a [`Sky`].
struct Solution {
    atmosphere: Atmosphere,
    grid: WavelengthGrid,
    shell: Arc<Shell>,
    blocks: Vec<Box<dyn Block>>,
}

impl fmt::Debug for Sky {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Sky")
            .field("atmosphere", &self.0.atmosphere.name)
            .field("wavelengths", &self.0.grid.len())
            .finish_non_exhaustive()
    }
}

impl Sky {
    /// Solves for the light inside `atmosphere` at the wavelengths of `grid`, whose solar spectrum is replaced by that of the
    /// atmosphere.
    ///
    /// # Errors
    /// [`SkyError`] if a setting is out of range, or the atmosphere is invalid or has too many constituents.
    pub fn prepare(
        atmosphere: &Atmosphere,
        grid: &WavelengthGrid,
        settings: &SkySettings,
    ) -> Result<Self, SkyError> {
        Self::prepare_with(atmosphere, grid, settings, Control::default())
    }

    /// As [`Sky::prepare`], with progress and cancellation through `control`. Progress is in permille of each block of 16
    /// wavelengths, estimated within a block.
    ///
    /// # Errors
    /// As [`Sky::prepare`]; [`SkyError::Cancelled`] within milliseconds of cancellation.
    pub fn prepare_with(
        atmosphere: &Atmosphere,
        grid: &WavelengthGrid,
        settings: &SkySettings,
        control: Control<'_>,
    ) -> Result<Self, SkyError> {
        settings.validate()?;
        atmosphere.validate()?;
        let shell = Arc::new(Shell::new(atmosphere, settings.suns.includes_low_suns())?);
        let grid = grid.clone().with_solar(&atmosphere.solar_irradiance);
        let blocks = block::solve(atmosphere, &shell, grid.wavelengths_nm(), settings, control)?;
        Ok(Self(Arc::new(Solution {
            atmosphere: atmosphere.clone(),
            grid,
            shell,
            blocks,
        })))
    }

    /// The atmosphere.
    pub fn atmosphere(&self) -> &Atmosphere {
        &self.0.atmosphere
    }

    /// The wavelength grid, with the solar spectrum of the atmosphere.
    pub fn grid(&self) -> &WavelengthGrid {
        &self.0.grid
    }

    pub(super) fn shell(&self) -> &Shell {
        &self.0.shell
    }

    /// Solutions for blocks of wavelengths.
    pub(super) fn blocks(&self) -> &[Box<dyn Block>] {
        &self.0.blocks
    }

    /// View from `altitude_m` (m; raised to the ground if below it) with the sun in the direction of the unit vector `sun`
    /// (world axes: [`crate::axes`]), at the planet's mean distance from the sun.
    pub fn view(&self, altitude_m: f64, sun: DVec3) -> View {
        View::new(self, altitude_m, sun)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::reference;
    use crate::control::Progress;
    use std::sync::Mutex;
    use std::sync::atomic::{AtomicBool, Ordering};

    #[test]
    fn settings_out_of_range_are_refused() {
        type Change = fn(&mut SkySettings);
        let changes: [Change; 7] = [
            |s| s.suns = SunCoverage::near(f64::NAN, 0.0),
            |s| s.altitudes = 1,
            |s| s.orders.degree = 17,
            |s| s.orders.peak_degree = 7,
            |s| s.orders.rescattered_degree = 9,
            |s| s.orders.later.panel_nodes = 5,
            |s| s.orders.tolerance = 0.0,
        ];
        for change in changes {
            let mut settings = SkySettings::default();
            assert_eq!(settings.validate(), Ok(()));
            change(&mut settings);
            assert!(
                matches!(settings.validate(), Err(SkyError::Setting(_))),
                "{settings:?}"
            );
        }
    }
    /// Records progress and cancels after a number of reports.
    struct Recorder {
        reports: Mutex<Vec<(u64, u64)>>,
        cancel: AtomicBool,
        at: usize,
    }

    impl Progress for Recorder {
        fn advanced(&self, done: u64, total: u64) {
            let mut reports = self.reports.lock().unwrap();
            reports.push((done, total));
            self.cancel
                .store(reports.len() >= self.at, Ordering::Relaxed);
        }
    }

    fn recorded(at: usize) -> (Result<Sky, SkyError>, Vec<(u64, u64)>) {
        let recorder = Recorder {
            reports: Mutex::default(),
            cancel: AtomicBool::new(false),
            at,
        };
        let control = Control::cancelled_by(&recorder.cancel).reporting_to(&recorder);
        let settings = SkySettings {
            suns: SunCoverage::near(20.0, 0.0),
            altitudes: 6,
            ..Default::default()
        };
        let nm = (0..20).map(|k| 400.0 + 15.0 * f64::from(k)).collect();
        let grid = WavelengthGrid::from_wavelengths_nm(nm).unwrap();
        let sky = Sky::prepare_with(&reference::earth_demo(), &grid, &settings, control);
        (sky, recorder.reports.into_inner().unwrap())
    }

    #[test]
    fn progress_rises_to_its_total() {
        let (sky, reports) = recorded(usize::MAX);
        assert!(sky.is_ok());
        assert!(reports.len() > 6, "{reports:?}");
        assert!(reports.is_sorted(), "{reports:?}");
        assert!(reports.iter().all(|&(_, total)| total == 2000));
        assert_eq!(reports.last(), Some(&(2000, 2000)));
    }

    #[test]
    fn cancelling_ends_preparation_at_any_stage() {
        for at in [1, 2, 3, 5] {
            let (sky, reports) = recorded(at);
            assert!(matches!(sky, Err(SkyError::Cancelled(_))), "{at}");
            assert_eq!(reports.len(), at, "nothing was done after {at} reports");
        }
    }
}
