//! Splits rays at heights, between which several layers are treated as one.

use crate::atmosphere::{HeightStructure, RaySegment};

/// Breakpoints of an exponential decay in scale heights, dense where most of the fog is.
const STEPS: [f64; 14] = [
    0.0, 0.12, 0.25, 0.4, 0.57, 0.77, 1.0, 1.3, 1.65, 2.1, 2.7, 3.5, 5.0, 8.0,
];

/// Breakpoints of an interval of smooth variation that is not exponential, as fractions of it: eighths, and one more near each
/// end, as the ratio to the density of other layers changes fastest where a density rises from 0.
const RAMP_STEPS: [f64; 11] = [
    0.0, 0.03, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 0.97, 1.0,
];

/// Breakpoints for profiles with these structures, in increasing order, m: steps from the start of each exponential decay
/// upwards, steps of smooth variation, edges of layers.
pub(super) fn height_breakpoints(profiles: &[HeightStructure], ground_height_m: f64) -> Vec<f64> {
    let mut heights: Vec<f64> = Vec::new();
    for profile in profiles {
        heights.extend(profile.other_kinks_m());
        for decay in &profile.decays {
            let from = decay.from_m.max(ground_height_m);
            heights.extend(STEPS.map(|step| from + step * decay.scale_height_m));
        }
        for [from, to] in &profile.ramps_m {
            heights.extend(RAMP_STEPS.map(|step| from + step * (to - from)));
        }
    }
    heights.sort_by(f64::total_cmp);
    // Merge heights that nearly coincide.
    heights.dedup_by(|b, a| *b - *a < 1e-6 * (1.0 + a.abs()));
    heights
}

/// Splits a ray at `heights_m` (increasing) and calls `visit` with the parts from the start on, until it returns `false`. Over
/// round ground a ray is also split at its lowest point, so that each part only rises or only falls.
pub(super) fn split_at_heights(
    ray: &RaySegment,
    heights_m: &[f64],
    mut visit: impl FnMut(&RaySegment) -> bool,
) {
    if let Some(lowest) = ray.dip_m() {
        let falling = ray.part(0.0, lowest);
        if monotone(&falling, false, heights_m, &mut visit) {
            monotone(&ray.part(lowest, ray.length_m), true, heights_m, &mut visit);
        }
    } else {
        // Over round ground a level ray rises from its start on.
        let rises =
            ray.sin_elevation > 0.0 || (ray.sin_elevation == 0.0 && ray.curvature_per_m > 0.0);
        monotone(ray, rises, heights_m, &mut visit);
    }
}

/// [`split_at_heights`] for a ray that only rises or only falls. Returns whether all parts were visited.
fn monotone(
    ray: &RaySegment,
    rises: bool,
    heights_m: &[f64],
    visit: &mut impl FnMut(&RaySegment) -> bool,
) -> bool {
    let mut from = 0.0;
    let mut cut = |at: f64, visit: &mut dyn FnMut(&RaySegment) -> bool| {
        // The height of the start does not split the ray.
        if at > from && at < ray.length_m {
            let part = ray.part(from, at);
            from = at;
            return visit(&part);
        }
        true
    };
    if rises {
        let first = heights_m.partition_point(|&height| height <= ray.height_m);
        for &height in &heights_m[first..] {
            let at = ray.below(height).1;
            if at >= ray.length_m {
                break;
            }
            if !cut(at, visit) {
                return false;
            }
        }
    } else {
        let last = heights_m.partition_point(|&height| height < ray.height_m);
        for &height in heights_m[..last].iter().rev() {
            let (enters, leaves) = ray.below(height);
            if enters == leaves {
                break;
            }
            if !cut(enters, visit) {
                return false;
            }
        }
    }
    visit(&ray.part(from, ray.length_m))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cuts(ray: RaySegment, heights: &[f64]) -> Vec<RaySegment> {
        let mut all = Vec::new();
        split_at_heights(&ray, heights, |part| {
            all.push(*part);
            true
        });
        all
    }

    #[test]
    fn parts_cover_the_ray_and_stay_between_the_heights() {
        let heights = [0.0, 5.0, 10.0, 40.0, 300.0];
        for ray in [
            RaySegment::flat(7.0, 0.5, 300.0),
            RaySegment::flat(70.0, -0.5, 130.0),
            RaySegment::flat(10.0, 0.0, 1e4),
            RaySegment::flat(10.0, -1e-4, 1e5),
            RaySegment::new(20.0, -2e-3, 5e4, 6.4e6),
            RaySegment::new(20.0, 0.0, 5e4, 6.4e6),
            RaySegment::new(5.0, 1.0, 1e4, 6.4e6),
        ] {
            let parts = cuts(ray, &heights);
            let sum: f64 = parts.iter().map(|part| part.length_m).sum();
            assert!((sum / ray.length_m - 1.0).abs() < 1e-12, "{ray:?}");
            for part in &parts {
                let (a, b) = (part.height_m, part.end_height_m());
                for height in heights {
                    let (low, high) = (a.min(b) + 1e-6, a.max(b) - 1e-6);
                    assert!(
                        !(low < height && height < high),
                        "{ray:?}: {part:?} crosses {height}"
                    );
                }
            }
        }
        assert_eq!(cuts(RaySegment::flat(7.0, 0.5, 300.0), &heights).len(), 3);
        // The last part of an infinite ray is infinite.
        let parts = cuts(RaySegment::flat(7.0, 0.5, f64::INFINITY), &heights);
        assert_eq!(parts.last().unwrap().length_m, f64::INFINITY);
    }
}
