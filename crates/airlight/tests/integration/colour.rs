//! What the default wavelengths cost in the colour of solved skies.

use airlight::atmosphere::Preset;
use airlight::axes::direction;
use airlight::sky::{Sky, SkySettings, SunCoverage};
use airlight::spectrum::WavelengthGrid;
use airlight::spectrum::difference::{D65_WHITE, ciede2000, xyz_to_lab};

/// Colours (CIE XYZ) of the sun, where it has not set, and of the sky in six directions.
fn colours(air: Preset, grid: &WavelengthGrid, sun_elevation_deg: f64) -> Vec<[f64; 3]> {
    let settings = SkySettings {
        suns: SunCoverage::near(sun_elevation_deg, 0.0),
        ..Default::default()
    };
    let sky = Sky::prepare(&air.atmosphere(), grid, &settings).unwrap();
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
    let has_set = sun_elevation_deg < 0.0;
    let sun = (!has_set).then(|| view.sun_irradiance());
    sun.into_iter()
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
    compare_colours(Preset::Average, &WavelengthGrid::fine(), &[10.0], 0.1);
}

#[test]
#[ignore = "takes a minute"]
fn the_default_wavelengths_give_the_colours_of_one_nanometre() {
    compare_colours(
        Preset::Average,
        &WavelengthGrid::one_nanometre(),
        &[60.0, 10.0, 2.0],
        0.1,
    );
}

#[test]
#[ignore = "takes half a minute: prints the errors that the book states"]
fn few_wavelengths_keep_the_colours_of_twilight() {
    let fine = WavelengthGrid::fine();
    compare_colours(Preset::Average, &fine, &[-2.0, -4.0, -6.0], 0.15);
    compare_colours(Preset::Average, &fine, &[-9.0, -12.0, -18.0], 0.25);
}

#[test]
#[ignore = "takes half a minute: prints the errors that the book states"]
fn few_wavelengths_keep_the_colours_of_other_airs() {
    let fine = WavelengthGrid::fine();
    for (air, suns) in [
        (Preset::Clear, &[30.0, 2.0, -4.0][..]),
        (Preset::Hazy, &[30.0, 2.0, -4.0]),
        // Lower suns are not seen.
        (Preset::Wildfire, &[30.0]),
        (Preset::Mars, &[30.0, 2.0, -4.0]),
    ] {
        compare_colours(air, &fine, suns, 0.25);
    }
}

/// Compares the colours of the grids `standard` and `fast` with those of a dense one, within a CIEDE2000.
fn compare_colours(air: Preset, dense: &WavelengthGrid, sun_elevations_deg: &[f64], bound: f64) {
    for &elevation in sun_elevations_deg {
        let exact = colours(air, dense, elevation);
        for (name, allowed) in [("fine", 0.03), ("standard", bound), ("fast", bound)] {
            let got = colours(air, &name.parse::<WavelengthGrid>().unwrap(), elevation);
            let differences: Vec<f64> = exact
                .iter()
                .zip(&got)
                .map(|(a, b)| difference(*a, *b))
                .collect();
            let worst = differences.iter().copied().fold(0.0, f64::max);
            let luminance = exact
                .iter()
                .zip(&got)
                .map(|(a, b)| (b[1] / a[1] - 1.0).abs());
            println!(
                "{air:?}, {name}, sun at {elevation} degrees: CIEDE2000 at most {worst:.3}, luminance within {:.2} %",
                100.0 * luminance.fold(0.0, f64::max)
            );
            assert!(
                worst < allowed,
                "{name}, sun at {elevation}: {differences:.3?}"
            );
        }
    }
}
