//! Draws two curves as SVG and PNG: `cargo run -p airlight-plot --example chart -- OUT_WITHOUT_ENDING`.

use airlight_plot::{Axis, Curve, Raster, line_chart};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let name = std::env::args()
        .nth(1)
        .ok_or("expected OUT_WITHOUT_ENDING, got nothing")?;
    let transmittance = |visibility_m: f64| Curve {
        name: format!("visibility {visibility_m} m"),
        points: (0..=100)
            .map(|i| {
                (
                    10.0 * f64::from(i),
                    (-2.996 / visibility_m * 10.0 * f64::from(i)).exp(),
                )
            })
            .collect(),
    };
    let svg = line_chart(
        &Axis::linear("distance (m)"),
        &Axis::linear("transmittance").with_range(0.0, 1.0),
        &[transmittance(200.0), transmittance(1000.0)],
    )?;
    std::fs::write(
        format!("{name}.png"),
        Raster::from_svg(&svg, 2.0)?.to_png()?,
    )?;
    std::fs::write(format!("{name}.svg"), svg)?;
    Ok(())
}
