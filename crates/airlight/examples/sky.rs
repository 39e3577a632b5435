//! Colours of the sky from the horizon to the zenith: `cargo run --release -p airlight --example sky -- [SUN_ELEVATION_DEG]`.

use airlight::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let sun_deg = std::env::args()
        .nth(1)
        .map_or(Ok(30.0), |deg| deg.parse())?;
    let settings = SkySettings {
        suns: SunCoverage::near(sun_deg, 2.0),
        ..Default::default()
    };
    let air = Preset::Average.atmosphere();
    let sky = Sky::prepare(&air, &WavelengthGrid::standard(), &settings)?;
    let view = sky
        .view(2.0, axes::direction(180.0, sun_deg))
        .rgb(RgbSpace::Srgb);

    // The half of the sky away from the sun.
    let elevations = [0.0, 5.0, 15.0, 30.0, 60.0, 90.0];
    let directions = elevations.map(|deg| axes::direction(0.0, deg));
    let mut radiances = [[0.0; 3]; 6];
    view.radiances(&directions, &mut radiances);
    for (deg, rgb) in elevations.iter().zip(radiances) {
        println!("{deg:4} degrees: {rgb:7.0?} cd/m^2 of linear sRGB");
    }
    println!("sun's disc: {:.0?} lx", view.sun_irradiance());
    Ok(())
}
