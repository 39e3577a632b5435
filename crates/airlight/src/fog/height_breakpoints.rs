//! Heights between which a fog of several layers is treated as a single layer.

use crate::atmosphere::HeightStructure;

/// Steps in scale heights: dense where most of the fog is.
const STEPS: [f64; 14] = [
    0.0, 0.12, 0.25, 0.4, 0.57, 0.77, 1.0, 1.3, 1.65, 2.1, 2.7, 3.5, 5.0, 8.0,
];

/// Steps in each other interval of smooth variation.
const RAMP_STEPS: u32 = 4;

/// Rising heights (m) for the profiles of these structures over ground at a height: steps of each scale height upwards from
/// where the profile starts to decay, steps of smooth variation, edges of layers.
pub(super) fn between(profiles: &[HeightStructure], ground_height_m: f64) -> Vec<f64> {
    let mut heights: Vec<f64> = Vec::new();
    for profile in profiles {
        heights.extend(profile.other_kinks_m());
        for decay in &profile.decays {
            let from = decay.from_m.max(ground_height_m);
            heights.extend(STEPS.map(|step| from + step * decay.scale_height_m));
        }
        for [from, to] in &profile.ramps_m {
            let step = (to - from) / f64::from(RAMP_STEPS);
            heights.extend((0..=RAMP_STEPS).map(|k| from + f64::from(k) * step));
        }
    }
    heights.sort_by(f64::total_cmp);
    // Heights that nearly coincide count once.
    heights.dedup_by(|b, a| *b - *a < 1e-6 * (1.0 + a.abs()));
    heights
}
