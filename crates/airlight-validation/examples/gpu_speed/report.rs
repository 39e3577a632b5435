//! What is printed: a table of passes, and one of events.

use serde::Serialize;
use std::fmt;

/// All times.
#[derive(Debug, Serialize)]
pub struct Report {
    /// Name of the adapter.
    pub adapter: String,
    /// Its driver.
    pub driver: String,
    /// What passes are timed by.
    pub clock: String,
    /// Rounds of which medians are taken.
    pub frames: usize,
    /// Places where the densities of the air are evaluated, by event: ours, and those of Hillaire 2020.
    pub evaluations: Vec<[u64; 2]>,
    /// Times by size.
    pub sizes: Vec<SizeReport>,
}

/// Times of frames of one size.
#[derive(Debug, Serialize)]
pub struct SizeReport {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Times of passes.
    pub passes: Vec<Pass>,
    /// Times of frames, in the order of [`Report::evaluations`].
    pub events: Vec<Event>,
}

/// Time of a pass.
#[derive(Debug, Serialize)]
pub struct Pass {
    /// Renderer and pass.
    pub name: String,
    /// Median, ms.
    pub ms: f64,
}

/// Times of a frame after which something has changed.
#[derive(Debug, Serialize)]
pub struct Event {
    /// What has changed.
    pub name: String,
    /// Median of `airlight-gpu`, ms.
    pub ours_ms: f64,
    /// Median of Hillaire 2020, ms.
    pub hillaire_ms: f64,
    /// Median of the ratios of the rounds.
    pub ratio: f64,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            adapter,
            driver,
            clock,
            frames,
            ..
        } = self;
        writeln!(
            f,
            "{adapter}, driver {driver}; {clock}; medians of {frames} rounds, ms\n"
        )?;
        write!(f, "| pass |")?;
        for SizeReport {
            size: [width, height],
            ..
        } in &self.sizes
        {
            write!(f, " {width} x {height} |")?;
        }
        writeln!(f, "\n|---|{}", "---|".repeat(self.sizes.len()))?;
        let passes = self.sizes.first().map_or(0, |size| size.passes.len());
        for index in 0..passes {
            write!(f, "| {} |", self.sizes[0].passes[index].name)?;
            for size in &self.sizes {
                write!(f, " {:.3} |", size.passes[index].ms)?;
            }
            writeln!(f)?;
        }
        writeln!(
            f,
            "\n| size | event | airlight-gpu | Hillaire 2020 | ratio | evaluations of the medium |"
        )?;
        writeln!(f, "|---|---|---|---|---|---|")?;
        for SizeReport {
            size: [width, height],
            events,
            ..
        } in &self.sizes
        {
            for (event, [ours, theirs]) in events.iter().zip(&self.evaluations) {
                let Event {
                    name,
                    ours_ms,
                    hillaire_ms,
                    ratio,
                } = event;
                writeln!(
                    f,
                    "| {width} x {height} | {name} | {ours_ms:.3} | {hillaire_ms:.3} | {ratio:.2} | {ours}, {theirs} |"
                )?;
            }
        }
        Ok(())
    }
}
