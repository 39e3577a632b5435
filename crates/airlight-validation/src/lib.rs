//! How right Airlight is: its solvers beside measured skies, other people's codes and a Monte Carlo.
//!
//! Each comparison is a [`Check`]: rows of a value of ours beside a reference, with the place they belong to. [`run`] makes
//! all checks of some [`Suite`]s; [`report`] writes them.
//!
//! Rooms, each importing only from those above it: [`check`] (rows and their statistics), [`table`] (the embedded tables),
//! [`solved`] (a sky solved for a table's wavelengths), [`skies`] (against tables of skies), [`measured`] (against the
//! measured sky), [`report`].

pub mod check;
pub mod measured;
pub mod report;
pub mod skies;
pub mod solved;
pub mod table;

use airlight::sky::SkySettings;
pub use check::{At, Check, Row, Statistics, Suite, Unit};

/// Makes all checks of the suites, in the order of [`Suite::ALL`].
pub fn run(suites: &[Suite]) -> Vec<Check> {
    let wanted = Suite::ALL.into_iter().filter(|s| suites.contains(s));
    wanted
        .flat_map(|suite| match suite {
            Suite::Tables => skies::checks(),
            Suite::MonteCarlo => skies::against_truth(&SkySettings::default()),
            Suite::Peers => skies::peers(),
            Suite::Measured => measured::checks(),
        })
        .collect()
}
