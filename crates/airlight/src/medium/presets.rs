//! Atmospheres ready to use.

pub mod reference;
