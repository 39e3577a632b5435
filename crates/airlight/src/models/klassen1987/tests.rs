//! Tests of the model against its errata, its limits and itself.

use super::errata::{EARTH_M, SPHERES};
use super::lanes::WAVELENGTHS;
use super::*;
use crate::atmosphere::{ConstituentKind, preset};
use crate::axes::direction;
use crate::spectrum::RgbSpace;
use crate::spectrum::rgb::{apply, srgb_encode};

type Outcome = Result<(), Klassen1987Error>;

#[test]
fn both_geometries_agree_overhead() {
    // With sun and view at the zenith both forms equal the closed integral.
    let line = RaySegment {
        sin_elevation: 1.0,
        sin_sun: 1.0,
        cos_sun: 1.0,
    };
    for path in [HazePath::LinearInRadius, HazePath::Exact] {
        for ray in [SunRay::Printed, SunRay::Exact] {
            for x in [0.0, 0.25, 1.0] {
                let got = SPHERES.lengths(&line, 2e3, x, path, ray).unwrap();
                assert!((got.air_m - 6.4e3).abs() < 1e-6, "{got:?}");
                assert!((got.haze_m - 2e3).abs() < 1e-6, "{got:?}");
            }
        }
    }
}

/// A sequence evaluates the particles of the haze once.
#[test]
fn suns_share_what_does_not_depend_on_them() {
    let settings = Klassen1987Settings {
        base_blue: BaseBlue::PAPER,
        ..Klassen1987Settings::of(&preset("average").unwrap())
    };
    let base = Base::prepare(&settings, SunCoverage::All, Control::default()).unwrap();
    let under = |sun_deg| {
        let sun = SunState::from(direction(180.0, sun_deg));
        Klassen1987::over(&settings, &base, &sun, Control::default()).unwrap()
    };
    let (high, low) = (under(60.0), under(5.0));
    assert!(Arc::ptr_eq(&high.haze, &low.haze));
    assert!(high.sun_irradiance()[10] > low.sun_irradiance()[10]);
}

/// Eq. 19 compared with the law of cosines, and at both ends of its range.
#[test]
fn path_lengths_end_on_the_sphere() {
    for sin in [0.0, 1e-9, 0.1, 0.7, 1.0, -0.01] {
        let y = geometry::outward_m(EARTH_M, EARTH_M + 2e3, sin);
        let r2 = EARTH_M * EARTH_M + y * y + 2.0 * EARTH_M * y * sin;
        assert!((r2.sqrt() - EARTH_M - 2e3).abs() < 1e-6, "{sin}");
        assert!(y > 0.0);
    }
    assert_eq!(geometry::outward_m(EARTH_M, EARTH_M, 0.5), 0.0);
    assert_eq!(geometry::outward_m(EARTH_M, EARTH_M, 0.0), 0.0);
}

/// With the sun on the horizon, a horizontal ray away from it sees haze in the planet's shadow.
#[test]
fn planet_shades_haze_beyond_the_horizon() {
    let line = RaySegment {
        sin_elevation: 0.0,
        sin_sun: 0.0,
        cos_sun: -1.0,
    };
    let at = |x| SPHERES.lengths(&line, 150e3, x, HazePath::Exact, SunRay::Exact);
    assert!(at(0.0).is_some() && at(0.5).is_some());
    let dark = RaySegment {
        sin_sun: -1e-3,
        ..line
    };
    assert!(
        SPHERES
            .lengths(&dark, 150e3, 0.0, HazePath::Exact, SunRay::Exact)
            .is_none()
    );
}

fn paper() -> Klassen1987Settings {
    Klassen1987Settings::default().printed()
}

fn plain() -> Klassen1987Settings {
    Klassen1987Settings {
        base_blue: BaseBlue::PAPER,
        ..Klassen1987Settings::default()
    }
}

/// Thin haze has radiance `I_0 beta_sc l` and opacity `beta l`, to within its optical depth of 4e-7 and the rounding of f32.
#[test]
fn radiance_of_thin_haze_is_linear_in_density() -> Outcome {
    let settings = Klassen1987Settings {
        haze_extinction_per_m: 1e-10,
        air_density: 1e-6,
        phase: HazePhase::HenyeyGreenstein { g: 0.7 },
        ..plain()
    };
    let model = Klassen1987::new(&settings, direction(180.0, 40.0))?;
    let look = direction(90.0, 30.0);
    let cos = look.dot(direction(180.0, 40.0));
    let phase = crate::optics::PhaseFunction::HenyeyGreenstein { g: 0.7 }.evaluate(cos, 550.0);
    // The lane of 550 nm; 2 km of haze at an elevation of 30 degrees over a sphere of 6371.0088 km.
    let length_m = 3998.1188;
    let want = model.grid().solar_irradiance()[17] * 1e-10 * phase * length_m;
    let got = model.haze_spectrum(look)[17];
    assert!((got / want - 1.0).abs() < 2e-6, "{got} {want}");
    let opacity = model.opacity(look)[17];
    // 1 - e^-x in f32 would be off by a tenth.
    assert!(
        (opacity / (1e-10 * length_m) - 1.0).abs() < 1e-6,
        "{opacity}"
    );
    Ok(())
}

/// Eq. 22 with its signs: a lower sun is dimmer and redder, and never brighter than outside the atmosphere.
#[test]
fn sun_reddens_as_it_sets() -> Outcome {
    for settings in [paper(), plain()] {
        let mut before: Option<Vec<f64>> = None;
        for elevation in [90.0, 40.0, 10.0, 3.0, 0.0] {
            let model = Klassen1987::new(&settings, direction(180.0, elevation))?;
            let sun = model.sun_irradiance();
            let outside = model.grid().solar_irradiance();
            assert!(sun.iter().zip(outside).all(|(l, e)| *l > 0.0 && l < e));
            if let Some(before) = before {
                assert!(sun.iter().zip(&before).all(|(l, b)| l < b));
                assert!(sun[5] / before[5] < sun[30] / before[30]);
            }
            before = Some(sun);
        }
    }
    Ok(())
}

/// Without haze the sky is the blue; dense haze hides it.
#[test]
fn dense_haze_hides_the_blue() -> Outcome {
    let with = |haze_extinction_per_m| {
        let settings = Klassen1987Settings {
            haze_extinction_per_m,
            ..plain()
        };
        Klassen1987::new(&settings, direction(180.0, 40.0))
    };
    let clear = with(0.0)?;
    let up = direction(0.0, 60.0);
    assert_eq!(clear.sky_xyz(up), clear.sky_xyz(direction(33.0, 2.0)));
    let noon = Klassen1987::new(
        &Klassen1987Settings {
            haze_extinction_per_m: 0.0,
            ..plain()
        },
        direction(0.0, 90.0),
    )?;
    assert!((noon.sky_xyz(up)[1] / 3000.0 - 1.0).abs() < 1e-4);
    let sunset = Klassen1987::new(
        &Klassen1987Settings {
            haze_extinction_per_m: 0.0,
            ..plain()
        },
        direction(0.0, 0.0),
    )?;
    assert!((sunset.sky_xyz(up)[1] / 30.0 - 1.0).abs() < 1e-4);
    let dense = with(1e-2)?;
    assert!(dense.opacity(up).iter().all(|&o| o > 0.999_99));
    Ok(())
}

/// Without haze, the solver's blue equals the solver's sky.
#[test]
fn solver_blue_matches_the_solver() -> Result<(), Box<dyn std::error::Error>> {
    use crate::sky::{Sky, SkySettings, SunCoverage};
    let sun = direction(180.0, 20.0);
    let settings = Klassen1987Settings {
        haze_extinction_per_m: 0.0,
        ..Klassen1987Settings::default()
    };
    let model = Klassen1987::new(&settings, sun)?;
    let sky = Sky::prepare(
        &settings.clear_air,
        model.grid(),
        &SkySettings {
            suns: SunCoverage::near(20.0, 0.0),
            ..SkySettings::default()
        },
    )?;
    let view = sky.view(0.0, sun);
    for (azimuth, elevation) in [(180.0, 60.0), (90.0, 5.0), (250.0, 20.0), (0.0, 45.0)] {
        let look = direction(azimuth, elevation);
        let want = view.along(look, None).path_radiance();
        for (got, want) in model.sky_spectrum(look).iter().zip(&want) {
            assert!(
                (got / f64::from(*want) - 1.0).abs() < 5e-3,
                "{azimuth} {elevation}: {got} {want}"
            );
        }
    }
    Ok(())
}

/// Layers preserve the optical depths of an atmosphere.
#[test]
fn layers_preserve_optical_depths() -> Result<(), Box<dyn std::error::Error>> {
    for name in ["clear", "hazy", "mars", "bruneton"] {
        let atmosphere = preset(name)?;
        let settings = Klassen1987Settings::of(&atmosphere);
        let model = Klassen1987::new(&settings.clone().printed(), direction(180.0, 30.0))?;
        let haze: f64 = atmosphere
            .constituents
            .iter()
            .filter(|part| {
                part.kind != ConstituentKind::Molecules && part.scattering_per_m.at(550.0) > 0.0
            })
            .map(|part| part.optical_depth(0.0, atmosphere.planet.top_altitude_m, 550.0))
            .sum();
        let got = settings.haze_extinction_per_m * settings.haze_thickness_m;
        assert!((got / haze - 1.0).abs() < 1e-6, "{name}: {got} {haze}");
        let lane = f64::from(model.haze.extinction_per_m.0[17]);
        assert!(
            (lane / settings.haze_extinction_per_m - 1.0).abs() < 1e-5,
            "{name}"
        );
        let air = atmosphere.clear_air().optical_depth_550;
        let got = f64::from(model.air_per_m.0[17]) * settings.air_thickness_m;
        assert!((got / air - 1.0).abs() < 1e-5, "{name}: {got} {air}");
    }
    let clear = Klassen1987Settings::of(&preset("clear")?);
    assert!((clear.haze_thickness_m / 1.5e3 - 1.0).abs() < 1e-3);
    assert!(
        (8.3e3..8.6e3).contains(&clear.air_thickness_m),
        "{}",
        clear.air_thickness_m
    );
    Ok(())
}

/// Converting settings to an atmosphere and back reproduces them.
#[test]
fn layers_round_trip_through_an_atmosphere() -> Outcome {
    let settings = Klassen1987Settings {
        haze_extinction_per_m: 2e-4,
        haze_thickness_m: 1.2e3,
        ..plain()
    };
    let again = Klassen1987Settings::of(&settings.atmosphere()?);
    assert!((again.haze_extinction_per_m / 2e-4 - 1.0).abs() < 1e-6);
    assert!((again.haze_thickness_m / 1.2e3 - 1.0).abs() < 1e-6);
    let names = |air: &crate::atmosphere::Atmosphere| -> Vec<String> {
        air.constituents
            .iter()
            .map(|part| part.kind.to_string())
            .collect()
    };
    assert_eq!(names(&again.clear_air), ["rayleigh", "ozone"]);
    let same = |nm| again.air_extinction_per_m(nm) == settings.air_extinction_per_m(nm);
    assert!(wavelengths_nm().all(same));
    Ok(())
}

#[test]
fn disc_spectrum_matches_its_colour() -> Outcome {
    let model = Klassen1987::new(&plain(), direction(180.0, 30.0))?;
    let sun = model.sun();
    let lanes: Vec<f32> = model.disc_spectrum(sun).iter().map(|&v| v as f32).collect();
    assert_eq!(lanes.len(), WAVELENGTHS);
    assert_eq!(model.grid().to_xyz(&lanes), model.disc_xyz(sun));
    // The centre of the disc is brighter than its mean, irradiance divided by solid angle.
    let solid_angle = std::f64::consts::PI * model.disc_edge_rad().sin().powi(2);
    for (centre, irradiance) in lanes.iter().zip(model.sun_irradiance()) {
        let ratio = f64::from(*centre) * solid_angle / irradiance;
        assert!((1.0..2.0).contains(&ratio), "{ratio}");
    }
    assert_eq!(model.disc_spectrum(-sun), [0.0; WAVELENGTHS]);
    Ok(())
}

/// Pictures with and without coherence: 8-bit sRGB codes differ by at most 1.
#[test]
fn coherence_changes_codes_by_at_most_one() -> Outcome {
    let from_xyz = RgbSpace::Srgb.from_xyz_matrix();
    let (width, height) = (64, 40);
    for settings in [plain(), paper(), Klassen1987Settings::default()] {
        for sun_deg in [0.5, 10.0, 60.0] {
            let model = Klassen1987::new(&settings, direction(180.0, sun_deg))?;
            let mut walk = model.walk();
            let looks: Vec<DVec3> = (0..width * height)
                .map(|i| {
                    let (x, y) = (i % width, i / width);
                    // The side of the sky towards the sun, down to the horizon.
                    direction(
                        120.0 + 120.0 * f64::from(x) / f64::from(width),
                        50.0 * f64::from(y) / f64::from(height),
                    )
                })
                .collect();
            let plain: Vec<[f64; 3]> = looks
                .iter()
                .map(|&look| apply(&from_xyz, model.sky_xyz(look)))
                .collect();
            let walked: Vec<[f64; 3]> = looks
                .iter()
                .map(|&look| apply(&from_xyz, walk(look)))
                .collect();
            // Exposed so that a tenth of the picture is above white.
            let mut green: Vec<f64> = plain.iter().map(|rgb| rgb[1]).collect();
            green.sort_by(f64::total_cmp);
            let white = green[green.len() * 9 / 10];
            let code = |v: f64| (255.0 * srgb_encode((v / white).clamp(0.0, 1.0))).round();
            let (mut worst, mut differing) = (0.0f64, 0);
            for (a, b) in plain.iter().zip(&walked) {
                for (a, b) in a.iter().zip(b) {
                    let step = (code(*a) - code(*b)).abs();
                    worst = worst.max(step);
                    differing += i32::from(step > 0.0);
                }
            }
            assert!(worst <= 1.0, "sun {sun_deg}: {worst} codes");
            assert!(differing > 0, "nothing was reused");
        }
    }
    Ok(())
}

#[test]
fn settings_out_of_range_are_refused() {
    type Change = fn(&mut Klassen1987Settings);
    let changes: [Change; 8] = [
        |s| s.haze_extinction_per_m = -1e-6,
        |s| s.haze_thickness_m = 0.0,
        |s| s.haze_thickness_m = 9e3,
        |s| s.air_density = f64::NAN,
        |s| s.air_thickness_m = f64::INFINITY,
        |s| s.bits_per_channel = 3,
        |s| s.phase = HazePhase::Printed { g: 1.0 },
        |s| s.clear_air.constituents.clear(),
    ];
    let sun = direction(180.0, 30.0);
    for change in changes {
        let mut settings = plain();
        assert_eq!(settings.validate(), Ok(()));
        change(&mut settings);
        assert!(Klassen1987::new(&settings, sun).is_err(), "{settings:?}");
    }
    for below in [direction(0.0, -1.0), DVec3::ZERO, DVec3::NAN] {
        assert!(Klassen1987::new(&plain(), below).is_err());
    }
}

/// All directions have finite, non-negative colours; below the horizon that of the horizon.
#[test]
fn all_directions_have_finite_colours() -> Outcome {
    for settings in [paper(), plain()] {
        for sun_deg in [0.0, 45.0, 90.0] {
            let model = Klassen1987::new(&settings, direction(77.0, sun_deg))?;
            let mut walk = model.walk();
            for azimuth in [0.0, 77.0, 257.0] {
                for elevation in [-90.0, -3.0, 0.0, 1e-7, 0.2, 45.0, 90.0] {
                    let look = direction(azimuth, elevation);
                    for xyz in [model.sky_xyz(look), walk(look), model.disc_xyz(look)] {
                        assert!(xyz.iter().all(|v| v.is_finite() && *v >= 0.0), "{xyz:?}");
                    }
                }
            }
            assert_eq!(
                model.sky_xyz(direction(10.0, -20.0)),
                model.sky_xyz(DVec3::new(
                    direction(10.0, 0.0).x,
                    0.0,
                    direction(10.0, 0.0).z
                )),
            );
        }
    }
    Ok(())
}
