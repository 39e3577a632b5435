//! Why a command ends before its time, and with which exit code.

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

/// Why a command ends before its time.
#[derive(Debug, PartialEq, Eq)]
pub enum CliError {
    /// What was asked for makes no sense; the sentence says what would.
    Usage(String),
    /// It made sense and failed.
    Failure(String),
    /// The user stopped it.
    Interrupted,
    /// Whoever read standard output has gone: no failure of this program's.
    ReaderGone,
}

impl CliError {
    /// What was asked for makes no sense.
    pub fn usage(sentence: impl Into<String>) -> Self {
        Self::Usage(sentence.into())
    }

    /// It failed.
    pub fn failure(sentence: impl Into<String>) -> Self {
        Self::Failure(sentence.into())
    }

    /// What to say on standard error, if anything.
    pub fn sentence(&self) -> Option<&str> {
        match self {
            Self::Usage(sentence) | Self::Failure(sentence) => Some(sentence),
            Self::Interrupted => Some("stopped; no unfinished file was left behind"),
            Self::ReaderGone => None,
        }
    }

    /// 2 for bad use, 1 for failure, 130 after Ctrl-C (as shells have it).
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Failure(_) => 1,
            Self::Interrupted => 130,
            Self::ReaderGone => 0,
        }
    }

    /// What standard output said.
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
            ImageError::Size { .. }
            | ImageError::Setting { .. }
            | ImageError::UnknownFormat { .. } => Self::usage(error.to_string()),
            _ => Self::failure(error.to_string()),
        }
    }
}

impl From<RenderError> for CliError {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Scene(error) => error.into(),
            error if error.is_cancelled() => Self::Interrupted,
            error if error.is_refusal() => Self::usage(error.to_string()),
            error => Self::failure(error.to_string()),
        }
    }
}

impl From<BatchError> for CliError {
    fn from(error: BatchError) -> Self {
        match (error.is_cancelled(), error.is_refusal()) {
            (true, _) => Self::Interrupted,
            (_, true) => Self::usage(error.to_string()),
            _ => Self::failure(error.to_string()),
        }
    }
}

impl From<PlotError> for CliError {
    fn from(error: PlotError) -> Self {
        Self::failure(error.to_string())
    }
}

/// These are refusals of what was asked for.
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
    /// In the words of the command line: flags for the keys of a scene.
    fn from(error: SceneError) -> Self {
        if error.is_cancelled() {
            return Self::Interrupted;
        }
        let mut sentence = error.to_string();
        if error.key().is_some_and(|key| key.starts_with("sun")) {
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

/// Flags for the keys of the sun that sentences suggest, the longer ones first.
const SUN_FLAGS: [(&str, &str); 4] = [
    (
        "latitude_deg and longitude_deg with time",
        "--at LAT,LON with --when TIME",
    ),
    ("elevation_deg = 10", "--sun-elevation 10"),
    ("elevation_deg", "--sun-elevation"),
    ("azimuth_deg", "--sun-azimuth"),
];

/// The flag that fills in a key of a scene.
fn flag(key: &str) -> String {
    let known = match key {
        "sun" => "--sun-elevation",
        "sun.elevation_deg" => "--sun-elevation",
        "sun.azimuth_deg" => "--sun-azimuth",
        "sun.latitude_deg" | "sun.longitude_deg" => "--at",
        "sun.time" => "--when",
        "observer" => "--altitude-m and --eye-height-m",
        "air.aerosol, humidity, aod_550, turbidity and haze_visibility_m" => {
            "--aerosol, --humidity, --aod-550, --turbidity and --haze-visibility-m"
        }
        "fog" => "--visibility-m",
        "fog.profile" => "--fog-profile",
        "fog.scattering" => "--fog-scattering",
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
    fn codes_tell_bad_use_from_failure() {
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
