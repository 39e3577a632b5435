//! Exposure of display pictures (PNG, JPEG, previews): fixed, or metered from a small picture.

use airlight::scene::{self, MeteringMode, OutputSpec};
use airlight::spectrum::RgbSpace;
use airlight_image::tone::{Exposure, MIDDLE_GREY, Metering};
use airlight_image::{Frame, ImageError, Size};
use glam::DVec3;
use std::f64::consts::PI;

/// Width of the small picture that is metered, pixels.
pub const METERED_WIDTH: u32 = 96;
/// Exposure value at ISO 100 below which nothing is metered: 20 s at f/1.4 and ISO 2500, a photograph of the Milky Way. What is
/// darker stays dark.
pub const DARKEST_EV100: f64 = -8.0;

/// Weight of ground relative to sky, so that a dark foreground does not overexpose the sky.
const GROUND_SHARE: f64 = 0.2;
/// Stops by which a picture of sky only is brighter than middle grey; a picture of ground only (from space) is middle grey.
const SKY_STOPS: f64 = 1.0;
/// Luminance of a daylight sky, cd/m^2, and stops by which a picture is darkened for each stop below it, so that dusk looks
/// darker than day.
const DAYLIGHT_CD_M2: f64 = 2000.0;
const DARKER_PER_STOP: f64 = 0.1;
/// Luminance relative to the mean below which evaluative metering counts a pixel as black: space above the air.
const BLACK: f64 = 1e-3;
/// Share of the picture that a spot meter sees.
const SPOT_SHARE: f64 = 0.025;
/// Standard deviation of the weights of centre-weighted metering, relative to the shorter side of the picture.
const CENTRE_DEVIATION: f64 = 0.2;
/// Exposed value of the luminance that only a hundredth of the picture exceeds, in highlight-weighted metering.
const HIGHLIGHT: f64 = 0.8;

/// Exposure of display pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExposureSettings {
    /// Exposure value at ISO 100 (sunny day 15, dusk 8); `None` is automatic.
    pub ev100: Option<f64>,
    /// What automatic exposure is metered from.
    pub metering: MeteringMode,
    /// Stops by which pictures are brightened (negative: darkened).
    pub brighten_stops: f64,
}

/// A pixel to be metered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeteredPixel {
    /// Luminance, cd/m^2.
    pub luminance: f64,
    /// Solid angle relative to the other pixels.
    pub solid_angle: f64,
    /// Whether it shows the ground or an object on it, not the sky.
    pub is_ground: bool,
}

/// A small picture to be metered, without the sun's disc.
#[derive(Clone, Debug, PartialEq)]
pub struct MeteredPicture {
    /// Width and height.
    pub size: Size,
    /// Pixels, row by row.
    pub pixels: Vec<MeteredPixel>,
    /// Illuminance of sun and sky on the horizontal, lx.
    pub horizontal_lx: f64,
}

impl ExposureSettings {
    /// The exposure settings of a scene's output.
    pub fn of(output: &OutputSpec) -> Self {
        let (ev100, metering) = match output.exposure {
            Some(scene::Exposure::Metered(mode)) => (None, mode),
            other => (
                other.and_then(scene::Exposure::ev100),
                MeteringMode::default(),
            ),
        };
        Self {
            ev100,
            metering,
            brighten_stops: output.brighten.unwrap_or(0.0),
        }
    }

    /// The exposure if it does not depend on the picture.
    ///
    /// # Errors
    /// [`ImageError::Setting`] for an exposure value out of range.
    pub fn fixed(&self) -> Result<Option<Exposure>, ImageError> {
        self.ev100
            .map(|ev100| Exposure::from_ev100(ev100)?.brighter_by(self.brighten_stops))
            .transpose()
    }

    /// The exposure of a picture, metered if it is automatic; not longer than [`DARKEST_EV100`] before it is brightened.
    ///
    /// # Errors
    /// [`ImageError::Setting`] for an exposure out of range.
    pub fn metered(&self, picture: &MeteredPicture) -> Result<Exposure, ImageError> {
        if let Some(exposure) = self.fixed()? {
            return Ok(exposure);
        }
        let longest = Exposure::from_ev100(DARKEST_EV100)?;
        let factor = match self.metering {
            MeteringMode::CentreWeighted => picture.mean(|pixel| pixel.centre_weight()),
            MeteringMode::Spot => picture.mean(|pixel| f64::from(pixel.in_spot())),
            MeteringMode::Average => picture.mean(|_| 1.0),
            MeteringMode::HighlightWeighted => picture.highlight(),
            // A card of any reflectance is shown as that reflectance.
            MeteringMode::Incident => PI / picture.horizontal_lx,
            _ => picture.evaluative(),
        };
        // A black picture, whose factor is infinite or NaN, is black in any exposure.
        let factor = f64::min(factor, longest.factor());
        Exposure::from_factor(factor)?.brighter_by(self.brighten_stops)
    }
}

/// A pixel and its place in the picture.
struct Pixel {
    luminance: f64,
    solid_angle: f64,
    is_ground: bool,
    /// Distance from the centre, relative to the shorter side of the picture.
    from_centre: f64,
    /// Share of the picture's pixels that lie closer to the centre.
    share_within: f64,
}

impl Pixel {
    fn centre_weight(&self) -> f64 {
        (-0.5 * (self.from_centre / CENTRE_DEVIATION).powi(2)).exp()
    }

    fn in_spot(&self) -> bool {
        self.share_within < SPOT_SHARE
    }
}

impl MeteredPicture {
    /// The pixels of a frame, from their colours in a space (cd/m^2), with ground below the horizon.
    pub fn of_frame(
        frame: &Frame,
        colours: &[[f32; 3]],
        space: RgbSpace,
        horizon_elevation_rad: f64,
        horizontal_lx: f64,
    ) -> Self {
        let size = frame.size();
        let meets_ground = |d: DVec3| d.y.clamp(-1.0, 1.0).asin() < horizon_elevation_rad;
        let pixels = (0..).zip(colours).map(|(index, rgb)| {
            let (i, j) = (index % size.width(), index / size.width());
            MeteredPixel {
                luminance: space.luminance(rgb.map(f64::from)),
                solid_angle: frame.pixel_solid_angle(i, j),
                is_ground: frame.pixel_direction(i, j).is_some_and(meets_ground),
            }
        });
        Self {
            size,
            pixels: pixels.collect(),
            horizontal_lx,
        }
    }

    fn pixels(&self) -> impl Iterator<Item = Pixel> + '_ {
        let size = self.size;
        let (width, height) = (f64::from(size.width()), f64::from(size.height()));
        (0..).zip(&self.pixels).map(move |(index, pixel)| {
            let (i, j) = (index % size.width(), index / size.width());
            let across = f64::from(i) + 0.5 - 0.5 * width;
            let down = f64::from(j) + 0.5 - 0.5 * height;
            let &MeteredPixel {
                luminance,
                solid_angle,
                is_ground,
            } = pixel;
            Pixel {
                luminance,
                solid_angle,
                is_ground,
                from_centre: across.hypot(down) / width.min(height),
                share_within: PI * across.hypot(down).powi(2) / (width * height),
            }
        })
    }

    /// Factor that makes the mean luminance, weighted by solid angle and `weight`, middle grey.
    fn mean(&self, weight: impl Fn(&Pixel) -> f64) -> f64 {
        MIDDLE_GREY / self.mean_luminance(weight)
    }

    fn mean_luminance(&self, weight: impl Fn(&Pixel) -> f64) -> f64 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for pixel in self.pixels().filter(|pixel| pixel.luminance.is_finite()) {
            let weight = pixel.solid_angle * weight(&pixel);
            sum += weight * pixel.luminance;
            weights += weight;
        }
        sum / weights
    }

    /// Factor that places the luminance that only a hundredth of the picture exceeds at [`HIGHLIGHT`].
    fn highlight(&self) -> f64 {
        let samples: Vec<_> = self
            .pixels()
            .map(|pixel| (pixel.luminance as f32, pixel.solid_angle as f32))
            .collect();
        let brightest = Metering {
            low_percentile: 0.99,
            high_percentile: 0.99,
            ..Metering::default()
        };
        HIGHLIGHT / brightest.typical_luminance(&samples).unwrap_or(0.0)
    }

    /// Factor that makes the typical luminance, more of the sky than of the ground, middle grey or somewhat brighter, and darker
    /// by dusk.
    fn evaluative(&self) -> f64 {
        let mut samples = Vec::with_capacity(self.pixels.len());
        let (mut lit_sky, mut lit) = (0.0f64, 0.0f64);
        let black = BLACK * self.mean_luminance(|_| 1.0);
        for pixel in self.pixels() {
            if pixel.luminance < black {
                continue;
            }
            let share = if pixel.is_ground { GROUND_SHARE } else { 1.0 };
            let weight = share * pixel.solid_angle;
            samples.push((pixel.luminance as f32, weight as f32));
            if pixel.luminance > 0.0 {
                lit += weight;
                lit_sky += if pixel.is_ground { 0.0 } else { weight };
            }
        }
        let typical = Metering::default()
            .typical_luminance(&samples)
            .unwrap_or(0.0);
        let dusk_stops = DARKER_PER_STOP * (typical / DAYLIGHT_CD_M2).log2().min(0.0);
        let sky_stops = SKY_STOPS * lit_sky / lit.max(f64::MIN_POSITIVE);
        MIDDLE_GREY / typical * (sky_stops + dusk_stops).exp2()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The exposure of an even picture.
    fn exposure(settings: ExposureSettings, luminance: f32) -> f64 {
        of(settings, |_| luminance)
    }

    /// The exposure of a picture of luminances by direction.
    fn of(settings: ExposureSettings, luminance: impl Fn(DVec3) -> f32) -> f64 {
        let frame = Frame::equirectangular(64).unwrap();
        let pixels: Vec<_> = (0..64 * 128)
            .map(|k| [luminance(frame.pixel_direction(k % 128, k / 128).unwrap()); 3])
            .collect();
        let picture = MeteredPicture::of_frame(&frame, &pixels, RgbSpace::Srgb, 0.0, 1000.0);
        settings.metered(&picture).unwrap().factor()
    }

    fn by(metering: MeteringMode) -> ExposureSettings {
        ExposureSettings {
            metering,
            ..Default::default()
        }
    }

    /// Space above the air has no influence.
    #[test]
    fn black_is_not_metered() {
        let auto = ExposureSettings::default();
        let ground = |d: DVec3, space: f32| if d.y < -0.2 { 3000.0 } else { space };
        let (black, dim) = (of(auto, |d| ground(d, 0.0)), of(auto, |d| ground(d, 0.1)));
        assert!((3000.0 * black - MIDDLE_GREY).abs() < 1e-4);
        assert_eq!(black, dim);
    }

    #[test]
    fn dusk_has_more_exposure_than_day_and_is_still_darker() {
        let auto = ExposureSettings::default();
        let (day, dusk) = (exposure(auto, 4000.0), exposure(auto, 4.0));
        assert!(dusk > day);
        assert!(4.0 * dusk < 0.6 * 4000.0 * day, "{day} {dusk}");
    }

    /// An even picture is middle grey, or just below white, in all modes that look at the picture alone.
    #[test]
    fn modes_meter_what_they_are_named_for() {
        use MeteringMode::{Average, CentreWeighted, HighlightWeighted, Incident, Spot};
        for mode in [Average, CentreWeighted, Spot] {
            let value = 50.0 * exposure(by(mode), 50.0);
            assert!((value - MIDDLE_GREY).abs() < 1e-6, "{mode}: {value}");
        }
        assert!((50.0 * exposure(by(HighlightWeighted), 50.0) - HIGHLIGHT).abs() < 1e-6);
        let grey_card = MIDDLE_GREY * 1000.0 / PI;
        assert!((grey_card * exposure(by(Incident), 50.0) - MIDDLE_GREY).abs() < 1e-9);
        // North, in the centre, ten times as bright: 7 % of all directions.
        let bright = |d: DVec3| if d.z < -0.86 { 1000.0 } else { 100.0 };
        let values = [Spot, CentreWeighted, Average].map(|mode| 1000.0 * of(by(mode), bright));
        assert!((values[0] - MIDDLE_GREY).abs() < 1e-6, "{values:?}");
        assert!(
            values[0] < 0.8 * values[1] && values[1] < 0.5 * values[2],
            "{values:?}"
        );
        let highlight = 1000.0 * of(by(HighlightWeighted), bright);
        assert!((highlight - HIGHLIGHT).abs() < 1e-6, "{highlight}");
    }

    /// Without a metered level there is the longest exposure.
    #[test]
    fn the_night_stays_dark() {
        let longest = Exposure::from_ev100(DARKEST_EV100).unwrap().factor();
        for &mode in airlight::Named::ALL {
            for luminance in [1e-7, 0.0, f32::NAN] {
                let exposure = of(by(mode), |_| luminance);
                assert!(exposure <= longest, "{mode}: {exposure}");
                if mode != MeteringMode::Incident {
                    assert_eq!(exposure, longest, "{mode} {luminance}");
                }
            }
        }
        assert!(1e-7 * longest < 0.01 * MIDDLE_GREY);
    }

    #[test]
    fn stops_are_factors_of_two_and_fixed_exposures_ignore_the_picture() {
        let with = |ev100, brighten_stops| ExposureSettings {
            ev100,
            brighten_stops,
            ..Default::default()
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
