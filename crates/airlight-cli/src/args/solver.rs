//! Options for how the light is solved for.

use crate::parse::{self, put};
use airlight::models::registry;
use airlight::scene::{BaseBlueKind, Effort, Klassen1987Spec, SolverSpec, SunlightKind, WetHaze};
use airlight::sky::Scattering;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};

/// How the light is solved for.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Solver")]
pub struct SolverArgs {
    /// Solver or published model [default: orders]
    #[arg(long, value_name = "NAME", value_parser = solvers())]
    pub solver: Option<String>,
    /// Wavelengths to compute: rgb (3), fast (8), standard (16), fine (95), 1nm (471), or a list in nm: 440,550,680 [default:
    /// standard]
    #[arg(long, value_name = "GRID|LIST")]
    pub wavelengths: Option<String>,
    /// Which light is computed: all orders of scattering, or sunlight scattered once with the ground lit by the sun alone
    /// [default: all]
    #[arg(long, value_name = "WHICH", value_parser = scattering())]
    pub scattering: Option<Scattering>,
    /// How finely orders of scattering are solved; fine is within 1 % by day in haze as in clear air (dust under a sun at the
    /// horizon: 4 %), and takes five times as long [default: standard]
    #[arg(long, value_parser = parse::named::<Effort>())]
    pub effort: Option<Effort>,
    /// Monte Carlo paths for each pixel [default: 256] or direction [default: 65536], 128 or above
    #[arg(long, value_name = "N")]
    pub paths: Option<u64>,
    /// Seed of the Monte Carlo paths: the same seed gives the same picture [default: 1]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Form of a published model that has several: printed (as published, with its mistakes), corrected, and for
    /// single-scattering printed-f64, table and multiple [default: corrected]
    #[arg(long, value_name = "FORM", help_heading = "Published models")]
    pub variant: Option<String>,
    /// single-scattering: sunlight white on the ground when it stands in the zenith, as printed, or as measured outside the
    /// air [default: white]
    #[arg(long, value_name = "COLOUR", help_heading = "Published models")]
    #[arg(value_parser = parse::named::<SunlightKind>())]
    pub sunlight: Option<SunlightKind>,
    /// single-scattering: illuminance by a white sun in the zenith, lx; 6.2832 for colours about 1 [default: 120000]
    #[arg(long, value_name = "LX", value_parser = parse::positive, help_heading = "Published models")]
    pub zenith_lux: Option<f64>,
    #[command(flatten)]
    pub klassen: KlassenArgs,
}

/// Settings of the model of 1987.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Published models")]
pub struct KlassenArgs {
    /// klassen1987: extinction of its haze at 550 nm, 1/m [default: that of the atmosphere's haze at the ground]
    #[arg(long, value_name = "1/M", value_parser = parse::not_negative)]
    pub haze_extinction_per_m: Option<f64>,
    /// klassen1987: thickness of its haze, m [default: that which gives the atmosphere's optical depth of haze]
    #[arg(long, value_name = "M", value_parser = parse::positive)]
    pub haze_thickness_m: Option<f64>,
    /// klassen1987: its haze consists of Deirmendjian's drops by the sea (haze-m), over land (haze-l) or aloft (haze-h)
    /// [default: the atmosphere's haze]
    #[arg(long, value_name = "KIND", value_parser = parse::named::<WetHaze>())]
    pub wet_haze: Option<WetHaze>,
    /// klassen1987: density of its air over the atmosphere's [default: 1]
    #[arg(long, value_name = "FACTOR", value_parser = parse::positive)]
    pub air_density: Option<f64>,
    /// klassen1987: thickness of its air were it all as dense as at the ground, m [default: that which gives the atmosphere's]
    #[arg(long, value_name = "M", value_parser = parse::positive)]
    pub air_thickness_m: Option<f64>,
    /// klassen1987: the sky behind its haze, the paper's constant blue or solved for [default: solver; paper with --variant
    /// printed]
    #[arg(long, value_name = "WHICH", value_parser = parse::named::<BaseBlueKind>())]
    pub base_blue: Option<BaseBlueKind>,
}

impl SolverArgs {
    /// Overrides what a scene has.
    pub fn fill(&self, solver: &mut SolverSpec) {
        put(&mut solver.name, &self.solver);
        put(&mut solver.wavelengths, &self.wavelengths);
        put(&mut solver.scattering, &self.scattering);
        put(&mut solver.effort, &self.effort);
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

/// The names of the registry.
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
