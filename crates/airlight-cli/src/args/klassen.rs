//! Options of the model of 1987.

use crate::parse;
use airlight::models::klassen1987::{BaseBlue, Haze, Klassen1987Settings};
use airlight::optics::mie::droplets::Drops;
use clap::{Args, ValueEnum};

/// The sky behind the haze.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BaseBlueArg {
    /// One constant blue, dimmed to a hundredth from noon to sunset.
    Paper,
    /// The air without haze, solved for.
    Solver,
}

/// Kinds of wet haze.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum WetHazeArg {
    /// Deirmendjian's haze M: by the sea.
    HazeM,
    /// Deirmendjian's haze L: over land.
    HazeL,
    /// Deirmendjian's haze H: aloft.
    HazeH,
}

/// Options of the model of 1987.
#[derive(Clone, Debug, Default, PartialEq, Args)]
#[command(next_help_heading = "Published models")]
pub struct KlassenArgs {
    /// klassen1987: extinction of its haze at 550 nm, 1/m [default: that of the atmosphere's haze at the ground]
    #[arg(long, value_name = "1/M", value_parser = parse::not_negative)]
    pub haze_extinction_per_m: Option<f64>,
    /// klassen1987: height of its haze, m [default: that which makes the atmosphere's optical depth of haze]
    #[arg(long, value_name = "M", value_parser = parse::positive)]
    pub haze_thickness_m: Option<f64>,
    /// klassen1987: its haze is of water drops of this kind [default: the atmosphere's haze]
    #[arg(long, value_enum, value_name = "KIND")]
    pub wet_haze: Option<WetHazeArg>,
    /// klassen1987: density of its air over the atmosphere's
    #[arg(long, value_name = "FACTOR", value_parser = parse::positive)]
    pub air_density: Option<f64>,
    /// klassen1987: height of its air were it all as dense as at the ground, m [default: that which makes the atmosphere's]
    #[arg(long, value_name = "M", value_parser = parse::positive)]
    pub air_thickness_m: Option<f64>,
    /// klassen1987: the sky behind its haze [default: solver; paper with --variant printed]
    #[arg(long, value_enum)]
    pub base_blue: Option<BaseBlueArg>,
}

impl KlassenArgs {
    /// Whether one was given.
    pub fn given(&self) -> bool {
        *self != Self::default()
    }

    /// Puts what was given in place of what the atmosphere has.
    pub fn apply(&self, settings: &mut Klassen1987Settings) {
        let put = |value: &mut f64, given: Option<f64>| *value = given.unwrap_or(*value);
        put(
            &mut settings.haze_extinction_per_m,
            self.haze_extinction_per_m,
        );
        put(&mut settings.haze_thickness_m, self.haze_thickness_m);
        put(&mut settings.air_density, self.air_density);
        put(&mut settings.air_thickness_m, self.air_thickness_m);
        if let Some(kind) = self.wet_haze {
            settings.haze = Haze::Drops(match kind {
                WetHazeArg::HazeM => Drops::HazeM,
                WetHazeArg::HazeL => Drops::HazeL,
                WetHazeArg::HazeH => Drops::HazeH,
            });
        }
        match self.base_blue {
            Some(BaseBlueArg::Paper) => settings.base_blue = BaseBlue::PAPER,
            Some(BaseBlueArg::Solver) => settings.base_blue = BaseBlue::Solver,
            None => {}
        }
    }
}
