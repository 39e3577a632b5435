//! The program as its users run it: files, reports, refusals, exit codes.

mod common;

mod accuracy;
mod compare;
mod farm;
mod fog;
mod interrupt;
mod plot;
mod probe;
mod refusals;
mod sky;
mod sky_fog;
#[cfg(feature = "view")]
mod view;
