use super::*;
use crate::math::quadrature::GaussRule;

const EARTH_M: f64 = 6.371e6;

/// The column by brute force: Gauss's rule in many stretches that shrink towards every point where density changes fast.
fn by_quadrature(profile: &Profile, line: &RaySegment, length_m: f64) -> f64 {
    let mut breaks = Vec::new();
    let lowest = -0.5 * line.sin_elevation / line.curvature_per_m;
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
    GaussRule::new(24).integrate_between(0.0, length_m, &breaks, |s| {
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
                for sin_elevation in [
                    0.0, 1e-12, -1e-12, 1e-6, -1e-6, -1e-3, 1e-3, 0.02, -0.02, 0.5, -0.5, 1.0, -1.0,
                ] {
                    for length in [1e-6, 1e-2, 1.0, 63.0, 1e3, 1e5, 1e7] {
                        for height in [0.0, 1.7, 20.0, 500.0] {
                            let line = RaySegment::new(height, sin_elevation, length, radius);
                            // Deep below ground density means nothing, and overflows.
                            let dip = (-0.5 * line.sin_elevation / line.curvature_per_m)
                                .clamp(0.0, length);
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
    assert!((fog.column(&RaySegment::flat(0.0, 0.1, f64::INFINITY)) - 1000.0).abs() < 1e-9);
    assert_eq!(
        fog.column(&RaySegment::flat(0.0, 0.0, f64::INFINITY)),
        f64::INFINITY
    );
    assert_eq!(
        fog.column(&RaySegment::flat(0.0, -0.1, f64::INFINITY)),
        f64::INFINITY
    );
    // Over round ground a horizontal line leaves the fog: H sqrt(pi R / 2 H).
    let column = fog.column(&RaySegment::new(0.0, 0.0, f64::INFINITY, EARTH_M));
    let chapman = 100.0 * (std::f64::consts::PI * EARTH_M / 200.0).sqrt();
    assert!((column / chapman - 1.0).abs() < 1e-12, "{column} {chapman}");
    for profile in profiles(50.0) {
        let above = profile.column_above(10.0);
        let column = profile.column(&RaySegment::flat(10.0, 0.25, f64::INFINITY));
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
    let line = RaySegment::flat(1.0, 0.3, 200.0);
    assert!((gentle.column(&line) / 200.0 - 1.0).abs() < 1e-7);
    assert!((steep.column(&line) / slab.column(&line) - 1.0).abs() < 1e-7);
    assert!(Profile::from_falloff(5.0, -1.0).is_err());
    assert!(Profile::from_falloff(f64::NAN, 1.0).is_err());
    assert!(Profile::from_falloff(0.0, f64::NAN).is_err());
}

/// The fog note's optical depth, `a / (f (c - p)_y) d e^-(f (p_y - h0)) (1 - e^-(f (c - p)_y))`, is that of density without the
/// `max(0, ...)` that the note puts into it: right wholly above the base, too large below.
#[test]
fn the_notes_formula_is_of_unclamped_fog() {
    let (h0, falloff) = (20.0, 1.0 / 30.0);
    let printed = |p: f64, c: f64, d: f64| {
        let rise = falloff * (c - p);
        d / rise * (-falloff * (p - h0)).exp() * (1.0 - (-rise).exp())
    };
    let (unclamped, clamped) = (
        Profile::Exponential {
            reference_height_m: h0,
            scale_height_m: 1.0 / falloff,
        },
        Profile::from_falloff(h0, falloff).unwrap(),
    );
    let mut too_much = Vec::new();
    for (p, c, d) in [
        (25.0, 60.0, 100.0),
        (90.0, 22.0, 400.0),
        (0.0, 60.0, 100.0),
        (-40.0, 10.0, 300.0),
    ] {
        let printed = printed(p, c, d);
        // From the camera to the surface.
        let line = RaySegment::flat(c, (p - c) / d, d);
        assert!((unclamped.column(&line) / printed - 1.0).abs() < 1e-12);
        assert!((clamped.column(&line) / by_quadrature(&clamped, &line, d) - 1.0).abs() < 1e-9);
        too_much.push(printed / clamped.column(&line));
    }
    let right = [1.0, 1.0, 1.2003, 3.5961];
    for (got, right) in too_much.iter().zip(right) {
        assert!((got - right).abs() < 1e-3, "{too_much:?}");
    }
}
