//! Scans of the sun, of the view and of the altitude in small steps: light changes as smoothly as the air and the geometry do.

use crate::common::sky_of;
use airlight::atmosphere::{Atmosphere, presets};
use airlight::axes::direction;
use airlight::sky::{Sky, SunCoverage, TableChannels};
use glam::DVec3;

/// Altitude at which the dust of [`dusty`] ends, m.
const DUST_TOP_M: f64 = 6e3;

/// Azimuth of the sun, degrees.
const SUN_DEG: f64 = 180.0;

/// Azimuth and elevation of views from the horizon to the zenith, degrees.
const VIEWS: [(f64, f64); 6] = [
    (SUN_DEG, 1.0),
    (SUN_DEG, 10.0),
    (90.0, 5.0),
    (0.0, 2.0),
    (0.0, 30.0),
    (0.0, 90.0),
];

fn average() -> Atmosphere {
    presets::preset("average").unwrap()
}

/// The average air with desert dust, whose density jumps at its top.
fn dusty() -> Atmosphere {
    Atmosphere::from_toml("aerosol = { type = \"desert\", aod_550 = 0.3 }").unwrap()
}

fn sun(elevation_deg: f64) -> DVec3 {
    direction(SUN_DEG, elevation_deg)
}

/// Evenly spaced numbers from one to another, both included, at most `step` apart.
fn steps(from: f64, to: f64, step: f64) -> impl Iterator<Item = f64> {
    let count = ((to - from) / step - 1e-9).ceil();
    (0..=count as u32).map(move |k| from + (to - from) * f64::from(k) / count)
}

/// Largest roughness of a scan at any wavelength, with the place of the scan: the relative difference between a step and the mean of
/// the steps before and after it.
///
/// It is the size of a jump, half the change of slope at a kink, and half the third difference of smooth light.
fn roughness(places: impl Iterator<Item = f64>, light: impl Fn(f64) -> Vec<f32>) -> (f64, f64) {
    let scan: Vec<(f64, Vec<f64>)> = places
        .map(|place| {
            let logarithms = light(place).iter().map(|l| f64::from(*l).ln()).collect();
            (place, logarithms)
        })
        .collect();
    let mut worst = (0.0, f64::NAN);
    for four in scan.windows(4) {
        for lane in 0..four[0].1.len() {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| four[k].1[lane]);
            let rough = (1.5 * (c - b) - 0.5 * (d - a)).abs();
            assert!(rough.is_finite(), "{} at {}", rough, four[1].0);
            if rough > worst.0 {
                worst = (rough, four[1].0);
            }
        }
    }
    worst
}

/// Asserts that no step of a scan differs from its neighbours by 0.3 %.
fn assert_smooth(what: &str, (rough, place): (f64, f64)) {
    let percent = 100.0 * rough;
    println!("{what}: {percent:.3} % at {place:.3}");
    assert!(percent < 0.3, "{what}: {percent:.3} % at {place}");
}

/// Steps of 0.05 degrees from deep twilight to daylight. The largest are kinks at suns of the field's grid, and shadows of the dust.
#[test]
fn light_changes_smoothly_with_the_sun() {
    for (name, air) in [("average", average()), ("desert", dusty())] {
        let sky = sky_of(&air, SunCoverage::All);
        for (azimuth, elevation) in VIEWS {
            let eye = direction(azimuth, elevation);
            let light = |sun_deg| sky.view(2.0, sun(sun_deg)).along(eye, None).radiance();
            for (from, to) in [(-14.0, -9.0), (-9.0, -3.0), (-3.0, 2.0)] {
                let what = format!("{name}, sun from {from} to {to}, view {azimuth} {elevation}");
                assert_smooth(&what, roughness(steps(from, to, 0.05), light));
            }
        }
    }
}

/// Around the suns where the grid of suns, the heights or their spacing are chosen differently.
#[test]
fn skies_prepared_for_neighbouring_suns_join_smoothly() {
    for sun_deg in [8.0, 4.0, -8.0] {
        let suns: Vec<f64> = steps(sun_deg - 0.075, sun_deg + 0.075, 0.05).collect();
        let skies: Vec<Vec<Vec<f32>>> = suns
            .iter()
            .map(|&sun_deg| {
                let sky = sky_of(&average(), SunCoverage::near(sun_deg, 2.0));
                let view = sky.view(2.0, sun(sun_deg));
                VIEWS
                    .map(|(azimuth, elevation)| {
                        view.along(direction(azimuth, elevation), None).radiance()
                    })
                    .into()
            })
            .collect();
        for (k, (azimuth, elevation)) in VIEWS.into_iter().enumerate() {
            let rough = roughness((0..4).map(f64::from), |index| {
                skies[index as usize][k].clone()
            });
            let what = format!("skies for suns about {sun_deg}, view {azimuth} {elevation}");
            assert_smooth(&what, rough);
        }
    }
}

/// Steps of 0.02 degrees on both sides of the horizon, and of the elevation at which a ray grazes the dust from above: below it, the
/// path in the dust grows with the root of the angle, and so are the steps there.
#[test]
fn light_changes_smoothly_with_the_view() {
    for (name, air) in [("average", average()), ("desert", dusty())] {
        for (altitude_m, sun_deg) in [(2.0, 5.0), (10e3, 10.0)] {
            let sky = sky_of(&air, SunCoverage::near(sun_deg, altitude_m));
            let view = sky.view(altitude_m, sun(sun_deg));
            let table = view.table(TableChannels::Spectral);
            let horizon = view.horizon_elevation_rad().to_degrees();
            let radius_m = air.planet.radius_m;
            let grazing = -((radius_m + DUST_TOP_M) / view.radius_m())
                .min(1.0)
                .acos()
                .to_degrees();
            for azimuth in [SUN_DEG, 150.0, 90.0, 0.0] {
                let traced = |elevation| view.along(direction(azimuth, elevation), None).radiance();
                let tabulated = |elevation| {
                    let mut radiance = vec![0.0; 3];
                    table.sample(direction(azimuth, elevation), &mut radiance);
                    radiance
                };
                let check = |way: &str, light: &dyn Fn(f64) -> Vec<f32>| {
                    let what = format!(
                        "{name} from {altitude_m} m, sun {sun_deg}, azimuth {azimuth}, {way}"
                    );
                    // From low above the ground, its distance changes fast.
                    let below = horizon - if altitude_m < 10.0 { 0.3 } else { 0.01 };
                    let ground = steps(horizon - 2.0, below, 0.02);
                    assert_smooth(&format!("{what}, ground"), roughness(ground, light));
                    let above = (horizon + 0.01).max(grazing + 0.001);
                    let sky = steps(above, 3.0, 0.02);
                    assert_smooth(&format!("{what}, sky"), roughness(sky, light));
                    if horizon < grazing {
                        let end = horizon + 0.01;
                        let roots = steps(0.0, (grazing - end).sqrt(), 0.01);
                        let rough = roughness(roots, |root| light(grazing - root * root));
                        assert_smooth(&format!("{what}, in the layer"), rough);
                    }
                };
                check("traced", &traced);
                check("tabulated", &tabulated);
            }
        }
    }
}

/// Length of the air along a ray from an altitude that does not meet the ground, m.
fn air_ahead_m(air: &Atmosphere, altitude_m: f64, sin_elevation: f64) -> f64 {
    let planet = &air.planet;
    let (below_m, radius_m) = (
        planet.top_altitude_m - altitude_m,
        planet.radius_m + altitude_m,
    );
    let level = radius_m * sin_elevation;
    let squares = below_m * (planet.radius_m + planet.top_altitude_m + radius_m);
    squares / (level + (level * level + squares).sqrt())
}

/// From the ground to above the top of the air, in steps of 20 m there. Light from above is that of a metre of the air ahead.
#[test]
fn light_changes_smoothly_with_altitude() {
    for (name, air, suns_deg) in [
        ("average", average(), [40.0, -5.0]),
        ("desert", dusty(), [40.0, 5.0]),
    ] {
        let sky: Sky = sky_of(&air, SunCoverage::All);
        let top_m = air.planet.top_altitude_m;
        for sun_deg in suns_deg {
            for (azimuth, elevation) in [
                (0.0, -90.0),
                (90.0, -20.0),
                (0.0, 90.0),
                (90.0, 20.0),
                (90.0, 0.0),
            ] {
                let eye = direction(azimuth, elevation);
                let light = |altitude_m: f64| {
                    let light = sky
                        .view(altitude_m, sun(sun_deg))
                        .along(eye, None)
                        .radiance();
                    let metres = match elevation < 0.0 {
                        true => 1.0,
                        false => air_ahead_m(&air, altitude_m, eye.y),
                    };
                    light.iter().map(|light| light / metres as f32).collect()
                };
                let what = format!("{name}, sun {sun_deg}, view {azimuth} {elevation}");
                // Light near the ground changes with the root of the altitude.
                let low = |from: f64, to: f64| {
                    roughness(steps(from.sqrt(), to.sqrt(), 0.5), |root| {
                        light(root * root)
                    })
                };
                // A level ray within the dust reaches its top along a path that changes with the root of the distance from it.
                let to = if elevation == 0.0 {
                    DUST_TOP_M - 1e3
                } else {
                    DUST_TOP_M - 1e-3
                };
                assert_smooth(&format!("{what}, low"), low(0.0, to));
                assert_smooth(&format!("{what}, middle"), low(DUST_TOP_M + 1e-3, 20e3));
                let high = roughness(steps(20e3, 95e3, 250.0), light);
                assert_smooth(&format!("{what}, high"), high);
                let end_m = if elevation < 0.0 {
                    top_m + 1e3
                } else {
                    top_m - 1.0
                };
                let highest = roughness(steps(95e3, end_m, 20.0), light);
                assert_smooth(&format!("{what}, top"), highest);
            }
        }
    }
}
