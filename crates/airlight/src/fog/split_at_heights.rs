//! Walking along a line from height to height.

use crate::atmosphere::RaySegment;

/// Calls `visit` with the parts into which the rising `breakpoints_m` cut a line, from its start on, until it says `false`.
/// A line over round ground is also cut at its lowest point, so that each part only climbs or only falls.
pub(super) fn split_at_heights(
    line: &RaySegment,
    breakpoints_m: &[f64],
    mut visit: impl FnMut(&RaySegment) -> bool,
) {
    if let Some(lowest) = line.dip_m() {
        let falling = line.part(0.0, lowest);
        if monotone(&falling, false, breakpoints_m, &mut visit) {
            monotone(
                &line.part(lowest, line.length_m),
                true,
                breakpoints_m,
                &mut visit,
            );
        }
    } else {
        // Over round ground a level line climbs from its start on.
        let rises =
            line.sin_elevation > 0.0 || (line.sin_elevation == 0.0 && line.curvature_per_m > 0.0);
        monotone(line, rises, breakpoints_m, &mut visit);
    }
}

/// The same for a line that only climbs or only falls; says whether all was visited.
fn monotone(
    line: &RaySegment,
    rises: bool,
    breakpoints_m: &[f64],
    visit: &mut impl FnMut(&RaySegment) -> bool,
) -> bool {
    let mut from = 0.0;
    let mut cut = |at: f64, visit: &mut dyn FnMut(&RaySegment) -> bool| {
        // A level that the line starts on cuts nothing off.
        if at > from && at < line.length_m {
            let part = line.part(from, at);
            from = at;
            return visit(&part);
        }
        true
    };
    if rises {
        let first = breakpoints_m.partition_point(|&level| level <= line.height_m);
        for &level in &breakpoints_m[first..] {
            let at = line.below(level).1;
            if at >= line.length_m {
                break;
            }
            if !cut(at, visit) {
                return false;
            }
        }
    } else {
        let last = breakpoints_m.partition_point(|&level| level < line.height_m);
        for &level in breakpoints_m[..last].iter().rev() {
            let (enters, leaves) = line.below(level);
            if enters == leaves {
                break;
            }
            if !cut(enters, visit) {
                return false;
            }
        }
    }
    visit(&line.part(from, line.length_m))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cuts(line: RaySegment, levels: &[f64]) -> Vec<RaySegment> {
        let mut all = Vec::new();
        split_at_heights(&line, levels, |part| {
            all.push(*part);
            true
        });
        all
    }

    #[test]
    fn the_parts_make_up_the_line_and_keep_between_levels() {
        let levels = [0.0, 5.0, 10.0, 40.0, 300.0];
        for line in [
            RaySegment::flat(7.0, 0.5, 300.0),
            RaySegment::flat(70.0, -0.5, 130.0),
            RaySegment::flat(10.0, 0.0, 1e4),
            RaySegment::flat(10.0, -1e-4, 1e5),
            RaySegment::new(20.0, -2e-3, 5e4, 6.4e6),
            RaySegment::new(20.0, 0.0, 5e4, 6.4e6),
            RaySegment::new(5.0, 1.0, 1e4, 6.4e6),
        ] {
            let parts = cuts(line, &levels);
            let sum: f64 = parts.iter().map(|part| part.length_m).sum();
            assert!((sum / line.length_m - 1.0).abs() < 1e-12, "{line:?}");
            for part in &parts {
                let (a, b) = (part.height_m, part.end_height_m());
                for level in levels {
                    let (low, high) = (a.min(b) + 1e-6, a.max(b) - 1e-6);
                    assert!(
                        !(low < level && level < high),
                        "{line:?}: {part:?} crosses {level}"
                    );
                }
            }
        }
        assert_eq!(cuts(RaySegment::flat(7.0, 0.5, 300.0), &levels).len(), 3);
        // A line without end: the last part has none.
        let parts = cuts(RaySegment::flat(7.0, 0.5, f64::INFINITY), &levels);
        assert_eq!(parts.last().unwrap().length_m, f64::INFINITY);
    }
}
