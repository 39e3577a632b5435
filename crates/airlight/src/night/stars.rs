//! The bright stars.

use super::celestial::spherical;
use crate::spectrum::embedded_table;
use glam::DVec3;
use std::sync::LazyLock;

/// Illuminance of a star of V magnitude 0 outside the air, lx (Allen, Astrophysical Quantities, 4th edition, sec. 2.6).
const MAGNITUDE_0_LX: f64 = 2.54e-6;

/// A star.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Star {
    /// Unit vector in equatorial coordinates of J2000 ([`CelestialFrame::to_world`](super::CelestialFrame::to_world)).
    pub equatorial: DVec3,
    /// Apparent V magnitude.
    pub magnitude: f64,
    /// Colour temperature, K.
    pub temperature_k: f64,
}

impl Star {
    /// Illuminance outside the air on a surface that faces it, lx.
    pub fn illuminance_lx(&self) -> f64 {
        MAGNITUDE_0_LX * 10f64.powf(-0.4 * self.magnitude)
    }
}

/// The 8404 stars up to V magnitude 6.5 of the Bright Star Catalogue (Hoffleit & Warren 1991), brightest first. Positions are
/// rounded to 0.001 degrees and proper motion is left out: below 0.01 degrees in a century for all but 100 stars.
pub fn bright_stars() -> &'static [Star] {
    static STARS: LazyLock<Vec<Star>> = LazyLock::new(|| {
        embedded_table::<4>(include_str!("../../data/night/bright_stars.txt"))
            .into_iter()
            .map(
                |[
                    right_ascension_deg,
                    declination_deg,
                    magnitude,
                    temperature_k,
                ]| Star {
                    equatorial: spherical(
                        right_ascension_deg.to_radians(),
                        declination_deg.to_radians(),
                    ),
                    magnitude,
                    temperature_k,
                },
            )
            .collect()
    });
    &STARS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_catalogue_is_complete_and_sorted() {
        let stars = bright_stars();
        assert_eq!(stars.len(), 8404);
        assert!(
            stars
                .windows(2)
                .all(|pair| pair[0].magnitude <= pair[1].magnitude)
        );
        assert!(
            stars
                .iter()
                .all(|star| star.equatorial.is_normalized() && star.temperature_k > 1500.0)
        );
        let sirius = stars[0];
        assert_eq!((sirius.magnitude, sirius.temperature_k), (-1.46, 9750.0));
        let bright = stars.iter().filter(|star| star.magnitude < 1.5).count();
        assert!((20..=24).contains(&bright), "{bright}");
        // All of them together: about 0.35 stars of magnitude 0 a square degree of a hemisphere, 1.3e-4 lx.
        let sum: f64 = stars.iter().map(Star::illuminance_lx).sum();
        assert!((0.8e-4..3e-4).contains(&sum), "{sum}");
    }
}
