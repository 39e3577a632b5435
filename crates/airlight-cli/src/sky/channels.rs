//! What the values of a pixel are, and how spectra become them.

use crate::args::{ColorSpaceArg, PictureArgs};
use crate::error::CliError;
use crate::scene::Scene;
use airlight::sky::TableChannels;
use airlight::spectrum::{RgbSpace, WavelengthGrid, rgb};
use airlight_image::output::Chromaticities;
use airlight_image::output::spectral::SpectralLayout;

/// The values of a pixel: red, green, blue, and for spectral pictures the radiance at each wavelength after them.
pub struct Channels {
    /// The space of the first three.
    pub space: RgbSpace,
    /// Names of the others.
    pub spectral: Option<SpectralLayout>,
}

/// Weights of each wavelength's radiance in red, green and blue.
pub type RgbWeights = Vec<[f32; 3]>;

impl Channels {
    /// As the options say.
    ///
    /// # Errors
    /// [`CliError::Usage`] for wavelengths that channels cannot be named by.
    pub fn new(args: &PictureArgs, spectral: bool, scene: &Scene) -> Result<Self, CliError> {
        let spectral = match spectral {
            true => Some(SpectralLayout::new(scene.grid.wavelengths_nm())?),
            false => None,
        };
        Ok(Self {
            space: space_of(args.color_space),
            spectral,
        })
    }

    /// What to tabulate.
    pub fn table(&self) -> TableChannels {
        match self.spectral {
            Some(_) => TableChannels::Spectral,
            None => TableChannels::Rgb(self.space),
        }
    }

    /// Luminance, cd/m^2, of a table's channels.
    pub fn luminance(&self, grid: &WavelengthGrid, table_values: &[f32]) -> f64 {
        match (self.spectral.is_some(), table_values) {
            (true, spectrum) => grid.to_xyz(spectrum)[1],
            (false, &[r, g, b]) => self.space.luminance([r, g, b].map(f64::from)),
            (false, _) => 0.0,
        }
    }

    /// How radiances become RGB.
    pub fn rgb_weights(&self, grid: &WavelengthGrid) -> RgbWeights {
        let from_xyz = self.space.from_xyz_matrix();
        grid.xyz_weights()
            .iter()
            .map(|&w| rgb::apply(&from_xyz, w).map(|v| v as f32))
            .collect()
    }

    /// What files say of the RGB space.
    pub fn chromaticities(&self) -> Chromaticities {
        match self.space {
            RgbSpace::Srgb => Chromaticities::SRGB,
            RgbSpace::Rec2020 => Chromaticities::REC2020,
            RgbSpace::AcesCg => Chromaticities::ACESCG,
        }
    }
}

/// The space of an option.
pub fn space_of(arg: ColorSpaceArg) -> RgbSpace {
    match arg {
        ColorSpaceArg::Srgb => RgbSpace::Srgb,
        ColorSpaceArg::Rec2020 => RgbSpace::Rec2020,
        ColorSpaceArg::Acescg => RgbSpace::AcesCg,
    }
}

/// The name of a space on the command line.
pub fn space_name(space: RgbSpace) -> &'static str {
    match space {
        RgbSpace::Srgb => "srgb",
        RgbSpace::Rec2020 => "rec2020",
        RgbSpace::AcesCg => "acescg",
    }
}
