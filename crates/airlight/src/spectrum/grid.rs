//! The wavelengths that transport runs on, and what each of them weighs in colour.
//!
//! # Colour from few wavelengths
//! The radiance of a sunlit sky is `L(l) = r(l) S(l)`: r, radiance per unit solar irradiance, is smooth in wavelength;
//! the solar spectrum S, full of absorption lines, and the observer are not. So r alone is interpolated between the
//! nodes, `r(l) = sum_k r_k phi_k(l)`, and the rough factors are integrated once, at 0.5 nm:
//!
//! ```text
//! XYZ = sum_k r_k W_k,   W_k = 683 lm/W * integral S(l) cmf(l) phi_k(l) dl
//! ```
//!
//! `phi_k` are the cardinal functions of the natural cubic spline (straight lines with fewer than 5 nodes), constant
//! beyond the end nodes. A response that does not depend on wavelength therefore gives the sun's own XYZ on any grid.
//! Radiance at a node is `L_k = r_k E_k` with `E_k` the mean solar irradiance about the node
//! ([`WavelengthGrid::solar_irradiance`]), so its weight is `W_k / E_k`.
//!
//! # What it costs
//! CIEDE2000 against 1 nm, direct sunlight and a singly scattered sky through air, ozone (300 DU) and haze (0.1 at
//! 550 nm), measured by `spectrum::colour_cost`:
//!
//! | grid | sun at 60 deg | 10 deg | 2 deg |
//! |---|---|---|---|
//! | `standard` | 0.004, 0.002 | 0.016, 0.014 | 0.046, 0.040 |
//! | `fast` | 0.023, 0.016 | 0.065, 0.032 | 0.120, 0.116 |
//! | `fine` | 0.000, 0.000 | 0.000, 0.000 | 0.000, 0.001 |
//! | `rgb` | 1.5, 1.3 | 3.3, 7.3 | 9.7, 7.6 |
//!
//! (the direct sun first, then the sky). With ozone from 0 to 500 DU, haze from 0 to 0.3 and air masses from 1 to 19.5
//! the standard grid stays below 0.08.

use super::SpectralCurve;
use super::cie::{self, LUMINOUS_EFFICACY_LM_PER_W};
use super::solar;
use crate::math::spline::{local_means, product_weights};

/// Step of integrals over wavelength, nm: the finest step of the solar and observer tables.
const STEP_NM: f64 = 0.5;
/// Widest reach of the mean solar irradiance about a node, nm.
const WIDEST_MEAN_NM: f64 = 20.0;

/// Wavelengths in nm, strictly increasing, each with its solar irradiance and its weights in XYZ.
#[derive(Clone, Debug, PartialEq)]
pub struct WavelengthGrid {
    wavelengths_nm: Vec<f64>,
    solar_irradiance: Vec<f64>,
    xyz_weights: Vec<[f64; 3]>,
    smooth_xyz_weights: Vec<[f64; 3]>,
}

/// Why wavelengths do not make a grid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GridError {
    /// No wavelengths.
    #[error("a wavelength grid needs at least one wavelength")]
    Empty,
    /// A wavelength outside what the tables cover, or not a number.
    #[error("wavelength {index} is {nm} nm: it must lie between 300 nm and 900 nm")]
    OutOfRange {
        /// Which entry, counted from 0.
        index: usize,
        /// Its value, nm.
        nm: f64,
    },
    /// A wavelength not above the one before it.
    #[error(
        "wavelength {index} is {nm} nm after {previous} nm: list wavelengths in increasing order, at least 0.1 nm apart"
    )]
    Order {
        /// Which entry, counted from 0.
        index: usize,
        /// Its value, nm.
        nm: f64,
        /// The entry before it, nm.
        previous: f64,
    },
    /// Neither the name of a grid nor a list of wavelengths.
    #[error(
        "no wavelength grid is called '{name}': valid are rgb, fast, standard, fine, 1nm, or wavelengths in nm such as \
         450,550,650"
    )]
    UnknownName {
        /// What was asked for.
        name: String,
    },
}

/// Names that [`WavelengthGrid::by_name`] knows, besides lists of wavelengths.
pub const GRID_NAMES: [&str; 5] = ["rgb", "fast", "standard", "fine", "1nm"];

/// Shortest wavelength a grid may have, nm.
pub const SHORTEST_NM: f64 = 300.0;
/// Longest wavelength a grid may have, nm.
pub const LONGEST_NM: f64 = 900.0;
/// Least distance of neighbouring wavelengths, nm.
const CLOSEST_NM: f64 = 0.1;

// Found by scripts/choose_wavelengths.py: least CIEDE2000 against 1 nm over direct, singly scattered and twilight-like
// spectra with air masses 1 to 38, ozone 0 to 450 DU and haze 0.03 to 0.4 at 550 nm, penalising negative weights and
// crowded nodes; for the standard grid with 360, 765 and 830 nm held so that it spans the observer's range.
const FAST_NM: [f64; 8] = [413.0, 448.0, 483.0, 523.0, 563.0, 596.0, 632.0, 682.0];
const STANDARD_NM: [f64; 16] = [
    360.0, 398.0, 424.0, 446.0, 466.0, 485.0, 510.0, 539.0, 562.0, 595.0, 612.0, 637.0, 671.0,
    716.0, 765.0, 830.0,
];

impl WavelengthGrid {
    /// 440, 550 and 680 nm, the wavelengths of Bruneton's models: for real-time use. Its order is blue, green, red.
    ///
    /// Straight lines through 3 wavelengths follow no sunset: see the table of the module.
    pub fn rgb() -> Self {
        Self::build(vec![440.0, 550.0, 680.0])
    }

    /// 8 wavelengths from 413 nm to 682 nm: colour almost as good as the standard grid's in half the time.
    pub fn fast() -> Self {
        Self::build(FAST_NM.to_vec())
    }

    /// 16 wavelengths from 360 nm to 830 nm: the default.
    pub fn standard() -> Self {
        Self::build(STANDARD_NM.to_vec())
    }

    /// Every 5 nm from 360 nm to 830 nm: 95 wavelengths, for spectra to look at.
    pub fn fine() -> Self {
        Self::build((0..95).map(|i| 360.0 + 5.0 * i as f64).collect())
    }

    /// Every 1 nm from 360 nm to 830 nm: 471 wavelengths, the measure of the others.
    pub fn one_nanometre() -> Self {
        Self::build((360..=830).map(f64::from).collect())
    }

    /// A grid of the user's own wavelengths in nm: any number, strictly increasing, within 300 nm to 900 nm and at least
    /// 0.1 nm apart.
    ///
    /// Colour takes the response as constant beyond the ends, so good colour wants wavelengths from about 410 nm to
    /// 680 nm; those beyond 360 nm and 830 nm count only through the interpolation.
    ///
    /// # Errors
    /// [`GridError`] where there is no wavelength, one is out of range or not a number, or they do not increase.
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

    /// The grid of a name, one of [`GRID_NAMES`], or of a list of wavelengths in nm such as `450,550,650`.
    ///
    /// # Errors
    /// [`GridError::UnknownName`] (its text lists what is valid) where `name` is neither; as
    /// [`Self::from_wavelengths_nm`] for a list.
    pub fn by_name(name: &str) -> Result<Self, GridError> {
        match name.trim() {
            "rgb" => Ok(Self::rgb()),
            "fast" => Ok(Self::fast()),
            "standard" => Ok(Self::standard()),
            "fine" => Ok(Self::fine()),
            "1nm" => Ok(Self::one_nanometre()),
            list => list
                .split(',')
                .map(|field| field.trim().parse::<f64>())
                .collect::<Result<Vec<_>, _>>()
                .map_err(|_| GridError::UnknownName {
                    name: name.to_owned(),
                })
                .and_then(Self::from_wavelengths_nm),
        }
    }

    /// This grid under another sun: `solar` is the extraterrestrial irradiance, W m^-2 nm^-1 at 1 AU over nm, for
    /// [`Self::solar_irradiance`] and the colour weights.
    ///
    /// It is sampled every 0.5 nm. Negative values count as 0, and a node about which there is no light at all has no
    /// weight.
    pub fn with_solar(self, solar: &SpectralCurve) -> Self {
        Self::with_sun(self.wavelengths_nm, |nm| solar.at(nm).max(0.0))
    }

    fn build(nm: Vec<f64>) -> Self {
        Self::with_sun(nm, |nm| solar::extraterrestrial().at(nm))
    }

    fn with_sun(wavelengths_nm: Vec<f64>, sun: impl Fn(f64) -> f64) -> Self {
        let range = (cie::FIRST_NM, cie::LAST_NM);
        let observer = |nm| cie::color_matching(nm).map(|v| v * LUMINOUS_EFFICACY_LM_PER_W);
        let smooth_xyz_weights = product_weights(&wavelengths_nm, range, STEP_NM, observer);
        let solar_irradiance = local_means(&wavelengths_nm, WIDEST_MEAN_NM, &sun);
        let mut xyz_weights = product_weights(&wavelengths_nm, range, STEP_NM, |nm| {
            let e = sun(nm);
            observer(nm).map(|v| v * e)
        });
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

    /// The wavelengths, nm, strictly increasing.
    pub fn wavelengths_nm(&self) -> &[f64] {
        &self.wavelengths_nm
    }

    /// How many wavelengths.
    pub fn len(&self) -> usize {
        self.wavelengths_nm.len()
    }

    /// False: a grid has at least one wavelength.
    pub fn is_empty(&self) -> bool {
        self.wavelengths_nm.is_empty()
    }

    /// Extraterrestrial solar irradiance at 1 AU, W m^-2 nm^-1: the mean about each wavelength, weighted by a triangle
    /// that reaches half-way to the nearer neighbour, and no further than 20 nm.
    pub fn solar_irradiance(&self) -> &[f64] {
        &self.solar_irradiance
    }

    /// Weights that turn sunlit spectral radiance at the wavelengths, W m^-2 sr^-1 nm^-1, into CIE 1931 XYZ with Y in
    /// cd/m^2: `XYZ = sum_k xyz_weights[k] * L[k]`.
    ///
    /// They hold for light whose ratio to the sun's is smooth; for other light see [`Self::smooth_xyz_weights`].
    pub fn xyz_weights(&self) -> &[[f64; 3]] {
        &self.xyz_weights
    }

    /// As [`Self::xyz_weights`], for light that is itself smooth in wavelength: incandescent lamps, thermal emission.
    pub fn smooth_xyz_weights(&self) -> &[[f64; 3]] {
        &self.smooth_xyz_weights
    }

    /// CIE 1931 XYZ, Y in cd/m^2, of sunlit spectral radiance at the wavelengths, W m^-2 sr^-1 nm^-1 (of irradiance,
    /// W m^-2 nm^-1: Y in lx).
    ///
    /// # Panics
    /// Where there is not one value for each wavelength.
    pub fn to_xyz(&self, spectral: &[f32]) -> [f64; 3] {
        assert_eq!(spectral.len(), self.len(), "one value for each wavelength");
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

    fn flat(grid: &WavelengthGrid) -> [f64; 3] {
        let sun: Vec<f32> = grid.solar_irradiance().iter().map(|&e| e as f32).collect();
        grid.to_xyz(&sun)
    }

    #[test]
    fn a_flat_response_gives_the_suns_own_xyz_on_every_grid() {
        // The plain 1 nm sum over ASTM G173 by colour-science 0.4.7: 133.1 klx outside the air.
        let want = [129_387.4, 133_100.8, 137_621.5];
        let lists = [
            "440",
            "450,650",
            "300,320,600,900",
            "500,510,520,530,540,900",
        ];
        for name in GRID_NAMES.into_iter().chain(lists) {
            let got = flat(&WavelengthGrid::by_name(name).unwrap());
            for i in 0..3 {
                assert!((got[i] / want[i] - 1.0).abs() < 1e-5, "{name}: {got:?}");
            }
        }
    }

    #[test]
    fn counts_are_what_the_solver_is_built_for() {
        let sizes = GRID_NAMES.map(|name| WavelengthGrid::by_name(name).unwrap().len());
        assert_eq!(sizes, [3, 8, 16, 95, 471]);
        assert_eq!(WavelengthGrid::default(), WavelengthGrid::standard());
        let standard = WavelengthGrid::standard();
        assert_eq!(standard.wavelengths_nm()[0], 360.0);
        assert_eq!(standard.wavelengths_nm()[15], 830.0);
        assert!(!standard.is_empty());
    }

    #[test]
    fn one_nanometre_is_the_plain_sum() {
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
            let grid = WavelengthGrid::by_name(name).unwrap();
            assert!(grid.xyz_weights().iter().flatten().all(|&w| w > 0.0));
        }
        // The spline of the larger grids may dip below 0, by little.
        for name in ["fast", "standard"] {
            let grid = WavelengthGrid::by_name(name).unwrap();
            for (w, e) in grid.xyz_weights().iter().zip(grid.solar_irradiance()) {
                for (w, total) in w.iter().zip(flat(&grid)) {
                    assert!(w * e > -0.01 * total, "{name} {w}");
                }
            }
        }
    }

    #[test]
    fn another_sun_changes_irradiance_and_leaves_the_response_to_it() {
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
    fn bad_grids_are_refused_with_advice() {
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
        let text = WavelengthGrid::by_name("650,550").unwrap_err().to_string();
        assert!(text.contains("increasing"), "{text}");
        for name in ["best", "", "450,,550", "450;550"] {
            let text = WavelengthGrid::by_name(name).unwrap_err().to_string();
            assert!(
                GRID_NAMES.iter().all(|known| text.contains(known)),
                "{text}"
            );
        }
        assert_eq!(WavelengthGrid::by_name(" 450, 550 ,650").unwrap().len(), 3);
    }
}
