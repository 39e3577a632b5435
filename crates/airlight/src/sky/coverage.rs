//! For which heights of the sun a sky is prepared.

/// The heights of the sun that a prepared sky can be asked about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SunCoverage {
    /// One height of the sun, seen from one place: the fastest to prepare.
    Near {
        /// Elevation of the sun at the observer's nadir, degrees.
        sun_elevation_deg: f64,
        /// Altitude of the observer, m.
        observer_altitude_m: f64,
    },
    /// Every height of the sun and of the observer: for sequences and for views from space.
    All,
}

/// Beyond this zenith angle of the sun (degrees) not even the highest air that matters is lit: night.
const NIGHT_DEG: f64 = 118.0;

impl SunCoverage {
    /// [`SunCoverage::Near`] in short.
    pub fn near(sun_elevation_deg: f64, observer_altitude_m: f64) -> Self {
        Self::Near {
            sun_elevation_deg,
            observer_altitude_m,
        }
    }

    /// Whether suns are among them from which only thin air is lit.
    pub(super) fn are_low(self) -> bool {
        /// Where the light of panels that end too low begins to be missed, degrees.
        const LOW_DEG: f64 = 8.0;
        match self {
            Self::Near {
                sun_elevation_deg, ..
            } => sun_elevation_deg < LOW_DEG,
            Self::All => true,
        }
    }

    /// Zenith angles of the sun, increasing (degrees), at which the light inside the air is solved for.
    pub(super) fn sun_zeniths_deg(self, ground_radius_m: f64, top_radius_m: f64) -> Vec<f64> {
        let Self::Near {
            sun_elevation_deg,
            observer_altitude_m,
        } = self
        else {
            return all_zeniths_deg();
        };
        // A line of sight ends below the horizon of the highest air; seen from there the sun stands differently by
        // as much as the planet's surface has curved on the way.
        let dip = |radius_m: f64| {
            (ground_radius_m / radius_m.max(ground_radius_m))
                .acos()
                .to_degrees()
        };
        let reach = dip(top_radius_m) + dip(ground_radius_m + observer_altitude_m.max(0.0));
        if reach > 15.0 {
            return all_zeniths_deg();
        }
        let centre = (90.0 - sun_elevation_deg).clamp(0.0, NIGHT_DEG);
        // In twilight the light comes from air beyond the horizon, where the sun is higher.
        // The deeper it is, the faster it fades with every degree.
        let twilight = centre > 86.0;
        let lowest = (centre - reach - if twilight { 8.0 } else { 5.0 }).max(0.0);
        let highest = (centre + reach + 2.0).min(NIGHT_DEG);
        let mut zeniths = vec![centre];
        for (side, end) in [(-1.0, lowest), (1.0, highest)] {
            let (mut step, growth) = if twilight {
                (0.8, if centre > 98.0 { 1.12 } else { 1.25 })
            } else {
                (1.5, 1.5)
            };
            let mut here = centre;
            while (here - end) * side < 0.0 {
                here += side * step;
                if (here - end) * side > 0.0 || (here - end).abs() < 0.3 * step {
                    here = end;
                }
                zeniths.push(here);
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

/// The whole range: coarse where the sun is high, a degree apart through twilight.
fn all_zeniths_deg() -> Vec<f64> {
    let mut zeniths = vec![0.0];
    let mut here = 0.0;
    while here < NIGHT_DEG {
        here += match here {
            z if z < 55.0 => 5.0,
            z if z < 73.0 => 3.0,
            z if z < 83.0 => 2.0,
            z if z < 112.0 => 1.0,
            _ => 2.0,
        };
        zeniths.push(here);
    }
    zeniths
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_asked_height_is_a_node_and_the_nodes_span_what_is_seen() {
        for elevation in [90.0, 60.0, 10.0, 2.0, -4.0, -18.0] {
            let zeniths = SunCoverage::near(elevation, 0.0).sun_zeniths_deg(6.36e6, 6.46e6);
            assert!(zeniths.contains(&(90.0 - elevation)));
            assert!(zeniths.windows(2).all(|w| w[1] > w[0]), "{zeniths:?}");
            assert!(zeniths[0] <= (90.0 - elevation - 10.0).max(0.0));
            assert!(zeniths.len() < 32, "{zeniths:?}");
        }
    }

    #[test]
    fn from_space_all_heights_of_the_sun_are_seen() {
        assert_eq!(
            SunCoverage::near(30.0, 400e3).sun_zeniths_deg(6.36e6, 6.46e6),
            SunCoverage::All.sun_zeniths_deg(6.36e6, 6.46e6)
        );
    }
}
