//! Rust twins of the shader functions: the same names, parameters and steps, in f32.
//!
//! The tests run both on the same inputs. Use the twins to compute on the CPU what a shader computes, for instance parameters
//! that are the same for all pixels. The WGSL files document the functions, with their costs and errors.

pub mod air;
pub mod article;
pub mod colour;
pub mod columns;
pub mod disc;
pub mod dither;
pub mod exponentials;
pub mod fog;
pub mod fog_table;
pub mod lights;
pub mod path_optics;
pub mod phase;
pub mod shadows;
pub mod sky_tables;
pub mod texture;
pub mod tone;
