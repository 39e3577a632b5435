use super::column::MAX_LN_DENSITY;
use super::*;
use crate::math::quadrature::GaussRule;

#[test]
fn columns_are_integrals_of_the_density() {
    for profile in profiles() {
        for (a, b) in [(-500.0, 700.0), (0.0, 90e3), (2.5e3, 30e3), (4.5e3, 4.6e3)] {
            let mut breaks = profile.breakpoints_m();
            breaks.extend(standard_air::kinks_m());
            breaks.extend((1..90).map(|i| f64::from(i) * 1e3));
            let want = GaussRule::new(12).integrate_between(a, b, &breaks, |z| profile.at(z));
            let got = profile.column_m(a, b);
            assert!(
                (got - want).abs() <= 1e-10 * want,
                "{profile:?} {a} {b}: {got} against {want}"
            );
        }
        assert_eq!(profile.column_m(5e3, 5e3), 0.0);
        assert_eq!(profile.column_m(6e3, 5e3), 0.0);
    }
}

#[test]
fn densities_beyond_the_ends() {
    let exponential = DensityProfile::exponential(8e3);
    assert!(exponential.at(-400.0) > 1.0);
    let [_, air, table, ..] = &profiles()[..] else {
        unreachable!()
    };
    assert!(air.at(-400.0) > 1.03 && air.at(-400.0) < 1.05);
    assert_eq!(air.at(0.0), 1.0);
    assert_eq!(
        (table.at(-1e3), table.at(5e3), table.at(6e3)),
        (1.0, 0.0, 0.0)
    );
    assert_eq!(table.breakpoints_m(), [0.0, 1e3, 4e3, 5e3]);
    let edge = DensityProfile::Tent {
        bottom_m: 0.0,
        peak_m: 0.0,
        top_m: 2e3,
    };
    assert_eq!(
        (edge.at(0.0), edge.at(1e3), edge.column_m(0.0, 9e3)),
        (1.0, 0.5, 1e3)
    );
}

#[test]
fn thin_columns_are_precise() {
    let profile = DensityProfile::exponential(8e3);
    assert!(
        (profile.column_m(100.0, 100.0 + 1e-6) / (1e-6 * profile.at(100.0)) - 1.0).abs() < 1e-7
    );
    let flat = DensityProfile::tabulated(vec![0.0, 1e3], vec![0.3, 0.3], Interpolation::LogLinear)
        .unwrap();
    assert_eq!(flat.column_m(0.0, 1e3), 0.3e3);
}

#[test]
fn invalid_profiles_are_rejected() {
    for scale_height_m in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let profile = DensityProfile::exponential(scale_height_m);
        assert!(matches!(
            profile.validate(),
            Err(DensityError::ScaleHeight(_))
        ));
    }
    let upside_down = DensityProfile::Layer {
        bottom_m: 2.0,
        top_m: 1.0,
    };
    assert_eq!(
        upside_down.validate(),
        Err(DensityError::Edges(vec![2.0, 1.0]))
    );
    let sum = DensityProfile::Sum(vec![(-1.0, DensityProfile::StandardAir1976)]);
    assert!(matches!(
        sum.validate(),
        Err(DensityError::Negative { index: 0, .. })
    ));
    let table = |z: &[f64], d: &[f64]| {
        AltitudeTable::new(z.to_vec(), d.to_vec(), Interpolation::Linear).unwrap_err()
    };
    assert!(matches!(
        table(&[0.0], &[1.0]),
        DensityError::Altitudes { .. }
    ));
    assert!(matches!(
        table(&[0.0, 0.0], &[1.0; 2]),
        DensityError::Altitudes { index: 1, .. }
    ));
    assert!(matches!(
        table(&[0.0, 1.0], &[1.0]),
        DensityError::Length { .. }
    ));
    assert!(matches!(
        table(&[0.0, 1.0], &[1.0, -1.0]),
        DensityError::Negative { index: 1, .. }
    ));
}

#[test]
fn raising_a_profile_moves_its_densities_and_columns() {
    for profile in profiles() {
        let Some(raised) = profile.raised(250.0) else {
            assert_eq!(profile, DensityProfile::StandardAir1976);
            continue;
        };
        for z in [-800.0, 0.0, 2.2e3, 2.99e3, 6.2e3, 12e3, 26e3] {
            let (got, want) = (raised.at(z + 250.0), profile.at(z));
            assert!((got - want).abs() <= 1e-12 * want, "{profile:?} {z}");
            let (got, want) = (raised.max_above(z + 250.0), profile.max_above(z));
            assert!((got - want).abs() <= 1e-12 * want, "{profile:?} {z}");
        }
        let (got, want) = (raised.column_m(550.0, 9.25e3), profile.column_m(300.0, 9e3));
        assert!((got - want).abs() <= 1e-11 * want, "{profile:?}");
    }
}

#[test]
fn no_density_exceeds_the_bound_above_a_height() {
    for profile in profiles() {
        for start in 0..60 {
            let from = 1e3 * f64::from(start) - 2e3;
            let bound = profile.max_above(from);
            let most = (0..600)
                .map(|k| profile.at(from + 100.0 * f64::from(k)))
                .fold(0.0, f64::max);
            assert!(
                most <= bound * (1.0 + 1e-12),
                "{profile:?} {from}: {most} {bound}"
            );
        }
    }
}

/// Tents, tables and the standard atmosphere along rays over flat and round ground.
#[test]
fn columns_by_quadrature_are_integrals_along_the_ray() {
    for profile in profiles() {
        let mut heights = profile.breakpoints_m();
        heights.extend(standard_air::kinks_m());
        heights.extend((0..240).map(|i| f64::from(i) * 250.0));
        for radius in [f64::INFINITY, EARTH_M] {
            for (height, sin_elevation, length) in [
                (100.0, 0.3, 20e3),
                (6e3, -0.2, 25e3),
                (4e3, -0.015, 300e3),
                (2.5e3, 0.0, 1e5),
                (30e3, -1.0, 29e3),
            ] {
                let ray = RaySegment::new(height, sin_elevation, length, radius);
                let mut breaks: Vec<f64> = heights
                    .iter()
                    .flat_map(|&height| <[f64; 2]>::from(ray.below(height)))
                    .collect();
                breaks.extend(ray.dip_m());
                breaks.sort_by(f64::total_cmp);
                let want = GaussRule::new(12)
                    .integrate_between(0.0, length, &breaks, |s| profile.at(ray.height_at(s)));
                let got = profile.column_along_m(&ray);
                assert!(
                    (got - want).abs() <= 1e-9 * want,
                    "{profile:?} {ray:?}: {got} against {want}"
                );
            }
        }
        // Straight up without end.
        let (got, want) = (
            profile.column_along_m(&RaySegment::flat(700.0, 1.0, f64::INFINITY)),
            profile.column_above_m(700.0),
        );
        assert!(
            got == want || (got / want - 1.0).abs() < 1e-9,
            "{profile:?}: {got} {want}"
        );
    }
}

#[test]
fn sums_resolve_into_their_terms() {
    let (a, b) = (DensityProfile::slab(10.0), DensityProfile::exponential(5.0));
    let inner = DensityProfile::Sum(vec![(2.0, a.clone()), (3.0, b.clone())]);
    let sum = DensityProfile::Sum(vec![(0.5, inner), (1.0, a.clone())]);
    assert_eq!(sum.terms(), [(1.0, &a), (1.5, &b), (1.0, &a)]);
    assert_eq!(a.terms(), [(1.0, &a)]);
}

const EARTH_M: f64 = 6.371e6;

/// The column by Gauss-Legendre quadrature in many intervals that shrink towards every point where density changes fast.
fn by_quadrature(profile: &DensityProfile, ray: &RaySegment, length_m: f64) -> f64 {
    let mut breaks = Vec::new();
    let lowest = -0.5 * ray.sin_elevation / ray.curvature_per_m;
    let mut centres = vec![0.0, length_m];
    if lowest.is_finite() && lowest > 0.0 && lowest < length_m {
        centres.push(lowest);
    }
    for height in profile.breakpoints_m() {
        let (first, last) = ray.below(height);
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
    GaussRule::new(24).integrate_between(0.0, length_m, &breaks, |s| profile.at(ray.height_at(s)))
}

#[test]
fn columns_match_quadrature_at_all_scales() {
    for radius in [f64::INFINITY, EARTH_M] {
        for scale in [0.1, 7.0, 300.0, 8e3, 1e7] {
            for profile in fog_profiles(scale) {
                for sin_elevation in [
                    0.0, 1e-12, -1e-12, 1e-6, -1e-6, -1e-3, 1e-3, 0.02, -0.02, 0.5, -0.5, 1.0, -1.0,
                ] {
                    for length in [1e-6, 1e-2, 1.0, 63.0, 1e3, 1e5, 1e7] {
                        for height in [0.0, 1.7, 20.0, 500.0] {
                            let ray = RaySegment::new(height, sin_elevation, length, radius);
                            // Deep below the ground the density is limited.
                            let dip =
                                (-0.5 * ray.sin_elevation / ray.curvature_per_m).clamp(0.0, length);
                            let dip = if dip.is_nan() { 0.0 } else { dip };
                            let lowest = ray.end_height_m().min(ray.height_at(dip));
                            if profile.at(lowest) > MAX_LN_DENSITY.exp() * 0.999 {
                                continue;
                            }
                            let exact = by_quadrature(&profile, &ray, length);
                            let got = profile.column_along_m(&ray);
                            assert!(
                                (got - exact).abs() <= 1e-9 * exact.abs() + 1e-290,
                                "{profile:?} {ray:?}: {got} against {exact}"
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn infinite_columns() {
    let fog = DensityProfile::Exponential {
        reference_height_m: 0.0,
        scale_height_m: 100.0,
    };
    assert!((fog.column_along_m(&RaySegment::flat(0.0, 0.1, f64::INFINITY)) - 1000.0).abs() < 1e-9);
    assert_eq!(
        fog.column_along_m(&RaySegment::flat(0.0, 0.0, f64::INFINITY)),
        f64::INFINITY
    );
    assert_eq!(
        fog.column_along_m(&RaySegment::flat(0.0, -0.1, f64::INFINITY)),
        f64::INFINITY
    );
    // Over round ground a horizontal ray leaves the fog: H sqrt(pi R / 2 H).
    let column = fog.column_along_m(&RaySegment::new(0.0, 0.0, f64::INFINITY, EARTH_M));
    let chapman = 100.0 * (std::f64::consts::PI * EARTH_M / 200.0).sqrt();
    assert!((column / chapman - 1.0).abs() < 1e-12, "{column} {chapman}");
    for profile in fog_profiles(50.0) {
        let above = profile.column_above_m(10.0);
        let column = profile.column_along_m(&RaySegment::flat(10.0, 0.25, f64::INFINITY));
        assert!(
            column == above * 4.0 || (column / above / 4.0 - 1.0).abs() < 1e-12,
            "{profile:?}"
        );
    }
}

#[test]
fn falloffs_range_from_uniform_to_slab() {
    assert_eq!(
        DensityProfile::from_falloff(5.0, 0.0),
        Ok(DensityProfile::Uniform)
    );
    assert_eq!(
        DensityProfile::from_falloff(5.0, f64::INFINITY),
        Ok(DensityProfile::slab(5.0))
    );
    let gentle = DensityProfile::from_falloff(5.0, 1e-9).unwrap();
    let steep = DensityProfile::from_falloff(5.0, 1e9).unwrap();
    let slab = DensityProfile::slab(5.0);
    let ray = RaySegment::flat(1.0, 0.3, 200.0);
    assert!((gentle.column_along_m(&ray) / 200.0 - 1.0).abs() < 1e-7);
    assert!((steep.column_along_m(&ray) / slab.column_along_m(&ray) - 1.0).abs() < 1e-7);
    assert!(DensityProfile::from_falloff(5.0, -1.0).is_err());
    assert!(DensityProfile::from_falloff(f64::NAN, 1.0).is_err());
    assert!(DensityProfile::from_falloff(0.0, f64::NAN).is_err());
}

/// The fog note's optical depth, `a / (f (c - p)_y) d e^-(f (p_y - h0)) (1 - e^-(f (c - p)_y))`, is that of a density without the
/// `max(0, ...)` of the note's definition: correct for rays above the base, too large for others.
#[test]
fn the_formula_of_the_fog_note_is_for_unclamped_fog() {
    let (h0, falloff) = (20.0, 1.0 / 30.0);
    let printed = |p: f64, c: f64, d: f64| {
        let rise = falloff * (c - p);
        d / rise * (-falloff * (p - h0)).exp() * (1.0 - (-rise).exp())
    };
    let (unclamped, clamped) = (
        DensityProfile::Exponential {
            reference_height_m: h0,
            scale_height_m: 1.0 / falloff,
        },
        DensityProfile::from_falloff(h0, falloff).unwrap(),
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
        let ray = RaySegment::flat(c, (p - c) / d, d);
        assert!((unclamped.column_along_m(&ray) / printed - 1.0).abs() < 1e-12);
        assert!(
            (clamped.column_along_m(&ray) / by_quadrature(&clamped, &ray, d) - 1.0).abs() < 1e-9
        );
        too_much.push(printed / clamped.column_along_m(&ray));
    }
    let right = [1.0, 1.0, 1.2003, 3.5961];
    for (got, right) in too_much.iter().zip(right) {
        assert!((got - right).abs() < 1e-3, "{too_much:?}");
    }
}

#[test]
fn densities_and_columns_far_below_the_reference_are_finite() {
    let limit = MAX_LN_DENSITY.exp();
    for radius in [f64::INFINITY, EARTH_M] {
        for sin_elevation in [0.0, 1e-9, -1e-9, 0.5, -0.5, 1.0] {
            for length_m in [0.0, 1e-6, 3.0, 1e5] {
                let profile = DensityProfile::exponential(0.8);
                let ray = RaySegment::new(-4e3, sin_elevation, length_m, radius);
                let column = profile.column_along_m(&ray);
                assert!(
                    column.is_finite() && column <= limit * length_m * (1.0 + 1e-12),
                    "{ray:?}: {column}"
                );
                assert!(length_m < 1.0 || column > 0.1 * limit);
            }
        }
        assert_eq!(DensityProfile::exponential(0.8).at(-4e3), limit);
    }
    assert_eq!(DensityProfile::exponential(0.8).column_m(-4e3, -4e3), 0.0);
    // A table without density below, and a part of a sum without weight, over an infinite height.
    let empty = vec![0.0, 1.0, 0.0];
    let table = DensityProfile::tabulated(vec![0.0, 1.0, 2.0], empty, Interpolation::Linear);
    assert_eq!(table.unwrap().column_above_m(f64::NEG_INFINITY), 1.0);
    let sum = DensityProfile::Sum(vec![(0.0, DensityProfile::Uniform)]);
    assert_eq!(sum.column_above_m(0.0), 0.0);
}
