//! A tone curve in the manner of a camera: contrast around middle grey, highlights that roll off to white, hue kept.
//!
//! # Derivation
//! **Curve.** `y = x^n / (x^n + q)`, the logistic function of `ln x` (the response of film and of the retina, Naka & Rushton 1966),
//! with `q = g^n (1/g - 1)`, so that middle grey `g = 0.18` is unchanged. Its slope there on logarithmic axes, the contrast, is
//! `n (1 - g)`. It has neither black nor white point: black stays 0, and white is approached.
//!
//! **Hue.** A curve of each component by itself turns bright orange yellow and bright blue cyan, because the middle component
//! catches up with the largest (`hue drift` in the tests: 13 to 28 degrees for a setting sun). With the largest and the smallest
//! component by the curve and the middle one at its old place between them, `c = lo + (hi - lo) (c - min) / (max - min)`, the
//! hue angle of the RGB hexagon stays, as in cameras' raw converters (the reference rendering of Adobe's DNG); but a colour that
//! is mixed with white at a constant hexagonal hue looks pinker (orange) or more violet (blue): Abney's effect. One fifth of the
//! first way and four fifths of the second keep the hue of Oklab within 3 degrees for light of the sky, up to 8 stops above
//! middle grey.
//!
//! **Shadows.** The contrast of the curve alone raises the chroma of dark colours by 42 % (3 stops below middle grey). In
//! the dark the components therefore keep their ratios, `hi / max`, of which the share falls as `(1 - hi)^3`.
//!
//! **Inset.** Before the curve each component moves by a small fraction towards the mean, so that pure hues go to white as well.

use super::blocks::{LUMINANCE, OctaveTable, Planes, into_unit_cube, max, min, mix};
use super::exposure::MIDDLE_GREY;
use crate::ImageError;

/// Share of the curve by components in the middle component.
const BY_COMPONENT: f32 = 0.2;

/// Fraction by which colours move towards white before the curve.
const INSET: f32 = 0.01;

/// Look of the camera curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraSettings {
    /// Slope of the curve at middle grey on logarithmic axes; 0.5 to 3. 1 is the contrast of the scene; more also saturates colours.
    pub contrast: f64,
    /// Factor on the distance from grey after the curve; 0 (grey) to 3.
    pub saturation: f64,
}

impl Default for CameraSettings {
    fn default() -> Self {
        Self {
            contrast: 1.2,
            saturation: 1.0,
        }
    }
}

/// The camera curve, tabulated.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Camera {
    saturation: f32,
    table: OctaveTable,
}

impl Camera {
    /// Checks the settings and tabulates the curve.
    pub(super) fn new(settings: CameraSettings) -> Result<Self, ImageError> {
        let CameraSettings {
            contrast,
            saturation,
        } = settings;
        ImageError::require(
            (0.5..=3.0).contains(&contrast),
            "the contrast of the tone curve",
            contrast,
            "0.5 to 3",
        )?;
        ImageError::require(
            (0.0..=3.0).contains(&saturation),
            "the saturation",
            saturation,
            "0 to 3",
        )?;
        let power = contrast / (1.0 - MIDDLE_GREY);
        let half = MIDDLE_GREY.powf(power) * (1.0 / MIDDLE_GREY - 1.0);
        let [black, white] = [-24.0, 24.0].map(|stops: f64| (MIDDLE_GREY * stops.exp2()) as f32);
        let response = |x: f64| match x > f64::from(black) {
            true => 1.0 / (1.0 + half * x.powf(-power)),
            false => 0.0,
        };
        Ok(Self {
            saturation: saturation as f32,
            table: OctaveTable::new(black, white, response),
        })
    }

    /// Converts exposed linear colours without negative components to display light in `[0, 1]`.
    #[inline(always)]
    pub(super) fn apply<const N: usize>(&self, planes: &mut Planes<N>) {
        mix(planes, LUMINANCE, 1.0 - INSET, INSET);
        let [r, g, b] = planes;
        for i in 0..N {
            let linear = [r[i], g[i], b[i]];
            let least = min(min(linear[0], linear[1]), linear[2]);
            let most = max(max(linear[0], linear[1]), linear[2]);
            let span = most - least;
            let hi = self.table.at(most);
            // Black has no ratios.
            let scale = if most > 0.0 { hi / most } else { 0.0 };
            let dark = (1.0 - hi) * (1.0 - hi) * (1.0 - hi);
            let curved = linear.map(|v| {
                let by_curve = self.table.at(v);
                by_curve + dark * (v * scale - by_curve)
            });
            let lo = min(min(curved[0], curved[1]), curved[2]);
            // Grey has no hue.
            let rise = if span > 0.0 { (hi - lo) / span } else { 0.0 };
            let place = |c: usize| {
                let kept = lo + rise * (linear[c] - least);
                kept + BY_COMPONENT * (curved[c] - kept)
            };
            (r[i], g[i], b[i]) = (place(0), place(1), place(2));
        }
        mix(planes, LUMINANCE, self.saturation, 1.0 - self.saturation);
        into_unit_cube(planes);
    }
}
