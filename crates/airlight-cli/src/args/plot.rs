//! Options of `airlight plot`.

use super::SceneArgs;
use crate::parse::{self, AzEl};
use airlight::fog::droplets::DropletKind;
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// Options of `airlight plot`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct PlotArgs {
    /// Kinds of plots.
    #[command(subcommand)]
    pub what: PlotWhat,
}

/// Kinds of plots.
#[derive(Debug, Subcommand)]
pub enum PlotWhat {
    /// Phase functions of fog droplets and single spheres by scattering angle, also in polar form.
    Phase(PhasePlotArgs),
    /// Scattering efficiency of spheres by size parameter, for a single size and a distribution of sizes.
    Efficiency(EfficiencyPlotArgs),
    /// Spectra of the sky along directions, or of sunlight and skylight.
    Spectrum(Box<SpectrumPlotArgs>),
    /// Transmittance of the air by wavelength, for some zenith angles or as a map.
    Transmittance(Box<TransmittancePlotArgs>),
    /// Extinction of fog by height.
    FogProfile(FogProfilePlotArgs),
    /// Map of the error of the split-sum approximation.
    SplitSum(SplitSumPlotArgs),
}

/// Options of `airlight plot spectrum`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct SpectrumPlotArgs {
    /// File to write: .svg or .png
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// View direction: azimuth,elevation in degrees; can be repeated [default: plot irradiances instead]
    #[arg(long, value_name = "AZ,EL", value_parser = parse::az_el, allow_hyphen_values = true)]
    pub view: Vec<AzEl>,
    #[command(flatten)]
    pub scene: SceneArgs,
}

/// Options of `airlight plot transmittance`, which does not depend on the sun.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct TransmittancePlotArgs {
    /// File to write: .svg or .png
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Zenith angles, degrees
    #[arg(long, value_name = "DEG,...", value_delimiter = ',', value_parser = zenith_deg, default_values_t = [0.0, 60.0, 75.0, 85.0, 89.0])]
    pub zenith_deg: Vec<f64>,
    /// Plot a map over wavelength and all zenith angles instead of curves
    #[arg(long, conflicts_with = "zenith_deg")]
    pub map: bool,
    #[command(flatten)]
    pub scene: SceneArgs,
}

/// Options of `airlight plot fog-profile`.
#[derive(Debug, Args)]
pub struct FogProfilePlotArgs {
    /// File to write: .svg or .png
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Visibility where the fog is densest, m: the distance at which contrast falls to 5 %
    #[arg(long, value_name = "M", value_parser = parse::length_m, default_value_t = 200.0)]
    pub visibility_m: f64,
    /// Top of the slab, m
    #[arg(long, value_name = "M", value_parser = parse::length_m, default_value_t = 100.0)]
    pub top_m: f64,
    /// Scale height of the exponential profiles, m
    #[arg(long, value_name = "M", value_parser = parse::length_m, default_value_t = 50.0)]
    pub scale_height_m: f64,
    /// Height above which the clamped profile decreases, m
    #[arg(long, value_name = "M", value_parser = parse::not_negative, default_value_t = 50.0)]
    pub base_height_m: f64,
    /// Largest height shown, m [default: from the profiles]
    #[arg(long, value_name = "M", value_parser = parse::length_m)]
    pub to_m: Option<f64>,
}

/// Options of `airlight plot split-sum`.
#[derive(Debug, Args)]
pub struct SplitSumPlotArgs {
    /// File to write: .svg or .png
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
}

fn zenith_deg(text: &str) -> Result<f64, String> {
    match parse::not_negative(text)? {
        deg if deg <= 90.0 => Ok(deg),
        deg => Err(format!(
            "expected a zenith angle from 0 to 90 degrees, got {deg}"
        )),
    }
}

/// Options of `airlight plot phase`.
#[derive(Debug, Args)]
pub struct PhasePlotArgs {
    /// File to write: .svg or .png
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Fog droplets, as for `airlight fog --droplets`
    #[arg(long, value_name = "KIND,...", value_delimiter = ',', value_parser = parse::named::<DropletKind>())]
    pub droplets: Vec<DropletKind>,
    /// Wavelengths of --droplets, nm
    #[arg(long, value_name = "NM,...", value_delimiter = ',', value_parser = parse::positive, default_values_t = [550.0])]
    pub wavelength_nm: Vec<f64>,
    /// Size parameters of single spheres: circumference divided by wavelength, 2 pi r / lambda
    #[arg(long, value_name = "X,...", value_delimiter = ',', value_parser = parse::positive)]
    pub size_parameter: Vec<f64>,
    /// Refractive index of single spheres: n, or n,k with absorption
    #[arg(long, value_name = "N[,K]", value_parser = index, default_value = "1.333")]
    pub index: Index,
    /// Polar plots with light from the left, one panel for each curve; single spheres as |S|^2 instead of the phase function
    #[arg(long)]
    pub polar: bool,
}

/// Options of `airlight plot efficiency`.
#[derive(Debug, Args)]
pub struct EfficiencyPlotArgs {
    /// File to write: .svg or .png
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Refractive index: n, or n,k with absorption
    #[arg(long, value_name = "N[,K]", value_parser = index, default_value = "1.333")]
    pub index: Index,
    /// Largest size parameter, 2 pi r / lambda
    #[arg(long, value_name = "X", value_parser = parse::positive, default_value_t = 50.0)]
    pub to: f64,
}

/// A complex refractive index `n + i k`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Index {
    /// `n`.
    pub real: f64,
    /// `k`.
    pub imaginary: f64,
}

fn index(text: &str) -> Result<Index, String> {
    let (real, imaginary) = match text.contains(',') {
        true => parse::two_numbers(text)?,
        false => (parse::number(text)?, 0.0),
    };
    Ok(Index { real, imaginary })
}

const EXAMPLES: &str = "\
Examples:
  Angular scattering by drops of six sizes (figure 2 of Klassen 1987), and the efficiency of water (figure 3):
    airlight plot phase --polar --size-parameter 0.2,1,2,4,6,10 -o angular.svg
    airlight plot efficiency -o efficiency.svg
  Fogbow and glory of two fogs:
    airlight plot phase --droplets heavy-radiation-fog,moderate-advection-fog --wavelength-nm 450,650 -o fogs.svg
  Spectra of sunlight and skylight for a low sun; of the sky in two directions; a map of the air's transmittance:
    airlight plot spectrum --sun-elevation 5 --wavelengths fine -o light.svg
    airlight plot spectrum --sun-elevation 30 --wavelengths fine --view 0,90 --view 180,5 -o sky.png
    airlight plot transmittance --sun-elevation 30 --wavelengths fine --map -o transmittance.png";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refractive_indices_have_one_or_two_numbers() {
        let water = Index {
            real: 1.33,
            imaginary: 0.0,
        };
        assert_eq!(index("1.33"), Ok(water));
        assert_eq!(index("1.75,0.44").map(|m| m.imaginary), Ok(0.44));
        for text in ["", "x", "1,2,3", "1,"] {
            assert!(index(text).is_err(), "{text}");
        }
    }
}
