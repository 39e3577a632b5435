//! Wavelength grids and their conversion to CIE XYZ.
//!
//! # Colour from few wavelengths
//! The radiance of a sunlit sky is `L(l) = r(l) S(l)`: r, the radiance per unit solar irradiance, is smooth in wavelength,
//! whereas the solar spectrum S, full of absorption lines, and the observer are not. So r alone is interpolated between
//! the nodes, `r(l) = sum_k r_k phi_k(l)`, and the other factors are integrated once, at 0.5 nm:
//!
//! ```text
//! XYZ = sum_k r_k W_k,   W_k = 683 lm/W * integral S(l) cmf(l) phi_k(l) dl
//! ```
//!
//! `phi_k` are the cardinal functions of the natural cubic spline (linear interpolation with fewer than 5 nodes), constant
//! beyond the end nodes; those of `fast` follow the [bands of ozone](super::interpolant). A response that does not depend on
//! wavelength therefore gives the sun's own XYZ on any grid.
//! The radiance at a node is `L_k = r_k E_k`, with `E_k` the mean solar irradiance about the node
//! ([`WavelengthGrid::solar_irradiance`]), so its weight is `W_k / E_k`.
//!
//! # Colour error
//! CIEDE2000 against 1 nm for direct sunlight and a singly scattered sky through air, ozone (300 DU) and haze (0.1 at
//! 550 nm), measured by `spectrum::colour_cost`; the direct sun first, then the sky:
//!
//! | grid | sun at 60 deg | 10 deg | 2 deg |
//! |---|---|---|---|
//! | `standard` | 0.004, 0.002 | 0.016, 0.014 | 0.046, 0.040 |
//! | `fast` | 0.014, 0.017 | 0.038, 0.018 | 0.042, 0.067 |
//! | `fine` | 0.000, 0.000 | 0.000, 0.000 | 0.000, 0.001 |
//! | `rgb` | 1.5, 1.3 | 3.3, 7.3 | 9.7, 7.6 |
//!
//! For ozone from 0 to 500 DU, haze from 0 to 0.3 and air masses from 1 to 19.5 the standard grid stays below 0.08.

use super::cie::{self, LUMINOUS_EFFICACY_LM_PER_W};
use super::rgb::{self, RgbSpace};
use super::{SpectralCurve, interpolant, solar};
use crate::math::spline::{local_means, product_weights};
use crate::names::{UnknownName, named};
use std::str::FromStr;

/// Step of integrals over wavelength, nm: the finest step of the solar and observer tables.
const STEP_NM: f64 = 0.5;
/// Widest reach of the mean solar irradiance about a node, nm.
const WIDEST_MEAN_NM: f64 = 20.0;

/// Strictly increasing wavelengths in nm, with the solar irradiance and the XYZ weights of each.
#[derive(Clone, Debug, PartialEq)]
pub struct WavelengthGrid {
    wavelengths_nm: Vec<f64>,
    solar_irradiance: Vec<f64>,
    xyz_weights: Vec<[f64; 3]>,
    smooth_xyz_weights: Vec<[f64; 3]>,
}

/// Error of [`WavelengthGrid::from_wavelengths_nm`] and of reading a grid from text.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// No wavelengths.
    #[error("expected at least one wavelength, got none")]
    Empty,
    /// A wavelength outside the range of the tables, or not a number.
    #[error("expected wavelengths from 300 nm to 900 nm, got {nm} nm at index {index}")]
    OutOfRange {
        /// Index of the wavelength, from 0.
        index: usize,
        /// The wavelength, nm.
        nm: f64,
    },
    /// A wavelength less than 0.1 nm above its predecessor.
    #[error(
        "expected wavelengths in increasing order, at least 0.1 nm apart; got {nm} nm after {previous} nm at index {index}"
    )]
    Order {
        /// Index of the wavelength, from 0.
        index: usize,
        /// The wavelength, nm.
        nm: f64,
        /// The preceding wavelength, nm.
        previous: f64,
    },
    /// A text that is neither the name of a grid nor a list of wavelengths.
    #[error("{0}; or list wavelengths in nm, such as \"450,550,650\"")]
    UnknownName(UnknownName),
}

/// A named wavelength grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum GridPreset {
    /// 440, 550 and 680 nm.
    Rgb,
    /// 8 wavelengths from 423 nm to 683 nm.
    Fast,
    /// 16 wavelengths from 360 nm to 830 nm.
    #[default]
    Standard,
    /// Every 5 nm from 360 nm to 830 nm.
    Fine,
    /// Every 1 nm from 360 nm to 830 nm.
    OneNanometre,
}

named! { GridPreset, "a wavelength grid", [
    ("rgb", (Rgb), "3 wavelengths: 440, 550 and 680 nm"),
    ("fast", (Fast), "8 wavelengths from 423 to 683 nm"),
    ("standard", (Standard), "16 wavelengths from 360 to 830 nm"),
    ("fine", (Fine), "every 5 nm from 360 to 830 nm"),
    ("1nm", (OneNanometre), "every 1 nm from 360 to 830 nm"),
] }

impl From<GridPreset> for WavelengthGrid {
    fn from(preset: GridPreset) -> Self {
        match preset {
            GridPreset::Rgb => Self::rgb(),
            GridPreset::Fast => Self::fast(),
            GridPreset::Standard => Self::standard(),
            GridPreset::Fine => Self::fine(),
            GridPreset::OneNanometre => Self::one_nanometre(),
        }
    }
}

impl FromStr for WavelengthGrid {
    type Err = GridError;

    /// The grid of a name ([`GridPreset`]) or of a list of wavelengths in nm such as `450,550,650`.
    fn from_str(text: &str) -> Result<Self, GridError> {
        let text = text.trim();
        let list: Result<Vec<f64>, _> = text.split(',').map(|nm| nm.trim().parse()).collect();
        match (text.parse::<GridPreset>(), list) {
            (Ok(preset), _) => Ok(preset.into()),
            (_, Ok(list)) => Self::from_wavelengths_nm(list),
            (Err(unknown), _) => Err(GridError::UnknownName(unknown)),
        }
    }
}

/// Shortest wavelength a grid may have, nm.
pub const SHORTEST_NM: f64 = 300.0;
/// Longest wavelength a grid may have, nm.
pub const LONGEST_NM: f64 = 900.0;
/// Smallest distance between neighbouring wavelengths, nm.
const CLOSEST_NM: f64 = 0.1;

// Found by scripts/choose_wavelengths.py, as are the nodes of the interpolant. It minimises the CIEDE2000 difference to 1 nm
// over direct, singly scattered and twilight-like spectra with air masses 1 to 38, ozone 0 to 450 DU and haze 0.03 to 0.4
// at 550 nm, and penalises negative weights and crowded nodes. The nodes 360, 765 and 830 nm are fixed, so that the grid
// spans the observer's range.
const STANDARD_NM: [f64; 16] = [
    360.0, 398.0, 424.0, 446.0, 466.0, 485.0, 510.0, 539.0, 562.0, 595.0, 612.0, 637.0, 671.0,
    716.0, 765.0, 830.0,
];

impl WavelengthGrid {
    /// 440, 550 and 680 nm, the wavelengths of Bruneton's models, for real-time use. In order of wavelength: blue, green, red.
    ///
    /// Linear interpolation through 3 wavelengths does not reproduce a sunset: see the table of the module.
    pub fn rgb() -> Self {
        Self::build(vec![440.0, 550.0, 680.0])
    }

    /// 8 wavelengths from 423 nm to 683 nm, the default for pictures: the colours of the standard grid in two thirds of the time.
    pub fn fast() -> Self {
        Self::build(interpolant::NODES_NM.to_vec())
    }

    /// 16 wavelengths from 360 nm to 830 nm, the default for spectra.
    pub fn standard() -> Self {
        Self::build(STANDARD_NM.to_vec())
    }

    /// Every 5 nm from 360 nm to 830 nm: 95 wavelengths, for plots of spectra.
    pub fn fine() -> Self {
        Self::build((0..95).map(|i| 360.0 + 5.0 * i as f64).collect())
    }

    /// Every 1 nm from 360 nm to 830 nm: 471 wavelengths, the reference for the other grids.
    pub fn one_nanometre() -> Self {
        Self::build((360..=830).map(f64::from).collect())
    }

    /// A grid of arbitrary wavelengths in nm: any number, strictly increasing, from 300 nm to 900 nm, at least 0.1 nm apart.
    ///
    /// For colour the response is taken as constant beyond the ends, so accurate colour needs wavelengths from about 410 nm
    /// to 680 nm; wavelengths outside 360 nm to 830 nm contribute to colour only through the interpolation.
    ///
    /// # Errors
    /// [`GridError`] if the list is empty, a wavelength is out of range or not a number, or the order is not increasing.
    pub fn from_wavelengths_nm(nm: Vec<f64>) -> Result<Self, GridError> {
        if nm.is_empty() {
            return Err(GridError::Empty);
        }
        for (index, &value) in nm.iter().enumerate() {
            if !(SHORTEST_NM..=LONGEST_NM).contains(&value) {
                return Err(GridError::OutOfRange { index, nm: value });
            }
            if index > 0 && value - nm[index - 1] < CLOSEST_NM * (1.0 - 1e-9) {
                return Err(GridError::Order {
                    index,
                    nm: value,
                    previous: nm[index - 1],
                });
            }
        }
        Ok(Self::build(nm))
    }

    /// This grid with another solar spectrum: `solar` is the extraterrestrial irradiance at 1 AU, W m^-2 nm^-1 by wavelength
    /// in nm, used by [`Self::solar_irradiance`] and the XYZ weights.
    ///
    /// It is sampled every 0.5 nm. Negative values count as 0; a node with no irradiance about it has weight 0.
    pub fn with_solar(self, solar: &SpectralCurve) -> Self {
        Self::with_sun(self.wavelengths_nm, |nm| solar.at(nm).max(0.0))
    }

    /// This grid under `factor` times the solar irradiance: that of a sun at another distance, for
    /// [`SunState::irradiance_factor`](crate::sun::SunState::irradiance_factor).
    pub fn with_solar_factor(&self, factor: f64) -> Self {
        let mut grid = self.clone();
        grid.solar_irradiance.iter_mut().for_each(|e| *e *= factor);
        grid
    }

    /// Weights that convert sunlit spectral radiance at the wavelengths, W m^-2 sr^-1 nm^-1, to linear red, green and blue of
    /// an RGB space, cd/m^2.
    pub fn rgb_weights(&self, space: RgbSpace) -> Vec<[f32; 3]> {
        let from_xyz = space.from_xyz_matrix();
        let weights = self.xyz_weights.iter();
        weights
            .map(|&weights| rgb::apply(&from_xyz, weights).map(|v| v as f32))
            .collect()
    }

    fn build(nm: Vec<f64>) -> Self {
        Self::with_sun(nm, |nm| solar::extraterrestrial().at(nm))
    }

    fn with_sun(wavelengths_nm: Vec<f64>, sun: impl Fn(f64) -> f64) -> Self {
        let range = (cie::FIRST_NM, cie::LAST_NM);
        let observer = |nm| cie::color_matching(nm).map(|v| v * LUMINOUS_EFFICACY_LM_PER_W);
        let smooth_xyz_weights = product_weights(&wavelengths_nm, range, STEP_NM, observer);
        let solar_irradiance = local_means(&wavelengths_nm, WIDEST_MEAN_NM, &sun);
        let sunlit = |nm| {
            let e = sun(nm);
            observer(nm).map(|v| v * e)
        };
        let mut xyz_weights = match wavelengths_nm == interpolant::NODES_NM {
            true => interpolant::product_weights(STEP_NM, sunlit),
            false => product_weights(&wavelengths_nm, range, STEP_NM, sunlit),
        };
        for (weight, &e) in xyz_weights.iter_mut().zip(&solar_irradiance) {
            *weight = weight.map(|w| if e > 0.0 { w / e } else { 0.0 });
        }
        Self {
            wavelengths_nm,
            solar_irradiance,
            xyz_weights,
            smooth_xyz_weights,
        }
    }

    /// Wavelengths in nm, strictly increasing.
    pub fn wavelengths_nm(&self) -> &[f64] {
        &self.wavelengths_nm
    }

    /// Number of wavelengths.
    pub fn len(&self) -> usize {
        self.wavelengths_nm.len()
    }

    /// Always false: a grid has at least one wavelength.
    pub fn is_empty(&self) -> bool {
        self.wavelengths_nm.is_empty()
    }

    /// Extraterrestrial solar irradiance at 1 AU, W m^-2 nm^-1: the mean about each wavelength, weighted by a triangle that
    /// extends half-way to the nearer neighbour, at most 20 nm.
    pub fn solar_irradiance(&self) -> &[f64] {
        &self.solar_irradiance
    }

    /// Weights that convert sunlit spectral radiance at the wavelengths, W m^-2 sr^-1 nm^-1, to CIE 1931 XYZ with Y in
    /// cd/m^2: `XYZ = sum_k xyz_weights[k] * L[k]`.
    ///
    /// Valid for light whose ratio to sunlight is smooth in wavelength; for other light see [`Self::smooth_xyz_weights`].
    pub fn xyz_weights(&self) -> &[[f64; 3]] {
        &self.xyz_weights
    }

    /// As [`Self::xyz_weights`], for light that is itself smooth in wavelength: incandescent lights, thermal emission.
    pub fn smooth_xyz_weights(&self) -> &[[f64; 3]] {
        &self.smooth_xyz_weights
    }

    /// CIE 1931 XYZ of sunlit spectral radiance at the wavelengths: Y in cd/m^2 for radiance in W m^-2 sr^-1 nm^-1, in lx for
    /// irradiance in W m^-2 nm^-1.
    ///
    /// # Panics
    /// If the number of values differs from the number of wavelengths.
    pub fn to_xyz(&self, spectral: &[f32]) -> [f64; 3] {
        assert_eq!(
            spectral.len(),
            self.len(),
            "expected one value for each wavelength"
        );
        let mut xyz = [0.0; 3];
        for (weight, &value) in self.xyz_weights.iter().zip(spectral) {
            for (sum, w) in xyz.iter_mut().zip(weight) {
                *sum += w * f64::from(value);
            }
        }
        xyz
    }
}

impl Default for WavelengthGrid {
    /// [`WavelengthGrid::standard`].
    fn default() -> Self {
        Self::standard()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::names::Named;

    fn flat(grid: &WavelengthGrid) -> [f64; 3] {
        let sun: Vec<f32> = grid.solar_irradiance().iter().map(|&e| e as f32).collect();
        grid.to_xyz(&sun)
    }

    #[test]
    fn constant_response_gives_the_xyz_of_the_sun_on_every_grid() {
        // The plain 1 nm sum over ASTM G173 by colour-science 0.4.7: 133.1 klx outside the atmosphere.
        let want = [129_387.4, 133_100.8, 137_621.5];
        let lists = [
            "440",
            "450,650",
            "300,320,600,900",
            "500,510,520,530,540,900",
        ];
        for name in GridPreset::ALL
            .iter()
            .map(|preset| preset.name())
            .chain(lists)
        {
            let got = flat(&name.parse::<WavelengthGrid>().unwrap());
            for i in 0..3 {
                assert!((got[i] / want[i] - 1.0).abs() < 1e-5, "{name}: {got:?}");
            }
        }
    }

    #[test]
    fn named_grids_have_the_documented_sizes() {
        let size = |&preset: &GridPreset| WavelengthGrid::from(preset).len();
        let sizes: Vec<usize> = GridPreset::ALL.iter().map(size).collect();
        assert_eq!(sizes, [3, 8, 16, 95, 471]);
        assert_eq!(WavelengthGrid::default(), WavelengthGrid::standard());
        let standard = WavelengthGrid::standard();
        assert_eq!(standard.wavelengths_nm()[0], 360.0);
        assert_eq!(standard.wavelengths_nm()[15], 830.0);
        assert!(!standard.is_empty());
    }

    #[test]
    fn one_nanometre_grid_matches_the_plain_sum() {
        let grid = WavelengthGrid::one_nanometre();
        let response = |nm: f64| (-(nm - 450.0).powi(2) / 9000.0).exp();
        let spectral: Vec<f32> = (0..grid.len())
            .map(|k| (grid.solar_irradiance()[k] * response(grid.wavelengths_nm()[k])) as f32)
            .collect();
        let mut sum = [0.0; 3];
        for nm in 360..=830 {
            let nm = nm as f64;
            let l = solar::extraterrestrial().at(nm) * response(nm) * LUMINOUS_EFFICACY_LM_PER_W;
            for (s, c) in sum.iter_mut().zip(cie::color_matching(nm)) {
                *s += l * c;
            }
        }
        for (got, want) in grid.to_xyz(&spectral).iter().zip(sum) {
            assert!((got / want - 1.0).abs() < 2e-5, "{got} against {want}");
        }
    }

    #[test]
    fn few_wavelengths_have_positive_weights() {
        for name in ["rgb", "450,550,650", "400,500,600,700", "550"] {
            let grid = name.parse::<WavelengthGrid>().unwrap();
            assert!(grid.xyz_weights().iter().flatten().all(|&w| w > 0.0));
        }
        // The spline of the larger grids may dip slightly below 0.
        for name in ["fast", "standard"] {
            let grid = name.parse::<WavelengthGrid>().unwrap();
            for (w, e) in grid.xyz_weights().iter().zip(grid.solar_irradiance()) {
                for (w, total) in w.iter().zip(flat(&grid)) {
                    assert!(w * e > -0.01 * total, "{name} {w}");
                }
            }
        }
    }

    #[test]
    fn another_solar_spectrum_changes_irradiance_and_weights() {
        let grid = WavelengthGrid::standard().with_solar(&SpectralCurve::Constant(2.0));
        assert!(
            grid.solar_irradiance()
                .iter()
                .all(|e| (e - 2.0).abs() < 1e-12)
        );
        for (w, smooth) in grid.xyz_weights().iter().zip(grid.smooth_xyz_weights()) {
            for i in 0..3 {
                assert!((w[i] - smooth[i]).abs() < 1e-9);
            }
        }
        let xyz = flat(&grid);
        assert!((xyz[1] / (2.0 * 683.002 * 106.856_9) - 1.0).abs() < 1e-5);
        let dark = WavelengthGrid::rgb().with_solar(&SpectralCurve::Constant(0.0));
        assert_eq!(flat(&dark), [0.0; 3]);
        assert!(dark.xyz_weights().iter().flatten().all(|w| w.is_finite()));
    }

    #[test]
    fn invalid_grids_are_refused_with_advice() {
        use GridError::*;
        let make = WavelengthGrid::from_wavelengths_nm;
        assert_eq!(make(vec![]), Err(Empty));
        assert!(matches!(
            make(vec![299.0]),
            Err(OutOfRange { index: 0, .. })
        ));
        assert!(matches!(make(vec![f64::NAN]), Err(OutOfRange { .. })));
        assert!(matches!(
            make(vec![400.0, 400.0]),
            Err(Order { index: 1, .. })
        ));
        let text = "650,550".parse::<WavelengthGrid>().unwrap_err().to_string();
        assert!(text.contains("increasing"), "{text}");
        for name in ["best", "", "450,,550", "450;550"] {
            let text = name.parse::<WavelengthGrid>().unwrap_err().to_string();
            assert!(
                GridPreset::ALL
                    .iter()
                    .all(|known| text.contains(known.name())),
                "{text}"
            );
        }
        assert_eq!(" 450, 550 ,650".parse::<WavelengthGrid>().unwrap().len(), 3);
    }
}
