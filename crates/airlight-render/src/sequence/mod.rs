//! Many pictures: file names, time steps, which are missing.

mod pattern;
mod plan;
mod span;
mod steps;

pub use pattern::FramePattern;
pub use plan::{FrameStep, SequencePlan};
pub use span::parse_span_s;
pub use steps::{Sequence, SequenceStep};
