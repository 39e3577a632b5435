//! Quantified errors of the paper's approximations.

use super::geometry::{HazePath, RaySegment, Spheres, SunRay};

/// Constants for which the errata are stated.
pub(super) const EARTH_M: f64 = 6_371e3;
pub(super) const SPHERES: Spheres = Spheres {
    earth_m: EARTH_M,
    haze_m: EARTH_M + 2e3,
    air_m: EARTH_M + 8.4e3,
};
const AIR_PER_M: f64 = 1.2e-5;
const HAZE_PER_M: f64 = 5e-5;

/// Integral of eq. 29 with its factor `l_max / (R_H - R_E)`, or of eq. 23, at one wavelength, by the midpoint rule.
fn integral(sun_deg: f64, elevation_deg: f64, path: HazePath) -> f64 {
    let (sun, elevation) = (sun_deg.to_radians(), elevation_deg.to_radians());
    let line = RaySegment {
        sin_elevation: elevation.sin(),
        sin_sun: sun.sin(),
        cos_sun: (sun - elevation).cos(),
    };
    let length_m = SPHERES.haze_length_m(line.sin_elevation);
    let steps = 20_000;
    let sum: f64 = (0..steps)
        .map(|i| {
            let x = (f64::from(i) + 0.5) / f64::from(steps);
            let lengths = SPHERES.lengths(&line, length_m, x, path, SunRay::Printed);
            lengths.map_or(0.0, |l| {
                (-AIR_PER_M * l.air_m - (AIR_PER_M + HAZE_PER_M) * l.haze_m).exp()
            })
        })
        .sum();
    sum * length_m / f64::from(steps)
}

/// Error of eq. 27: its integral (29) compared with that over the exact path. Also prints the book's table (`--nocapture`).
#[test]
fn path_linear_in_radius() {
    let error = |sun, elevation| {
        100.0
            * (integral(sun, elevation, HazePath::LinearInRadius)
                / integral(sun, elevation, HazePath::Exact)
                - 1.0)
    };
    println!("\n| line of sight | sun 2° | sun 20° | sun 60° |\n|---|---|---|---|");
    for elevation in [0.0, 1.0, 2.0, 5.0, 10.0, 20.0] {
        let cells = [2.0, 20.0, 60.0].map(|sun| match error(sun, elevation) {
            error if error.abs() < 0.05 => "0.0 %".to_owned(),
            error => format!("{error:+.1} %"),
        });
        println!("| {elevation}° | {} |", cells.join(" | "));
    }
    for (sun, elevation, percent) in [
        (2.0, 1.0, -9.2),
        (20.0, 1.0, -16.4),
        (40.0, 1.0, -16.7),
        (60.0, 1.0, -16.8),
        (20.0, 0.0, -79.5),
        (20.0, 2.0, -4.3),
    ] {
        let got = error(sun, elevation);
        assert!(
            (got - percent).abs() < 0.06,
            "sun {sun}, elevation {elevation}: {got:.2} %"
        );
    }
    for sun in [2.0, 20.0, 40.0, 60.0] {
        for elevation in [5.0, 7.0, 10.0, 20.0, 45.0, 90.0] {
            let got = error(sun, elevation);
            assert!(
                got.abs() < 0.6,
                "sun {sun}, elevation {elevation}: {got:.2} %"
            );
        }
    }
}

/// Error of eqs. 20 and 24: `d_1` with the angle at the eye compared with the exact intersections of the ray.
#[test]
fn way_above_the_haze() {
    let air = |sun_deg: f64, ray| SPHERES.sun_lengths(sun_deg.to_radians().sin(), ray).air_m;
    for (sun_deg, percent) in [
        (0.0, 70.44),
        (1.0, 29.30),
        (2.0, 14.53),
        (5.0, 3.580),
        (10.0, 0.972),
    ] {
        let got = 100.0 * (air(sun_deg, SunRay::Printed) / air(sun_deg, SunRay::Exact) - 1.0);
        assert!(
            (got / percent - 1.0).abs() < 1e-3,
            "sun {sun_deg}: {got:.2} %"
        );
    }
}

/// The paper: a ray that is horizontal at the eye crosses the top of the air at 10 degrees. This holds for a top at 100 km;
/// for the lowered top of the model it is 3 degrees.
#[test]
fn angles_at_the_arcs() {
    let at_top = |top_m: f64| (EARTH_M / (EARTH_M + top_m)).acos().to_degrees();
    assert!((at_top(100e3) - 10.1).abs() < 0.05, "{}", at_top(100e3));
    assert!((at_top(8.4e3) - 2.94).abs() < 0.01, "{}", at_top(8.4e3));
}
