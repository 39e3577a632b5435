//! Spectral EXR files in the layout of Fichet, Pacanowski and Wilkie, "An OpenEXR Layout for Spectral Images", JCGT
//! 10(3), 2021: one channel per wavelength, and RGB channels for ordinary viewers.

use super::{
    Metadata, Written,
    exr::{self, ExrOptions},
};
use crate::{Control, ImageError, RowSource, Size};
use std::path::Path;

/// Unit of radiance as written by the software of the layout's authors. The values are spectral densities, per nanometre.
pub const RADIANCE_UNITS: &str = "W.m^-2.sr^-1";

/// Channels of a spectral picture.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralLayout {
    names: Vec<String>,
}

impl SpectralLayout {
    /// A layout whose pixels hold red, green and blue, then the spectral radiance (W m^-2 sr^-1 nm^-1) at each of these
    /// wavelengths (nanometres).
    ///
    /// # Errors
    /// [`ImageError::Setting`] where there is no wavelength, one is not positive and finite, or two have the same name (which
    /// has a resolution of a millionth of a nanometre).
    pub fn new(wavelengths_nm: &[f64]) -> Result<Self, ImageError> {
        let refuse = |got: String, right| {
            Err(ImageError::Setting {
                what: "the wavelengths of a spectral picture",
                got,
                right,
            })
        };
        if wavelengths_nm.is_empty() {
            return refuse("none".to_owned(), "one or more");
        }
        let mut names: Vec<String> = ["R", "G", "B"].map(str::to_owned).into();
        for &wavelength_nm in wavelengths_nm {
            if !(wavelength_nm > 0.0 && wavelength_nm < 1e9) {
                return refuse(format!("{wavelength_nm} nm"), "above 0 and below 1e9 nm");
            }
            let name = channel_name(wavelength_nm);
            if names.contains(&name) {
                return refuse(format!("{wavelength_nm} nm twice"), "all different");
            }
            names.push(name);
        }
        Ok(Self { names })
    }

    /// Channel names in the order of a row's values.
    pub fn channel_names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(String::as_str)
    }
}

/// Name of the channel of unpolarised light at a wavelength. The decimal mark is a comma, as points separate layers.
pub fn channel_name(wavelength_nm: f64) -> String {
    let number = format!("{wavelength_nm:.6}").replace('.', ",");
    format!("S0.{number}nm")
}

/// Writes spectral rows, with pixels as in [`SpectralLayout::new`], to a file.
///
/// # Errors
/// [`ImageError`]; the target is then unchanged.
pub fn write(
    path: &Path,
    size: Size,
    layout: &SpectralLayout,
    source: &dyn RowSource,
    options: &ExrOptions,
    metadata: &Metadata,
    control: Control<'_>,
) -> Result<Written, ImageError> {
    let names: Vec<&str> = layout.channel_names().collect();
    let metadata = metadata
        .clone()
        .with_text("spectralLayoutVersion", "1.0")
        .with_text("emissiveUnits", RADIANCE_UNITS)
        .with_text("spectralDensity", "values are per nanometre of wavelength");
    exr::write(path, size, &names, source, options, &metadata, control)
}
