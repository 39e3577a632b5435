//! Settings of the sky solver, and its errors.

use super::coverage::SunCoverage;
use super::harmonics::Harmonics;
use crate::atmosphere::AtmosphereError;
use crate::control::Cancelled;
use crate::names::named;
use crate::transfer::shell::{MAX_CONSTITUENTS, TooManyConstituents};

/// Orders of scattering that are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Scattering {
    /// Sunlight scattered once, and the ground lit by direct sunlight.
    Single,
    /// All orders of scattering and reflection.
    All,
}

named! { Scattering, "a scattering", [
    ("all", (All), "all orders of scattering and reflection"),
    ("single", (Single), "sunlight scattered once, and the ground lit by direct sunlight"),
] }

/// Settings of the sky solver.
#[derive(Clone, Debug, PartialEq)]
pub struct SkySettings {
    /// Sun elevations and observer altitudes to prepare for.
    pub suns: SunCoverage,
    /// Distances between these elevations, relative to those of the default settings: 0.1 to 2.
    pub sun_spacing: f64,
    /// Orders of scattering that are computed.
    pub scattering: Scattering,
    /// Number of altitudes at which the light inside the atmosphere is solved for, 2 to 200.
    pub altitudes: usize,
    /// Whether scattering polarises the light, and scatters polarised light as such, which changes the radiance of clear skies by
    /// 1 to 3 %, and by up to 13 % in the violet ([`crate::optics::PhaseFunction::matrix_ratios`] says of which particles the
    /// polarisation is known). Without it the equations are those of scalar light, as in most published tables.
    pub polarisation_correction: bool,
    /// Resolution and convergence of the orders of scattering.
    pub orders: OrderSettings,
}

/// Resolution and convergence of the light scattered more than once.
#[derive(Clone, Debug, PartialEq)]
pub struct OrderSettings {
    /// Degree of the angular moments.
    pub degree: usize,
    /// Degree, at least `degree`, above which the moments of a phase function are treated as a forward peak, and the light in
    /// it as unscattered. Higher values improve the light near the sun; lower values reduce ringing elsewhere if the air
    /// contains much forward-scattering dust.
    pub peak_degree: usize,
    /// Degree, at most `degree`, of the moments that are scattered again while solving; the final field keeps all moments.
    pub rescattered_degree: usize,
    /// Directions for singly scattered light, which contains the forward peak of the aerosol and needs the most.
    pub first: Directions,
    /// Directions for all later orders, which are smoother.
    pub later: Directions,
    /// Relative error of the intensity below which the iteration ends, at any point of the grid under a sun above the horizon; under
    /// others eight times as much. With [`SunCoverage::Near`] it is relative to the intensity at the same height under the eye's sun where
    /// that is larger.
    pub tolerance: f32,
    /// Number of iterations after which the solver gives up.
    pub max_iterations: usize,
    /// Number of orders of scattering in the field, to compute a given number of orders instead of all.
    pub only_orders: Option<usize>,
}

/// Resolution of a set of directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Directions {
    /// Number of zenith angles below the horizon, just above it, and higher up.
    pub zenith_nodes: [usize; 3],
    /// Number of azimuths from that of the sun to the opposite one.
    pub azimuths: usize,
    /// Number of quadrature nodes in a panel of a ray.
    pub panel_nodes: usize,
}

impl Default for SkySettings {
    /// All orders, for all sun elevations, with the accuracy stated in the book: in clear and hazy air within 1 % of Monte Carlo for suns
    /// at 10 degrees and higher, 2 % near the horizon; in desert dust 2 and 4 %.
    fn default() -> Self {
        Self {
            suns: SunCoverage::All,
            sun_spacing: 1.0,
            scattering: Scattering::All,
            altitudes: 17,
            polarisation_correction: true,
            orders: OrderSettings {
                degree: 10,
                peak_degree: 10,
                rescattered_degree: 6,
                first: Directions {
                    zenith_nodes: [7, 10, 5],
                    azimuths: 10,
                    panel_nodes: 3,
                },
                later: Directions {
                    zenith_nodes: [5, 7, 5],
                    azimuths: 6,
                    panel_nodes: 2,
                },
                tolerance: 0.002,
                max_iterations: 100,
                only_orders: None,
            },
        }
    }
}

impl SkySettings {
    /// Settings for reference values, dust and low suns: denser suns, altitudes and directions and more moments; about twenty
    /// times slower.
    pub fn fine() -> Self {
        Self {
            sun_spacing: 0.5,
            altitudes: 28,
            orders: OrderSettings {
                degree: 20,
                peak_degree: 20,
                rescattered_degree: 16,
                first: Directions {
                    zenith_nodes: [12, 16, 12],
                    azimuths: 18,
                    panel_nodes: 4,
                },
                later: Directions {
                    zenith_nodes: [10, 12, 10],
                    azimuths: 14,
                    panel_nodes: 3,
                },
                tolerance: 5e-4,
                ..Self::default().orders
            },
            ..Self::default()
        }
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
            SunCoverage::All | SunCoverage::AboveHorizon => true,
            SunCoverage::Near {
                sun_elevation_deg,
                observer_altitude_m,
            } => sun_elevation_deg.is_finite() && observer_altitude_m.is_finite(),
        };
        let checks = [
            (finite, "a finite elevation and altitude in suns"),
            (
                (0.1..=2.0).contains(&self.sun_spacing),
                "a sun_spacing from 0.1 to 2",
            ),
            (
                (2..=200).contains(&self.altitudes),
                "altitudes from 2 to 200",
            ),
            (
                orders.degree <= Harmonics::MAX_DEGREE,
                "orders.degree of at most 20",
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
                !self.polarisation_correction || orders.rescattered_degree >= 2,
                "orders.rescattered_degree of at least 2 with polarisation_correction",
            ),
            (
                directions(&orders.first) && directions(&orders.later),
                "1 to 64 zenith nodes, 1 to 4 panel nodes and at least 1 azimuth in orders.first and orders.later",
            ),
            (orders.tolerance > 0.0, "an orders.tolerance above 0"),
            (
                orders.max_iterations >= 2,
                "at least 2 orders.max_iterations",
            ),
        ];
        match checks.into_iter().find(|(holds, _)| !holds) {
            Some((_, expected)) => Err(SkyError::Setting(expected)),
            None => Ok(()),
        }
    }
}

/// Error of [`Sky::prepare`](super::Sky::prepare).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
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
    /// The iteration for light scattered more than once did not converge.
    #[error(
        "the light scattered more than once did not converge: error {:.1} % after {iterations} iterations; \
         try less extinction or more altitudes",
        100.0 * error
    )]
    NotConverged {
        /// Estimated relative error.
        error: f32,
        /// Number of iterations.
        iterations: usize,
    },
    /// The computation was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl From<TooManyConstituents> for SkyError {
    fn from(TooManyConstituents(count): TooManyConstituents) -> Self {
        Self::TooManyConstituents(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_out_of_range_are_refused() {
        type Change = fn(&mut SkySettings);
        let changes: [Change; 9] = [
            |s| s.suns = SunCoverage::near(f64::NAN, 0.0),
            |s| s.altitudes = 1,
            |s| s.sun_spacing = 0.0,
            |s| s.orders.degree = 21,
            |s| s.orders.peak_degree = 7,
            |s| s.orders.rescattered_degree = 11,
            |s| s.orders.later.panel_nodes = 5,
            |s| s.orders.tolerance = 0.0,
            |s| s.orders.max_iterations = 1,
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
}
