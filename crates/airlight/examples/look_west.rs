//! Colour of the western sky in late afternoon: `cargo run --release -p airlight --example look_west`.

use airlight::sky::{Sky, SkySettings, SunCoverage};
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use airlight::{atmosphere, axes};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Solve for the light inside the atmosphere, for the sun at 10 degrees and an observer on the ground.
    let air = atmosphere::preset("average")?;
    let settings = SkySettings {
        suns: SunCoverage::near(10.0, 0.0),
        ..Default::default()
    };
    let sky = Sky::prepare(&air, &WavelengthGrid::standard(), &settings)?;

    // An observer 2 m above the ground, with the sun in the south-west.
    let view = sky.view(2.0, axes::direction(225.0, 10.0));

    // Look west, 20 degrees above the horizon.
    let light = view.along(axes::direction(270.0, 20.0), None);
    let rgb = RgbSpace::Srgb.from_xyz(sky.grid().to_xyz(&light.radiance()));
    println!("red, green, blue: {rgb:.0?} cd/m^2");
    Ok(())
}
