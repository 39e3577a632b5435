//! Fog over many pictures: inputs are found by name, settings can vary, pictures are processed in parallel, existing ones are
//! kept, and all are recorded in a manifest.
//!
//! 1. [`BatchPlan::new`] finds the inputs of an [`OverlayScene`](crate::overlay::OverlayScene) whose paths are folders or
//!    [`Pattern`]s, and checks that every picture has an output of its own.
//! 2. [`BatchPlan::start`] opens the manifest and finds the pictures that do not exist yet.
//! 3. [`BatchRun::run`] writes them.

mod draw;
mod error;
mod inputs;
mod pattern;
mod plan;
mod record;
mod run;
mod settings;
mod vary;

pub use crate::manifest::listed;
pub use error::BatchError;
pub use inputs::{FoundInputs, Input};
pub use pattern::{Match, Pattern};
pub use plan::{BatchPlan, BatchSettings, Variant, is_batch};
pub use run::{BatchReport, BatchRun};
pub use vary::{Each, Variation};
