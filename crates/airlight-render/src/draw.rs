//! Drawing a whole scene in one call: into memory or into files.

use crate::error::RenderError;
use crate::frame::WrittenFile;
use crate::image::RenderedImage;
use crate::renderer::Renderer;
use airlight_image::Control;
use std::time::Instant;

impl Renderer {
    /// Draws the scene at its time into memory.
    ///
    /// # Errors
    /// [`RenderError`] where the solver refuses the scene, for a cube, or where the caller asked to stop.
    pub fn render(&self, control: Control<'_>) -> Result<RenderedImage, RenderError> {
        let frame = self.layout().only_frame()?;
        let begun = Instant::now();
        let prepared = self.prepare(self.suns_near(&self.sun(None)?), control)?;
        let image = self
            .frame(prepared.as_ref(), None)?
            .image(&frame, control)?;
        Ok(RenderedImage {
            time: begun.elapsed(),
            ..image
        })
    }

    /// Writes the scene's picture, or the pictures of its sequence that are not there yet, to `output.file`.
    ///
    /// # Errors
    /// [`RenderError`]; files already written stay, and nothing is left of an unfinished one.
    pub fn write(&self, control: Control<'_>) -> Result<Vec<WrittenFile>, RenderError> {
        if let Some(sequence) = self.sequence()? {
            let missing = sequence.missing();
            let Some(suns) = self.suns_of(&missing)? else {
                return Ok(Vec::new());
            };
            let prepared = self.prepare(suns, control)?;
            let mut written = Vec::new();
            for step in missing {
                control.check()?;
                let frame = self.frame(prepared.as_ref(), Some(step.time))?;
                written.extend(frame.write(&step.path, control)?.files);
            }
            return Ok(written);
        }
        let path = self.output_path()?;
        let prepared = self.prepare(self.suns_near(&self.sun(None)?), control)?;
        let frame = self.frame(prepared.as_ref(), None)?;
        Ok(frame.write(path, control)?.files)
    }
}
