//! What the twins look up in the tables of a sky, against the solver's own march along the same rays.

use airlight::atmosphere::Preset;
use airlight::axes;
use airlight::sky::{Sky, SkySettings, SunCoverage, View};
use airlight::spectrum::{RgbSpace, WavelengthGrid, difference};
use airlight_shaders::twins::colour::rgb_from_spectrum;
use airlight_shaders::twins::sky_tables::{aerial_perspective, sky_radiance};
use airlight_shaders::twins::texture::{LinearSampler, Texture};
use airlight_shaders::{ColourFit, SkyTables, wavelength_grid};
use glam::Vec4;
use std::fmt;

/// Differences of one quantity.
#[derive(Default)]
struct Differences {
    count: f64,
    squares: f64,
    worst: f64,
    at: String,
}

impl Differences {
    fn add(&mut self, difference: f64, at: impl FnOnce() -> String) {
        self.count += 1.0;
        self.squares += difference * difference;
        if difference.abs() > self.worst.abs() {
            self.worst = difference;
            self.at = at();
        }
    }

    fn rms(&self) -> f64 {
        (self.squares / self.count).sqrt()
    }
}

impl fmt::Display for Differences {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:5.2} {:6.2}", 100.0 * self.rms(), 100.0 * self.worst)
    }
}

/// As a texture of half floats holds it.
fn halved(texture: &Texture) -> Texture {
    let half = |v: f32| half::f16::from_f32(v).to_f32();
    let texels = texture.texels().iter();
    let texels = texels.map(|v| Vec4::from_array(v.to_array().map(half)));
    Texture::new(texture.size(), texels.collect())
}

fn view(air: Preset, sun_deg: f64, height_m: f64) -> View {
    let settings = SkySettings {
        suns: SunCoverage::near(sun_deg, height_m),
        ..Default::default()
    };
    let sky = Sky::prepare(&air.atmosphere(), &wavelength_grid(), &settings).unwrap();
    sky.view(height_m, axes::direction(200.0, sun_deg))
}

fn tables(view: &View) -> SkyTables {
    let fit = ColourFit::new(view.sky().atmosphere()).unwrap();
    SkyTables::new(view, &fit, RgbSpace::Srgb).unwrap()
}

/// Relative differences of sky, transmittance (absolute) and path radiance.
fn differences(view: &View) -> [Differences; 3] {
    let tables = tables(view);
    let [sky_smooth, sky_haze, phase] =
        [&tables.sky_smooth, &tables.sky_haze, &tables.phase].map(halved);
    let [smooth, haze, extinction] = [
        &tables.aerial_smooth,
        &tables.aerial_haze,
        &tables.extinction,
    ]
    .map(halved);
    let mut all: [Differences; 3] = Default::default();
    let mut random = (0..).map(|k| {
        // Fractions of multiples of the golden ratio are evenly distributed.
        (f64::from(k) * 0.618_033_988_749_895).fract()
    });
    let mut next = || random.next().expect("an endless sequence");
    let horizon = view.horizon_elevation_rad().to_degrees();
    for k in 0..256 {
        let azimuth = 360.0 * next();
        // Denser towards the horizon; a quarter below it.
        let part = (f64::from(k) + 0.5) / 256.0;
        let elevation = match k % 4 {
            0 => horizon - (90.0 + horizon) * part * part,
            _ => horizon + (90.0 - horizon) * part * part,
        };
        let direction = axes::direction(azimuth, elevation);
        let d = direction.as_vec3();
        let at =
            |lane: usize| format!("azimuth {azimuth:.1}, elevation {elevation:.3}, lane {lane}");
        let got = sky_radiance(
            tables.view,
            tables.scales,
            &sky_smooth,
            &sky_haze,
            &phase,
            LinearSampler,
            d,
        );
        let right = view.along(direction, None).radiance();
        let brightest = right.iter().fold(0.0f32, |a, b| a.max(*b));
        for lane in 0..4 {
            // Not the dark channel of a saturated sky.
            let scale = right[lane].max(0.05 * brightest);
            if scale > 0.0 {
                all[0].add(f64::from((got[lane] - right[lane]) / scale), || at(lane));
            }
        }
        let distance_m = 100.0 * 1e3f64.powf(next());
        let path = aerial_perspective(
            tables.view,
            tables.scales,
            &smooth,
            &haze,
            &extinction,
            &phase,
            LinearSampler,
            d,
            distance_m as f32,
        );
        let right = view.along(direction, Some(distance_m));
        let light = right.path_radiance();
        let brightest = light.iter().fold(0.0f32, |a, b| a.max(*b));
        for lane in 0..4 {
            let here = || format!("{}, {distance_m:.0} m", at(lane));
            let difference = path.transmittance[lane] - right.transmittance[lane];
            all[1].add(f64::from(difference), here);
            let scale = light[lane].max(0.05 * brightest);
            if scale > 0.0 {
                all[2].add(
                    f64::from((path.path_radiance[lane] - light[lane]) / scale),
                    here,
                );
            }
        }
    }
    all
}

/// CIEDE2000 of the colours by four wavelengths and the fitted weights against sixteen wavelengths: rms and largest. The brightest
/// of the sky's directions counts as white.
fn colour_differences(air: Preset, sun_deg: f64, height_m: f64) -> Differences {
    let few = view(air, sun_deg, height_m);
    let weights = tables(&few).radiance_weights;
    let settings = SkySettings {
        suns: SunCoverage::near(sun_deg, height_m),
        ..Default::default()
    };
    let sky = Sky::prepare(&air.atmosphere(), &WavelengthGrid::standard(), &settings).unwrap();
    let many = sky.view(height_m, few.sun());
    let mut pairs = Vec::new();
    for azimuth in [200.0, 215.0, 260.0, 300.0, 380.0] {
        for elevation in [-20.0, 1.0, 4.0, 12.0, 30.0, 60.0, 90.0] {
            let direction = axes::direction(azimuth, elevation);
            let spectrum = few.along(direction, None).radiance();
            let rgb = rgb_from_spectrum(weights, Vec4::from_slice(&spectrum));
            let rgb = rgb.to_array().map(f64::from);
            let right = many.along(direction, None).radiance();
            pairs.push((RgbSpace::Srgb.to_xyz(rgb), sky.grid().to_xyz(&right)));
        }
    }
    let brightest = pairs.iter().map(|(_, xyz)| xyz[1]).fold(0.0, f64::max);
    let white = difference::D65_WHITE;
    let lab = |xyz: [f64; 3]| difference::xyz_to_lab(xyz.map(|v| 100.0 * v / brightest), white);
    let mut all = Differences::default();
    for (got, right) in pairs {
        all.add(difference::ciede2000(lab(got), lab(right)), String::new);
    }
    all
}

const SUNS_DEG: [f64; 4] = [60.0, 10.0, 2.0, -4.0];
const HEIGHTS_M: [f64; 3] = [2.0, 3e3, 1e4];

fn print(air: Preset, sun_deg: f64, height_m: f64) -> [Differences; 3] {
    let all = differences(&view(air, sun_deg, height_m));
    let [sky, transmittance, path] = &all;
    println!("{air:?} {sun_deg} {height_m}: sky {sky} at {}", sky.at);
    println!("    transmittance {transmittance} at {}", transmittance.at);
    println!("    path {path} at {}", path.at);
    all
}

mod guards {
    use super::*;

    #[test]
    fn tables_reproduce_the_sky_they_were_made_of() {
        for (air, sun_deg, height_m) in [(Preset::Hazy, 10.0, 2.0), (Preset::Clear, -4.0, 3e3)] {
            let [sky, transmittance, path] = print(air, sun_deg, height_m);
            assert!(sky.rms() < 0.005 && sky.worst.abs() < 0.02);
            assert!(transmittance.worst.abs() < 0.005);
            assert!(path.rms() < 0.01 && path.worst.abs() < 0.05);
        }
    }

    #[test]
    fn four_wavelengths_give_the_colours_of_sixteen() {
        for (air, sun_deg) in [(Preset::Hazy, 10.0), (Preset::Clear, -4.0)] {
            let difference = colour_differences(air, sun_deg, 2.0);
            println!(
                "{air:?} {sun_deg}: CIEDE2000 {:.2} {:.2}",
                difference.rms(),
                difference.worst
            );
            assert!(difference.rms() < 0.5 && difference.worst < 1.5);
        }
    }

    /// Prints rms and worst differences in %. 24 skies take a minute.
    #[test]
    #[ignore = "solves 24 skies"]
    fn tables_reproduce_every_sky() {
        for air in [Preset::Clear, Preset::Hazy] {
            for sun_deg in SUNS_DEG {
                for height_m in HEIGHTS_M {
                    let [sky, ..] = print(air, sun_deg, height_m);
                    assert!(sky.rms() < 0.01, "{}", sky.at);
                    let colour = colour_differences(air, sun_deg, height_m);
                    println!("    CIEDE2000 {:.2} {:.2}", colour.rms(), colour.worst);
                }
            }
        }
    }
}
