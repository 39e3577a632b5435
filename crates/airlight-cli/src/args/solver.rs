//! Options for the solver.

use crate::parse::{self, put};
use airlight::models::registry;
use airlight::scene::{BaseBlueKind, Effort, Klassen1987Spec, SolverSpec, SunlightKind, WetHaze};
use airlight::sky::Scattering;
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{ArgAction, Args};

/// Options for the solver.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Solver")]
pub struct SolverArgs {
    /// Solver or published model [default: orders]
    #[arg(long, value_name = "NAME", value_parser = solvers())]
    pub solver: Option<String>,
    /// Wavelengths to compute: rgb (3), fast (8), standard (16), fine (95), 1nm (471), or a list in nm: 440,550,680 [default:
    /// fast for pictures in colour, standard for spectra]
    #[arg(long, value_name = "GRID|LIST")]
    pub wavelengths: Option<String>,
    /// Orders of scattering: all, or single scattering with the ground lit by direct sunlight [default: all]
    #[arg(long, value_name = "WHICH", value_parser = scattering())]
    pub scattering: Option<Scattering>,
    /// Resolution of the orders of scattering; the error of fine is below 0.5 %, in haze, dust and twilight as in clear air, and it
    /// is twenty times slower [default: standard]
    #[arg(long, value_parser = parse::named::<Effort>())]
    pub effort: Option<Effort>,
    /// Whether light is polarised by scattering: on or off, for the equations of scalar light as in most published tables, which
    /// are off by 1 to 3 % in clear skies [default: on]
    #[arg(long, value_name = "on|off", action = ArgAction::Set, value_parser = parse::on_off)]
    pub polarisation_correction: Option<bool>,
    /// Monte Carlo paths for each pixel [default: 256] or direction [default: 65536], 128 or above
    #[arg(long, value_name = "N")]
    pub paths: Option<u64>,
    /// Seed of the Monte Carlo paths: the same seed gives the same picture [default: 1]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Variant of a published model: printed (as published, with errors), corrected, and for single-scattering printed-f64,
    /// table and multiple [default: corrected]
    #[arg(long, value_name = "FORM", help_heading = "Published models")]
    pub variant: Option<String>,
    /// single-scattering: sunlight that is white on the ground with the sun at the zenith, as printed, or as measured outside
    /// the air [default: white]
    #[arg(long, value_name = "COLOUR", help_heading = "Published models")]
    #[arg(value_parser = parse::named::<SunlightKind>())]
    pub sunlight: Option<SunlightKind>,
    /// single-scattering: illuminance by a white sun at the zenith, lx; 6.2832 for colours of about 1 [default: 120000]
    #[arg(long, value_name = "LX", value_parser = parse::positive, help_heading = "Published models")]
    pub zenith_lux: Option<f64>,
    #[command(flatten)]
    pub klassen: KlassenArgs,
}

/// Settings of klassen1987.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Published models")]
pub struct KlassenArgs {
    /// klassen1987: extinction of the haze at 550 nm, 1/m [default: that of the atmosphere's haze at the ground]
    #[arg(long, value_name = "1/M", value_parser = parse::not_negative)]
    pub haze_extinction_per_m: Option<f64>,
    /// klassen1987: thickness of the haze, m [default: the one that preserves the haze's optical depth]
    #[arg(long, value_name = "M", value_parser = parse::positive)]
    pub haze_thickness_m: Option<f64>,
    /// klassen1987: water drops of the haze, of Deirmendjian's distributions for marine (haze-m), continental (haze-l) or high
    /// (haze-h) haze [default: particles of the atmosphere's haze]
    #[arg(long, value_name = "KIND", value_parser = parse::named::<WetHaze>())]
    pub wet_haze: Option<WetHaze>,
    /// klassen1987: density of the air relative to the atmosphere's [default: 1]
    #[arg(long, value_name = "FACTOR", value_parser = parse::positive)]
    pub air_density: Option<f64>,
    /// klassen1987: thickness of the air at its density at the ground, m [default: the one that preserves its optical depth]
    #[arg(long, value_name = "M", value_parser = parse::positive)]
    pub air_thickness_m: Option<f64>,
    /// klassen1987: sky behind the haze, the paper's constant blue or the solved sky [default: solver; paper with --variant
    /// printed]
    #[arg(long, value_name = "WHICH", value_parser = parse::named::<BaseBlueKind>())]
    pub base_blue: Option<BaseBlueKind>,
}

impl SolverArgs {
    /// Overrides values of a scene.
    pub fn fill(&self, solver: &mut SolverSpec) {
        put(&mut solver.name, &self.solver);
        put(&mut solver.wavelengths, &self.wavelengths);
        put(&mut solver.scattering, &self.scattering);
        put(&mut solver.effort, &self.effort);
        let polarisation = &self.polarisation_correction;
        put(&mut solver.polarisation_correction, polarisation);
        put(&mut solver.paths, &self.paths);
        put(&mut solver.seed, &self.seed);
        put(&mut solver.variant, &self.variant);
        put(&mut solver.sunlight, &self.sunlight);
        put(&mut solver.zenith_lux, &self.zenith_lux);
        self.klassen.fill(&mut solver.klassen1987);
    }
}

impl KlassenArgs {
    fn fill(&self, spec: &mut Klassen1987Spec) {
        put(&mut spec.haze_extinction_per_m, &self.haze_extinction_per_m);
        put(&mut spec.haze_thickness_m, &self.haze_thickness_m);
        put(&mut spec.wet_haze, &self.wet_haze);
        put(&mut spec.air_density, &self.air_density);
        put(&mut spec.air_thickness_m, &self.air_thickness_m);
        put(&mut spec.base_blue, &self.base_blue);
    }
}

/// Parser of the names of solvers and published models.
fn solvers() -> PossibleValuesParser {
    let values = registry::ALL.iter();
    PossibleValuesParser::new(
        values.map(|model| PossibleValue::new(model.name()).help(model.summary())),
    )
}

fn scattering() -> impl clap::builder::TypedValueParser<Value = Scattering> {
    use clap::builder::TypedValueParser;
    PossibleValuesParser::new(["all", "single"]).map(|name| match name.as_str() {
        "single" => Scattering::Single,
        _ => Scattering::All,
    })
}
