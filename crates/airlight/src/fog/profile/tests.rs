use super::*;
use crate::quadrature::{gauss_legendre, integrate_by};

const EARTH_M: f64 = 6.371e6;

/// The column by brute force: Gauss's rule in many stretches that shrink towards every point where density changes fast.
fn by_quadrature(profile: &Profile, line: &Line, length_m: f64) -> f64 {
    let rule = gauss_legendre(24);
    let mut breaks = Vec::new();
    let lowest = -0.5 * line.climb / line.bend_per_m;
    let mut centres = vec![0.0, length_m];
    if lowest.is_finite() && lowest > 0.0 && lowest < length_m {
        centres.push(lowest);
    }
    for height in match *profile {
        Profile::Clamped { base_height_m, .. } => vec![base_height_m],
        Profile::Slab { top_height_m } => vec![top_height_m],
        _ => vec![],
    } {
        let (first, last) = line.below(height);
        centres.extend([first, last]);
    }
    for centre in centres {
        breaks.push(centre);
        for k in 0..140 {
            let step = length_m * 0.75f64.powi(k);
            breaks.extend([centre - step, centre + step]);
        }
    }
    breaks.sort_by(f64::total_cmp);
    integrate_by(&rule, 0.0, length_m, &breaks, |s| {
        profile.density(line.height_at(s))
    })
}

fn profiles(scale_height_m: f64) -> [Profile; 4] {
    [
        Profile::Uniform,
        Profile::Exponential {
            reference_height_m: 3.0,
            scale_height_m,
        },
        Profile::Clamped {
            base_height_m: 20.0,
            scale_height_m,
        },
        Profile::Slab { top_height_m: 35.0 },
    ]
}

#[test]
fn columns_match_quadrature_from_micrometres_to_the_far_side_of_the_world() {
    for radius in [f64::INFINITY, EARTH_M] {
        for scale in [0.1, 7.0, 300.0, 8e3, 1e7] {
            for profile in profiles(scale) {
                for climb in [
                    0.0, 1e-12, -1e-12, 1e-6, -1e-6, -1e-3, 1e-3, 0.02, -0.02, 0.5, -0.5, 1.0, -1.0,
                ] {
                    for length in [1e-6, 1e-2, 1.0, 63.0, 1e3, 1e5, 1e7] {
                        for height in [0.0, 1.7, 20.0, 500.0] {
                            let line = Line::new(height, climb, length, radius);
                            // Deep below ground density means nothing, and overflows.
                            let dip = (-0.5 * line.climb / line.bend_per_m).clamp(0.0, length);
                            let dip = if dip.is_nan() { 0.0 } else { dip };
                            if line.end_height_m().min(line.height_at(dip)) < -50.0 * scale {
                                continue;
                            }
                            let exact = by_quadrature(&profile, &line, length);
                            let got = profile.column(&line);
                            assert!(
                                (got - exact).abs() <= 1e-9 * exact.abs() + 1e-290,
                                "{profile:?} {line:?}: {got} against {exact}"
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn columns_without_end() {
    let fog = Profile::Exponential {
        reference_height_m: 0.0,
        scale_height_m: 100.0,
    };
    assert!((fog.column(&Line::flat(0.0, 0.1, f64::INFINITY)) - 1000.0).abs() < 1e-9);
    assert_eq!(
        fog.column(&Line::flat(0.0, 0.0, f64::INFINITY)),
        f64::INFINITY
    );
    assert_eq!(
        fog.column(&Line::flat(0.0, -0.1, f64::INFINITY)),
        f64::INFINITY
    );
    // Over round ground a horizontal line leaves the fog: H sqrt(pi R / 2 H).
    let column = fog.column(&Line::new(0.0, 0.0, f64::INFINITY, EARTH_M));
    let chapman = 100.0 * (std::f64::consts::PI * EARTH_M / 200.0).sqrt();
    assert!((column / chapman - 1.0).abs() < 1e-12, "{column} {chapman}");
    for profile in profiles(50.0) {
        let above = profile.column_above(10.0);
        let column = profile.column(&Line::flat(10.0, 0.25, f64::INFINITY));
        assert!(
            column == above * 4.0 || (column / above / 4.0 - 1.0).abs() < 1e-12,
            "{profile:?}"
        );
    }
}

#[test]
fn falloff_runs_from_endless_to_sharp() {
    assert_eq!(Profile::from_falloff(5.0, 0.0), Ok(Profile::Uniform));
    assert_eq!(
        Profile::from_falloff(5.0, f64::INFINITY),
        Ok(Profile::Slab { top_height_m: 5.0 })
    );
    let gentle = Profile::from_falloff(5.0, 1e-9).unwrap();
    let steep = Profile::from_falloff(5.0, 1e9).unwrap();
    let slab = Profile::Slab { top_height_m: 5.0 };
    let line = Line::flat(1.0, 0.3, 200.0);
    assert!((gentle.column(&line) / 200.0 - 1.0).abs() < 1e-7);
    assert!((steep.column(&line) / slab.column(&line) - 1.0).abs() < 1e-7);
    assert!(Profile::from_falloff(5.0, -1.0).is_err());
    assert!(Profile::from_falloff(f64::NAN, 1.0).is_err());
    assert!(Profile::from_falloff(0.0, f64::NAN).is_err());
}
