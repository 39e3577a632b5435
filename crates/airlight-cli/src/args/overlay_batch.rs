//! Options of `airlight fog` for many pictures.

use crate::parse;
use airlight_render::Shard;
use airlight_render::batch::{BatchSettings, Each, Variation};
use clap::Args;
use std::num::NonZeroU32;
use std::path::PathBuf;

/// Many pictures.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Many pictures")]
pub struct BatchArgs {
    /// Draw a random value of a setting for each picture: visibility=50..500, fog-profile=uniform,height (see below)
    #[arg(long, value_name = "NAME=LOW..HIGH|A,B")]
    pub vary: Vec<Variation>,
    /// Make every picture with each of several values: visibility=5,10,20 gives three; several options give all combinations.
    /// {NAME} in --output is replaced by the value, otherwise _NAME-VALUE precedes the extension
    #[arg(long, value_name = "NAME=A,B,C")]
    pub each: Vec<Each>,
    /// Number of variants of each input; {variant} in --output is replaced by their number, otherwise _v0001 precedes the
    /// extension
    #[arg(long, value_name = "N", requires = "vary")]
    pub variants: Option<NonZeroU32>,
    /// Time between successive pictures, as of a film, for which --patch-wind moves the patches of the fog, s [default: 0]
    #[arg(long, value_name = "S", value_parser = parse::number)]
    pub patch_interval_s: Option<f64>,
    /// Seed of the draws of --vary, which also depend on the picture's name and the variant [default: 0], and of Monte Carlo
    /// paths [default: 1]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Make only a part of the pictures, for one of several machines: 3/16 is the third of 16 parts, with the same draws as a run of
    /// all
    #[arg(long, value_name = "K/N")]
    pub shard: Option<Shard>,
    /// Draw nothing and write a job template of Open Job Description for render farms, whose tasks make the shards
    #[arg(long, value_name = "FILE.json", conflicts_with_all = ["shard", "manifest", "overwrite"])]
    pub openjd: Option<PathBuf>,
    /// Number of tasks of the job [default: 16, or fewer for few pictures]
    #[arg(long, value_name = "N", requires = "openjd")]
    pub tasks: Option<u32>,
    /// Manifest, with a line of JSON for each picture [default: manifest.jsonl beside the outputs; with --shard 3/16
    /// manifest-3-of-16.jsonl]
    #[arg(long, value_name = "FILE")]
    pub manifest: Option<PathBuf>,
    /// Replace existing pictures; otherwise they are kept
    #[arg(long)]
    pub overwrite: bool,
    /// Leave out pictures without depth
    #[arg(long)]
    pub skip_unpaired: bool,
    /// Stop at the first picture that fails; otherwise continue with the others
    #[arg(long)]
    pub fail_fast: bool,
    /// Number of threads, which also limits the pictures in memory [default: one for each processor]
    #[arg(long, value_name = "N")]
    pub jobs: Option<NonZeroU32>,
}

impl BatchArgs {
    /// Whether any option of batches is given; a single picture is then a batch of one.
    pub fn is_given(&self) -> bool {
        !self.vary.is_empty()
            || !self.each.is_empty()
            || self.shard.is_some()
            || self.openjd.is_some()
            || self.patch_interval_s.is_some()
            || self.manifest.is_some()
            || self.jobs.is_some()
            || self.overwrite
            || self.skip_unpaired
            || self.fail_fast
    }

    /// The settings of a batch.
    pub fn settings(&self) -> BatchSettings {
        BatchSettings {
            vary: self.vary.clone(),
            each: self.each.clone(),
            variants: self.variants,
            shard: self.shard,
            patch_interval_s: self.patch_interval_s,
            seed: self.seed.unwrap_or_default(),
            manifest: self.manifest.clone(),
            overwrite: self.overwrite,
            skip_unpaired: self.skip_unpaired,
            fail_fast: self.fail_fast,
            threads: self.jobs,
        }
    }
}
