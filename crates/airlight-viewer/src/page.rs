//! [`run_in_page`].

use crate::app::{Viewer, ViewerError};
use crate::options::Options;

/// Shows the viewer in a canvas of a page.
///
/// # Errors
/// Why it cannot be shown, as a sentence.
pub async fn run_in_page(
    canvas: web_sys::HtmlCanvasElement,
    options: Options,
) -> Result<(), String> {
    let create: eframe::AppCreator<'_> = Box::new(|context| {
        let render = context.wgpu_render_state.clone();
        let render = render.ok_or(ViewerError::NoDevice)?;
        let viewer = Viewer::new(&context.egui_ctx, render, options)?;
        Ok(Box::new(viewer))
    });
    let runner = eframe::WebRunner::new();
    let started = runner.start(canvas, eframe::WebOptions::default(), create);
    started.await.map_err(|error| {
        let text = error.as_string();
        text.unwrap_or_else(|| format!("{error:?}"))
    })
}
