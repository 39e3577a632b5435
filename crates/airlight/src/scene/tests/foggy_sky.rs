//! Sky and fog together: order of the layers, seams, limits.

use super::{SPECTRAL, path_optics, sky};
use crate::atmosphere::Constituent;
use crate::axes::direction;
use crate::control::Control;
use crate::fog::droplets::Droplets;
use crate::fog::visibility::{Contrast, extinction_per_m};
use crate::fog::{DensityProfile, FogScattering, Ground, RaySegment};
use crate::scene::foggy::FoggySky;
use crate::scene::lane_channels::LaneChannels;
use crate::sky::{SunCoverage, View};
use crate::spectrum::{RgbSpace, Spectrum};
use crate::transfer::PathOptics;
use glam::DVec3;

fn layer(visibility_m: f64, profile: DensityProfile) -> Constituent {
    let extinction = extinction_per_m(visibility_m, Contrast::FivePercent);
    Constituent::fog(extinction, Droplets::Radiation.into(), profile, &[]).unwrap()
}

fn thinning(scale_height_m: f64) -> DensityProfile {
    DensityProfile::exponential(scale_height_m)
}

fn slab(top_m: f64) -> DensityProfile {
    DensityProfile::slab(top_m)
}

fn foggy(view: &View, layer: Constituent, ground: Ground) -> FoggySky<3> {
    let (scattering, control) = (FogScattering::Single, Control::default());
    FoggySky::new(view, SPECTRAL, &[layer], ground, scattering, control).unwrap()
}

#[test]
fn changing_the_fog_of_a_sky_gives_the_bits_of_a_new_one() {
    let sky = sky("average", SunCoverage::near(20.0, 30.0));
    let view = sky.view(30.0, direction(120.0, 20.0));
    let ground = FoggySky::<3>::round_ground(&view);
    let (scattering, control) = (FogScattering::Multiple, Control::default());
    let new = |layers: &[Constituent]| {
        let channels = LaneChannels::Rgb(RgbSpace::Srgb);
        FoggySky::<3>::new(&view, channels, layers, ground, scattering, control).unwrap()
    };
    let first = new(&[layer(300.0, slab(40.0))]);
    // As high, and higher.
    for other in [layer(900.0, slab(40.0)), layer(300.0, thinning(80.0))] {
        let other = [other];
        let (new_sky, changed) = (
            new(&other),
            first.with_fog(&other, scattering, control).unwrap(),
        );
        for (azimuth, elevation, distance_m) in [
            (100.0, 1.0, f64::INFINITY),
            (300.0, -2.0, 700.0),
            (10.0, 30.0, 5e3),
        ] {
            let towards = direction(azimuth, elevation);
            let optics = new_sky.optics(towards, distance_m, None);
            assert_eq!(optics, changed.optics(towards, distance_m, None));
            let seen = [new_sky.sky(towards), changed.sky(towards)];
            assert_eq!(seen[0], seen[1]);
            // The fog over what has come through the air is the fog without the air.
            let air = new_sky.aerial().optics(towards, distance_m);
            let both = new_sky.over_clear(towards, distance_m, None).then(air);
            assert_eq!(both, optics);
        }
        assert!(first.sky(direction(100.0, 1.0)) != changed.sky(direction(100.0, 1.0)));
    }
    assert!(
        first
            .with_fog(&[layer(-1.0, slab(4.0))], scattering, control)
            .is_err()
    );
}

/// Fog and sky together beside each of them, and beside thin slices of both.
mod guards {
    use super::*;

    /// Fog and air of a line cut into thin slices, one after the other.
    fn sliced(view: &View, foggy: &FoggySky<3>, towards: DVec3, length_m: f64) -> PathOptics<3> {
        const SLICES: usize = 250;
        let ground = foggy.ground();
        let eye_m = view.radius_m() - view.sky().atmosphere().planet.radius_m;
        let line = RaySegment::new(eye_m, towards.y, length_m, ground.radius_m);
        let cos_sun = towards.dot(view.sun());
        let mut whole = PathOptics::CLEAR;
        let mut before = PathOptics::<3>::CLEAR;
        let mut from = 0.0;
        for k in 1..=SLICES {
            let to = length_m * (k as f64 / SLICES as f64).powi(2);
            let fog = foggy.fog.path_along(&line.part(from, to), cos_sun);
            let air = path_optics::<3>(&view.along(towards, Some(to)));
            let slice = PathOptics {
                transmittance: air.transmittance / before.transmittance,
                path_radiance: (air.path_radiance - before.path_radiance) / before.transmittance,
            };
            // Half the air on either side of the fog.
            let half = PathOptics {
                transmittance: slice.transmittance.map(f32::sqrt),
                path_radiance: slice.path_radiance * 0.5,
            };
            whole = whole.then(half).then(fog).then(half);
            before = air;
            from = to;
            if whole.transmittance.max_element() < 1e-7 {
                break;
            }
        }
        whole
    }

    /// Greatest relative error of the path radiance, and greatest error of the transmittance.
    fn off(got: PathOptics<3>, exact: PathOptics<3>) -> (f32, f32) {
        let mut worst = (0.0f32, 0.0f32);
        for lane in 0..3 {
            worst.0 = worst
                .0
                .max((got.path_radiance[lane] / exact.path_radiance[lane] - 1.0).abs());
            worst.1 = worst
                .1
                .max((got.transmittance[lane] - exact.transmittance[lane]).abs());
        }
        worst
    }

    #[test]
    fn fog_and_air_lie_in_their_order() {
        let sky = sky("average", SunCoverage::near(25.0, 0.0));
        let mut all = Vec::new();
        for (what, eye_m, layer, elevations) in [
            ("in it", 2.0, layer(200.0, thinning(50.0)), [0.0, 3.0, 30.0]),
            ("in it", 2.0, layer(1e3, thinning(50.0)), [0.0, 3.0, 30.0]),
            ("in it", 2.0, layer(5e3, thinning(50.0)), [0.0, 3.0, 30.0]),
            ("in slab", 2.0, layer(200.0, slab(100.0)), [0.0, 3.0, 30.0]),
            ("in slab", 2.0, layer(2e3, slab(100.0)), [0.0, 3.0, 30.0]),
            (
                "above",
                300.0,
                layer(200.0, thinning(30.0)),
                [-1.0, -3.0, -20.0],
            ),
            (
                "above",
                300.0,
                layer(2e3, thinning(30.0)),
                [-1.0, -3.0, -20.0],
            ),
            (
                "above slab",
                300.0,
                layer(200.0, slab(100.0)),
                [-1.0, -3.0, -20.0],
            ),
            (
                "above slab",
                300.0,
                layer(3e3, slab(100.0)),
                [-0.9, -1.2, -20.0],
            ),
            (
                "far above",
                3000.0,
                layer(500.0, slab(200.0)),
                [-2.0, -5.0, -20.0],
            ),
            ("haze", 2.0, layer(20e3, thinning(1e3)), [0.0, 1.0, 10.0]),
            ("haze", 2.0, layer(50e3, thinning(500.0)), [0.0, 1.0, 10.0]),
            (
                "haze",
                500.0,
                layer(20e3, thinning(300.0)),
                [-0.5, 0.5, -3.0],
            ),
        ] {
            let view = sky.view(eye_m, direction(180.0, 25.0));
            let foggy = foggy(&view, layer, FoggySky::<3>::round_ground(&view));
            for (k, elevation) in elevations.into_iter().enumerate() {
                let azimuth = [170.0, 60.0][k % 2];
                let towards = direction(azimuth, elevation);
                let far = foggy.aerial().ground_distance_m(towards).unwrap_or(200e3);
                for length_m in [300.0, 3e3, 20e3, 200e3] {
                    let length_m = f64::min(length_m, far);
                    let exact = sliced(&view, &foggy, towards, length_m);
                    let (s, t) = off(foggy.optics(towards, length_m, None), exact);
                    all.push((s, t, what, eye_m, elevation, azimuth, length_m));
                }
            }
        }
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let error = |share: f64| all[((all.len() - 1) as f64 * share) as usize];
        println!(
            "S: median {:.2e}, 90 % {:.2e}, worst {:?}",
            error(0.5).0,
            error(0.9).0,
            error(1.0)
        );
        assert!(error(0.5).0 < 1e-3 && error(0.9).0 < 3e-3 && error(1.0).0 < 0.015);
        // Only haze that fills the lower air is off by more.
        assert!(all.iter().all(|l| l.0 < 6e-3 || l.2 == "haze"));
        assert!(all.iter().all(|l| l.1 < 1e-3));
    }

    #[test]
    fn there_is_no_seam_at_the_horizon() {
        let sky = sky("average", SunCoverage::near(25.0, 0.0));
        for eye_m in [2.0, 30.0] {
            let view = sky.view(eye_m, direction(180.0, 25.0));
            for ground in [Ground::FLAT, FoggySky::<3>::round_ground(&view)] {
                for profile in [thinning(50.0), slab(60.0)] {
                    let foggy = foggy(&view, layer(200.0, profile.clone()), ground);
                    for azimuth in [0.0, 90.0, 175.0] {
                        let at = |k: i32| foggy.sky(direction(azimuth, f64::from(k) * 1e-3));
                        for k in -200..50 {
                            for lane in 0..3 {
                                let step = (at(k + 1)[lane] / at(k)[lane] - 1.0).abs();
                                // The fog's own quadrature over round ground steps by 0.23 %.
                                assert!(step < 3e-3, "{ground:?} {profile:?} {k}: {step}");
                            }
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn distant_objects_fade_into_the_sky_without_fog() {
        let sky = sky("average", SunCoverage::near(25.0, 0.0));
        let none = layer(f64::INFINITY, thinning(50.0));
        let mut before = 0.0;
        for eye_m in [2.0, 100.0, 1e3, 4e3, 10e3] {
            let view = sky.view(eye_m, direction(180.0, 25.0));
            let foggy = foggy(&view, none.clone(), FoggySky::<3>::round_ground(&view));
            let mut clear = [0.0; 3];
            for (azimuth, elevation) in [(0.0, 5.0), (130.0, 0.5), (60.0, 80.0), (10.0, -30.0)] {
                let towards = direction(azimuth, elevation);
                foggy.clear().sample(towards, &mut clear);
                assert_eq!(foggy.sky(towards).0, clear, "without fog nothing changes");
                if elevation > 0.0 {
                    // The table of the air ends where the table of the sky lies.
                    let end = foggy.optics(towards, f64::INFINITY, None).path_radiance;
                    for lane in 0..3 {
                        assert!(
                            (end[lane] / clear[lane] - 1.0).abs() < 0.01,
                            "{eye_m}: {end:?}"
                        );
                    }
                }
            }
            // A black object at the horizon's distance, against the sky just above it.
            let horizon_deg = foggy.clear().horizon_elevation_rad().to_degrees();
            let below = direction(60.0, horizon_deg - 1e-4);
            let ground_m = foggy.aerial().ground_distance_m(below).unwrap();
            let black = foggy.optics(below, ground_m, None);
            foggy
                .clear()
                .sample(direction(60.0, horizon_deg + 1e-4), &mut clear);
            let share = black.path_radiance[0] / clear[0];
            println!("black at the horizon's {eye_m} m: {share} of the sky above it");
            assert!(share > before - 0.01 && share < 1.01, "{eye_m}: {share}");
            before = share;
        }
        assert!(before > 0.99, "{before}");
    }

    #[test]
    fn thick_fog_takes_its_own_colour() {
        let sky = sky("average", SunCoverage::near(25.0, 0.0));
        let view = sky.view(2.0, direction(180.0, 25.0));
        let ground = FoggySky::<3>::round_ground(&view);
        let foggy = foggy(&view, layer(50.0, thinning(100.0)), ground);
        for (azimuth, elevation) in [(0.0, 0.0), (90.0, 20.0), (180.0, 10.0), (30.0, -0.5)] {
            let towards = direction(azimuth, elevation);
            let ray = RaySegment::new(2.0, towards.y, 1e4, ground.radius_m);
            let alone = foggy
                .fog
                .path_along(&ray, towards.dot(view.sun()))
                .path_radiance;
            for seen in [
                foggy.sky(towards),
                foggy.optics(towards, 1e4, None).path_radiance,
            ] {
                for lane in 0..3 {
                    let off = (seen[lane] / alone[lane] - 1.0).abs();
                    // The air in the fog counts as sunlit: towards the sun that is 2 % here.
                    assert!(off < 0.03, "{azimuth} {elevation}: {off}");
                }
            }
        }
        // Colour and spectrum are the same light.
        let space = RgbSpace::Srgb;
        let coloured = FoggySky::<3>::new(
            &view,
            LaneChannels::Rgb(space),
            &[layer(300.0, thinning(100.0))],
            ground,
            FogScattering::Single,
            Control::default(),
        )
        .unwrap();
        let spectral = super::foggy(&view, layer(300.0, thinning(100.0)), ground);
        for towards in [direction(20.0, 5.0), direction(170.0, -3.0)] {
            let (a, b) = (coloured.sky(towards), spectral.sky(towards));
            let b = space.from_xyz(view.sky().grid().to_xyz(&b.0));
            for lane in 0..3 {
                let off = (f64::from(a[lane]) / b[lane] - 1.0).abs();
                assert!(off < 0.005, "{towards}: {a:?} {b:?}");
            }
        }
    }

    #[test]
    fn the_ground_under_fog_is_lit_through_it() {
        let sky = sky("average", SunCoverage::near(25.0, 0.0));
        let view = sky.view(120.0, direction(180.0, 25.0));
        let down = direction(0.0, -90.0);
        let albedo = &sky.atmosphere().planet.ground_albedo;
        let albedo =
            Spectrum::<3>::from_fn(|lane| albedo.at(sky.grid().wavelengths_nm()[lane]) as f32);
        let ground = FoggySky::<3>::round_ground(&view);
        let share = |visibility_m: f64, scattering| {
            let fog = [layer(visibility_m, slab(100.0))];
            let control = Control::default();
            let foggy = FoggySky::new(&view, SPECTRAL, &fog, ground, scattering, control).unwrap();
            if let Some(irradiance) = foggy.fog.ground_irradiance() {
                // The ground as the fog has it, seen through fog and air.
                let lit = irradiance * albedo / std::f32::consts::PI;
                let whole = foggy.optics(down, 120.0, None).apply(lit);
                for lane in 0..3 {
                    let off = (foggy.sky(down)[lane] / whole[lane] - 1.0).abs();
                    assert!(off < 0.01, "{visibility_m} m, lane {lane}: {off}");
                }
            }
            let added = foggy.optics(down, 120.0, None);
            let clear = view.along(down, None);
            let through = (foggy.sky(down) - added.path_radiance) / added.transmittance;
            f64::from(through[1] / (clear.ground[1] / clear.transmittance[1]))
        };
        for visibility_m in [50.0, 400.0, 1e5] {
            let [solved, estimated] = [FogScattering::Multiple, FogScattering::Single]
                .map(|orders| share(visibility_m, orders));
            println!(
                "visibility {visibility_m} m: ground's light {solved:.3}, by two streams {estimated:.3}"
            );
            assert!((0.0..1.01).contains(&solved), "{solved}");
            assert!(visibility_m < 1e5 || solved > 0.98, "{solved}");
            // The slant of the sun is not in the estimate: thick fog takes more of a low sun's light.
            assert!(solved < estimated * 1.02 && solved > 0.5 * estimated);
        }
    }
}
