//! Visibility and extinction: how far one sees in air that is the same everywhere.
//!
//! Along a horizontal line the contrast of a black object against the horizon falls as `e^(-extinction * distance)`
//! (Koschmieder 1924); visibility is the distance at which a stated contrast is left.

use crate::names::named;

/// Which contrast counts as the last that is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Contrast {
    /// 5 %: the meteorological optical range (WMO-No. 8, chapter 9), which instruments and weather reports state.
    #[default]
    FivePercent,
    /// 2 %: Koschmieder's visual range, which much of the literature on haze means.
    TwoPercent,
}

named! { Contrast, "a contrast", [
    ("five-percent", (FivePercent), "meteorological optical range"),
    ("two-percent", (TwoPercent), "Koschmieder's visual range"),
] }

impl Contrast {
    /// The contrast itself.
    pub fn value(self) -> f64 {
        match self {
            Self::FivePercent => 0.05,
            Self::TwoPercent => 0.02,
        }
    }

    /// Optical depth at which it is reached: 2.996 or 3.912.
    pub fn optical_depth(self) -> f64 {
        -self.value().ln()
    }
}

/// The extinction (1/m) at which one sees `visibility_m` far.
pub fn extinction_per_m(visibility_m: f64, contrast: Contrast) -> f64 {
    contrast.optical_depth() / visibility_m
}

/// How far one sees (m) at an extinction (1/m).
pub fn visibility_m(extinction_per_m: f64, contrast: Contrast) -> f64 {
    contrast.optical_depth() / extinction_per_m
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_at_the_visibility_is_the_contrast() {
        for contrast in [Contrast::FivePercent, Contrast::TwoPercent] {
            let extinction = extinction_per_m(150.0, contrast);
            assert!(((-extinction * 150.0).exp() / contrast.value() - 1.0).abs() < 1e-14);
            assert!((visibility_m(extinction, contrast) / 150.0 - 1.0).abs() < 1e-14);
        }
        assert!((Contrast::FivePercent.optical_depth() - 2.996).abs() < 5e-4);
        assert!((Contrast::TwoPercent.optical_depth() - 3.912).abs() < 5e-4);
    }
}
