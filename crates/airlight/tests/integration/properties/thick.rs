//! Skies of random airs of several thick layers, by day and in twilight: the solver converges, whatever the profiles are.

use super::draw::Draw;
use super::{Failure, light};
use crate::common::grey_layer;
use airlight::atmosphere::{Atmosphere, DensityProfile, Interpolation};
use airlight::axes;
use airlight::optics::PhaseFunction;
use airlight::sky::{Sky, SkySettings, SunCoverage};
use airlight::spectrum::{SpectralCurve, WavelengthGrid};

/// Radius of the planet and height of its air, m: of the Earth, lower air, and of Mars, where a view is wide enough that the sky is
/// solved for all suns.
const PLANETS: [(f64, f64); 6] = [
    (6371e3, 10e3),
    (6371e3, 30e3),
    (6371e3, 60e3),
    (6371e3, 100e3),
    (3390e3, 60e3),
    (3390e3, 120e3),
];

/// One air under one sun.
pub fn sky(draw: &mut Draw) -> Result<(), Failure> {
    let (air, sun_elevation_deg) = (air(draw), draw.pick(&[80.0, 45.0, 20.0, 8.0, 2.0, -2.0]));
    let settings = SkySettings {
        suns: SunCoverage::near(sun_elevation_deg, 0.0),
        ..SkySettings::default()
    };
    let grid = WavelengthGrid::from_wavelengths_nm(vec![550.0]).unwrap();
    let described = |failure: String| {
        let planet = &air.planet;
        let parts: Vec<String> = air
            .constituents
            .iter()
            .map(|part| {
                format!(
                    "{:?}: depth {:.3}, albedo {:?}, {:?}",
                    part.density,
                    part.optical_depth(0.0, planet.top_altitude_m, 550.0),
                    part.scattering_per_m.at(550.0) / part.extinction_per_m(550.0),
                    part.phase,
                )
            })
            .collect();
        format!(
            "{failure}\n    sun {sun_elevation_deg}, {planet:?}\n    {}",
            parts.join("\n    ")
        )
    };
    let sky = Sky::prepare(&air, &grid, &settings).map_err(|error| described(error.to_string()))?;
    let view = sky.view(0.0, axes::direction(0.0, sun_elevation_deg));
    let line = view.along(axes::direction(120.0, 30.0), None);
    light("light", &line.path_radiance()).map_err(described)
}

/// One to four layers over a planet of some size, with a vertical optical depth from 1 to 100.
fn air(draw: &mut Draw) -> Atmosphere {
    let mut air = Atmosphere::from_toml("base = \"none\"").unwrap();
    let (radius_m, top_m) = draw.pick(&PLANETS);
    air.planet.radius_m = radius_m;
    air.planet.top_altitude_m = top_m;
    air.planet.ground_albedo = SpectralCurve::Constant(draw.pick(&[0.0, 0.15, 0.8, 1.0]));
    air.solar_irradiance = SpectralCurve::Constant(1.0);
    air.constituents = (0..=draw.below(4))
        .map(|_| {
            let density = density(draw, top_m);
            let depth = draw.scale(1.0, 100.0);
            let albedo = draw.pick(&[1.0, 1.0, 0.999, 0.97, 0.9, 0.6, 0.0]);
            let phase = match draw.below(3) {
                0 => PhaseFunction::Isotropic,
                _ => PhaseFunction::henyey_greenstein(draw.between(-0.3, 0.9)).unwrap(),
            };
            let column_m = density.column_m(0.0, top_m);
            grey_layer(density, depth / column_m, albedo, phase)
        })
        .collect();
    air
}

/// A profile with a column between the ground and the top: smooth, a thin layer, or a table with steep edges.
fn density(draw: &mut Draw, top_m: f64) -> DensityProfile {
    let place_m = |draw: &mut Draw| top_m * draw.scale(1e-3, 0.9);
    match draw.below(6) {
        0 => DensityProfile::exponential(top_m * draw.scale(0.01, 0.5)),
        1 => {
            let bottom_m = place_m(draw);
            DensityProfile::Layer {
                bottom_m,
                top_m: bottom_m + top_m * draw.scale(1e-4, 0.1),
            }
        }
        2 => {
            let bottom_m = place_m(draw);
            let peak_m = bottom_m + top_m * draw.scale(1e-4, 0.05);
            DensityProfile::Tent {
                bottom_m,
                peak_m,
                top_m: peak_m + top_m * draw.scale(1e-4, 0.05),
            }
        }
        _ => {
            let knots = 3 + draw.below(20);
            let highest_m = top_m * draw.between(0.3, 1.0);
            let scale_height_m = top_m * draw.scale(0.05, 1.0);
            let altitudes_m: Vec<f64> = (0..knots)
                .map(|k| highest_m * k as f64 / (knots - 1) as f64)
                .collect();
            // Rough, and steep in places.
            let roughness = draw.pick(&[1.0, 2.0, 10.0]);
            let densities: Vec<f64> = altitudes_m
                .iter()
                .enumerate()
                .map(|(k, z)| match k > 1 && draw.chance(0.15) {
                    true => 0.0,
                    false => (-z / scale_height_m).exp() * draw.scale(1.0 / roughness, 1.0),
                })
                .collect();
            let kind = draw.pick(&[Interpolation::Linear, Interpolation::LogLinear]);
            DensityProfile::tabulated(altitudes_m, densities, kind).unwrap()
        }
    }
}
