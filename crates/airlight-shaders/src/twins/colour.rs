//! Colour: wavelengths, XYZ, RGB spaces, sRGB signals: `wgsl/colour.wgsl`.

use glam::{Vec3, Vec4};

/// Weights of four wavelengths in red, green and blue, or in X, Y and Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbWeights {
    /// In red.
    pub red: Vec4,
    /// In green.
    pub green: Vec4,
    /// In blue.
    pub blue: Vec4,
}

/// Red, green and blue of a radiance at four wavelengths.
pub fn rgb_from_spectrum(weights: RgbWeights, spectrum: Vec4) -> Vec3 {
    Vec3::new(
        weights.red.dot(spectrum),
        weights.green.dot(spectrum),
        weights.blue.dot(spectrum),
    )
}

/// XYZ of linear sRGB.
pub fn xyz_from_srgb(rgb: Vec3) -> Vec3 {
    Vec3::new(
        Vec3::new(0.412_390_8, 0.357_584_33, 0.180_480_8).dot(rgb),
        Vec3::new(0.212_639, 0.715_168_65, 0.072_192_32).dot(rgb),
        Vec3::new(0.019_330_818, 0.119_194_78, 0.950_532_14).dot(rgb),
    )
}

/// Linear sRGB of XYZ.
pub fn srgb_from_xyz(xyz: Vec3) -> Vec3 {
    Vec3::new(
        Vec3::new(3.240_97, -1.537_383_2, -0.498_610_76).dot(xyz),
        Vec3::new(-0.969_243_65, 1.875_967_5, 0.041_555_06).dot(xyz),
        Vec3::new(0.055_630_08, -0.203_976_96, 1.056_971_5).dot(xyz),
    )
}

/// XYZ of linear BT.2020.
pub fn xyz_from_rec2020_rgb(rgb: Vec3) -> Vec3 {
    Vec3::new(
        Vec3::new(0.636_958_06, 0.144_616_9, 0.168_880_98).dot(rgb),
        Vec3::new(0.262_700_2, 0.677_998_07, 0.059_301_715).dot(rgb),
        Vec3::new(0.0, 0.028_072_692, 1.060_985).dot(rgb),
    )
}

/// Linear BT.2020 of XYZ.
pub fn rec2020_from_xyz(xyz: Vec3) -> Vec3 {
    Vec3::new(
        Vec3::new(1.716_651_2, -0.355_670_8, -0.253_366_3).dot(xyz),
        Vec3::new(-0.666_684_3, 1.616_481_2, 0.015_768_546).dot(xyz),
        Vec3::new(0.017_639_857, -0.042_770_613, 0.942_103_1).dot(xyz),
    )
}

/// XYZ of ACEScg, whose white is adapted to D65.
pub fn xyz_from_acescg(rgb: Vec3) -> Vec3 {
    Vec3::new(
        Vec3::new(0.652_237_53, 0.128_236_14, 0.169_982_24).dot(rgb),
        Vec3::new(0.267_672_18, 0.674_34, 0.057_987_83).dot(rgb),
        Vec3::new(-0.005_381_816, 0.001_369_060_2, 1.093_070_5).dot(rgb),
    )
}

/// ACEScg of XYZ, D65 adapted to its white.
pub fn acescg_from_xyz(xyz: Vec3) -> Vec3 {
    Vec3::new(
        Vec3::new(1.660_585_3, -0.315_295_56, -0.241_509_33).dot(xyz),
        Vec3::new(-0.659_926_06, 1.608_391_4, 0.017_298_594).dot(xyz),
        Vec3::new(0.009_002_569, -0.003_566_876_5, 0.913_643_3).dot(xyz),
    )
}

/// sRGB signal of linear components.
pub fn srgb_encode(linear: Vec3) -> Vec3 {
    linear.map(|x| {
        let v = x.abs();
        let curved = 1.055 * v.max(0.0031308).powf(0.416_666_66) - 0.055;
        x.signum() * if v <= 0.0031308 { 12.92 * v } else { curved }
    })
}

/// Linear components of an sRGB signal.
pub fn srgb_decode(signal: Vec3) -> Vec3 {
    signal.map(|x| {
        let v = x.abs();
        let curved = ((v + 0.055) / 1.055).powf(2.4);
        x.signum() * if v <= 0.04045 { v / 12.92 } else { curved }
    })
}

/// Luminance of linear sRGB.
pub fn srgb_luminance(rgb: Vec3) -> f32 {
    Vec3::new(0.2126, 0.7152, 0.0722).dot(rgb)
}

/// Linear sRGB moved towards grey until no component is negative.
pub fn without_negatives(rgb: Vec3) -> Vec3 {
    let bottom = rgb.min_element();
    if bottom >= 0.0 {
        return rgb;
    }
    let grey = srgb_luminance(rgb).max(0.0);
    (grey + grey / (grey - bottom) * (rgb - grey)).max(Vec3::ZERO)
}

/// Linear sRGB moved towards grey until all components are from 0 to 1.
pub fn into_unit_cube(rgb: Vec3) -> Vec3 {
    let positive = without_negatives(rgb);
    let top = positive.max_element();
    if top <= 1.0 {
        return positive;
    }
    let grey = srgb_luminance(positive);
    if grey >= 1.0 {
        return Vec3::ONE;
    }
    (grey + (1.0 - grey) / (top - grey) * (positive - grey)).clamp(Vec3::ZERO, Vec3::ONE)
}
