//! Night vision: colours as the dark-adapted eye sees them.

use super::blocks::Planes;

/// Luminance below which only rods see, and above which only cones do, cd/m^2.
const MESOPIC_CD_M2: (f32, f32) = (0.01, 4.0);
/// Linear sRGB of the bluish grey as which scotopic light of luminance 1 appears: chromaticity 0.25, 0.25 (Jensen et al. 2000).
const NIGHT_BLUE: [f32; 3] = [0.706_2, 0.989_9, 1.965_7];

/// Replaces colours (linear sRGB, cd/m^2) by what rods see of them, in grey with a touch of blue: wholly below 0.01 cd/m^2, not
/// at all above 4 cd/m^2, blended by the logarithm of the luminance between.
///
/// Scotopic luminance is estimated as `Y (1.33 (1 + (Y + Z) / X) - 1.68)` (Larson, Rushmeier & Piatko 1997, eq. 12): reds darken and
/// blues brighten (Purkinje shift). A preview, not a model of the eye: acuity and noise stay as they are.
#[inline(always)]
pub(super) fn apply<const N: usize>(planes: &mut Planes<N>) {
    for i in 0..N {
        let [r, g, b] = [planes[0][i], planes[1][i], planes[2][i]];
        let x = 0.412_390_8 * r + 0.357_584_3 * g + 0.180_480_8 * b;
        let y = 0.212_639 * r + 0.715_168_7 * g + 0.072_192_3 * b;
        let z = 0.019_330_8 * r + 0.119_194_8 * g + 0.950_532_1 * b;
        if y >= MESOPIC_CD_M2.1 || !(x > 0.0 && y > 0.0) {
            continue;
        }
        let scotopic = (y * (1.33 * (1.0 + (y + z) / x) - 1.68)).max(0.0);
        let (dark, bright) = MESOPIC_CD_M2;
        let t = ((y / dark).ln() / (bright / dark).ln()).clamp(0.0, 1.0);
        let cones = t * t * (3.0 - 2.0 * t);
        for (plane, blue) in planes.iter_mut().zip(NIGHT_BLUE) {
            plane[i] = cones * plane[i] + (1.0 - cones) * scotopic * blue;
        }
    }
}
