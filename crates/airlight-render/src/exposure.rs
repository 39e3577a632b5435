//! Exposure of display pictures (PNG, JPEG, previews): fixed, or metered from a small picture.

use airlight::spectrum::RgbSpace;
use airlight_image::tone::{Exposure, Metering};
use airlight_image::{Frame, ImageError};
use glam::DVec3;

/// Width of the small picture that is metered, pixels.
pub const METERED_WIDTH: u32 = 96;
/// Weight of ground relative to sky, so that a dark foreground does not overexpose the sky.
const GROUND_SHARE: f64 = 0.2;
/// Stops by which a picture of sky only is brighter than middle grey; a picture of ground only (from space) is middle grey.
const SKY_STOPS: f64 = 1.0;
/// Luminance of a daylight sky, cd/m^2, and stops by which a picture is darkened for each stop below it, so that dusk looks
/// darker than day.
const DAYLIGHT_CD_M2: f64 = 2000.0;
const DARKER_PER_STOP: f64 = 0.1;

/// Exposure of display pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExposureSettings {
    /// Exposure value at ISO 100 (sunny day 15, dusk 8); `None` is automatic.
    pub ev100: Option<f64>,
    /// Stops by which pictures are brightened (negative: darkened).
    pub brighten_stops: f64,
}

impl ExposureSettings {
    /// The exposure if it does not depend on the picture.
    ///
    /// # Errors
    /// [`ImageError::Setting`] for an exposure value out of range.
    pub fn fixed(&self) -> Result<Option<Exposure>, ImageError> {
        self.ev100
            .map(|ev100| Exposure::from_ev100(ev100)?.brighter_by(self.brighten_stops))
            .transpose()
    }

    /// The exposure of a picture, metered if it is automatic. `pixels` are those of a small picture in `frame`, linear in
    /// `space` (cd/m^2) and without the sun's disc; `is_ground` returns whether a direction meets the ground.
    ///
    /// # Errors
    /// [`ImageError::Setting`] for an exposure out of range.
    pub fn metered(
        &self,
        (frame, pixels): (&Frame, &[[f32; 3]]),
        space: RgbSpace,
        is_ground: impl Fn(DVec3) -> bool,
    ) -> Result<Exposure, ImageError> {
        if let Some(exposure) = self.fixed()? {
            return Ok(exposure);
        }
        let mut samples = Vec::with_capacity(pixels.len());
        let (mut lit_sky, mut lit) = (0.0f64, 0.0f64);
        for (index, rgb) in (0..).zip(pixels) {
            let (i, j) = (index % frame.size().width(), index / frame.size().width());
            let luminance = space.luminance(rgb.map(f64::from));
            let below = frame.pixel_direction(i, j).is_some_and(&is_ground);
            let share = if below { GROUND_SHARE } else { 1.0 };
            let weight = share * frame.pixel_solid_angle(i, j);
            samples.push((luminance as f32, weight as f32));
            if luminance > 0.0 {
                lit += weight;
                lit_sky += if below { 0.0 } else { weight };
            }
        }
        let metering = Metering::default();
        // A black picture is black in any exposure.
        let typical = metering
            .typical_luminance(&samples)
            .unwrap_or(DAYLIGHT_CD_M2);
        let dusk_stops = DARKER_PER_STOP * (typical / DAYLIGHT_CD_M2).log2().min(0.0);
        let sky_stops = SKY_STOPS * lit_sky / lit.max(f64::MIN_POSITIVE);
        Exposure::from_factor(metering.key / typical)?
            .brighter_by(self.brighten_stops + sky_stops + dusk_stops)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exposure(settings: ExposureSettings, luminance: f32) -> f64 {
        let frame = Frame::equirectangular(8).unwrap();
        let pixels = vec![[luminance; 3]; 128];
        settings
            .metered((&frame, &pixels), RgbSpace::Srgb, |d| d.y < 0.0)
            .unwrap()
            .factor()
    }

    #[test]
    fn dusk_has_more_exposure_than_day_and_is_still_darker() {
        let auto = ExposureSettings::default();
        let (day, dusk) = (exposure(auto, 4000.0), exposure(auto, 4.0));
        assert!(dusk > day);
        assert!(4.0 * dusk < 0.6 * 4000.0 * day, "{day} {dusk}");
    }

    #[test]
    fn stops_are_factors_of_two_and_fixed_exposures_ignore_the_picture() {
        let with = |ev100, brighten_stops| ExposureSettings {
            ev100,
            brighten_stops,
        };
        let ratio = exposure(with(None, 2.0), 100.0) / exposure(with(None, 0.0), 100.0);
        assert!((ratio - 4.0).abs() < 1e-9);
        let fixed = with(Some(14.0), 0.0);
        assert_eq!(exposure(fixed, 1.0), exposure(fixed, 1000.0));
        let ratio = exposure(with(Some(13.0), 1.0), 1.0) / exposure(fixed, 1.0);
        assert!((ratio - 4.0).abs() < 1e-9);
        assert!(with(Some(1000.0), 0.0).fixed().is_err());
        assert!(with(Some(15.0), 1e9).fixed().is_err());
    }
}
