//! Options that say what fog lies in the air.

use crate::parse;
use airlight::fog::droplets::Droplets;
use clap::{Args, ValueEnum};
use serde::Serialize;

/// Kinds of fog by their drops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DropletsArg {
    /// Young fog over land, smog: 5 micrometres.
    Fine,
    /// Radiation fog: 10 micrometres.
    Radiation,
    /// Advection fog, sea fog: 20 micrometres.
    Advection,
    /// Drizzling fog: 40 micrometres.
    Coarse,
}

impl From<DropletsArg> for Droplets {
    fn from(arg: DropletsArg) -> Self {
        match arg {
            DropletsArg::Fine => Self::Fine,
            DropletsArg::Radiation => Self::Radiation,
            DropletsArg::Advection => Self::Advection,
            DropletsArg::Coarse => Self::Coarse,
        }
    }
}

/// What fog lies in the air. Heights are above the ground.
#[derive(Debug, Args)]
#[command(next_help_heading = "Fog")]
pub struct FogArgs {
    /// Fog in which one sees this far where it is thickest, m: the distance at which 5 % of contrast is left
    #[arg(long, value_name = "M", value_parser = parse::length_m)]
    pub fog_visibility_m: Option<f64>,
    /// Height up to which the fog reaches, evenly thick, m
    #[arg(long, value_name = "M", value_parser = parse::length_m, requires = "fog_visibility_m")]
    #[arg(conflicts_with_all = ["fog_scale_height_m", "fog_base_m"])]
    pub fog_top_m: Option<f64>,
    /// Height over which the fog thins to 1/e, m [default: 50]
    #[arg(long, value_name = "M", value_parser = parse::length_m, requires = "fog_visibility_m")]
    pub fog_scale_height_m: Option<f64>,
    /// Height from which on it thins, m [default: 0]
    #[arg(long, value_name = "M", value_parser = parse::not_negative, requires = "fog_visibility_m")]
    pub fog_base_m: Option<f64>,
    /// Drops that the fog consists of
    #[arg(long, value_enum, value_name = "KIND", default_value_t = DropletsArg::Radiation)]
    pub fog_droplets: DropletsArg,
}
