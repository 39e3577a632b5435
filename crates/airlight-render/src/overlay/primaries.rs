//! Colours of a picture and of its fog, which is computed in linear sRGB.

use airlight::transfer::RgbPathOptics;
use airlight_image::Picture;
use glam::{DVec3, Mat3, Vec3};

/// Conversion between the primaries of a picture and linear sRGB, white to white.
#[derive(Clone, Copy, Debug)]
pub(super) struct Primaries(Option<Matrices>);

#[derive(Clone, Copy, Debug)]
struct Matrices {
    to_srgb: Mat3,
    from_srgb: Mat3,
    /// White of sRGB in the picture's primaries: not (1, 1, 1) where these are not adapted to their white point.
    white: Vec3,
}

impl Primaries {
    /// Those of a picture.
    pub fn of(picture: &Picture) -> Self {
        Self(picture.to_linear_srgb().map(|matrix| {
            let from_srgb = matrix.inverse();
            Matrices {
                to_srgb: matrix.as_mat3(),
                from_srgb: from_srgb.as_mat3(),
                white: (from_srgb * DVec3::ONE).as_vec3(),
            }
        }))
    }

    /// Whether the picture's are those of sRGB.
    pub fn are_srgb(self) -> bool {
        self.0.is_none()
    }

    /// A colour of the picture in linear sRGB, negative components as 0: no light has them.
    pub fn to_srgb(self, colour: [f32; 3]) -> [f32; 3] {
        match self.0 {
            Some(matrices) => (matrices.to_srgb * Vec3::from(colour))
                .max(Vec3::ZERO)
                .into(),
            None => colour,
        }
    }

    /// A colour of linear sRGB in the picture's primaries.
    pub fn in_picture(self, colour: [f32; 3]) -> [f32; 3] {
        match self.0 {
            Some(matrices) => (matrices.from_srgb * Vec3::from(colour)).into(),
            None => colour,
        }
    }

    /// Optics for red, green and blue of the picture: path radiance is converted as a colour, and transmittance is what remains of
    /// white. Grey fog thus has the same transmittance in all primaries.
    pub fn optics(self, optics: RgbPathOptics) -> RgbPathOptics {
        match self.0 {
            Some(matrices) => RgbPathOptics {
                transmittance: (matrices.from_srgb * Vec3::from(optics.transmittance)
                    / matrices.white)
                    .into(),
                path_radiance: (matrices.from_srgb * Vec3::from(optics.path_radiance)).into(),
            },
            None => optics,
        }
    }
}
