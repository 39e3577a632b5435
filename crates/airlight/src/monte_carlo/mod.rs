//! Light in a spherical atmosphere by Monte Carlo: no approximation, only noise, and the noise is told.
//!
//! Random paths go backwards from the eye through air and ground; at each of their vertices the light that comes
//! straight from the sun is added. The mean over paths is the radiance, whatever their number: only its standard error
//! depends on that. The book's chapter "Monte Carlo" derives it.
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
//! Inside, from the ground up: `layers` (the air in layers in which columns are polynomials), `chord` (a straight way
//! through them), `lanes` (coefficients by wavelength), `sun`, `lit` (the part of a line outside the planet's shadow), `path` (a random
//! path), `estimate` (mean and error), `solver` (the door in), `finite` (lines that end at a distance),
//! `stokes` (what a path carries of polarisation), `polarised` (the door to that).

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

pub use estimate::{Estimate, Measured, Sample};
pub use path::ORDERS;
pub use polarised::{PolarisedEstimate, PolarisedSample};
pub use solver::{BUNDLE, MonteCarlo, MonteCarloSettings};
pub use sun::SunShape;
