//! Sequences of pictures: file names, times and missing pictures.

mod pattern;
mod plan;
mod run;
mod span;
mod steps;

pub use pattern::FramePattern;
pub use plan::{FrameStep, SequencePlan};
pub use run::{SequenceRun, SequenceSettings};
pub use span::parse_span_s;
pub use steps::{PreparedSequence, Sequence, SequenceStep};
