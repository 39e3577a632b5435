//! The solver for a spherical, multiply scattering atmosphere.
//!
//! [`Sky::prepare`] solves once for the light inside the atmosphere; a [`View`] then answers, from any height and under
//! any sun that was prepared for, what arrives along a line of sight; and a [`SkyTable`] of a view answers the same for
//! every direction at the cost of a table look-up, for pictures.
//!
//! ```
//! use airlight::{axes, atmosphere::reference, sky::{Sky, SkySettings, SunCoverage}, spectrum::WavelengthGrid};
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
//! The geometry is that of [`crate::transfer`]; `field` and `harmonics` hold the light inside the air, `ray_bundle` rays
//! that share their path, `orders` the solver, `trace` the light along a ray, `samples_along_ray` the same at distances on
//! the way, `table` all directions of a view.

mod block;
mod coverage;
mod field;
mod harmonics;
mod orders;
mod ray_bundle;
mod samples_along_ray;
mod solver;
mod table;
mod tabulate;
mod trace;
mod view;

pub use coverage::SunCoverage;
pub use solver::{Scattering, Sky, SkyError, SkySettings};
pub use table::{SkyColumns, SkyTable, TableChannels};
pub(crate) use tabulate::{Peaked, channel_weights};
pub use view::{LineOfSight, View};
