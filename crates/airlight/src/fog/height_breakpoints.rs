//! Heights between which a fog of several layers may be taken as if it were of one.

use super::profile::Profile;

/// Steps in scale heights: dense where most of the matter is.
const STEPS: [f64; 14] = [
    0.0, 0.12, 0.25, 0.4, 0.57, 0.77, 1.0, 1.3, 1.65, 2.1, 2.7, 3.5, 5.0, 8.0,
];

/// Rising heights (m) for these profiles over ground at a height: steps of each scale height upwards from where the profile
/// starts to thin, edges of layers.
pub(super) fn between(profiles: &[Profile], ground_height_m: f64) -> Vec<f64> {
    let mut levels: Vec<f64> = Vec::new();
    for profile in profiles {
        let (from, scale) = match *profile {
            Profile::Uniform => continue,
            Profile::Exponential { scale_height_m, .. } => (ground_height_m, scale_height_m),
            Profile::Clamped {
                base_height_m,
                scale_height_m,
            } => (base_height_m.max(ground_height_m), scale_height_m),
            Profile::Slab { top_height_m } => {
                levels.push(top_height_m);
                continue;
            }
        };
        levels.extend(STEPS.map(|step| from + step * scale));
    }
    levels.sort_by(f64::total_cmp);
    // Two that nearly coincide are one.
    levels.dedup_by(|b, a| *b - *a < 1e-6 * (1.0 + a.abs()));
    levels
}
