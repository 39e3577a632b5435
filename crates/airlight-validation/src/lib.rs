//! Validation of Airlight: its solvers compared with measured skies, other codes and Monte Carlo.
//!
//! Each comparison is a [`Check`]: rows of a value and its reference, with direction and wavelength. [`run`] performs all
//! checks of some [`Suite`]s; [`report`] writes them.
//!
//! Modules, each importing only from those above it: [`check`] (rows and their statistics), [`table`] (the embedded tables),
//! [`solved`] (a sky solved at a table's wavelengths), [`skies`] (tables of skies), [`limits`] (skies where solvers fail), [`measured`] (the measured sky),
//! [`report`].

pub mod check;
pub mod limits;
pub mod measured;
pub mod report;
pub mod skies;
pub mod solved;
pub mod table;

use airlight::Named;
use airlight::sky::SkySettings;
pub use check::{At, Check, Row, Statistics, Suite, Unit};

/// Performs all checks of the suites, in the order of [`Suite::ALL`].
pub fn run(suites: &[Suite]) -> Vec<Check> {
    let wanted = Suite::ALL.iter().filter(|s| suites.contains(s));
    wanted
        .flat_map(|suite| match suite {
            Suite::Tables => skies::checks(),
            Suite::MonteCarlo => skies::against_truth(&SkySettings::default()),
            Suite::Limits => limits::checks(),
            Suite::Peers => skies::peers(),
            Suite::Measured => measured::checks(),
        })
        .collect()
}
