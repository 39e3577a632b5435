//! What the default wavelengths cost in the colour of solved skies.

use airlight::atmosphere::presets;
use airlight::axes::direction;
use airlight::sky::{Sky, SkySettings, SunCoverage};
use airlight::spectrum::WavelengthGrid;
use airlight::spectrum::difference::{D65_WHITE, ciede2000, xyz_to_lab};

/// Colours (CIE XYZ) of the sun and of the sky in six directions.
fn colours(grid: &WavelengthGrid, sun_elevation_deg: f64) -> Vec<[f64; 3]> {
    let settings = SkySettings {
        suns: SunCoverage::near(sun_elevation_deg, 0.0),
        ..Default::default()
    };
    let air = presets::preset("average").unwrap();
    let sky = Sky::prepare(&air, grid, &settings).unwrap();
    let view = sky.view(0.0, direction(180.0, sun_elevation_deg));
    let eyes = [
        (180.0, 90.0),
        (180.0, 1.0),
        (150.0, 12.0),
        (90.0, 5.0),
        (0.0, 1.0),
        (0.0, 40.0),
    ];
    let skies =
        eyes.map(|(azimuth, elevation)| view.along(direction(azimuth, elevation), None).radiance());
    std::iter::once(view.sun_irradiance())
        .chain(skies)
        .map(|light| sky.grid().to_xyz(&light))
        .collect()
}

/// CIEDE2000 of two colours, seen side by side at the first one's luminance under a D65 white.
fn difference(reference: [f64; 3], other: [f64; 3]) -> f64 {
    let scale = 100.0 / reference[1];
    let lab = |xyz: [f64; 3]| xyz_to_lab(xyz.map(|v| v * scale), D65_WHITE);
    ciede2000(lab(reference), lab(other))
}

/// 5 nm, whose colours are those of 1 nm within a CIEDE2000 of 0.03.
#[test]
fn the_default_wavelengths_give_the_colours_of_five_nanometres() {
    compare_colours(&"fine".parse().unwrap(), &[10.0]);
}

#[test]
#[ignore = "takes a minute"]
fn the_default_wavelengths_give_the_colours_of_one_nanometre() {
    compare_colours(&WavelengthGrid::one_nanometre(), &[60.0, 10.0, 2.0]);
}

fn compare_colours(dense: &WavelengthGrid, sun_elevations_deg: &[f64]) {
    for &elevation in sun_elevations_deg {
        let exact = colours(dense, elevation);
        for (name, allowed) in [("fine", 0.03), ("standard", 0.5), ("fast", 1.0)] {
            let got = colours(&name.parse::<WavelengthGrid>().unwrap(), elevation);
            let differences: Vec<f64> = exact
                .iter()
                .zip(got)
                .map(|(a, b)| difference(*a, b))
                .collect();
            let worst = differences.iter().copied().fold(0.0, f64::max);
            println!(
                "{name}, sun at {elevation} degrees: CIEDE2000 sun {:.3}, sky at most {worst:.3}",
                differences[0]
            );
            assert!(
                worst < allowed,
                "{name}, sun at {elevation}: {differences:.3?}"
            );
        }
    }
}
