//! [`CliError`]: errors of commands and their exit codes.

use airlight::UnknownName;
use airlight::atmosphere::{AerosolError, AtmosphereError};
use airlight::optics::mie::MieError;
use airlight::scene::SceneError;
use airlight::sky::SkyError;
use airlight::spectrum::GridError;
use airlight::sun::EphemerisError;
use airlight_image::ImageError;
use airlight_plot::PlotError;
use airlight_render::RenderError;
use airlight_render::batch::BatchError;
use std::io;

/// Error or early end of a command.
#[derive(Debug, PartialEq, Eq)]
pub enum CliError {
    /// An invalid request, with a complete message.
    Usage(String),
    /// A valid request that failed, with a complete message.
    Failure(String),
    /// The user interrupted the command.
    Interrupted,
    /// The reader of standard output has closed it, which is not an error of this program.
    ReaderGone,
}

impl CliError {
    /// An invalid request.
    pub fn usage(sentence: impl Into<String>) -> Self {
        Self::Usage(sentence.into())
    }

    /// A failure.
    pub fn failure(sentence: impl Into<String>) -> Self {
        Self::Failure(sentence.into())
    }

    /// Message for standard error, if any.
    pub fn sentence(&self) -> Option<&str> {
        match self {
            Self::Usage(sentence) | Self::Failure(sentence) => Some(sentence),
            Self::Interrupted => Some("stopped; unfinished files were removed"),
            Self::ReaderGone => None,
        }
    }

    /// Exit code: 2 for an invalid request, 1 for a failure, 130 after Ctrl-C (as in shells).
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Failure(_) => 1,
            Self::Interrupted => 130,
            Self::ReaderGone => 0,
        }
    }

    /// Converts an error of standard output.
    pub fn from_stdout(error: &io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::ReaderGone,
            _ => Self::failure(format!("cannot write to standard output: {error}")),
        }
    }
}

impl From<ImageError> for CliError {
    fn from(error: ImageError) -> Self {
        match error {
            ImageError::Cancelled => Self::Interrupted,
            // Pictures that are read are recognised by their contents.
            ImageError::UnknownFormat { .. } => Self::usage(format!("--output: {error}")),
            ImageError::Setting { what, .. } if what.contains("field of view") => {
                Self::usage(format!("--fov: {error}"))
            }
            ImageError::Size { .. } | ImageError::Setting { .. } => Self::usage(error.to_string()),
            _ => Self::failure(error.to_string()),
        }
    }
}

impl From<RenderError> for CliError {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Scene(error) => error.into(),
            RenderError::Image(error) => error.into(),
            error if error.is_cancelled() => Self::Interrupted,
            error if error.is_refusal() => Self::usage(error.to_string()),
            error => Self::failure(error.to_string()),
        }
    }
}

impl From<BatchError> for CliError {
    fn from(error: BatchError) -> Self {
        match error {
            BatchError::Render(error) => error.into(),
            error if error.is_cancelled() => Self::Interrupted,
            error if error.is_refusal() => Self::usage(error.to_string()),
            error => Self::failure(error.to_string()),
        }
    }
}

impl From<PlotError> for CliError {
    fn from(error: PlotError) -> Self {
        Self::failure(error.to_string())
    }
}

/// Converts errors that are invalid requests.
macro_rules! refusals {
    ($($kind:ty),*) => {$(
        impl From<$kind> for CliError {
            fn from(error: $kind) -> Self {
                Self::usage(error.to_string())
            }
        }
    )*};
}

refusals!(
    AerosolError,
    AtmosphereError,
    EphemerisError,
    GridError,
    MieError,
    SkyError,
    UnknownName
);

impl From<SceneError> for CliError {
    /// Replaces keys of a scene by command-line flags.
    fn from(error: SceneError) -> Self {
        if error.is_cancelled() {
            return Self::Interrupted;
        }
        let mut sentence = error.to_string();
        if error
            .key()
            .is_some_and(|key| key.starts_with("sun") || key.starts_with("night"))
        {
            for (keys, flags) in SUN_FLAGS {
                sentence = sentence.replace(keys, flags);
            }
        }
        Self::Usage(match error.key() {
            Some(key) => match sentence.strip_prefix(key) {
                Some(rest) => format!("{}{rest}", flag(key)),
                None => sentence,
            },
            None => sentence,
        })
    }
}

/// Flags for keys of sun and moon in messages, the longest first.
const SUN_FLAGS: [(&str, &str); 6] = [
    (
        "latitude_deg and longitude_deg with time",
        "--at LAT,LON with --when TIME",
    ),
    ("moon_elevation_deg = 30", "--moon-elevation 30"),
    ("moon_elevation_deg", "--moon-elevation"),
    ("elevation_deg = 10", "--sun-elevation 10"),
    ("elevation_deg", "--sun-elevation"),
    ("azimuth_deg", "--sun-azimuth"),
];

/// The flag that sets a key of a scene.
pub fn flag(key: &str) -> String {
    let known = match key {
        "sun" => "--sun-elevation",
        "sun.elevation_deg" => "--sun-elevation",
        "sun.azimuth_deg" => "--sun-azimuth",
        "sun.latitude_deg" | "sun.longitude_deg" => "--at",
        "sun.time" => "--when",
        "night" => "--night, --moon, --stars, --solar-flux and --sky-quality",
        "night.lights" => "--night",
        "night.moon_elevation_deg" => "--moon-elevation",
        "night.moon_azimuth_deg" => "--moon-azimuth",
        "night.moon_phase_deg" => "--moon-phase",
        "night.solar_flux_sfu" => "--solar-flux",
        "night.sky_quality_mag" => "--sky-quality",
        "night.latitude_deg" => "--star-latitude",
        "observer" => "--altitude-m and --eye-height-m",
        "air.aerosol, humidity, aod_550, turbidity and haze_visibility_m" => {
            "--aerosol, --humidity, --aod-550, --turbidity and --haze-visibility-m"
        }
        "fog" => "--visibility-m",
        "fog.profile" => "--fog-profile",
        "fog.scattering" => "--fog-scattering",
        "fog.patches" => "--patch-strength",
        "fog.patches.strength" => "--patch-strength",
        "fog.patches.size_m" => "--patch-size-m",
        "fog.patches.height_m" => "--patch-height-m",
        "fog.patches.wind_m_s" => "--patch-wind",
        "fog.patches.time_s" => "--patch-time-s",
        "objects.shadows" => "--no-shadows",
        "objects.file" => "--objects",
        "solver.name" => "--solver",
        "solver.paths and solver.seed" => "--paths and --seed",
        "solver.sunlight and solver.zenith_lux" => "--sunlight and --zenith-lux",
        "solver.klassen1987" => {
            "--haze-extinction-per-m, --haze-thickness-m, --wet-haze, --air-density, --air-thickness-m and --base-blue"
        }
        "camera.azimuth_deg" => "--camera-azimuth",
        "camera.elevation_deg" => "--camera-elevation",
        "camera.roll_deg" => "--camera-roll",
        "camera.fov_deg" => "--fov",
        "output.file" => "--output",
        "output.white_balance_k" => "--white-balance",
        _ => "",
    };
    match (known, key.strip_prefix("fog.layers")) {
        ("", None) => {
            let name = key.rsplit('.').next().unwrap_or(key);
            format!("--{}", name.replace('_', "-"))
        }
        ("", Some(_)) => "--layer".to_owned(),
        (known, _) => known.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exit_codes_distinguish_invalid_requests_from_failures() {
        let size = ImageError::Size {
            width: 0,
            height: 0,
        };
        assert_eq!(CliError::from(size).exit_code(), 2);
        let missing = ImageError::NoFolder {
            path: "a/b".into(),
            folder: "a".into(),
        };
        assert_eq!(CliError::from(missing).exit_code(), 1);
        assert_eq!(CliError::from(ImageError::Cancelled).exit_code(), 130);
        let pipe = io::Error::from(io::ErrorKind::BrokenPipe);
        assert_eq!(CliError::from_stdout(&pipe), CliError::ReaderGone);
        assert_eq!(CliError::ReaderGone.exit_code(), 0);
    }
}
