//! Validation of Airlight: its solvers compared with measured skies, other codes and Monte Carlo.
//!
//! Each comparison is a [`Check`]: rows of a value and its reference, with direction and wavelength. [`run`] performs all
//! checks of some [`Suite`]s; [`report`] writes them.
//!
//! Modules, each importing only from those above it: [`check`] (rows and their statistics), [`table`] (the embedded tables),
//! [`solved`] (a sky solved at a table's wavelengths), [`skies`] (tables of skies), [`limits`] (skies where solvers fail), [`random_airs`] (random skies), [`fine`] (the same skies with the fine settings),
//! [`measured`] (the measured sky),
//! `frames` (frames of a graphics device, with the feature `gpu`), [`report`].

pub mod check;
pub mod fine;
#[cfg(feature = "gpu")]
pub mod frames;
pub mod limits;
pub mod measured;
pub mod random_airs;
pub mod report;
pub mod skies;
pub mod solved;
pub mod table;

use airlight::sky::SkySettings;
use airlight::{Cancelled, Control, Named};
pub use check::{At, Check, Row, Statistics, Suite, Unit};

/// Error of [`run`].
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// A suite draws on a graphics device, and this crate was built without the feature `gpu`.
    #[error("the suite {0} needs a program built with the feature gpu")]
    WithoutGpu(Suite),
    /// The caller cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Frames could not be drawn.
    #[cfg(feature = "gpu")]
    #[error(transparent)]
    Frames(#[from] frames::FramesError),
}

/// Performs all checks of the suites, in the order of [`Suite::ALL`].
///
/// # Errors
/// [`RunError`] for suites of a graphics device: without one, and without the feature `gpu`.
pub fn run(suites: &[Suite]) -> Result<Vec<Check>, RunError> {
    run_with(suites, Control::default())
}

/// The same, with cancellation, and progress of the suites of a graphics device.
///
/// # Errors
/// As [`run`], and [`RunError::Cancelled`].
pub fn run_with(suites: &[Suite], control: Control<'_>) -> Result<Vec<Check>, RunError> {
    let mut checks = Vec::new();
    for suite in Suite::ALL.iter().filter(|s| suites.contains(s)) {
        control.check()?;
        control.stage(suite.title(), 0);
        checks.extend(match suite {
            Suite::Tables => skies::checks(control)?,
            Suite::MonteCarlo => skies::against_truth(&SkySettings::default(), control)?,
            Suite::Limits => limits::checks(&SkySettings::default(), control)?,
            Suite::RandomAirs => random_airs::checks(&SkySettings::default(), control)?,
            Suite::Fine => fine::checks(control)?,
            Suite::Peers => skies::peers(control)?,
            Suite::Measured => measured::checks(control)?,
            #[cfg(feature = "gpu")]
            Suite::Gpu | Suite::GpuAll => frames::checks(*suite, control)?,
            #[cfg(feature = "gpu")]
            Suite::GpuMonteCarlo => frames::monte_carlo_checks(control)?,
            #[cfg(not(feature = "gpu"))]
            Suite::Gpu | Suite::GpuAll | Suite::GpuMonteCarlo => {
                return Err(RunError::WithoutGpu(*suite));
            }
        });
    }
    Ok(checks)
}
