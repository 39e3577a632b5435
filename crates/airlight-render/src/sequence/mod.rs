//! Many pictures: file names, time steps, taking up where an earlier run stopped.

mod pattern;
mod plan;

pub use pattern::FramePattern;
pub use plan::{FrameStep, SequencePlan, SequenceProgress, SequenceReport, run};
