//! Options of the fog in `airlight sky`.

use super::fog::{DropletsArg, FogScatteringArg};
use crate::parse;
use clap::Args;

/// What fog lies in the air. Heights are above the ground.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Fog")]
pub struct SkyFogArgs {
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
    #[arg(long, value_enum, value_name = "KIND", default_value_t)]
    pub fog_droplets: DropletsArg,
    /// Which light the fog scatters
    #[arg(long, value_enum, value_name = "WHICH", default_value_t)]
    pub fog_scattering: FogScatteringArg,
}
