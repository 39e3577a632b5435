//! Range of sun elevations that a sky is prepared for.

/// The sun elevations and observer altitudes that a sky is prepared for. For others it is solved again by the first
/// [`Sky::view`](super::Sky::view) that needs it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SunCoverage {
    /// One sun elevation, to a quarter of a degree in twilight and a degree where it is high, and one observer altitude: the fastest to prepare.
    Near {
        /// Elevation of the sun at the observer, degrees.
        sun_elevation_deg: f64,
        /// Altitude of the observer, m.
        observer_altitude_m: f64,
    },
    /// All sun elevations and observer altitudes: for sequences and views from space.
    All,
    /// Sources above the horizon, at a coarse spacing: for the moon and for light from the whole sky, such as airglow.
    AboveHorizon,
}

/// Zenith angle of the sun beyond which no relevant part of the atmosphere is sunlit, degrees.
const NIGHT_DEG: f64 = 118.0;

impl SunCoverage {
    /// Creates [`SunCoverage::Near`].
    pub fn near(sun_elevation_deg: f64, observer_altitude_m: f64) -> Self {
        Self::Near {
            sun_elevation_deg,
            observer_altitude_m,
        }
    }

    /// True if the light is solved for wherever the rays of an eye at an altitude above the ground lead under a sun at an elevation.
    pub(super) fn covers(
        self,
        (altitude_m, sun_elevation_deg): (f64, f64),
        spacing: f64,
        ground_radius_m: f64,
        top_radius_m: f64,
    ) -> bool {
        /// Elevation below which a source has no light left that a coarse spacing could miss, degrees.
        const SET_DEG: f64 = -2.0;
        let centre = match self {
            Self::All => return true,
            Self::AboveHorizon => return sun_elevation_deg > SET_DEG,
            Self::Near { .. } => self.eye_zenith_deg(ground_radius_m, top_radius_m),
        };
        let Some(centre) = centre else {
            // Solved for all suns.
            return true;
        };
        let zenith = (90.0 - sun_elevation_deg).clamp(0.0, NIGHT_DEG);
        if (zenith - centre).abs() > same_sun_deg(centre) {
            return false;
        }
        let zeniths = self.sun_zeniths_deg(spacing, ground_radius_m, top_radius_m);
        let (first, last) = (zeniths[0] - 1e-6, zeniths[zeniths.len() - 1] + 1e-6);
        let range = range_deg(altitude_m, ground_radius_m, top_radius_m);
        (zenith - range).max(0.0) >= first && (zenith + range).min(NIGHT_DEG) <= last
    }

    /// True if the range includes suns low enough that only thin air is sunlit.
    pub(super) fn includes_low_suns(self) -> bool {
        /// Elevation below which the default altitude range misses light, degrees.
        const LOW_DEG: f64 = 8.0;
        match self {
            Self::Near {
                sun_elevation_deg, ..
            } => sun_elevation_deg < LOW_DEG,
            Self::All | Self::AboveHorizon => true,
        }
    }

    /// Air masses of the sunlight, relative to the zenith, that bracket those of the range.
    pub(super) fn air_masses(self) -> Vec<f64> {
        /// At the horizon, and for light that passes the ground and comes up again.
        const LOW: [f64; 3] = [10.0, 38.0, 76.0];
        match self {
            Self::Near {
                sun_elevation_deg, ..
            } if !self.includes_low_suns() => vec![1.0 / sun_elevation_deg.to_radians().sin()],
            Self::Near { .. } => LOW.to_vec(),
            Self::All | Self::AboveHorizon => [&[1.0, 3.0], &LOW[..]].concat(),
        }
    }

    /// Zenith angle of the sun at the eye, degrees, where views reach no suns far from it.
    pub(super) fn eye_zenith_deg(self, ground_radius_m: f64, top_radius_m: f64) -> Option<f64> {
        let Self::Near {
            sun_elevation_deg,
            observer_altitude_m,
        } = self
        else {
            return None;
        };
        let range = range_deg(observer_altitude_m, ground_radius_m, top_radius_m);
        (range <= WIDE_DEG).then(|| (90.0 - sun_elevation_deg).clamp(0.0, NIGHT_DEG))
    }

    /// Zenith angles of the sun at which the light inside the atmosphere is solved for, degrees, increasing: `spacing` times as far
    /// apart as by default.
    pub(super) fn sun_zeniths_deg(
        self,
        spacing: f64,
        ground_radius_m: f64,
        top_radius_m: f64,
    ) -> Vec<f64> {
        let (
            Self::Near {
                observer_altitude_m,
                ..
            },
            Some(centre),
        ) = (self, self.eye_zenith_deg(ground_radius_m, top_radius_m))
        else {
            return match self {
                Self::AboveHorizon => zeniths_above_horizon_deg(spacing),
                _ => all_zeniths_deg(spacing),
            };
        };
        let range = range_deg(observer_altitude_m, ground_radius_m, top_radius_m);
        let lowest = (centre - range - MARGIN_DEG).max(0.0);
        let highest = (centre + range + MARGIN_DEG).min(NIGHT_DEG);
        let mut zeniths = vec![centre];
        for (side, end) in [(-1.0, lowest), (1.0, highest)] {
            let (step, growth) = steps_deg(centre);
            let (mut step, growth) = (step * spacing, growth.powf(spacing));
            let mut zenith = centre;
            while (zenith - end) * side < 0.0 {
                zenith += side * step;
                if (zenith - end) * side > 0.0 || (zenith - end).abs() < 0.3 * step {
                    zenith = end;
                }
                zeniths.push(zenith);
                step *= growth;
            }
        }
        zeniths.sort_by(f64::total_cmp);
        zeniths.dedup();
        if zeniths.len() == 1 {
            zeniths.push(zeniths[0] + 1.0);
        }
        zeniths
    }
}

/// Distance of the suns beside one at a zenith angle, degrees, and the factor by which distances grow from there. Most of the light that
/// an eye sees was scattered nearby, under almost the same sun. By day light varies with the air mass of the sunlight; in twilight it
/// fades with each degree, faster the deeper the sun is.
fn steps_deg(zenith_deg: f64) -> (f64, f64) {
    match zenith_deg {
        ..=86.0 => (f64::max(1.5, 0.35 * (90.0 - zenith_deg)), 2.0),
        ..=98.0 => (1.1, 2.0),
        ..=104.0 => (0.8, 1.35),
        _ => (0.8, 1.2),
    }
}

/// Largest distance of a sun from the one at a zenith angle that was prepared for, degrees. Within it skies of average and hazy air differ
/// from those prepared for the sun itself by at most 0.3 % rms; at 2 degrees by up to 2.7 %.
fn same_sun_deg(zenith_deg: f64) -> f64 {
    f64::max(0.25, (90.0 - zenith_deg) / 50.0)
}

/// Range of a view beyond which it is prepared for all suns, degrees.
const WIDE_DEG: f64 = 15.0;

/// What views from another altitude may reach beyond, degrees.
const MARGIN_DEG: f64 = 2.0;

/// Largest difference of the sun's zenith angle along the view rays of an eye above the ground, degrees: a ray extends to the horizon
/// of the highest air, where the sun's zenith angle differs by the curvature of the planet along the way.
fn range_deg(altitude_m: f64, ground_radius_m: f64, top_radius_m: f64) -> f64 {
    let horizon_dip = |radius_m: f64| {
        (ground_radius_m / radius_m.max(ground_radius_m))
            .acos()
            .to_degrees()
    };
    horizon_dip(top_radius_m) + horizon_dip(ground_radius_m + altitude_m.max(0.0))
}

/// Zenith angles over the whole range: coarse for high suns, every degree through twilight.
fn all_zeniths_deg(spacing: f64) -> Vec<f64> {
    zeniths_deg(NIGHT_DEG, spacing, |zenith| match zenith {
        z if z < 60.0 => 15.0,
        z if z < 72.0 => 6.0,
        z if z < 84.0 => 3.0,
        z if z < 87.0 => 1.5,
        z if z < 108.0 => 1.0,
        _ => 1.5,
    })
}

/// Zenith angles down to 10 degrees below the horizon.
fn zeniths_above_horizon_deg(spacing: f64) -> Vec<f64> {
    zeniths_deg(100.0, spacing, |zenith| match zenith {
        z if z < 60.0 => 6.0,
        z if z < 75.0 => 5.0,
        z if z < 85.0 => 3.0,
        _ => 2.0,
    })
}

/// Zenith angles from 0 to `lowest`, with `spacing` times a step that depends on the angle.
fn zeniths_deg(lowest: f64, spacing: f64, step: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut zeniths = vec![0.0];
    let mut zenith = 0.0;
    while zenith < lowest {
        zenith = f64::min(zenith + spacing * step(zenith), lowest);
        zeniths.push(zenith);
    }
    zeniths
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requested_elevation_is_a_node_and_nodes_cover_the_visible_range() {
        for elevation in [90.0, 60.0, 10.0, 2.0, -4.0, -18.0] {
            for spacing in [1.0, 0.5] {
                let near = SunCoverage::near(elevation, 0.0);
                let zeniths = near.sun_zeniths_deg(spacing, 6.36e6, 6.46e6);
                assert!(zeniths.contains(&(90.0 - elevation)));
                assert!(zeniths.windows(2).all(|w| w[1] > w[0]), "{zeniths:?}");
                assert!(zeniths[0] <= (90.0 - elevation - 10.0).max(0.0));
                assert!(
                    zeniths.len() < (32.0 / spacing) as usize,
                    "{spacing}: {zeniths:?}"
                );
            }
        }
    }

    #[test]
    fn views_are_covered_by_what_was_prepared_for_them() {
        let earth = (6.36e6, 6.46e6);
        let covers = |coverage: SunCoverage, altitude_m: f64, elevation: f64| {
            coverage.covers((altitude_m, elevation), 1.0, earth.0, earth.1)
        };
        for elevation in [90.0, 60.0, 10.0, 2.0, -4.0, -18.0, -40.0, -90.0] {
            for altitude_m in [0.0, 3e3, 12e3, 60e3, 400e3] {
                let near = SunCoverage::near(elevation, altitude_m);
                assert!(
                    covers(near, altitude_m, elevation),
                    "{elevation} {altitude_m}"
                );
                assert!(covers(SunCoverage::All, altitude_m, elevation));
            }
        }
        let near = SunCoverage::near(30.0, 0.0);
        assert!(covers(near, 0.0, 30.5) && covers(near, 10.0, 29.5));
        assert!(!covers(near, 0.0, 29.0) && !covers(near, 0.0, 60.0));
        let twilight = SunCoverage::near(-4.0, 0.0);
        assert!(covers(twilight, 3e3, -4.2) && !covers(twilight, 0.0, -4.3));
        assert!(!covers(near, 400e3, 30.0) && !covers(near, 20e3, 30.0));
        assert!(covers(SunCoverage::near(30.0, 400e3), 0.0, -5.0));
    }

    #[test]
    fn views_from_space_cover_all_sun_elevations() {
        assert_eq!(
            SunCoverage::near(30.0, 400e3).sun_zeniths_deg(1.0, 6.36e6, 6.46e6),
            SunCoverage::All.sun_zeniths_deg(1.0, 6.36e6, 6.46e6)
        );
    }
}
