//! A tone curve in the manner of AgX: inset colours towards white, map the logarithm of each component by a sigmoid, and
//! outset them again.
//!
//! # Derivation
//! **Curve.** With `x = log2(v / 0.18)` in stops, taken linearly from `[-black_stops, white_stops]` to `[0, 1]`, the
//! display signal is a sigmoid through three points: `(0, 0)`, the pivot `(x_p, y_p)` of middle grey, and
//! `(1, 1)`, with slope `m` at the pivot. Display light is the power 2.4 of the signal, and middle grey is unchanged:
//! `y_p = 0.18^(1/2.4)`. On either side of the pivot, with `u = m |x - x_p|`, the generalised sigmoid
//! `u / (1 + (u/a)^p)^(1/p)` starts with slope `m`, bends and never exceeds `a`; the condition that it cover exactly the
//! height `h` (to 0 or 1) over the width `w` gives `a = m w / ((m w / h)^p - 1)^(1/p)`, which needs `m w > h`.
//!
//! **Inset.** `c' = (1 - s) c + s (w . c)`: each component moves by the fraction `s` towards a weighted mean. Bright
//! saturated light thus reaches all three components and goes to white, as on film, instead of clipping to a pure
//! hue. The published AgX matrix (T. Sobotka, 2022) is of this form with `s = 0.2` and weights
//! (0.2120, 0.3922, 0.3958). After the curve the exact inverse, `c = (c' - s (w . c')) / (1 - s)` as the weights sum to
//! 1, restores the saturation where the curve is straight.

use super::blocks::{OctaveTable, Planes, into_unit_cube, mix};
use super::exposure::MIDDLE_GREY;
use crate::ImageError;

/// Weights of the mean of the inset.
const INSET_WEIGHTS: [f32; 3] = [0.212, 0.3922, 0.3958];

/// Exponent from the signal of the curve to display light.
const SIGNAL_POWER: f64 = 2.4;

/// Shape of the curve. The default is the base look of AgX.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgxSettings {
    /// Stops from middle grey down to black; 1 to 30.
    pub black_stops: f64,
    /// Stops from middle grey up to white; 1 to 30.
    pub white_stops: f64,
    /// Slope of the curve at middle grey: signal (0 to 1) over the range of stops (0 to 1). 2.4 hardly changes colours
    /// near middle grey; more gives more contrast.
    pub slope: f64,
    /// Sharpness of the toe, the bend to black; above 0, at most 10.
    pub toe_power: f64,
    /// Sharpness of the shoulder, the bend to white; above 0, at most 10.
    pub shoulder_power: f64,
    /// Fraction by which colours move towards white before the curve: 0 to below 0.9.
    pub inset: f64,
}

impl Default for AgxSettings {
    fn default() -> Self {
        Self {
            black_stops: 10.0,
            white_stops: 6.5,
            slope: 2.4,
            toe_power: 1.5,
            shoulder_power: 1.5,
            inset: 0.2,
        }
    }
}

/// The curve of AgX, tabulated.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Agx {
    inset: f32,
    outset_scale: f32,
    table: OctaveTable,
}

impl Agx {
    /// Checks the settings and tabulates the curve.
    pub(super) fn new(settings: AgxSettings) -> Result<Self, ImageError> {
        let s = settings;
        let stops = |n: f64| (1.0..=30.0).contains(&n);
        let power = |n: f64| n > 0.0 && n <= 10.0;
        ImageError::require(
            stops(s.black_stops),
            "the stops below middle grey",
            s.black_stops,
            "1 to 30",
        )?;
        ImageError::require(
            stops(s.white_stops),
            "the stops above middle grey",
            s.white_stops,
            "1 to 30",
        )?;
        ImageError::require(
            power(s.toe_power),
            "the toe power",
            s.toe_power,
            "above 0 and at most 10",
        )?;
        ImageError::require(
            power(s.shoulder_power),
            "the shoulder power",
            s.shoulder_power,
            "above 0 and at most 10",
        )?;
        ImageError::require(
            (0.0..0.9).contains(&s.inset),
            "the inset",
            s.inset,
            "0 to below 0.9",
        )?;
        let pivot = s.pivot();
        let min_slope = (pivot.1 / pivot.0).max((1.0 - pivot.1) / (1.0 - pivot.0));
        ImageError::require(
            s.slope > min_slope * 1.001 && s.slope <= 20.0,
            "the slope of the tone curve",
            s.slope,
            "steeper than the lines from middle grey to black and to white, and at most 20",
        )?;
        let lowest = MIDDLE_GREY * (-s.black_stops).exp2();
        let highest = MIDDLE_GREY * s.white_stops.exp2();
        Ok(Self {
            inset: s.inset as f32,
            outset_scale: (1.0 / (1.0 - s.inset)) as f32,
            table: OctaveTable::new(lowest as f32, highest as f32, |v| s.display_light(v)),
        })
    }

    /// Converts exposed linear colours without negative components to display light in `[0, 1]`.
    #[inline(always)]
    pub(super) fn apply<const N: usize>(&self, planes: &mut Planes<N>) {
        mix(planes, INSET_WEIGHTS, 1.0 - self.inset, self.inset);
        for v in planes.as_flattened_mut() {
            *v = self.table.at(*v);
        }
        let share = -self.inset * self.outset_scale;
        mix(planes, INSET_WEIGHTS, self.outset_scale, share);
        into_unit_cube(planes);
    }
}

impl AgxSettings {
    /// Middle grey on the curve.
    fn pivot(&self) -> (f64, f64) {
        (
            self.black_stops / (self.black_stops + self.white_stops),
            MIDDLE_GREY.powf(1.0 / SIGNAL_POWER),
        )
    }

    /// Display light of a linear value.
    fn display_light(&self, v: f64) -> f64 {
        let stops = (v / MIDDLE_GREY).log2();
        let x = (stops + self.black_stops) / (self.black_stops + self.white_stops);
        if x <= 0.0 || x >= 1.0 {
            return x.clamp(0.0, 1.0);
        }
        let pivot = self.pivot();
        let bend = |width: f64, height: f64, power: f64, distance: f64| {
            let reach = self.slope * width;
            let limit = reach / ((reach / height).powf(power) - 1.0).powf(1.0 / power);
            let u = self.slope * distance;
            u / (1.0 + (u / limit).powf(power)).powf(1.0 / power)
        };
        let signal = if x < pivot.0 {
            pivot.1 - bend(pivot.0, pivot.1, self.toe_power, pivot.0 - x)
        } else {
            pivot.1
                + bend(
                    1.0 - pivot.0,
                    1.0 - pivot.1,
                    self.shoulder_power,
                    x - pivot.0,
                )
        };
        signal.clamp(0.0, 1.0).powf(SIGNAL_POWER)
    }
}
