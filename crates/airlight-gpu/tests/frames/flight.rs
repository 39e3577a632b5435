//! Tables of an eye that climbs from below the sea to far out in space: no step is a seam.

use super::valley_fog;
use airlight::atmosphere::{DensityProfile, Preset};
use airlight::axes;
use airlight::glam::DVec3;
use airlight::sky::View;
use airlight::spectrum::RgbSpace;
use airlight_gpu::{FrameTables, SkySolver};

fn solver(air: Preset) -> SkySolver {
    SkySolver::new(
        &air.atmosphere(),
        &SkySolver::default_settings(),
        RgbSpace::Srgb,
    )
    .unwrap()
}

/// Luminance of the tables along a direction.
fn drawn(tables: &FrameTables, direction: DVec3) -> f64 {
    let rgb = tables.rgb_radiance(direction.as_vec3());
    RgbSpace::Srgb.luminance(rgb.to_array().map(f64::from))
}

/// Luminance of the solver's light along a direction, in the colours of the tables.
fn right(view: &View, tables: &FrameTables, direction: DVec3) -> f64 {
    let light = view.along(direction, None).radiance();
    let weights = tables.first.sky.radiance_weights;
    let channels = [weights.red, weights.green, weights.blue];
    let rgb = channels.map(|weights| {
        let each = weights.to_array().into_iter().zip(&light);
        each.map(|(w, l)| f64::from(w * l)).sum::<f64>()
    });
    RgbSpace::Srgb.luminance(rgb)
}

/// Heights from the sea to 36 000 km, denser where the horizon begins to dip and about the top of the air.
fn heights_m(top_m: f64) -> Vec<f64> {
    let steps = (0..=18).map(|k| 10f64.powf(-1.0 + f64::from(k) * 0.465));
    let about_top = [-3e3, -100.0, -1.0, 1.0, 100.0, 3e3].map(|step| top_m + step);
    let mut all: Vec<f64> = [0.0, 3.6e7]
        .into_iter()
        .chain(steps)
        .chain(about_top)
        .collect();
    all.retain(|height_m| *height_m <= 3.6e7);
    all.sort_by(f64::total_cmp);
    all
}

/// Along directions that are fixed to the vertical, and to the horizon: the ratio of table to solver stays near 1, and changes little from
/// one height to the next. What is dark beside the brightest light of the view counts little.
#[test]
fn an_eye_climbs_from_the_sea_to_space_without_a_seam() {
    const DARK: f64 = 1e-4;
    let solver = solver(Preset::Average);
    let (_, top_radius_m) = solver.sky().view(0.0, DVec3::Y).bounds_m();
    let top_m = top_radius_m - solver.sky().atmosphere().planet.radius_m;
    for (sun_deg, limits) in [(25.0, [0.03, 0.03]), (-5.0, [0.05, 0.05])] {
        let sun = axes::direction(140.0, sun_deg);
        let mut before: Option<Vec<f64>> = None;
        let mut worst = [(0.0f64, 0.0, String::new()), (0.0, 0.0, String::new())];
        for height_m in heights_m(top_m) {
            let tables = solver.tables(height_m, sun, None).unwrap();
            let view = solver.sky().view(height_m, sun);
            let horizon_deg = f64::from(tables.first.sky.view.horizon_rad).to_degrees();
            let fixed = [80.0, 20.0, 4.0, 1.0, -1.0, -4.0, -20.0, -80.0];
            let beside = [3.0, 0.3, -0.3, -3.0].map(|angle| horizon_deg + angle);
            let elevations = fixed.into_iter().chain(beside);
            let directions: Vec<(f64, f64)> = elevations
                .flat_map(|elevation_deg| {
                    [150.0, 240.0, 325.0].map(|azimuth_deg| (azimuth_deg, elevation_deg))
                })
                .collect();
            let light: Vec<[f64; 2]> = directions
                .iter()
                .map(|&(azimuth_deg, elevation_deg)| {
                    let direction = axes::direction(azimuth_deg, elevation_deg.max(-90.0));
                    [drawn(&tables, direction), right(&view, &tables, direction)]
                })
                .collect();
            let brightest = light.iter().map(|[_, right]| *right).fold(0.0, f64::max);
            assert!(brightest > 0.0, "black at {height_m} m");
            let errors: Vec<f64> = light
                .iter()
                .map(|[got, right]| (got - right) / right.max(DARK * brightest))
                .collect();
            for (k, (&error, &direction)) in errors.iter().zip(&directions).enumerate() {
                let beside_horizon = (direction.1 - horizon_deg).abs() < 0.05;
                if beside_horizon {
                    continue;
                }
                let at = || {
                    format!(
                        "{height_m:.1} m, azimuth {}, elevation {}",
                        direction.0, direction.1
                    )
                };
                if error.abs() > worst[0].0 {
                    worst[0] = (error.abs(), error, at());
                }
                if let Some(before) = &before {
                    let step = error - before[k];
                    if step.abs() > worst[1].0 {
                        worst[1] = (step.abs(), step, at());
                    }
                }
            }
            before = Some(errors);
        }
        println!("sun {sun_deg}: worst {:?}, step {:?}", worst[0], worst[1]);
        assert!(
            worst[0].0 < limits[0] && worst[1].0 < limits[1],
            "sun {sun_deg}: {worst:?}"
        );
    }
}

/// Below the sea the eye sees what it sees at its surface.
#[test]
fn below_the_sea_the_sky_is_that_above_it() {
    let solver = solver(Preset::Clear);
    let sun = axes::direction(140.0, 20.0);
    let fog = valley_fog();
    for fog in [None, Some(&fog)] {
        let tables = |height_m| solver.tables(height_m, sun, fog).unwrap();
        let surface = tables(0.0);
        for height_m in [-400.0, -10.0, -1e-3] {
            let below = tables(height_m);
            for elevation_deg in [-80.0, -5.0, -0.2, 0.2, 5.0, 80.0] {
                for azimuth_deg in [140.0, 250.0, 320.0] {
                    let direction = axes::direction(azimuth_deg, elevation_deg);
                    let light = drawn(&below, direction);
                    assert!(light > 0.0, "black at {height_m} m, {elevation_deg}");
                    assert_eq!(light, drawn(&surface, direction));
                }
            }
        }
    }
}

/// Through the top of a fog with a sharp edge: in half a metre of fog steep rays gain little light.
#[test]
fn an_eye_leaves_a_fog_without_a_seam() {
    let solver = solver(Preset::Clear);
    let sun = axes::direction(140.0, 30.0);
    let mut fog = valley_fog();
    fog.layers[0].density = DensityProfile::Layer {
        bottom_m: 0.0,
        top_m: 50.0,
    };
    fog.layers[0].extinction_per_m = [0.005; 3];
    let mut before: Option<Vec<f64>> = None;
    for k in -6..=6 {
        let height_m = 50.0 + 0.5 * f64::from(k);
        let tables = solver.tables(height_m, sun, Some(&fog)).unwrap();
        let elevations = [-80.0, -30.0, -15.0, 15.0, 30.0, 80.0];
        let light: Vec<f64> = elevations
            .iter()
            .flat_map(|&elevation_deg| {
                [170.0, 320.0].map(|azimuth_deg| axes::direction(azimuth_deg, elevation_deg))
            })
            .map(|direction| drawn(&tables, direction))
            .collect();
        if let Some(before) = before {
            for (k, (now, before)) in light.iter().zip(&before).enumerate() {
                let change = (now / before - 1.0).abs();
                assert!(
                    change < 0.03,
                    "{height_m} m, elevation {}: {before} {now}",
                    elevations[k / 2]
                );
            }
        }
        before = Some(light);
    }
}
