//! Linear RGB spaces and the sRGB transfer function.
//!
//! A space is defined by the chromaticities of its primaries and its white; the matrices follow (SMPTE RP 177-1993). RGB (1, 1, 1)
//! has Y = 1: an XYZ in cd/m^2 gives an RGB whose luminance is in cd/m^2.
//!
//! XYZ is relative to D65, the white of sRGB and BT.2020, whose conversion is therefore colorimetric. ACEScg has a white near D60: as
//! in OpenColorIO and all programs that use it, D65 is adapted to it by Bradford's transform ([`adaptation_matrix`]), so that light
//! that is neutral in sRGB is neutral in ACEScg. [`RgbSpace::AcesCgUnadapted`] keeps the XYZ instead.

use crate::names::named;

/// A 3 by 3 matrix, row-major.
pub type Matrix3 = [[f64; 3]; 3];

/// Wavelengths in nm that represent red, green and blue where a model is evaluated at three wavelengths: the dominant
/// wavelengths of the sRGB primaries.
pub(crate) const DOMINANT_NM: [f64; 3] = [612.0, 549.0, 465.0];

/// A linear RGB colour space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum RgbSpace {
    /// IEC 61966-2-1 primaries (those of BT.709), white D65.
    #[default]
    Srgb,
    /// ITU-R BT.2020 primaries, white D65.
    Rec2020,
    /// ACEScg: Academy S-2014-004 (AP1 primaries), to whose white near D60 D65 is adapted.
    AcesCg,
    /// The primaries and the white of ACEScg without adaptation: light keeps its XYZ, and D65 is bluish.
    AcesCgUnadapted,
}

named! { RgbSpace, "an RGB space", [
    ("srgb", (Srgb), "linear sRGB: BT.709 primaries, white D65"),
    ("rec2020", (Rec2020), "BT.2020 primaries, white D65"),
    ("acescg", (AcesCg), "ACEScg: AP1 primaries, D65 adapted to the white near D60"),
    ("acescg-unadapted", (AcesCgUnadapted), "ACEScg's primaries and white without adaptation: light keeps its XYZ"),
] }

/// White to which XYZ is relative: D65.
const XYZ_WHITE_XY: [f64; 2] = [0.3127, 0.3290];

impl RgbSpace {
    /// Chromaticities (x, y) of the red, green and blue primaries.
    pub fn primaries_xy(self) -> [[f64; 2]; 3] {
        match self {
            Self::Srgb => [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]],
            Self::Rec2020 => [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]],
            Self::AcesCg | Self::AcesCgUnadapted => {
                [[0.713, 0.293], [0.165, 0.830], [0.128, 0.044]]
            }
        }
    }

    /// Chromaticity (x, y) of the white point.
    pub fn white_point_xy(self) -> [f64; 2] {
        match self {
            Self::Srgb | Self::Rec2020 => XYZ_WHITE_XY,
            Self::AcesCg | Self::AcesCgUnadapted => [0.32168, 0.33767],
        }
    }

    /// Chromaticity (x, y) of light that counts as white: of D65, in the XYZ of the RGB values.
    pub fn neutral_xy(self) -> [f64; 2] {
        match self.is_adapted() {
            true => self.white_point_xy(),
            false => XYZ_WHITE_XY,
        }
    }

    /// Whether white, RGB (1, 1, 1), stands for D65 although the space has another white point.
    pub fn is_adapted(self) -> bool {
        self == Self::AcesCg
    }

    /// Matrix from linear RGB to XYZ.
    pub fn to_xyz_matrix(self) -> Matrix3 {
        match self.is_adapted() {
            true => multiply(
                &adaptation_matrix(self.white_point_xy(), XYZ_WHITE_XY),
                &self.primaries_matrix(),
            ),
            false => self.primaries_matrix(),
        }
    }

    /// Matrix whose columns are the XYZ of the primaries, scaled so that they sum to the white point.
    fn primaries_matrix(self) -> Matrix3 {
        let primaries = self.primaries_xy().map(xy_to_xyz);
        let columns: Matrix3 =
            std::array::from_fn(|row| std::array::from_fn(|column| primaries[column][row]));
        let amounts = apply(&invert(&columns), xy_to_xyz(self.white_point_xy()));
        columns.map(|row| std::array::from_fn(|column| row[column] * amounts[column]))
    }

    /// Matrix from XYZ to linear RGB.
    pub fn from_xyz_matrix(self) -> Matrix3 {
        invert(&self.to_xyz_matrix())
    }

    /// Linear RGB of an XYZ. Components are negative for colours outside the gamut.
    ///
    /// Derives the matrix on each call: to convert a whole picture, [`apply`] the result of [`Self::from_xyz_matrix`].
    pub fn from_xyz(self, xyz: [f64; 3]) -> [f64; 3] {
        apply(&self.from_xyz_matrix(), xyz)
    }

    /// XYZ of a linear RGB colour.
    pub fn to_xyz(self, rgb: [f64; 3]) -> [f64; 3] {
        apply(&self.to_xyz_matrix(), rgb)
    }

    /// Luminance Y of a linear RGB colour, in the unit of its components.
    pub fn luminance(self, rgb: [f64; 3]) -> f64 {
        self.to_xyz(rgb)[1]
    }
}

/// Chromatic adaptation matrix: maps XYZ under one white to the XYZ of the same appearance under another (chromaticities
/// x, y).
///
/// The linearised Bradford transform: scaling in its sharpened cone space (Lam 1985, as used by ICC.1:2022 annex E).
/// The y of both whites must not be 0. Equal whites give the identity up to rounding.
pub fn adaptation_matrix(from_white_xy: [f64; 2], to_white_xy: [f64; 2]) -> Matrix3 {
    const BRADFORD: Matrix3 = [
        [0.8951, 0.2664, -0.1614],
        [-0.7502, 1.7135, 0.0367],
        [0.0389, -0.0685, 1.0296],
    ];
    let from = apply(&BRADFORD, xy_to_xyz(from_white_xy));
    let to = apply(&BRADFORD, xy_to_xyz(to_white_xy));
    let scaled: Matrix3 =
        std::array::from_fn(|cone| BRADFORD[cone].map(|v| v * to[cone] / from[cone]));
    multiply(&invert(&BRADFORD), &scaled)
}

/// Product `matrix * vector`.
pub fn apply(matrix: &Matrix3, vector: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * vector[0] + row[1] * vector[1] + row[2] * vector[2])
}

/// Matrix product `a * b`.
pub fn multiply(a: &Matrix3, b: &Matrix3) -> Matrix3 {
    a.map(|row| std::array::from_fn(|j| row[0] * b[0][j] + row[1] * b[1][j] + row[2] * b[2][j]))
}

/// sRGB signal of a linear component: IEC 61966-2-1, extended as an odd function below 0 and unclipped above 1.
pub fn srgb_encode(linear: f64) -> f64 {
    let v = linear.abs();
    let signal = if v <= 0.003_130_8 {
        12.92 * v
    } else {
        1.055 * v.powf(1.0 / 2.4) - 0.055
    };
    signal.copysign(linear)
}

/// Linear component of an sRGB signal: the inverse of [`srgb_encode`] to 2e-8, the precision to which the standard's two
/// branches meet.
pub fn srgb_decode(signal: f64) -> f64 {
    let v = signal.abs();
    let linear = if v <= 0.040_45 {
        v / 12.92
    } else {
        ((v + 0.055) / 1.055).powf(2.4)
    };
    linear.copysign(signal)
}

/// XYZ of a chromaticity (x, y), with Y = 1.
fn xy_to_xyz([x, y]: [f64; 2]) -> [f64; 3] {
    [x / y, 1.0, (1.0 - x - y) / y]
}

/// Inverse by cofactors; used only on matrices known to be regular.
fn invert(m: &Matrix3) -> Matrix3 {
    let cofactor = |r: usize, c: usize| {
        let (r1, r2) = ((r + 1) % 3, (r + 2) % 3);
        let (c1, c2) = ((c + 1) % 3, (c + 2) % 3);
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let determinant: f64 = (0..3).map(|c| m[0][c] * cofactor(0, c)).sum();
    std::array::from_fn(|r| std::array::from_fn(|c| cofactor(c, r) / determinant))
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::names::Named;

    fn close(a: &Matrix3, b: &Matrix3, tolerance: f64) {
        for (ra, rb) in a.iter().zip(b) {
            for (x, y) in ra.iter().zip(rb) {
                assert!((x - y).abs() < tolerance, "{a:?} against {b:?}");
            }
        }
    }

    #[test]
    fn matrices_match_the_published_ones() {
        // IEC 61966-2-1 prints four decimals, ITU-R BT.2020 four for Y, S-2014-004 ten for AP1.
        let srgb = [
            [0.4124, 0.3576, 0.1805],
            [0.2126, 0.7152, 0.0722],
            [0.0193, 0.1192, 0.9505],
        ];
        close(&RgbSpace::Srgb.to_xyz_matrix(), &srgb, 6e-5);
        let y = RgbSpace::Rec2020.to_xyz_matrix()[1];
        for (got, want) in y.iter().zip([0.2627, 0.6780, 0.0593]) {
            assert!((got - want).abs() < 5e-5);
        }
        let ap1 = [
            [0.662_454_181_1, 0.134_004_206_5, 0.156_187_687_0],
            [0.272_228_716_8, 0.674_081_765_8, 0.053_689_517_4],
            [-0.005_574_649_5, 0.004_060_733_5, 1.010_339_100_3],
        ];
        close(&RgbSpace::AcesCgUnadapted.to_xyz_matrix(), &ap1, 1e-9);
    }

    #[test]
    fn acescg_is_that_of_colour_science() {
        // matrix_RGB_to_RGB("sRGB", "ACEScg", "Bradford") with derived matrices, and XYZ_to_RGB, of colour-science 0.4.7.
        let srgb_to_acescg = [
            [0.613_097_402_401, 0.339_523_146_184, 0.047_379_451_415],
            [0.070_193_722_47, 0.916_353_879_057, 0.013_452_398_473],
            [0.020_615_592_882, 0.109_569_772_938, 0.869_814_634_18],
        ];
        let matrix = multiply(
            &RgbSpace::AcesCg.from_xyz_matrix(),
            &RgbSpace::Srgb.to_xyz_matrix(),
        );
        close(&matrix, &srgb_to_acescg, 1e-9);
        for (space, want) in [
            (
                RgbSpace::AcesCg,
                [0.292_225_952_013, 0.609_677_634_757, 0.183_645_995_099],
            ),
            (
                RgbSpace::AcesCgUnadapted,
                [0.282_620_427_768, 0.611_918_207_749, 0.197_053_319_008],
            ),
        ] {
            let got = space.from_xyz([0.3, 0.5, 0.2]);
            for (got, want) in got.iter().zip(want) {
                assert!((got - want).abs() < 1e-9, "{space}: {got} {want}");
            }
        }
    }

    #[test]
    fn white_is_one_and_conversion_round_trips() {
        for &space in RgbSpace::ALL {
            let white = match space.is_adapted() {
                true => RgbSpace::Srgb.white_point_xy(),
                false => space.white_point_xy(),
            };
            let white = space.from_xyz(xy_to_xyz(white));
            assert!(white.iter().all(|v| (v - 1.0).abs() < 1e-12), "{white:?}");
            assert!((space.luminance([1.0; 3]) - 1.0).abs() < 1e-12);
            let xyz = [0.3, 0.7, 0.2];
            let back = space.to_xyz(space.from_xyz(xyz));
            for i in 0..3 {
                assert!((back[i] - xyz[i]).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn adaptation_maps_white_to_white() {
        let (d65, d60) = (
            RgbSpace::Srgb.white_point_xy(),
            RgbSpace::AcesCg.white_point_xy(),
        );
        let adapted = apply(&adaptation_matrix(d65, d60), xy_to_xyz(d65));
        let rgb = RgbSpace::AcesCgUnadapted.from_xyz(adapted);
        assert!(rgb.iter().all(|v| (v - 1.0).abs() < 1e-12), "{rgb:?}");
        // The same adaptation computed by colour-science 0.4.7.
        let patch = apply(&adaptation_matrix(d65, d60), [0.3, 0.5, 0.2]);
        for (got, want) in patch.iter().zip([0.303_968_91, 0.500_384_74, 0.186_391_41]) {
            assert!((got - want).abs() < 1e-8, "{patch:?}");
        }
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        close(&adaptation_matrix(d65, d65), &identity, 1e-12);
        let round = multiply(&adaptation_matrix(d60, d65), &adaptation_matrix(d65, d60));
        close(&round, &identity, 1e-12);
    }

    #[test]
    fn transfer_function_matches_srgb_and_round_trips() {
        // Mid grey and the ends of the range.
        assert_eq!(srgb_encode(0.0), 0.0);
        assert!((srgb_encode(1.0) - 1.0).abs() < 1e-15);
        assert!((srgb_encode(0.214_041_140_5) - 0.5).abs() < 1e-9);
        for i in -300..=300 {
            let signal = i as f64 / 200.0;
            assert!((srgb_encode(srgb_decode(signal)) - signal).abs() < 3e-8);
        }
        assert_eq!(srgb_encode(-0.5), -srgb_encode(0.5));
    }
}
