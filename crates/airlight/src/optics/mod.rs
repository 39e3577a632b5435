//! What one particle does to light.

pub mod ozone;
