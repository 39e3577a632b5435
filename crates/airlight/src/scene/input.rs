//! [`Input`]: inputs of a scene that not every model honours.

use std::fmt;

/// An input of a scene that not every model honours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Input {
    /// Atmosphere: preset or file.
    Atmosphere,
    /// Type, humidity, optical depth, turbidity or visibility of the haze.
    Haze,
    /// Ozone column.
    Ozone,
    /// Albedo of the ground.
    GroundAlbedo,
    /// Height of the eye, if it is far above the ground.
    ObserverHeight,
    /// Distance of the planet from the sun.
    SunDistance,
    /// Moon, stars and the other lights of the night.
    Night,
    /// Fog near the ground.
    Fog,
    /// Orders of scattering in the fog.
    FogScattering,
    /// Patches in the fog.
    FogPatches,
    /// Point, spot and sphere lights.
    Lights,
    /// Objects in front of the sky.
    Objects,
    /// Wavelengths to compute.
    Wavelengths,
    /// Orders of scattering in the air.
    Scattering,
    /// Resolution of the solver.
    Effort,
    /// Effect of polarisation on the radiance.
    PolarisationCorrection,
    /// Number of Monte Carlo paths and their seed.
    Paths,
    /// Maps of the standard error.
    NoiseMap,
    /// Polarisation of the light.
    Polarisation,
    /// Variant of a published model.
    Variant,
    /// Sunlight of the single-scattering shader.
    Sunlight,
    /// Settings of the 1987 model.
    Klassen1987,
    /// Pictures with one channel for each wavelength.
    Spectra,
    /// Path optics of the air in front of a point.
    Distances,
}

impl Input {
    /// Key in a scene file; several keys are joined by "and".
    pub fn key(self) -> &'static str {
        match self {
            Self::Atmosphere => "air.atmosphere",
            Self::Haze => "air.aerosol, humidity, aod_550, turbidity and haze_visibility_m",
            Self::Ozone => "air.ozone_du",
            Self::GroundAlbedo => "air.ground_albedo",
            Self::ObserverHeight => "observer",
            Self::SunDistance => "sun.distance_ratio",
            Self::Night => "night",
            Self::Fog => "fog",
            Self::FogScattering => "fog.scattering",
            Self::FogPatches => "fog.patches",
            Self::Lights => "lights",
            Self::Objects => "objects",
            Self::Wavelengths => "solver.wavelengths",
            Self::Scattering => "solver.scattering",
            Self::Effort => "solver.effort",
            Self::PolarisationCorrection => "solver.polarisation_correction",
            Self::Paths => "solver.paths and solver.seed",
            Self::NoiseMap => "output.noise_map",
            Self::Polarisation => "output.polarisation",
            Self::Variant => "solver.variant",
            Self::Sunlight => "solver.sunlight and solver.zenith_lux",
            Self::Klassen1987 => "solver.klassen1987",
            Self::Spectra => "output.spectral",
            Self::Distances => "distance_m",
        }
    }
}

impl fmt::Display for Input {
    /// Writes a phrase for error messages, such as "the ozone column".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Atmosphere => "the atmosphere",
            Self::Haze => "haze",
            Self::Ozone => "the ozone column",
            Self::GroundAlbedo => "the albedo of the ground",
            Self::ObserverHeight => "an eye high above the ground",
            Self::SunDistance => "the distance of the sun",
            Self::Night => "lights of the night",
            Self::Fog => "fog",
            Self::FogScattering => "the scattering of the fog",
            Self::FogPatches => "patches in the fog",
            Self::Lights => "lights",
            Self::Objects => "objects",
            Self::Wavelengths => "the wavelengths",
            Self::Scattering => "the orders of scattering",
            Self::Effort => "the effort",
            Self::PolarisationCorrection => "the correction for polarisation",
            Self::Paths => "the number of paths and their seed",
            Self::NoiseMap => "noise maps",
            Self::Polarisation => "polarisation",
            Self::Variant => "variants",
            Self::Sunlight => "the colour of the sunlight",
            Self::Klassen1987 => "the settings of the 1987 model",
            Self::Spectra => "spectral pictures",
            Self::Distances => "the air in front of a point",
        })
    }
}
