//! Options of `airlight plot`.

use super::fog::DropletsArg;
use crate::parse;
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// Options of `airlight plot`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct PlotArgs {
    /// What is plotted.
    #[command(subcommand)]
    pub what: PlotWhat,
}

/// What is plotted.
#[derive(Debug, Subcommand)]
pub enum PlotWhat {
    /// Phase functions of fogs and of single spheres against the scattering angle, or around the particle.
    Phase(PhasePlotArgs),
    /// Scattering efficiency of spheres against the size parameter, single and in a spread of sizes.
    Efficiency(EfficiencyPlotArgs),
}

/// Options of `airlight plot phase`.
#[derive(Debug, Args)]
pub struct PhasePlotArgs {
    /// File to write: .svg
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Drops of fog, as `airlight fog --droplets` has them
    #[arg(long, value_name = "KIND,...", value_delimiter = ',', value_enum)]
    pub droplets: Vec<DropletsArg>,
    /// Wavelengths for them, nm
    #[arg(long, value_name = "NM,...", value_delimiter = ',', value_parser = parse::positive, default_values_t = [550.0])]
    pub wavelength_nm: Vec<f64>,
    /// Single spheres by their edge in wavelengths, 2 pi r / lambda
    #[arg(long, value_name = "X,...", value_delimiter = ',', value_parser = parse::positive)]
    pub size_parameter: Vec<f64>,
    /// Refractive index of single spheres: n, or n,k where they absorb
    #[arg(long, value_name = "N[,K]", value_parser = index, default_value = "1.333")]
    pub index: Index,
    /// Around the particle, light from the left, each in a panel of its own; single spheres by |S|^2, not by phase function
    #[arg(long)]
    pub polar: bool,
}

/// Options of `airlight plot efficiency`.
#[derive(Debug, Args)]
pub struct EfficiencyPlotArgs {
    /// File to write: .svg
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Refractive index: n, or n,k where they absorb
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
  Angular scattering around drops of six sizes (figure 2 of Klassen 1987), and the efficiency of water (figure 3):
    airlight plot phase --polar --size-parameter 0.2,1,2,4,6,10 -o angular.svg
    airlight plot efficiency -o efficiency.svg
  Bow and glory of two fogs:
    airlight plot phase --droplets heavy-radiation-fog,moderate-advection-fog --wavelength-nm 450,650 -o fogs.svg";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_index_has_one_or_two_numbers() {
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
