//! The prepared sky.

use super::block::{self, Block};
use super::coverage::SunCoverage;
use super::settings::{SkyError, SkySettings};
use crate::atmosphere::Atmosphere;
use crate::control::Control;
use crate::math::parallel;
use crate::spectrum::WavelengthGrid;
use crate::transfer::columns::SlantColumns;
use crate::transfer::shell::Shell;
use std::fmt;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The solved light inside an atmosphere at the wavelengths of a grid. A handle: cheap to clone and to share between
/// threads.
#[derive(Clone)]
pub struct Sky(Arc<Solution>);

/// State shared by all clones of a [`Sky`].
struct Solution {
    atmosphere: Atmosphere,
    grid: WavelengthGrid,
    settings: SkySettings,
    columns: Arc<SlantColumns>,
    blocks: Vec<Box<dyn Block>>,
    /// The same for all suns and altitudes, once a view needs it.
    wider: OnceLock<Result<Sky, SkyError>>,
    /// Held while that is solved for, so that views in other threads wait for it.
    widening: Mutex<()>,
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
        let shell = Shell::new(atmosphere, settings.suns.includes_low_suns())?;
        let columns = Arc::new(SlantColumns::new(shell));
        let grid = grid.clone().with_solar(&atmosphere.solar_irradiance);
        let blocks = block::solve(
            atmosphere,
            &columns,
            grid.wavelengths_nm(),
            settings,
            control,
        )?;
        Ok(Self(Arc::new(Solution {
            atmosphere: atmosphere.clone(),
            grid,
            settings: settings.clone(),
            columns,
            blocks,
            wider: OnceLock::new(),
            widening: Mutex::new(()),
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

    /// Estimated relative error of the iteration for light scattered more than once: the largest over heights, suns and
    /// wavelengths, below [`OrderSettings::tolerance`](super::OrderSettings::tolerance); 0 for a given number of orders. Errors
    /// under suns below the horizon count an eighth, and with [`SunCoverage::Near`] those of light weaker than under the eye's sun less.
    /// Errors of the resolution come on top.
    pub fn iteration_error(&self) -> f32 {
        let blocks = self.0.blocks.iter();
        blocks
            .map(|block| block.iteration_error())
            .fold(0.0, f32::max)
    }

    /// True if the sky is prepared for views from `altitude_m` (m above sea level) under a sun at an elevation (degrees):
    /// [`SkySettings::suns`]. For others [`Sky::view`] and [`Sky::try_view`] have to solve again.
    pub fn covers(&self, altitude_m: f64, sun_elevation_deg: f64) -> bool {
        let shell = self.shell();
        let height_m = shell.planet_radius_m + altitude_m - shell.ground_radius_m;
        let bounds = (shell.ground_radius_m, shell.top_radius_m);
        let SkySettings {
            suns, sun_spacing, ..
        } = self.0.settings;
        suns.covers(
            (height_m, sun_elevation_deg),
            sun_spacing,
            bounds.0,
            bounds.1,
        )
    }

    /// This sky if it covers a view, otherwise that for all suns and altitudes.
    ///
    /// # Errors
    /// [`SkyError::NotConverged`]; [`SkyError::Cancelled`], after which the next view solves again.
    pub(super) fn covering(
        &self,
        altitude_m: f64,
        sun_elevation_deg: f64,
        control: Control<'_>,
    ) -> Result<&Self, SkyError> {
        if self.covers(altitude_m, sun_elevation_deg) {
            return Ok(self);
        }
        let wider = &self.0.wider;
        if wider.get().is_none() {
            let _widening = self
                .0
                .widening
                .lock()
                .unwrap_or_else(PoisonError::into_inner);
            if wider.get().is_none() {
                let settings = SkySettings {
                    suns: SunCoverage::All,
                    ..self.0.settings.clone()
                };
                let (air, grid) = (&self.0.atmosphere, &self.0.grid);
                match parallel::apart(|| Self::prepare_with(air, grid, &settings, control)) {
                    Err(SkyError::Cancelled(cancelled)) => return Err(cancelled.into()),
                    solved => drop(wider.set(solved)),
                }
            }
        }
        match wider.get() {
            Some(solved) => solved.as_ref().map_err(Clone::clone),
            None => unreachable!("the wider sky was solved for under the lock"),
        }
    }

    pub(super) fn shell(&self) -> &Shell {
        &self.0.columns.shell
    }

    /// Solutions for blocks of wavelengths.
    pub(super) fn blocks(&self) -> &[Box<dyn Block>] {
        &self.0.blocks
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::reference;
    use crate::axes;
    use crate::control::Progress;
    use std::sync::atomic::{AtomicBool, Ordering};

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
        let mut settings = SkySettings {
            suns: SunCoverage::near(20.0, 0.0),
            altitudes: 6,
            ..Default::default()
        };
        // So that it takes several iterations.
        settings.orders.tolerance = 1e-5;
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
    fn a_view_beyond_the_prepared_ones_that_does_not_converge_is_an_error() {
        let grid = WavelengthGrid::from_wavelengths_nm(vec![450.0]).unwrap();
        let mut settings = SkySettings {
            suns: SunCoverage::near(70.0, 0.0),
            ..Default::default()
        };
        // Enough for high suns, whose light needs no horizontal exchange, and not for all suns.
        settings.orders.max_iterations = 2;
        let sky = Sky::prepare(&reference::earth_demo(), &grid, &settings).unwrap();
        assert!(sky.try_view(0.0, axes::direction(180.0, 70.0)).is_ok());
        let view = sky.try_view(0.0, axes::direction(180.0, -3.0));
        assert!(matches!(view, Err(SkyError::NotConverged { .. })));
    }

    #[test]
    fn cancelling_ends_preparation_at_any_stage() {
        for at in [1, 2, 3, 5] {
            let (sky, reports) = recorded(at);
            assert!(matches!(sky, Err(SkyError::Cancelled(_))), "{at}");
            assert_eq!(reports.len(), at, "nothing was done after {at} reports");
        }
    }

    #[test]
    fn a_view_after_a_cancelled_one_is_solved() {
        let settings = SkySettings {
            suns: SunCoverage::near(60.0, 0.0),
            altitudes: 6,
            ..SkySettings::default()
        };
        let (air, grid) = (reference::rayleigh(0.1), WavelengthGrid::rgb());
        let sky = Sky::prepare(&air, &grid, &settings).unwrap();
        let (stop, sun) = (AtomicBool::new(true), axes::direction(0.0, 10.0));
        let stopped = sky.view_with(0.0, sun, Control::cancelled_by(&stop));
        assert!(matches!(stopped, Err(SkyError::Cancelled(_))));
        let view = sky.view_with(0.0, sun, Control::default()).unwrap();
        let zenith = view.along(axes::direction(0.0, 90.0), None).radiance();
        assert!(zenith.iter().all(|&v| v > 0.0), "{zenith:?}");
    }
}
