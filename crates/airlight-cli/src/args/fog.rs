//! Options that say what fog lies in the air.

use crate::parse;
use crate::report::short;
use airlight::fog::FogScattering;
use airlight::fog::droplets::DropletKind;
use airlight::optics::mie::droplets::Drops;
use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use serde::Serialize;
use std::sync::LazyLock;

/// Kinds of fog by their drops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DropletsArg(pub DropletKind);

impl ValueEnum for DropletsArg {
    fn value_variants<'a>() -> &'a [Self] {
        static ALL: LazyLock<Vec<DropletsArg>> = LazyLock::new(|| {
            DropletKind::all()
                .map(|(_, kind)| DropletsArg(kind))
                .collect()
        });
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let value = PossibleValue::new(self.0.name()).help(in_words(self.0));
        Some(match self.0 {
            DropletKind::Published(Drops::ModerateRadiationFog) => value.alias("mist"),
            _ => value,
        })
    }
}

impl DropletsArg {
    /// Drops by their name.
    ///
    /// # Errors
    /// What names there are.
    pub fn parse(text: &str) -> Result<Self, String> {
        Self::from_str(text, false).map_err(|_| {
            let names: Vec<&str> = DropletKind::all().map(|(name, _)| name).collect();
            format!("knows no {text}: there are {}", names.join(", "))
        })
    }
}

impl Serialize for DropletsArg {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.0.name())
    }
}

/// Drops in words, by their size.
pub fn in_words(kind: DropletKind) -> String {
    match kind {
        DropletKind::Analytic(droplets) => {
            format!("grey, of {} um diameter", short(droplets.diameter_um()))
        }
        DropletKind::Isotropic => {
            "grey, the same in all directions: no drops do so, published models do".to_owned()
        }
        DropletKind::Published(drops) => {
            let sizes = drops.sizes();
            format!(
                "Lorenz-Mie theory, mode radius {} um, effective radius {} um",
                short(sizes.mode_radius_um()),
                short(sizes.effective_radius_um())
            )
        }
    }
}

/// Which light fog scatters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FogScatteringArg {
    /// Any number of times, between sky, sun and ground.
    #[default]
    All,
    /// Once: sunlight after its way through the fog, ambient light as if the fog did not dim it.
    Single,
    /// Once, and the fog does not dim the sun: Ishiyama's height fog as printed.
    Undimmed,
}

impl FogScatteringArg {
    /// In the fog's words.
    pub fn scattering(self) -> FogScattering {
        match self {
            Self::All => FogScattering::Multiple,
            Self::Single => FogScattering::Single,
            Self::Undimmed => FogScattering::Undimmed,
        }
    }

    /// In words, where it is not all light.
    pub fn in_words(self) -> Option<&'static str> {
        match self {
            Self::All => None,
            Self::Single => Some("light scattered once"),
            Self::Undimmed => Some("light scattered once, the sun not dimmed"),
        }
    }
}

/// What fog lies in the air. Heights are above the ground.
#[derive(Clone, Debug, Args)]
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
    #[arg(long, value_enum, value_name = "KIND", default_value_t)]
    pub fog_droplets: DropletsArg,
    /// Which light the fog scatters
    #[arg(long, value_enum, value_name = "WHICH", default_value_t)]
    pub fog_scattering: FogScatteringArg,
}
