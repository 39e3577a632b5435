//! White balance: light of a colour temperature becomes neutral.

use super::blocks::Planes;
use crate::ImageError;
use airlight::spectrum::RgbSpace;
use airlight::spectrum::rgb::{Matrix3, adaptation_matrix, multiply};

/// Range of colour temperatures, K.
const RANGE_K: (f64, f64) = (1667.0, 25_000.0);

/// A linear map of linear sRGB colours.
#[derive(Clone, Copy, Debug)]
pub struct WhiteBalance([[f32; 3]; 3]);

impl WhiteBalance {
    /// The map that makes the light of a black body of a temperature neutral, by the Bradford transform.
    ///
    /// # Errors
    /// [`ImageError::Setting`] for a temperature outside 1667 to 25000 K.
    pub fn new(kelvin: f64) -> Result<Self, ImageError> {
        if !(RANGE_K.0..=RANGE_K.1).contains(&kelvin) {
            return Err(ImageError::Setting {
                what: "the white balance",
                got: format!("{kelvin} K"),
                right: "1667 to 25000 K",
            });
        }
        let srgb = RgbSpace::Srgb;
        let adapted = adaptation_matrix(black_body_xy(kelvin), srgb.white_point_xy());
        let matrix: Matrix3 = multiply(
            &srgb.from_xyz_matrix(),
            &multiply(&adapted, &srgb.to_xyz_matrix()),
        );
        // Luminance of the neutral colour is kept.
        Ok(Self(matrix.map(|row| row.map(|v| v as f32))))
    }

    /// Rows of the map of linear sRGB.
    pub fn matrix(&self) -> [[f32; 3]; 3] {
        self.0
    }

    /// Maps colours.
    #[inline(always)]
    pub(super) fn apply<const N: usize>(&self, planes: &mut Planes<N>) {
        for i in 0..N {
            let rgb = [planes[0][i], planes[1][i], planes[2][i]];
            for (plane, row) in planes.iter_mut().zip(&self.0) {
                plane[i] = row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2];
            }
        }
    }
}

/// CIE 1931 chromaticity of a black body from 1667 to 25000 K (Kim et al. 2002, US patent 7024034), within 1e-3.
fn black_body_xy(kelvin: f64) -> [f64; 2] {
    let cubic = |c: [f64; 4], v: f64| c[0] + v * (c[1] + v * (c[2] + v * c[3]));
    let inverse = 1e3 / kelvin;
    let x = match kelvin < 4000.0 {
        true => cubic(
            [0.179_910, 0.877_695_6, -0.234_358_9, -0.266_123_9],
            inverse,
        ),
        false => cubic([0.240_390, 0.222_634_7, 2.107_037_9, -3.025_846_9], inverse),
    };
    let y = match kelvin {
        k if k < 2222.0 => cubic([-0.202_196_83, 2.185_558_32, -1.348_110_2, -1.106_381_4], x),
        k if k < 4000.0 => cubic(
            [-0.167_488_67, 2.091_370_15, -1.374_185_93, -0.954_947_6],
            x,
        ),
        _ => cubic([-0.370_014_83, 3.751_129_97, -5.873_386_7, 3.081_758], x),
    };
    [x, y]
}
