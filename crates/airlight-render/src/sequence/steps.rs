//! Pictures of a scene's sequence: times, files, and missing pictures.

use super::{FramePattern, SequencePlan, parse_span_s};
use crate::error::RenderError;
use crate::layout::PictureFile;
use crate::manifest::is_whole;
use crate::renderer::Renderer;
use airlight::scene::PreparedModel;
use airlight::sky::SunCoverage;
use airlight::sun::Moment;
use airlight_image::Control;
use airlight_image::tone::Exposure;
use std::path::PathBuf;
use std::sync::Arc;

/// Pictures of a scene's sequence.
#[derive(Clone, Debug)]
pub struct Sequence {
    steps: Vec<SequenceStep>,
}

/// Pictures of a sequence, ready to draw.
#[derive(Clone, Debug)]
pub struct PreparedSequence {
    /// Solution for all their suns.
    pub solution: Arc<dyn PreparedModel>,
    /// Renderer with the exposure that all pictures of the sequence share, if they are metered together
    /// ([`Renderer::common_exposure`]).
    pub renderer: Renderer,
}

/// One picture of a sequence.
#[derive(Clone, Debug)]
pub struct SequenceStep {
    /// Number of the picture, from 1.
    pub number: u64,
    /// Time of the picture.
    pub time: Moment,
    /// Main file.
    pub path: PathBuf,
    /// All files, with the main file last.
    pub files: Vec<PictureFile>,
}

impl Renderer {
    /// Pictures of the scene's sequence, including those that exist already; `None` for a scene without a sequence.
    ///
    /// # Errors
    /// [`RenderError`] for a sequence without a file name, with a fixed sun, or with invalid times.
    pub fn sequence(&self) -> Result<Option<Sequence>, RenderError> {
        Sequence::of(self)
    }

    /// Solves for the light of pictures of a sequence, and meters the exposure that all its pictures share; `None` for no
    /// pictures.
    ///
    /// # Errors
    /// As [`Renderer::sun`] and [`Renderer::prepare`].
    pub fn prepare_sequence(
        &self,
        sequence: &Sequence,
        pictures: &[SequenceStep],
        control: Control<'_>,
    ) -> Result<Option<PreparedSequence>, RenderError> {
        let metered: Vec<&SequenceStep> = match self.meters_together() {
            true => sequence.first_middle_last(),
            false => Vec::new(),
        };
        if pictures.is_empty() {
            return Ok(None);
        }
        // By the whole sequence, so that a picture does not depend on which others are drawn with it.
        let suns = match sequence.steps() {
            [only] => self.suns_near(&self.sun(Some(only.time))?),
            _ => SunCoverage::All,
        };
        let solution = self.prepare(suns, control)?;
        let mut common: Option<Exposure> = None;
        for step in metered {
            let frame = self.frame_with(solution.as_ref(), Some(step.time), control)?;
            let exposure = frame.exposure()?;
            if common.is_none_or(|least| exposure.factor() < least.factor()) {
                common = Some(exposure);
            }
        }
        Ok(Some(PreparedSequence {
            solution,
            renderer: match common {
                Some(exposure) => self.clone().with_exposure(exposure),
                None => self.clone(),
            },
        }))
    }

    /// Whether the pictures of a sequence have one exposure, which is metered.
    pub(super) fn meters_together(&self) -> bool {
        let sequence = self.scene().sequence.as_ref();
        let is_linear = self
            .layout()
            .format()
            .is_none_or(|format| format.is_linear());
        sequence.is_some_and(|sequence| sequence.meter_each != Some(true))
            && !is_linear
            && self.exposure().ev100.is_none()
    }
}

impl Sequence {
    /// The sequence of a renderer's scene, if it has one.
    fn of(renderer: &Renderer) -> Result<Option<Self>, RenderError> {
        let Some(spec) = &renderer.scene().sequence else {
            return Ok(None);
        };
        let (Some(until), Some(every)) = (&spec.until, &spec.every) else {
            return Ok(None);
        };
        let pattern = FramePattern::new(renderer.output_path()?);
        let Some(start) = renderer.resolved().sun.start() else {
            return Err(RenderError::value(
                "sequence.until",
                "a sun of place and time",
                "a fixed sun",
                "sun.latitude_deg, longitude_deg and time",
            ));
        };
        let start = start.at(start.unix_s().floor());
        let refused = |key: &str, got: &str, right: String| RenderError::value(key, right, got, "");
        let end_s = match until.trim().strip_prefix('+') {
            Some(span) => {
                let span_s =
                    parse_span_s(span).map_err(|right| refused("sequence.until", until, right))?;
                start.unix_s() + span_s as f64
            }
            None => Moment::parse(until)
                .map_err(|error| refused("sequence.until", until, error.to_string()))?
                .unix_s(),
        };
        let every_s =
            parse_span_s(every).map_err(|right| refused("sequence.every", every, right))?;
        if end_s < start.unix_s() {
            return Err(RenderError::value(
                "sequence.until",
                format!("a time later than {}", start),
                until.clone(),
                "a duration such as +6h",
            ));
        }
        // Refuse times out of range before anything is computed.
        renderer.sun(Some(start.at(end_s)))?;
        let plan = SequencePlan::new(start.unix_s() as i64, end_s.floor() as i64, every_s)?;
        let step = |step: super::FrameStep| {
            let path = pattern.path(step.number, step.time_s);
            SequenceStep {
                number: step.number,
                time: start.at(step.time_s as f64),
                files: renderer.layout().files(&path),
                path,
            }
        };
        Ok(Some(Self {
            steps: plan.frames().map(step).collect(),
        }))
    }

    /// All pictures.
    pub fn steps(&self) -> &[SequenceStep] {
        &self.steps
    }

    pub(super) fn first_middle_last(&self) -> Vec<&SequenceStep> {
        let last = self.steps.len().saturating_sub(1);
        let places = [0, last / 2, last];
        places.iter().filter_map(|&k| self.steps.get(k)).collect()
    }
}

impl SequenceStep {
    /// Whether all its files exist.
    pub(super) fn is_whole(&self) -> bool {
        self.files.iter().all(|file| is_whole(&file.path))
    }

    /// Number of rows of all files.
    pub fn rows(&self) -> u64 {
        self.files
            .iter()
            .map(|file| u64::from(file.size().height()))
            .sum()
    }
}
