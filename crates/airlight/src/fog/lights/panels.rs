//! Where a line is cut into panels, so that fog and light are smooth in each.

use crate::atmosphere::RaySegment;
use crate::atmosphere::{Decay, HeightStructure};

/// Heights above a line's densest point, in scale heights, at which it is cut; there is no fog to speak of above the last.
const LEVELS: [f64; 3] = [3.0, 10.0, 40.0];

/// The optical depth from the eye after which nothing is seen.
const DARK: f64 = 90.0;

/// Cuts that are kept: of a fog with a beam in it at most 12, of each layer besides at most 6; more are left out, at the cost
/// of some accuracy.
const PLACES: usize = 40;

/// Distances along a line, rising, between which panels lie.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cuts {
    first: f64,
    last: f64,
    within: [f64; PLACES],
    count: usize,
}

impl Cuts {
    /// The whole ray; `density` is that of the fog at its start, `thinnest_per_m` the smallest extinction above 0 of any lane.
    ///
    /// It is cut where density has a kink, and at a few heights above its densest point: however far away the light is, the
    /// part of a ray that lies in dense fog gets nodes of its own. What lies above the fog's top or 40 scale heights above its
    /// densest point, or behind an optical depth of 90, is left out.
    pub(super) fn of(
        fog: &HeightStructure,
        density: f64,
        line: &RaySegment,
        thinnest_per_m: f64,
    ) -> Self {
        let mut cuts = Self {
            first: 0.0,
            last: line.length_m,
            within: [0.0; PLACES],
            count: 0,
        };
        for &kink in &fog.kinks_m {
            cuts.add(line.below(kink));
        }
        if fog.top_m.is_finite() {
            cuts.keep(line.below(fog.top_m));
        }
        for decay in &fog.decays {
            let mut floor = line.lowest_height_m().max(decay.from_m);
            if decay.from_m == f64::NEG_INFINITY && line.sin_elevation < 0.0 {
                // The fog in which even a steady descent has left DARK behind it.
                let density =
                    density + DARK * -line.sin_elevation / (thinnest_per_m * decay.scale_height_m);
                let dark = decay.reference_height_m - decay.scale_height_m * density.ln();
                if dark > floor {
                    cuts.keep((0.0, line.below(dark).0));
                    floor = dark;
                }
            }
            cuts.stratify(line, floor, decay);
        }
        cuts
    }

    /// Cuts where another layer, which dims the light, has a kink, and at heights where it has thinned out.
    pub(super) fn dimmed_by(&mut self, layer: &HeightStructure, line: &RaySegment) {
        for kink in layer.other_kinks_m() {
            self.add(line.below(kink));
        }
        for decay in &layer.decays {
            let base_m = line.lowest_height_m().max(decay.from_m);
            self.add(line.below(base_m));
            for level in &LEVELS[..2] {
                self.add(line.below(base_m + level * decay.scale_height_m));
            }
        }
    }

    /// Cuts at the levels above the densest point.
    fn stratify(&mut self, line: &RaySegment, densest_height_m: f64, decay: &Decay) {
        let below = |level: f64| line.below(densest_height_m + level * decay.scale_height_m);
        for level in LEVELS {
            self.add(below(level));
        }
        if line.sin_elevation != 0.0 || line.curvature_per_m != 0.0 {
            self.keep(below(LEVELS[LEVELS.len() - 1]));
        }
    }

    /// Leaves out what is not between two distances.
    pub(super) fn keep(&mut self, (first, last): (f64, f64)) {
        self.first = self.first.max(first);
        self.last = self.last.min(last);
    }

    /// Cuts at two distances.
    pub(super) fn add(&mut self, (first, last): (f64, f64)) {
        for at in [first, last] {
            if at.is_finite() && self.count < PLACES {
                self.within[self.count] = at;
                self.count += 1;
            }
        }
    }

    /// Calls `visit(from, to)` for every panel, nearest first.
    #[inline]
    pub(super) fn visit(&mut self, mut visit: impl FnMut(f64, f64)) {
        let within = &mut self.within[..self.count];
        within.sort_unstable_by(f64::total_cmp);
        let mut from = self.first;
        for &at in within.iter() {
            if at > from && at < self.last {
                visit(from, at);
                from = at;
            }
        }
        if self.last > from {
            visit(from, self.last);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::DensityProfile;

    fn panels(profile: &DensityProfile, line: RaySegment) -> Vec<(f64, f64)> {
        let mut all = Vec::new();
        let density = profile.at(line.height_m);
        Cuts::of(&profile.structure(), density, &line, 0.01).visit(|from, to| all.push((from, to)));
        all
    }

    #[test]
    fn a_slab_is_all_there_is_of_its_fog() {
        let slab = DensityProfile::slab(10.0);
        let up = RaySegment::flat(2.0, 0.5, f64::INFINITY);
        assert_eq!(panels(&slab, up), [(0.0, 16.0)]);
        let above = RaySegment::flat(12.0, 0.5, f64::INFINITY);
        assert_eq!(panels(&slab, above), []);
    }

    #[test]
    fn thinning_fog_is_cut_at_its_levels_and_its_base() {
        let profile = DensityProfile::Clamped {
            base_height_m: 10.0,
            scale_height_m: 1.0,
        };
        let up = RaySegment::flat(0.0, 1.0, f64::INFINITY);
        assert_eq!(
            panels(&profile, up),
            [(0.0, 10.0), (10.0, 13.0), (13.0, 20.0), (20.0, 50.0)]
        );
        let level = RaySegment::flat(12.0, 0.0, f64::INFINITY);
        assert_eq!(panels(&profile, level), [(0.0, f64::INFINITY)]);
    }

    #[test]
    fn a_descent_into_ever_denser_fog_ends() {
        let profile = DensityProfile::Exponential {
            reference_height_m: 0.0,
            scale_height_m: 10.0,
        };
        let down = RaySegment::flat(200.0, -0.7, f64::INFINITY);
        let all = panels(&profile, down);
        let end = all.last().unwrap().1;
        let depth = 0.01 * profile.column_along_m(&RaySegment::flat(200.0, -0.7, end));
        assert!((depth / DARK - 1.0).abs() < 1e-9, "{depth}");
        assert!(all.len() >= 3);
    }

    #[test]
    fn a_line_over_round_ground_is_lowest_where_it_dips() {
        let line = RaySegment::new(100.0, -1e-3, 1e5, 6.371e6);
        let low = line.lowest_height_m();
        assert!(low < 100.0 && low > 80.0);
        assert!(low <= line.height_at(6371.0) + 1e-9);
    }
}
