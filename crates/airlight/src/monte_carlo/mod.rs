//! Monte Carlo path tracing of a spherical atmosphere: unbiased, with a standard error for every result.
//!
//! Paths are traced backwards from the eye through air and ground, with next-event estimation of sunlight at each vertex.
//! The mean over paths is the radiance for any number of paths; only its standard error depends on the number. The book's
//! chapter "Monte Carlo" derives the method.
//!
//! ```
//! use airlight::{axes, atmosphere, monte_carlo::{MonteCarlo, MonteCarloSettings}, spectrum::WavelengthGrid};
//!
//! let air = atmosphere::preset("average")?;
//! let settings = MonteCarloSettings { paths: 4096, ..Default::default() };
//! let sky = MonteCarlo::new(&air, &WavelengthGrid::fast(), settings)?;
//! let zenith = sky.radiance(2.0, axes::direction(180.0, 30.0), axes::direction(0.0, 90.0));
//! for (mean, error) in zenith.mean.iter().zip(&zenith.standard_error) {
//!     assert!(*error < 0.05 * mean);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Modules: `layers` (the layered control medium), `chord` (a straight ray through the layers), `lanes` (optical
//! coefficients by wavelength), `sun`, `lit` (sampling of rays partly in the planet's shadow), `path` (path tracing),
//! `estimate` (mean and standard error), `solver` ([`MonteCarlo`]), `finite` (rays that end at a distance), `stokes`
//! (polarisation along a path), `polarised` (polarised radiance).

mod chord;
mod estimate;
mod finite;
mod lanes;
mod layers;
mod lit;
mod path;
mod polarised;
mod solver;
mod stokes;
mod sun;

pub use estimate::{Estimate, Measured};
pub(crate) use path::ORDERS;
pub use polarised::{PolarisedEstimate, PolarisedSample};
pub use solver::{BUNDLE, MonteCarlo, MonteCarloSettings};
pub use sun::SunShape;
