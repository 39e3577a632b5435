//! [`run`]: the viewer in a window.

use crate::app::{Viewer, ViewerError};
use crate::options::Options;

/// Opens a window, and returns when it is closed.
///
/// # Errors
/// [`ViewerError`] without a display or a graphics device.
pub fn run(options: Options) -> Result<(), ViewerError> {
    let viewport = eframe::egui::ViewportBuilder::default()
        .with_title("Airlight")
        .with_app_id("airlight")
        .with_inner_size(options.size)
        .with_min_inner_size([480.0, 320.0]);
    let native = eframe::NativeOptions {
        viewport,
        ..Default::default()
    };
    let create: eframe::AppCreator<'_> = Box::new(|context| {
        let render = context.wgpu_render_state.clone();
        let render = render.ok_or(ViewerError::NoDevice)?;
        let viewer = Viewer::new(&context.egui_ctx, render, options)?;
        Ok(Box::new(viewer))
    });
    eframe::run_native("Airlight", native, create).map_err(|error| match error {
        eframe::Error::WinitEventLoop(_) => ViewerError::NoDisplay,
        error => ViewerError::Window(error.to_string()),
    })
}
