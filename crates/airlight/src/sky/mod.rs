//! Solver for a spherical atmosphere with multiple scattering.
//!
//! [`Sky::prepare`] solves for the light inside the atmosphere once. A [`View`] evaluates the radiance along any view ray
//! for an observer altitude and a position of the sun within the prepared range. A [`SkyTable`] tabulates a view over all
//! directions, so that a pixel of a picture costs one table look-up.
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
//! The geometry is in [`crate::transfer`]. Modules: `field` and `harmonics` (angular moments of the light inside the
//! atmosphere), `polarised` (moments of its polarisation), `horizon` (light that forward peaks scatter at the horizon), `orders`
//! (all orders of scattering), `horizontal_exchange`, `damping` and `mixing` (its corrections in thick air), `transport` (light scattered once
//! more), `plane_parallel` (its direct solution in plane-parallel air), `ray_bundle` (rays that share their path), `trace` (light
//! along one ray), `samples_along_rays` and `along_row` (light at many distances along rays of one elevation), `table` (all directions of a view),
//! `table_coordinates` (where its rows and columns are dense), `horizontal_irradiance` (the sum over all directions), `split` (its light in
//! two parts that vary slowly, for tables), `stokes` (its
//! polarisation).

mod air;
mod along_row;
mod batch;
mod between_azimuths;
mod block;
mod coverage;
mod damping;
mod field;
mod harmonics;
mod horizon;
mod horizontal_exchange;
mod horizontal_irradiance;
mod light;
mod light_source;
mod mixing;
mod orders;
mod peaked;
mod plane_parallel;
mod polarised;
mod ray_bundle;
mod rgb_view;
mod samples_along_rays;
mod settings;
mod solver;
mod split;
mod stokes;
mod table;
mod table_coordinates;
mod tabulate;
mod trace;
mod transport;
mod view;

pub use along_row::{RowPath, RowRay};
pub use coverage::SunCoverage;
pub use light_source::LightSource;
pub(crate) use peaked::Peaked;
pub use rgb_view::RgbView;
pub use settings::{Directions, OrderSettings, Scattering, SkyError, SkySettings};
pub use solver::Sky;
pub use split::{SplitLight, SplitPath, SplitView};
pub use stokes::{PolarisationTable, PolarisedLight};
pub use table::{SkyColumns, SkyTable, TableChannels};
pub use table_coordinates::TableCoordinates;
pub(crate) use tabulate::channel_weights;
pub use view::{LineOfSight, View};
