//! Laws that every prepared sky obeys, whatever the numbers.

use crate::common::{sky, whole_and_joined};
use airlight::atmosphere::{
    AerosolLoad, AerosolMixture, AerosolType, Atmosphere, Constituent, ConstituentKind,
    DensityProfile, presets, reference,
};
use airlight::axes::direction;
use airlight::optics::PhaseFunction;
use airlight::sky::{LineOfSight, Scattering, Sky, SkySettings, SunCoverage, TableChannels};
use airlight::spectrum::{RgbSpace, SpectralCurve, WavelengthGrid};
use glam::DVec3;
use rayon::prelude::*;

fn relative_difference(a: &[f32], b: &[f32]) -> f32 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a / b - 1.0).abs())
        .fold(0.0, f32::max)
}

#[test]
fn a_line_of_sight_may_be_split_anywhere() {
    // Level on a ray that climbs: from the split on, the second half is seen from higher up under a turned sky.
    let sky = sky("average", SunCoverage::near(12.0, 0.0));
    let view = sky.view(100.0, direction(180.0, 12.0));
    for (split_m, length_m) in [(10.0, 2e3), (5e3, 40e3), (60e3, 61e3), (1e3, 2e5)] {
        let (whole, joined) = whole_and_joined(&view, direction(170.0, 3.0), split_m, length_m);
        for lane in 0..3 {
            let (a, b) = (joined.transmittance[lane], whole.transmittance[lane]);
            assert!(
                (a - b).abs() < 2e-4 * b + 1e-6,
                "T at {split_m}: {a} against {b}"
            );
            let (a, b) = (joined.path_radiance[lane], whole.path_radiance[lane]);
            assert!(
                (a / b - 1.0).abs() < 2e-3,
                "S at {split_m}: {a} against {b}"
            );
        }
    }
}

/// However far the suns that a sky was prepared for are from that of a view.
#[test]
fn a_view_is_that_of_a_sky_prepared_for_its_sun() {
    for (prepared_deg, sun_deg) in [
        (1.0, -0.9),
        (1.0, 0.8),
        (-4.0, -2.1),
        (-4.0, -4.2),
        (10.0, 8.2),
        (10.0, 9.8),
        (60.0, 59.0),
    ] {
        let skies = [prepared_deg, sun_deg].map(|deg| sky("hazy", SunCoverage::near(deg, 0.0)));
        let views = skies.map(|sky| sky.view(2.0, direction(0.0, sun_deg)));
        let (mut worst, mut squares, mut count) = (0.0f32, 0.0, 0.0);
        for (azimuth, elevation) in
            (0..12).map(|k| (60.0 * f64::from(k % 4), [1.0, 15.0, 60.0][k as usize / 4]))
        {
            let towards = direction(azimuth, elevation);
            let [far, near] = [0, 1].map(|k| views[k].along(towards, None).radiance());
            for (a, b) in far.iter().zip(&near) {
                let difference = a / b - 1.0;
                worst = worst.max(difference.abs());
                squares += difference * difference;
                count += 1.0;
            }
        }
        let rms = (squares / count).sqrt();
        println!(
            "{prepared_deg} {sun_deg}: rms {:.2} %, worst {:.2} %",
            100.0 * rms,
            100.0 * worst
        );
        assert!(
            rms < 4e-3 && worst < 0.012,
            "{prepared_deg} {sun_deg}: {rms} {worst}"
        );
    }
}

/// Views from threads of a pool that also solve, for suns that the sky was not prepared for: a thread that waits for the solution must
/// not be one that it needs.
#[test]
fn views_that_solve_again_on_many_threads_end() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build();
    pool.unwrap().install(|| {
        for _ in 0..3 {
            let settings = SkySettings {
                suns: SunCoverage::near(60.0, 0.0),
                altitudes: 6,
                ..SkySettings::default()
            };
            let air = presets::preset("clear").unwrap();
            let sky = Sky::prepare(&air, &WavelengthGrid::rgb(), &settings).unwrap();
            let lit = (0..64).into_par_iter().filter(|k| {
                let view = sky.view(0.0, direction(0.0, 20.0 + 0.1 * f64::from(*k)));
                view.along(DVec3::Y, None).radiance()[0] > 0.0
            });
            assert_eq!(lit.count(), 64);
        }
    });
}

#[test]
fn transmittance_lies_between_nothing_and_all_and_falls_with_distance() {
    let sky = sky("hazy", SunCoverage::near(30.0, 0.0));
    let view = sky.view(2.0, direction(90.0, 30.0));
    for elevation in [-30.0, -1.0, 0.0, 0.5, 10.0, 90.0] {
        let mut last = vec![1.0; 3];
        for distance in [1e-3, 1.0, 1e2, 1e3, 1e4, 1e5, 1e6] {
            let here = view.along(direction(0.0, elevation), Some(distance));
            for (now, before) in here.transmittance.iter().zip(&last) {
                assert!(
                    (0.0..=1.0).contains(now) && *now <= before * (1.0 + 1e-5),
                    "{elevation} {distance}"
                );
            }
            last = here.transmittance;
        }
    }
}

#[test]
fn a_short_path_scatters_in_proportion_to_its_length() {
    let sky = sky("clear", SunCoverage::near(40.0, 0.0));
    let view = sky.view(500.0, direction(0.0, 40.0));
    let metre = view.along(direction(60.0, 5.0), Some(1.0)).path_radiance();
    let millimetre = view.along(direction(60.0, 5.0), Some(1e-3)).path_radiance();
    for (a, b) in metre.iter().zip(&millimetre) {
        assert!(*b > 0.0 && (a / (1000.0 * b) - 1.0).abs() < 1e-3, "{a} {b}");
    }
}

#[test]
fn ground_radiance_matches_the_irradiance_by_sun_and_sky() {
    // The radiance of the ground is its irradiance by sun and sky times albedo / pi.
    let sky = sky("average", SunCoverage::near(35.0, 0.0));
    let view = sky.view(0.0, direction(180.0, 35.0));
    let sky_irradiance = view.table(TableChannels::Spectral).irradiance(DVec3::Y);
    let sun_irradiance = view.sun_irradiance();
    let ground = view.along(-DVec3::Y, None).ground;
    for (lane, &nm) in sky.grid().wavelengths_nm().iter().enumerate() {
        let albedo = sky.atmosphere().planet.ground_albedo.at(nm) as f32;
        let received = ground[lane] * std::f32::consts::PI / albedo;
        let summed = sky_irradiance[lane] + sun_irradiance[lane] * 35f32.to_radians().sin();
        assert!(
            (summed / received - 1.0).abs() < 0.005,
            "{nm}: {summed} against {received}"
        );
    }
}

#[test]
fn no_place_and_no_sun_gives_anything_but_finite_light() {
    for preset in ["mars", "reference-csm"] {
        let sky = match preset {
            "reference-csm" => Sky::prepare(
                &reference::csm(),
                &WavelengthGrid::rgb(),
                &SkySettings::default(),
            )
            .unwrap(),
            name => sky(name, SunCoverage::All),
        };
        for altitude in [-500.0, 0.0, 1.0, 9e3, 59.9e3, 100e3, 400e3, 4e7] {
            for sun_elevation in [-90.0, -18.0, -0.3, 0.0, 30.0, 90.0] {
                let view = sky.view(altitude, direction(10.0, sun_elevation));
                for elevation in [-90.0, -70.0, -19.9, -3.0, 0.0, 1e-6, 4.0, 90.0] {
                    for azimuth in [10.0, 100.0, 190.0] {
                        let line = view.along(direction(azimuth, elevation), None);
                        let LineOfSight {
                            transmittance,
                            single,
                            multiple,
                            ground,
                            ..
                        } = &line;
                        for list in [transmittance, single, multiple, ground] {
                            assert!(
                                list.iter().all(|v| v.is_finite() && *v >= 0.0),
                                "{preset} {altitude} {sun_elevation} {elevation} {azimuth}: {line:?}"
                            );
                        }
                    }
                }
                let irradiance = view.sun_irradiance();
                assert!(irradiance.iter().all(|v| v.is_finite() && *v >= 0.0));
            }
        }
    }
}

#[test]
fn twilight_only_gets_darker() {
    let sky = sky("clear", SunCoverage::All);
    let mut last = f32::INFINITY;
    for step in 0..=60 {
        let elevation = 3.0 - 0.35 * f64::from(step);
        let view = sky.view(0.0, direction(180.0, elevation));
        let zenith = view.along(DVec3::Y, None).radiance()[1];
        assert!(
            zenith > 0.0 && zenith < last,
            "{elevation}: {zenith} after {last}"
        );
        last = zenith;
    }
}

#[test]
fn scattering_once_is_part_of_all_scattering() {
    let settings = |scattering| SkySettings {
        suns: SunCoverage::near(20.0, 0.0),
        scattering,
        ..Default::default()
    };
    let air = presets::preset("average").unwrap();
    let once = Sky::prepare(&air, &WavelengthGrid::rgb(), &settings(Scattering::Single)).unwrap();
    let all = Sky::prepare(&air, &WavelengthGrid::rgb(), &settings(Scattering::All)).unwrap();
    let (sun, eye) = (direction(180.0, 20.0), direction(90.0, 30.0));
    let once = once.view(0.0, sun).along(eye, None);
    let all = all.view(0.0, sun).along(eye, None);
    assert_eq!(once.single, all.single);
    assert!(once.multiple.iter().all(|v| *v == 0.0) && all.multiple.iter().all(|v| *v > 0.0));
}

#[test]
fn every_number_of_threads_gives_the_same_bits() {
    let picture = |threads: usize| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap()
            .install(|| {
                let sky = sky("average", SunCoverage::near(8.0, 0.0));
                let table = sky
                    .view(0.0, direction(45.0, 8.0))
                    .table(TableChannels::Rgb(RgbSpace::Srgb));
                let mut out = [0.0; 3];
                table.sample(direction(80.0, 12.0), &mut out);
                out.map(f32::to_bits)
            })
    };
    assert_eq!(picture(1), picture(3));
}

/// The average air with desert dust, which ends at 6 km.
fn dusty() -> Atmosphere {
    let mut air = presets::preset("average").unwrap();
    let (ground, top) = (air.planet.ground_altitude_m, air.planet.top_altitude_m);
    let dust = AerosolMixture::of(AerosolType::Desert, AerosolMixture::USUAL_HUMIDITY)
        .unwrap()
        .constituent(
            Some(AerosolLoad::OpticalDepth550(0.3)),
            None,
            air.clear_air(),
            ground,
            top,
        )
        .unwrap();
    air.put(dust);
    air
}

/// The average air over a layer of haze with a sharp upper edge, at the ground.
fn layered() -> Atmosphere {
    let mut air = presets::preset("average").unwrap();
    let layer = Constituent {
        kind: ConstituentKind::Other("layer".into()),
        density: DensityProfile::slab(400.0),
        scattering_per_m: SpectralCurve::Constant(5e-5),
        absorption_per_m: SpectralCurve::Constant(0.0),
        phase: PhaseFunction::HenyeyGreenstein { g: 0.6 },
    };
    air.put(layer);
    air
}

/// Where a density ends abruptly, sunlight that grazes the end changes with the root of the distance: the transmittance along a ray has
/// an edge at which its quadrature starts again.
#[test]
fn single_scattering_under_a_low_sun_is_that_of_fine_quadrature() {
    let airs = [
        reference::earth_demo(),
        presets::preset("hazy").unwrap(),
        dusty(),
        layered(),
    ];
    for air in airs {
        let mut worst = (0.0f64, String::new());
        for sun_elevation in [10.0, 3.0, 2.0, 0.5, -2.0, -4.0] {
            let settings = SkySettings {
                suns: SunCoverage::near(sun_elevation, 0.0),
                scattering: Scattering::Single,
                ..Default::default()
            };
            let sky = Sky::prepare(&air, &WavelengthGrid::rgb(), &settings).unwrap();
            let sun = direction(180.0, sun_elevation);
            let view = sky.view(0.0, sun);
            for (azimuth, elevation) in [
                (180.0, 1.0),
                (90.0, 5.0),
                (0.0, 5.0),
                (0.0, 30.0),
                (0.0, 90.0),
            ] {
                // In twilight next to nothing is scattered once there.
                if sun_elevation < 0.0 && elevation < 30.0 && azimuth != 90.0 {
                    continue;
                }
                let eye = direction(azimuth, elevation);
                let got = view.along(eye, None).single;
                let want = by_quadrature(&sky, sun, eye);
                for (lane, (got, want)) in got.iter().zip(want).enumerate() {
                    // Three times as large an error is accepted in twilight.
                    let scale = if sun_elevation < 0.0 { 1.0 / 3.0 } else { 1.0 };
                    let error = scale * (f64::from(*got) / want - 1.0).abs();
                    if error > worst.0 {
                        let place = format!(
                            "{} sun {sun_elevation}, {azimuth} {elevation}, {lane}: {got} {want}",
                            air.name
                        );
                        worst = (error, place);
                    }
                }
            }
        }
        assert!(worst.0 < 1e-3, "{worst:?}");
    }
}

/// Singly scattered sunlight along a ray from the ground by the midpoint rule, in steps that grow with the distance.
fn by_quadrature(sky: &Sky, sun: DVec3, eye: DVec3) -> [f64; 3] {
    const STEPS: u32 = 8000;
    let air = sky.atmosphere();
    let planet = &air.planet;
    let (ground_m, top_m) = (planet.radius_m, planet.radius_m + planet.top_altitude_m);
    let length_m =
        (top_m * top_m - ground_m * ground_m * (1.0 - eye.y * eye.y)).sqrt() - ground_m * eye.y;
    let nm = sky.grid().wavelengths_nm();
    let solar = sky.view(0.0, sun).solar_irradiance();
    let (mut sum, mut depth) = ([0.0; 3], [0.0; 3]);
    for step in 0..STEPS {
        let at = |step: f64| length_m * (step / f64::from(STEPS)).powi(2);
        let (from_m, to_m) = (at(f64::from(step)), at(f64::from(step) + 1.0));
        let point = DVec3::Y * ground_m + eye * (0.5 * (from_m + to_m));
        let altitude_m = point.length() - ground_m;
        let turn = glam::DQuat::from_rotation_arc(point.normalize(), DVec3::Y);
        let sunlight = sky.view(altitude_m, sun).transmittance_to_space(turn * sun);
        for lane in 0..3 {
            let (mut extinction, mut scattered) = (0.0, 0.0);
            for part in &air.constituents {
                let density = part.density.at(altitude_m);
                extinction += density * part.extinction_per_m(nm[lane]);
                scattered += density
                    * part.scattering_per_m.at(nm[lane])
                    * part.phase.evaluate(eye.dot(sun), nm[lane]);
            }
            let step_depth = extinction * (to_m - from_m);
            let seen = f64::exp(-(depth[lane] + 0.5 * step_depth));
            sum[lane] +=
                seen * scattered * (to_m - from_m) * f64::from(sunlight[lane] * solar[lane]);
            depth[lane] += step_depth;
        }
    }
    sum
}

/// Tables and coverage of suns beside the field that they are made from.
mod guards {
    use super::*;

    #[test]
    fn preparing_for_one_sun_or_for_all_is_the_same() {
        let all = sky("average", SunCoverage::All);
        for (elevation, allowed) in [
            (50.0, 0.01),
            (5.0, 0.01),
            (-1.0, 0.02),
            (-5.0, 0.02),
            (-9.0, 0.04),
            (-14.0, 0.08),
        ] {
            let near = sky("average", SunCoverage::near(elevation, 0.0));
            let sun = direction(180.0, elevation);
            for eye in [
                direction(180.0, 1.0),
                direction(180.0, 20.0),
                direction(0.0, 10.0),
                direction(0.0, 90.0),
            ] {
                let a = all.view(0.0, sun).along(eye, None).radiance();
                let b = near.view(0.0, sun).along(eye, None).radiance();
                let difference = relative_difference(&a, &b);
                assert!(
                    difference < allowed,
                    "sun {elevation}, {eye}: {difference} {a:?} {b:?}"
                );
            }
        }
    }

    /// Also out of the range that the sky was prepared for.
    #[test]
    fn raising_a_view_is_looking_from_there() {
        let sky = sky("average", SunCoverage::near(5.0, 0.0));
        let (sun, eye) = (direction(180.0, 5.0), direction(100.0, -3.0));
        for altitude_m in [100.0, 20e3] {
            let raised = sky.view(0.0, sun).at_altitude(altitude_m).unwrap();
            let there = sky.view(altitude_m, sun);
            assert_eq!(
                raised.along(eye, None).radiance(),
                there.along(eye, None).radiance()
            );
        }
    }

    #[test]
    fn a_table_gives_what_tracing_gives() {
        for (preset, altitude, elevation) in [
            ("average", 0.0, 40.0),
            ("clear", 0.0, 2.0),
            ("clear", 0.0, -5.0),
            ("average", 11e3, 15.0),
            ("mars", 0.0, 20.0),
        ] {
            let sky = sky(preset, SunCoverage::near(elevation, altitude));
            let view = sky.view(altitude, direction(200.0, elevation));
            let table = view.table(TableChannels::Spectral);
            let azimuths: Vec<f64> = vec![0.0, 17.0, 62.0, 118.0, 180.0];
            let columns = table.columns(azimuths.iter().map(|a| (a - 200.0f64).to_radians()));
            let horizon = table.horizon_elevation_rad().to_degrees();
            for above in [-60.0, -5.0, -0.5, 0.05, 0.5, 3.0, 20.0, 70.0] {
                let mut row = vec![0.0; 3 * azimuths.len()];
                table.sample_row((horizon + above).to_radians(), &columns, &mut row);
                for (azimuth, in_row) in azimuths.iter().zip(row.chunks_exact(3)) {
                    let eye = direction(*azimuth, horizon + above);
                    let mut sampled = [0.0f32; 3];
                    table.sample(eye, &mut sampled);
                    let traced = view.along(eye, None).radiance();
                    let difference = relative_difference(&sampled, &traced);
                    assert!(
                        difference < 0.01,
                        "{preset} {elevation} {azimuth} {above}: {sampled:?} {traced:?}"
                    );
                    assert!(
                        relative_difference(in_row, &sampled) < 1e-3,
                        "{in_row:?} {sampled:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_table_of_many_wavelengths_gives_what_tracing_gives() {
        // More than one block of lanes, and dust whose phase function depends on wavelength.
        let grid = WavelengthGrid::from_wavelengths_nm(
            (0..20).map(|i| 400.0 + 17.0 * f64::from(i)).collect(),
        )
        .unwrap();
        let settings = SkySettings {
            suns: SunCoverage::near(25.0, 0.0),
            ..Default::default()
        };
        let sky = Sky::prepare(&presets::preset("mars").unwrap(), &grid, &settings).unwrap();
        let view = sky.view(0.0, direction(120.0, 25.0));
        let table = view.table(TableChannels::Spectral);
        for eye in [
            direction(118.0, 26.0),
            direction(100.0, 5.0),
            direction(300.0, 60.0),
        ] {
            let mut sampled = [0.0f32; 20];
            table.sample(eye, &mut sampled);
            let traced = view.along(eye, None).radiance();
            assert!(
                relative_difference(&sampled, &traced) < 0.01,
                "{sampled:?} {traced:?}"
            );
        }
    }
}
