//! Smoke of burning vegetation, from sun photometer measurements.

use super::modes::Mode;
use crate::optics::RefractiveIndex;
use crate::optics::mie::{Complex64, SizeDistribution};
use std::f64::consts::PI;

/// Optical depth at 440 nm at which size distributions are evaluated: the middle of the measured range.
const OPTICAL_DEPTH_440: f64 = 0.5;

/// Largest radius of the inversions, micrometres.
const LARGEST_UM: f64 = 15.0;

/// Smoke of one region, from O. Dubovik et al., *Variability of absorption and optical properties of key aerosol types observed in
/// worldwide locations*, J. Atmos. Sci. 59, 590, 2002, table 1: two lognormal volume distributions with one refractive
/// index at all wavelengths. Values are means over the column of ambient air, so humidity is not a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Smoke {
    /// African savanna, Zambia 1995 to 2000.
    Savanna,
    /// Amazonian forest, Brazil and Bolivia 1993 to 1999.
    Forest,
    /// Boreal forest, United States and Canada 1994 to 1998.
    Boreal,
}

impl Smoke {
    /// Fine and coarse mode at an optical depth of 0.5 at 440 nm. Number densities are those of a column 1 m high.
    pub(super) fn modes(self) -> Vec<Mode> {
        let tau = OPTICAL_DEPTH_440;
        // n, k; for each mode median radius of the volume (micrometres), standard deviation of ln r, volume in a column
        // (cubic micrometres over a square micrometre).
        let (index, fine, coarse) = match self {
            Self::Savanna => (
                Complex64::new(1.51, 0.021),
                [0.12 + 0.025 * tau, 0.40, 0.12 * tau],
                [3.22 + 0.71 * tau, 0.73, 0.09 * tau],
            ),
            Self::Forest => (
                Complex64::new(1.47, 0.0093),
                [0.14 + 0.013 * tau, 0.40, 0.12 * tau],
                [3.27 + 0.58 * tau, 0.79, 0.05 * tau],
            ),
            Self::Boreal => (
                Complex64::new(1.50, 0.0094),
                [0.15 + 0.015 * tau, 0.43, 0.01 + 0.1 * tau],
                [3.21 + 0.2 * tau, 0.81, 0.01 + 0.03 * tau],
            ),
        };
        let mode = |[radius_um, deviation, volume]: [f64; 3]| {
            // The median of the number lies 3 deviation^2 below that of the volume, in ln r.
            let median_um = radius_um * (-3.0 * deviation * deviation).exp();
            let sizes = SizeDistribution::log_normal(median_um, deviation.exp());
            let mean_volume_um3 = 4.0 / 3.0 * PI * sizes.mean_power(3.0);
            let sizes = SizeDistribution::LogNormal {
                median_radius_um: median_um,
                geometric_deviation: deviation.exp(),
                range_um: [0.0, LARGEST_UM],
            };
            Mode {
                // A column volume of 1 um^3/um^2 in a column 1 m high is 1e6 um^3 per cm^3.
                number_per_cm3: 1e6 * volume / mean_volume_um3,
                index: RefractiveIndex::constant(index),
                sizes,
            }
        };
        vec![mode(fine), mode(coarse)]
    }
}
