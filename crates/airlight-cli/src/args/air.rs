//! Options for gases, haze and ground, and for `airlight atmospheres`, which lists their names.

use crate::parse::{self, put};
use airlight::Named;
use airlight::atmosphere::{AerosolType, Preset};
use airlight::scene::AirSpec;
use clap::Args;

/// Gases, haze and ground.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Air")]
pub struct AirArgs {
    /// Atmosphere: a name (see --help or `airlight atmospheres`) or a TOML file [default: average]
    #[arg(long, value_name = "NAME|FILE.toml", long_help = atmosphere_help())]
    pub atmosphere: Option<String>,
    /// Haze of a published type (see --help or `airlight atmospheres`), or a mixture: urban:0.7,desert:0.3
    #[arg(long, value_name = "TYPE", long_help = aerosol_help())]
    pub aerosol: Option<String>,
    /// Relative humidity that determines the size of the particles of --aerosol, 0 to 0.99 [default: 0.8]
    #[arg(long, value_name = "SHARE", value_parser = parse::number)]
    pub humidity: Option<f64>,
    /// Optical depth of the haze (aerosol) at 550 nm: 0.05 clear, 0.12 average, 0.35 hazy
    #[arg(long, value_name = "DEPTH", value_parser = parse::not_negative, group = "haze")]
    pub aod_550: Option<f64>,
    /// Haze as turbidity at 550 nm: optical depth of air and haze relative to that of the air; 1 is air without haze
    #[arg(long, value_name = "RATIO", value_parser = parse::positive, group = "haze")]
    pub turbidity: Option<f64>,
    /// Haze as visibility at the ground, m: the distance at which contrast falls to --contrast at 550 nm
    #[arg(long, value_name = "M", value_parser = parse::positive, group = "haze")]
    pub haze_visibility_m: Option<f64>,
    /// Ozone column, Dobson units [default: the atmosphere's, 300 on the Earth]
    #[arg(long, value_name = "DU", value_parser = parse::not_negative)]
    pub ozone_du: Option<f64>,
    /// Albedo of the ground at all wavelengths, 0 to 1 [default: the atmosphere's]
    #[arg(long, value_name = "ALBEDO", value_parser = parse::fraction)]
    pub ground_albedo: Option<f64>,
    /// Altitude of the ground above sea level, m [default: 0, or --altitude-m if that is lower]
    #[arg(long, value_name = "M", value_parser = parse::altitude_m)]
    pub ground_altitude_m: Option<f64>,
}

impl AirArgs {
    /// Overrides values of a scene.
    pub fn fill(&self, air: &mut AirSpec) {
        if self.atmosphere.is_some() {
            (air.atmosphere, air.atmosphere_toml) = (self.atmosphere.clone(), None);
        }
        put(&mut air.aerosol, &self.aerosol);
        put(&mut air.humidity, &self.humidity);
        if self
            .aod_550
            .or(self.turbidity)
            .or(self.haze_visibility_m)
            .is_some()
        {
            air.aod_550 = self.aod_550;
            air.turbidity = self.turbidity;
            air.haze_visibility_m = self.haze_visibility_m;
        }
        put(&mut air.ozone_du, &self.ozone_du);
        put(&mut air.ground_albedo, &self.ground_albedo);
        put(&mut air.ground_altitude_m, &self.ground_altitude_m);
    }
}

/// Options of `airlight atmospheres`.
#[derive(Debug, Args)]
pub struct AtmospheresArgs {
    /// Atmosphere (name or TOML file) or type of haze to describe [default: list all]
    #[arg(value_name = "NAME|FILE.toml")]
    pub atmosphere: Option<String>,
}

/// Help of `--atmosphere`: all presets with their descriptions.
fn atmosphere_help() -> String {
    let names: String = Preset::ALL
        .iter()
        .map(|preset| format!("\n- {preset}: {}", preset.summary()))
        .collect();
    format!("Atmosphere: one of these names, or a TOML file\n{names}\n")
}

/// Help of `--aerosol`: all types with their descriptions.
fn aerosol_help() -> String {
    let names: String = AerosolType::ALL
        .iter()
        .map(|kind| format!("\n- {kind}: {}", kind.summary()))
        .collect();
    format!(
        "Haze of a published type instead of the atmosphere's, or a mixture by shares of the extinction (urban:0.7,desert:0.3). The default amount is that published\n{names}\n"
    )
}
