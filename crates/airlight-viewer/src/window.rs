//! [`run`]: the viewer in a window.

use crate::app::{Viewer, ViewerError};
use crate::graphics;
use crate::options::Options;
use std::sync::{Arc, Mutex};

/// Opens a window, and returns when it is closed. A window whose graphics device is lost is opened again on another, with what it showed.
///
/// # Errors
/// [`ViewerError`] without a display or a graphics device.
pub fn run(options: Options) -> Result<(), ViewerError> {
    let mut next = Some(options);
    while let Some(options) = next.take() {
        next = run_once(options)?;
    }
    Ok(())
}

/// Opens a window. What it showed if its device was lost.
fn run_once(options: Options) -> Result<Option<Options>, ViewerError> {
    let viewport = eframe::egui::ViewportBuilder::default()
        .with_title("Airlight")
        .with_app_id("airlight")
        .with_inner_size(options.size)
        .with_min_inner_size([480.0, 320.0]);
    let native = eframe::NativeOptions {
        viewport,
        wgpu_options: graphics::configuration(),
        ..Default::default()
    };
    let lost = Arc::new(Mutex::new(None));
    let shown = lost.clone();
    let create: eframe::AppCreator<'_> = Box::new(move |context| {
        let render = context.wgpu_render_state.clone();
        let render = render.ok_or(ViewerError::NoDevice)?;
        let mut viewer = Viewer::new(&context.egui_ctx, render, options)?;
        viewer.close_on_loss(shown);
        Ok(Box::new(viewer))
    });
    eframe::run_native("Airlight", native, create).map_err(|error| match error {
        eframe::Error::WinitEventLoop(_) => ViewerError::NoDisplay,
        error => ViewerError::Window(error.to_string()),
    })?;
    // A thread that holds it has ended with the window.
    let shown = lost.lock().map(|mut shown| shown.take());
    Ok(shown.unwrap_or_default())
}
