//! The solver for a spherical, multiply scattering atmosphere.
//!
//! [`Sky::prepare`] solves once for the light inside the atmosphere; a [`View`] then answers, from any height and under
//! any sun that was prepared for, what arrives along a line of sight; and a [`SkyTable`] of a view answers the same for
//! every direction at the cost of a table look-up, for pictures.
//!
//! ```
//! use airlight::{axes, medium::reference, sky::{Sky, SkySettings, SunCoverage}, spectrum::WavelengthGrid};
//!
//! let settings = SkySettings { suns: SunCoverage::near(30.0, 0.0), ..Default::default() };
//! let sky = Sky::prepare(&reference::earth_demo(), &WavelengthGrid::fast(), &settings)?;
//! let view = sky.view(2.0, axes::direction(180.0, 30.0));
//! let zenith = view.along(axes::direction(0.0, 90.0), None);
//! let xyz = sky.grid().to_xyz(&zenith.radiance());
//! assert!(xyz[2] > xyz[0], "the sky is blue: {xyz:?}");
//! # Ok::<(), airlight::sky::SkyError>(())
//! ```
//!
//! Inside, from the ground up: [`ray`] (lines, spheres, shadows), [`quadrature`], [`shell`] (the geometry of an
//! atmosphere) with its [`columns`], [`march`] (walking along a ray), [`air`] (an atmosphere at N wavelengths),
//! [`harmonics`] and [`field`] (the light inside the air), `fan` (rays that share their way), [`orders`] (solving for the
//! light), [`trace`] (light along a line), `stops` (the same, kept on the way), `table` (all directions of a view).

pub mod air;
mod block;
pub mod columns;
mod coverage;
pub(crate) mod cubic;
mod fan;
pub mod field;
pub mod harmonics;
pub mod march;
pub mod monte_carlo;
pub mod orders;
pub mod quadrature;
pub mod ray;
pub mod shell;
mod solver;
mod stops;
mod table;
mod tabulate;
pub mod trace;
mod view;

pub use coverage::SunCoverage;
pub use solver::{Scattering, Sky, SkyError, SkySettings};
pub use table::{SkyColumns, SkyTable, TableChannels};
pub(crate) use tabulate::{Peaked, channel_weights};
pub use view::{LineOfSight, View};
