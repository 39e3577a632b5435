//! Draws a sky with the sun's disc into an OpenEXR file, linear light in cd/m^2:
//!
//!     cargo run --release -p airlight-render --example sky_to_exr -- sky.exr

use airlight::scene::{Projection, Scene};
use airlight_image::Control;
use airlight_render::{RenderError, Renderer};

fn main() -> Result<(), RenderError> {
    let mut scene = Scene::default();
    scene.sun.elevation_deg = Some(10.0);
    scene.sun.azimuth_deg = Some(225.0);
    scene.air.aod_550 = Some(0.2);
    scene.camera.projection = Some(Projection::Perspective);
    scene.camera.size = Some([480, 270]);
    scene.output.file = std::env::args().nth(1).or(Some("sky.exr".to_owned()));
    for file in Renderer::new(&scene)?.write(Control::default())? {
        println!("{}: {} bytes", file.path.display(), file.written.bytes);
    }
    Ok(())
}
