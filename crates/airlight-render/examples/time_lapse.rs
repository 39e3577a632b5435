//! Draws a sunset every ten minutes, and in a second run only the pictures that are missing:
//!
//!     cargo run --release -p airlight-render --example time_lapse

use airlight::scene::Scene;
use airlight_image::Control;
use airlight_render::{RenderError, Renderer};

const SCENE: &str = r#"
sun = { latitude_deg = 64.1, longitude_deg = -21.9, time = "2026-09-21T18:30:00Z" }
camera = { projection = "fisheye", size = [256, 256] }
output = { file = "sunset-{time}.png", brighten = 0.5 }
sequence = { until = "+1h", every = "10m" }
"#;

fn main() -> Result<(), RenderError> {
    let renderer = Renderer::new(&Scene::from_toml(SCENE)?)?;
    for file in renderer.write(Control::default())? {
        println!("{}", file.path.display());
    }
    Ok(())
}
