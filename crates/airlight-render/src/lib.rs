//! Drawing with Airlight: fog over pictures, objects, sequences.
//!
//! - [`overlay`]: fog laid over a picture and its depth.
//! - [`objects`]: simple solids and their surfaces, intersected by rays.
//! - [`sequence`]: many pictures: file names, time steps, resuming an earlier run.

pub mod objects;
pub mod overlay;
pub mod sequence;
