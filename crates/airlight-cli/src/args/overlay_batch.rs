//! Options of `airlight fog` that make many pictures of many.

use super::overlay_vary::{self, Variation};
use clap::Args;
use std::num::NonZeroU32;
use std::path::PathBuf;

/// Whole folders, variation.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Many pictures")]
pub struct BatchArgs {
    /// Draw an option anew for each picture: visibility=50..500, model=uniform,height (see below)
    #[arg(long, value_name = "NAME=LOW..HIGH|A,B", value_parser = overlay_vary::parse)]
    pub vary: Vec<Variation>,
    /// So many pictures of each: {variant} in --output is the number, else _v0001 before the ending
    #[arg(long, value_name = "N", requires = "vary")]
    pub variants: Option<NonZeroU32>,
    /// What is drawn follows from this number, the picture's name and the number of the variant [default: 0]; so does the
    /// noise of random paths [default: 1]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// A line of JSON for each picture goes there [default: manifest.jsonl beside the outputs]
    #[arg(long, value_name = "FILE")]
    pub manifest: Option<PathBuf>,
    /// Make pictures anew that are there already; else those are taken as done
    #[arg(long)]
    pub overwrite: bool,
    /// Pass over pictures without depth
    #[arg(long)]
    pub skip_unpaired: bool,
    /// Stop at the first picture that fails; else the others are made
    #[arg(long)]
    pub fail_fast: bool,
    /// Threads, and so the most pictures in memory [default: one a core]
    #[arg(long, value_name = "N")]
    pub jobs: Option<NonZeroU32>,
}

impl BatchArgs {
    /// Whether any of them is given: then a single picture is a batch of one.
    pub fn is_given(&self) -> bool {
        !self.vary.is_empty()
            || self.manifest.is_some()
            || self.jobs.is_some()
            || self.overwrite
            || self.skip_unpaired
            || self.fail_fast
    }
}
