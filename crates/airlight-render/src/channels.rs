//! [`PixelChannels`]: conversion from the values of a view to those of a pixel.

use airlight::scene::Channels;
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use airlight_image::ImageError;
use airlight_image::output::Chromaticities;
use airlight_image::output::spectral::SpectralLayout;

/// Weights of the radiance at each wavelength (W m^-2 sr^-1 nm^-1) in linear red, green and blue (cd/m^2).
pub type RgbWeights = Vec<[f32; 3]>;

/// Values of a pixel: red, green and blue, followed by the radiance at each wavelength in spectral pictures.
#[derive(Clone, Debug)]
pub struct PixelChannels {
    space: RgbSpace,
    spectral: Option<(SpectralLayout, RgbWeights)>,
}

impl PixelChannels {
    /// Red, green and blue in a space.
    pub fn rgb(space: RgbSpace) -> Self {
        Self {
            space,
            spectral: None,
        }
    }

    /// Red, green and blue, and the radiance at the wavelengths of a grid.
    ///
    /// # Errors
    /// [`ImageError::Setting`] for wavelengths whose channel names would be equal.
    pub fn spectral(space: RgbSpace, grid: &WavelengthGrid) -> Result<Self, ImageError> {
        let layout = SpectralLayout::new(grid.wavelengths_nm())?;
        Ok(Self {
            space,
            spectral: Some((layout, grid.rgb_weights(space))),
        })
    }

    /// The RGB space.
    pub fn space(&self) -> RgbSpace {
        self.space
    }

    /// Channels of the views from which these pixels are computed.
    pub fn of_views(&self) -> Channels {
        match self.spectral {
            Some(_) => Channels::Spectral,
            None => Channels::Rgb(self.space),
        }
    }

    /// Number of values of a pixel.
    pub fn count(&self) -> usize {
        3 + self
            .spectral
            .as_ref()
            .map_or(0, |(_, weights)| weights.len())
    }

    /// Number of values that a view returns for each direction.
    pub fn view_count(&self) -> usize {
        match &self.spectral {
            Some((_, weights)) => weights.len(),
            None => 3,
        }
    }

    /// True if the values of a pixel are those that a view returns.
    pub fn are_those_of_views(&self) -> bool {
        self.spectral.is_none()
    }

    /// Channel names of a spectral picture; `None` for RGB.
    pub fn layout(&self) -> Option<&SpectralLayout> {
        self.spectral.as_ref().map(|(layout, _)| layout)
    }

    /// Adds the values of a view, multiplied by `scale`, to a pixel.
    pub fn add(&self, values: &[f32], scale: f32, pixel: &mut [f32]) {
        match &self.spectral {
            None => pixel
                .iter_mut()
                .zip(values)
                .for_each(|(p, v)| *p += v * scale),
            Some((_, weights)) => {
                let (rgb, spectrum) = pixel.split_at_mut(3);
                for ((value, weights), radiance) in values.iter().zip(weights).zip(spectrum) {
                    let scaled = value * scale;
                    *radiance += scaled;
                    rgb.iter_mut()
                        .zip(weights)
                        .for_each(|(c, w)| *c += w * scaled);
                }
            }
        }
    }

    /// Converts values of a view to red, green and blue.
    pub fn to_rgb(&self, values: &[f64]) -> [f64; 3] {
        let mut rgb = [0.0; 3];
        match &self.spectral {
            None => rgb.iter_mut().zip(values).for_each(|(c, v)| *c = *v),
            Some((_, weights)) => {
                for (value, weights) in values.iter().zip(weights) {
                    rgb.iter_mut()
                        .zip(weights)
                        .for_each(|(c, w)| *c += f64::from(*w) * value);
                }
            }
        }
        rgb
    }

    /// Primaries and white point of the RGB space, for file headers.
    pub fn chromaticities(&self) -> Chromaticities {
        self.space.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spectra_are_stored_and_converted_to_colour() {
        let grid = WavelengthGrid::fast();
        let channels = PixelChannels::spectral(RgbSpace::Srgb, &grid).unwrap();
        let spectrum: Vec<f32> = (0..grid.len()).map(|i| 0.01 + 0.001 * i as f32).collect();
        let mut pixel = vec![0.0; channels.count()];
        channels.add(&spectrum, 2.0, &mut pixel);
        let rgb = RgbSpace::Srgb.from_xyz(grid.to_xyz(&spectrum));
        for (got, want) in pixel.iter().zip(rgb) {
            assert!(
                (f64::from(*got) / (2.0 * want) - 1.0).abs() < 1e-5,
                "{pixel:?}"
            );
        }
        assert!(
            pixel[3..]
                .iter()
                .zip(&spectrum)
                .all(|(got, v)| *got == 2.0 * v)
        );
        let wide: Vec<f64> = spectrum.iter().map(|&v| f64::from(v)).collect();
        for (got, want) in channels.to_rgb(&wide).into_iter().zip(rgb) {
            assert!((got / want - 1.0).abs() < 1e-6);
        }
    }
}
