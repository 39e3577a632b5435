//! Drawing a scene in one call, to memory or to files.

use crate::error::RenderError;
use crate::frame::WrittenFile;
use crate::image::RenderedImage;
use crate::renderer::Renderer;
use crate::sequence::SequenceSettings;
use crate::solutions::Solutions;
use airlight_image::Control;
use web_time::Instant;

impl Renderer {
    /// Draws the scene at its time to memory.
    ///
    /// # Errors
    /// [`RenderError`] if the solver fails, for a cube, and if the caller cancelled.
    pub fn render(&self, control: Control<'_>) -> Result<RenderedImage, RenderError> {
        self.render_sharing(&mut Solutions::default(), control)
    }

    /// [`Self::render`] with the light of a solution that another picture left, if air and suns are the same.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn render_sharing(
        &self,
        solutions: &mut Solutions,
        control: Control<'_>,
    ) -> Result<RenderedImage, RenderError> {
        let frame = self.layout().only_frame()?;
        let begun = Instant::now();
        let suns = self.suns_near(&self.sun(None)?);
        let prepared = solutions.prepare(self, suns, control)?;
        let image = self
            .frame_with(prepared.as_ref(), None, control)?
            .image(&frame, control)?;
        Ok(RenderedImage {
            time: begun.elapsed(),
            ..image
        })
    }

    /// Writes the scene's picture, or the missing pictures of its sequence and their manifest, to `output.file`.
    ///
    /// # Errors
    /// [`RenderError`]; files that are already written remain, and unfinished ones are removed.
    pub fn write(&self, control: Control<'_>) -> Result<Vec<WrittenFile>, RenderError> {
        if let Some(sequence) = self.sequence()? {
            let run = self.start_sequence(&sequence, &SequenceSettings::default())?;
            let mut written = Vec::new();
            if let Some(ready) = self.prepare_sequence(&sequence, run.missing(), control)? {
                for (index, step) in run.missing().iter().enumerate() {
                    control.check()?;
                    let renderer = &ready.renderer;
                    let frame =
                        renderer.frame_with(ready.solution.as_ref(), Some(step.time), control)?;
                    written.extend(run.write(index, &frame, control)?.files);
                }
            }
            run.finish()?;
            return Ok(written);
        }
        let path = self.output_path()?;
        let prepared = self.prepare(self.suns_near(&self.sun(None)?), control)?;
        let frame = self.frame_with(prepared.as_ref(), None, control)?;
        Ok(frame.write(path, control)?.files)
    }
}
