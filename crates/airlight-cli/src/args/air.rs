//! Options that say what the air is and how its light is solved for.

use crate::error::CliError;
use crate::parse::name;
use crate::{aerosol, atmosphere, parse};
use airlight::monte_carlo::{MonteCarloSettings, SunShape};
use clap::{Args, ValueEnum};

/// Which light is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ScatteringArg {
    /// All orders of scattering and reflection.
    All,
    /// Sunlight scattered once, and the ground lit by the sun alone.
    Single,
}

/// How light is solved for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SolverArg {
    /// Successive orders of scattering on the sphere: the fast solver, without noise.
    Orders,
    /// Random paths: no approximation, slow, with noise whose size is told.
    MonteCarlo,
    /// Klassen 1987: two layers of haze and air, sunlight scattered once by the haze, before a blue sky.
    #[value(name = "klassen1987")]
    Klassen1987,
    /// Preetham, Shirley & Smits 1999: a formula by turbidity, for the sun above the horizon.
    Preetham,
    /// Bruneton & Neyret 2008: the first four orders of scattering.
    #[value(name = "bruneton2008")]
    Bruneton2008,
    /// Hosek & Wilkie 2012: a formula by turbidity and ground albedo (in builds with the feature hosek-wilkie).
    HosekWilkie,
    /// Hillaire 2020: few steps and two small tables, in the air of --atmosphere.
    #[value(name = "hillaire2020")]
    Hillaire2020,
    /// The sky article: sunlight scattered once, in its own air, and the steps beyond it (--variant).
    SingleScattering,
}

impl SolverArg {
    /// Whether it is a published model of the sky.
    pub fn is_published_model(self) -> bool {
        !matches!(self, Self::Orders | Self::MonteCarlo)
    }

    /// Whether it finds spectra, and not colours only.
    pub fn has_spectra(self) -> bool {
        !matches!(
            self,
            Self::Preetham | Self::HosekWilkie | Self::SingleScattering
        )
    }

    /// Whether it knows what light is scattered before a thing at a distance.
    pub fn has_distances(self) -> bool {
        self.has_spectra() && self != Self::Klassen1987
    }

    /// Its name on the command line.
    pub fn name(self) -> String {
        name(&self)
    }

    /// The names of all that something holds for.
    pub fn names(holds: fn(Self) -> bool) -> String {
        let all = Self::value_variants()
            .iter()
            .filter(|solver| holds(**solver));
        all.map(name).collect::<Vec<_>>().join(", ")
    }
}

/// How finely the orders of scattering are solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum EffortArg {
    /// By day within 1 % in clear air (1.4 % under a sun at the horizon), 3 % in haze.
    Standard,
    /// Twice the heights, more directions and moments.
    Fine,
}

/// What the air is and how its light is solved for.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Air")]
pub struct AirArgs {
    /// The atmosphere: a name (see --help or `airlight atmospheres`) or a TOML file
    #[arg(long, value_name = "NAME|FILE.toml", default_value = "average", long_help = atmosphere::option_help())]
    pub atmosphere: String,
    /// Haze of a published type (see --help or `airlight atmospheres`), or a mixture: urban:0.7,desert:0.3
    #[arg(long, value_name = "TYPE", long_help = aerosol::option_help())]
    pub aerosol: Option<String>,
    /// Relative humidity that the particles of --aerosol have grown in, 0 to 0.99 [default: 0.8]
    #[arg(long, value_name = "SHARE", value_parser = parse::number, requires = "aerosol")]
    pub humidity: Option<f64>,
    /// Optical depth of the haze (aerosol) at 550 nm: 0.05 clear, 0.12 average, 0.35 hazy
    #[arg(long, value_name = "DEPTH", value_parser = parse::not_negative, group = "haze")]
    pub aod_550: Option<f64>,
    /// Haze as turbidity at 550 nm: optical depth of air and haze over that of air; 1 is pure air
    #[arg(long, value_name = "RATIO", value_parser = parse::positive, group = "haze")]
    pub turbidity: Option<f64>,
    /// Haze as visibility at the ground, m: the distance at which 5 % of contrast is left at 550 nm
    #[arg(long, value_name = "M", value_parser = parse::positive, group = "haze")]
    pub visibility_m: Option<f64>,
    /// Contrast that --visibility-m means: 0.05 (meteorological optical range) or 0.02 (Koschmieder's visual range)
    #[arg(long, value_name = "C", default_value = "0.05", value_parser = ["0.05", "0.02"], requires = "visibility_m")]
    pub contrast: String,
    /// Ozone column, Dobson units (the Earth's atmospheres by default: 300)
    #[arg(long, value_name = "DU", value_parser = parse::not_negative)]
    pub ozone_du: Option<f64>,
    /// Albedo of the ground, 0 to 1, the same at all wavelengths
    #[arg(long, value_name = "ALBEDO", value_parser = parse::fraction)]
    pub ground_albedo: Option<f64>,
    /// Altitude of the ground above sea level, m [default: 0, or --altitude-m where that is lower]
    #[arg(long, value_name = "M", value_parser = parse::altitude_m)]
    pub ground_altitude_m: Option<f64>,
    /// Wavelengths to compute: rgb (3), fast (8), standard (16), fine (95), 1nm (471), or a list in nm: 440,550,680
    #[arg(long, value_name = "GRID|LIST", default_value = "standard")]
    pub wavelengths: String,
    /// Which light is computed
    #[arg(long, value_enum, default_value_t = ScatteringArg::All)]
    pub scattering: ScatteringArg,
    /// How light is solved for
    #[arg(long, value_enum, default_value_t = SolverArg::Orders)]
    pub solver: SolverArg,
    /// How finely --solver orders solves: fine is within 1 % by day in haze as in clear air (dust under a sun at the horizon: 4 %), and takes five times as long
    #[arg(long, value_enum, default_value_t = EffortArg::Standard)]
    pub effort: EffortArg,
    /// Random paths for each pixel [default: 256] or view [default: 65536]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(128..=1_000_000_000_000))]
    pub paths: Option<u64>,
    /// Seed of the random paths: the same seed gives the same picture, another one other noise [default: 1]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Threads to compute with [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub threads: Option<u32>,
}

impl AirArgs {
    /// Refuses any solver but the fast one.
    ///
    /// # Errors
    /// [`CliError::Usage`] where another is asked for.
    pub fn refuse_other_solvers(&self, command: &str) -> Result<(), CliError> {
        self.monte_carlo(1)?;
        match self.solver {
            SolverArg::Orders => Ok(()),
            _ => Err(CliError::usage(format!(
                "{command} solves by orders of scattering: leave out --solver"
            ))),
        }
    }

    /// The Monte Carlo's settings, `paths` where nothing is said; `None` where another solver is asked for.
    ///
    /// # Errors
    /// [`CliError::Usage`] for its options without it.
    pub fn monte_carlo(&self, paths: u64) -> Result<Option<MonteCarloSettings>, CliError> {
        match self.solver {
            SolverArg::MonteCarlo => Ok(Some(MonteCarloSettings {
                paths: self.paths.unwrap_or(paths),
                seed: self.seed.unwrap_or(1),
                sun: SunShape::Disc,
            })),
            _ if self.paths.is_some() || self.seed.is_some() => Err(CliError::usage(
                "--paths and --seed are for random paths: give --solver monte-carlo as well",
            )),
            _ => Ok(None),
        }
    }
}
