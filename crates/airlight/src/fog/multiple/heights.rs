//! Heights at which the diffuse light is stored.

use crate::atmosphere::DensityProfile;

/// A profile and the mean of its reduced extinction coefficient over wavelengths, 1/m.
pub type Weighted = (DensityProfile, f64);

/// Optical depth above a height, by mean extinction.
pub fn depth_above(layers: &[Weighted], height_m: f64) -> f64 {
    layers
        .iter()
        .map(|(profile, extinction)| extinction * profile.column_above_m(height_m))
        .sum()
}

/// Heights in increasing order from the ground to the top of the fog: dense in optical depth near both ends, sparse in between.
/// Includes the edges of all profiles.
pub fn between(layers: &[Weighted], ground_m: f64) -> Vec<f64> {
    let whole = depth_above(layers, ground_m);
    if whole <= 0.0 {
        return vec![ground_m, ground_m + 1.0];
    }
    let top_m = height_of(layers, ground_m, 1e-4 * whole.min(1.0));
    let mut heights: Vec<f64> = depths(whole)
        .into_iter()
        .map(|depth| height_of(layers, ground_m, depth))
        .filter(|&height| height < top_m)
        .collect();
    for (profile, _) in layers {
        let kinks = profile.breakpoints_m().into_iter();
        heights.extend(kinks.filter(|&kink| kink > ground_m && kink < top_m));
    }
    heights.extend([ground_m, top_m]);
    heights.sort_by(f64::total_cmp);
    let least = 1e-9 * (top_m - ground_m);
    heights.dedup_by(|b, a| *b - *a <= least);
    heights
}

/// Largest step of optical depth, by mean extinction.
const MAX_STEP: f64 = 0.8;

/// Largest number of steps from an end to the middle: the interior of fog deeper than about 300 optical depths is uniform.
const MAX_STEPS: usize = 200;

/// Optical depths from the top, with steps that grow away from both ends.
fn depths(whole: f64) -> Vec<f64> {
    let first = (whole / 20.0).min(0.01);
    let mut from_end = Vec::new();
    let mut depth = 0.0;
    while depth < 0.5 * whole && from_end.len() < MAX_STEPS {
        from_end.push(depth);
        depth += (0.4 * depth).max(first).min(MAX_STEP);
    }
    let other_end = from_end.iter().map(|depth| whole - depth);
    let mut depths: Vec<f64> = from_end.iter().copied().chain(other_end).collect();
    depths.push(0.5 * whole);
    depths
}

/// Height with this optical depth above it, at or above the ground, by bisection.
fn height_of(layers: &[Weighted], ground_m: f64, depth: f64) -> f64 {
    let deeper = |height: f64| depth_above(layers, height) > depth;
    if !deeper(ground_m) {
        return ground_m;
    }
    let mut step = 1e-3;
    while deeper(ground_m + step) && step < 1e12 {
        step *= 2.0;
    }
    let (mut low, mut high) = (0.0, step);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if deeper(ground_m + middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    ground_m + high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_increase_from_the_ground_with_bounded_steps() {
        let exponential = DensityProfile::Exponential {
            reference_height_m: 0.0,
            scale_height_m: 50.0,
        };
        let slab = DensityProfile::slab(30.0);
        for layers in [
            vec![(exponential.clone(), 0.02)],
            vec![(slab.clone(), 1.0)],
            vec![(slab, 1e-4), (exponential.clone(), 1e-3)],
            vec![(exponential, 10.0)],
        ] {
            let heights = between(&layers, 5.0);
            assert_eq!(heights[0], 5.0);
            assert!(
                heights.is_sorted() && (12..420).contains(&heights.len()),
                "{}",
                heights.len()
            );
            let depth = |h: f64| depth_above(&layers, h);
            let whole = depth(5.0);
            let steps = heights.windows(2).map(|w| depth(w[0]) - depth(w[1]));
            assert!(steps.clone().all(|step| step <= 0.6 * whole), "{layers:?}");
            assert!(
                whole > 300.0 || steps.clone().all(|step| step <= 0.81),
                "{layers:?}"
            );
            assert!(depth(heights[heights.len() - 1]) <= 1e-3 * whole);
        }
        assert_eq!(between(&[], 0.0), [0.0, 1.0]);
    }
}
