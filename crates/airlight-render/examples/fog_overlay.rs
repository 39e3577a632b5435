//! Fog of 12 m visibility over a photograph with depth in millimetres: `fog_overlay photo.png depth_mm.png fogged.png`.

use airlight_image::Control;
use airlight_render::overlay::{OverlayImage, OverlayScene, PreparedOverlay};
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let files: Vec<String> = std::env::args().skip(1).collect();
    let [colour, depth, output] = &files[..] else {
        return Err(
            "expected three files; try fog_overlay photo.png depth_mm.png fogged.png".into(),
        );
    };
    let mut scene = OverlayScene::default();
    scene.overlay.colour = colour.into();
    scene.overlay.depth = Some(depth.into());
    scene.overlay.depth_scale = 0.001;
    scene.fog_mut().visibility_m = Some(12.0);
    scene.check()?;
    let output = Path::new(output);
    let format = scene.output_format(output)?;
    let image = OverlayImage::read(&scene, format)?;
    let prepared = PreparedOverlay::new(&scene, &image, None)?;
    let rows = prepared.output(&scene, &image, format)?;
    rows.write(output, Control::default())?;
    Ok(())
}
