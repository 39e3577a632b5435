//! A sky, solved for.

use super::block::{self, Block};
use super::coverage::SunCoverage;
use super::orders::{Directions, OrderSettings};
use super::shell::{MAX_CONSTITUENTS, Shell};
use super::view::View;
use crate::medium::{Atmosphere, AtmosphereError};
use crate::spectrum::WavelengthGrid;
use glam::DVec3;
use std::sync::Arc;

/// Which light is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scattering {
    /// Sunlight scattered once, and the ground lit by the sun alone.
    Single,
    /// All orders of scattering and reflection.
    All,
}

/// How a sky is solved.
#[derive(Clone, Debug, PartialEq)]
pub struct SkySettings {
    /// The heights of the sun to prepare for.
    pub suns: SunCoverage,
    /// Which light is computed.
    pub scattering: Scattering,
    /// Number of altitudes at which the light inside the air is solved for.
    pub altitudes: usize,
    /// How finely the orders of scattering are solved.
    pub orders: OrderSettings,
}

impl Default for SkySettings {
    /// All orders for every height of the sun, at the accuracy stated in the book: within 1 % of the Monte Carlo
    /// (sun above 10 degrees), 2 % near the horizon's sun.
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

/// Why a sky cannot be prepared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SkyError {
    /// More constituents than the solver handles.
    #[error(
        "the sky solver handles at most {MAX_CONSTITUENTS} constituents: this atmosphere has {0}"
    )]
    TooManyConstituents(usize),
    /// The atmosphere itself is refused.
    #[error(transparent)]
    Atmosphere(#[from] AtmosphereError),
}

/// An atmosphere's light, solved for at the wavelengths of a grid; shared freely between threads.
pub struct Sky {
    atmosphere: Atmosphere,
    grid: WavelengthGrid,
    shell: Arc<Shell>,
    pub(super) blocks: Vec<Box<dyn Block>>,
}

impl Sky {
    /// Solves for the light inside `atmosphere` at the wavelengths of `grid` (whose solar spectrum is replaced by the
    /// atmosphere's own).
    ///
    /// # Errors
    /// [`SkyError`] for an atmosphere that fails its own validation or has too many constituents.
    pub fn prepare(
        atmosphere: &Atmosphere,
        grid: &WavelengthGrid,
        settings: &SkySettings,
    ) -> Result<Self, SkyError> {
        atmosphere.validate()?;
        let shell = Arc::new(Shell::new(atmosphere)?);
        let grid = grid.clone().with_solar(&atmosphere.solar_irradiance);
        let blocks = block::solve(atmosphere, &shell, grid.wavelengths_nm(), settings)?;
        Ok(Self {
            atmosphere: atmosphere.clone(),
            grid,
            shell,
            blocks,
        })
    }

    /// The atmosphere solved for.
    pub fn atmosphere(&self) -> &Atmosphere {
        &self.atmosphere
    }

    /// The wavelengths solved for, with this atmosphere's sun.
    pub fn grid(&self) -> &WavelengthGrid {
        &self.grid
    }

    pub(super) fn shell(&self) -> &Shell {
        &self.shell
    }

    /// What is seen from `altitude_m` (m; held at the ground below it) when the sun stands in the direction of the unit
    /// vector `sun` (world axes: [`crate::axes`]), at the planet's mean distance from it.
    pub fn view(&self, altitude_m: f64, sun: DVec3) -> View<'_> {
        View::new(self, altitude_m, sun)
    }
}
