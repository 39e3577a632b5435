//! Visibility and extinction in homogeneous air.
//!
//! The contrast of a black object against the horizon falls with distance as `e^(-extinction * distance)` (Koschmieder
//! 1924). Visibility is the distance at which it reaches a threshold.

use crate::names::named;

/// Contrast threshold that defines visibility.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Contrast {
    /// 5 %: the meteorological optical range (WMO-No. 8, chapter 9), used by instruments and weather reports.
    #[default]
    FivePercent,
    /// 2 %: Koschmieder's visual range, used in much of the literature on haze.
    TwoPercent,
}

named! { Contrast, "a contrast", [
    ("five-percent", (FivePercent), "meteorological optical range"),
    ("two-percent", (TwoPercent), "Koschmieder's visual range"),
] }

impl Contrast {
    /// The threshold.
    pub fn value(self) -> f64 {
        match self {
            Self::FivePercent => 0.05,
            Self::TwoPercent => 0.02,
        }
    }

    /// Optical depth at which the threshold is reached: 2.996 or 3.912.
    pub fn optical_depth(self) -> f64 {
        -self.value().ln()
    }
}

/// Extinction coefficient (1/m) of air with this visibility, m.
pub fn extinction_per_m(visibility_m: f64, contrast: Contrast) -> f64 {
    contrast.optical_depth() / visibility_m
}

/// Visibility (m) of air with this extinction coefficient, 1/m.
pub fn visibility_m(extinction_per_m: f64, contrast: Contrast) -> f64 {
    contrast.optical_depth() / extinction_per_m
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transmittance_at_the_visibility_is_the_threshold() {
        for contrast in [Contrast::FivePercent, Contrast::TwoPercent] {
            let extinction = extinction_per_m(150.0, contrast);
            assert!(((-extinction * 150.0).exp() / contrast.value() - 1.0).abs() < 1e-14);
            assert!((visibility_m(extinction, contrast) / 150.0 - 1.0).abs() < 1e-14);
        }
        assert!((Contrast::FivePercent.optical_depth() - 2.996).abs() < 5e-4);
        assert!((Contrast::TwoPercent.optical_depth() - 3.912).abs() < 5e-4);
    }
}
