//! Tests of several modules of the crate: whole skies, fog in them, paths of light.
//!
//! A test is a claim, compared with something outside this crate's own results, unless it stands in a module `guards`
//! (CONTRIBUTING.md, "Tests").

mod analytic_drops;
mod book;
mod cancelled;
mod colour;
mod common;
mod fog_drops;
mod fog_monte_carlo;
mod fog_reference;
mod forward_peaks;
mod models;
mod monte_carlo_lines;
mod monte_carlo_polarisation;
mod night;
mod patchy_fog;
mod polarised_sky;
mod properties;
mod reciprocity;
mod sky_laws;
mod smoothness;
mod thick_air;
mod wildfire;
mod worlds;
