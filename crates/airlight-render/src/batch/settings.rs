//! Settings of an overlay that can differ between the pictures of a batch.

use crate::overlay::OverlayScene;
use airlight::fog::FogScattering;
use airlight::fog::droplets::DropletKind;
use airlight::scene::{Exposure, FogPatchesSpec, FogProfile};
use airlight::{Named, UnknownName};
use std::str::FromStr;

/// A setting that can differ between pictures.
#[derive(Debug)]
pub(super) struct Setting {
    /// Name without unit.
    pub name: &'static str,
    /// Name on which its draws depend; it remains the same if the setting is renamed.
    pub stream: &'static str,
    pub kind: Kind,
    pub affects: Affects,
}

/// Values of a setting.
#[derive(Debug)]
pub(super) enum Kind {
    Number {
        /// Unit that may end the name.
        unit: &'static str,
        spacing: Spacing,
        domain: Domain,
        set: fn(&mut OverlayScene, f64),
    },
    Choice {
        names: fn() -> Vec<&'static str>,
        set: fn(&mut OverlayScene, &str),
    },
}

/// What a setting changes besides the fog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Affects {
    Fog,
    /// The solved sky.
    Sky,
    /// How the files are read.
    Files,
}

/// Distribution of values over a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Spacing {
    /// Uniform.
    Uniform,
    /// Uniform in the logarithm, so that all octaves are equally likely.
    Log,
}

/// Valid values of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Domain {
    Any,
    NotNegative,
    Positive,
    Fraction,
    Length,
    Elevation,
    MoonPhase,
    SolarFlux,
    SkyQuality,
    Altitude,
    FieldOfView,
    Contrast,
    PatchStrength,
    Quality,
    Whole,
}

impl Domain {
    /// Whether only whole numbers are valid.
    pub fn is_whole(self) -> bool {
        matches!(self, Self::Quality | Self::Whole)
    }

    fn contains(self, value: f64) -> bool {
        /// Whole numbers up to it are exact.
        const EXACT: f64 = (1u64 << 53) as f64;
        let is_whole = value.fract() == 0.0;
        match self {
            Self::Any => value.is_finite(),
            Self::NotNegative => value.is_finite() && value >= 0.0,
            Self::Positive => value.is_finite() && value > 0.0,
            Self::Fraction => (0.0..=1.0).contains(&value),
            Self::Length => value > 0.0 && value <= 1e9,
            Self::Elevation => (-90.0..=90.0).contains(&value),
            Self::MoonPhase => (0.0..=180.0).contains(&value),
            Self::SolarFlux => (50.0..=400.0).contains(&value),
            Self::SkyQuality => (14.0..=23.0).contains(&value),
            Self::Altitude => (-12e3..=1e9).contains(&value),
            Self::FieldOfView => value > 0.0 && value < 180.0,
            Self::Contrast => value == 0.05 || value == 0.02,
            Self::PatchStrength => (0.0..=2.0).contains(&value),
            Self::Quality => (1.0..=100.0).contains(&value) && is_whole,
            Self::Whole => (0.0..=EXACT).contains(&value) && is_whole,
        }
    }

    fn expected(self) -> &'static str {
        match self {
            Self::Any => "a number",
            Self::NotNegative => "a number, 0 or above",
            Self::Positive => "a number above 0",
            Self::Fraction => "a number from 0 to 1",
            Self::Length => "a number of metres above 0 and at most 1e9",
            Self::Elevation => "a number of degrees from -90 to 90",
            Self::MoonPhase => "a number of degrees from 0 (full) to 180 (new)",
            Self::SolarFlux => "a number of solar flux units from 50 to 400",
            Self::SkyQuality => "a number of magnitudes per square arcsecond from 14 to 23",
            Self::Altitude => "a number of metres from -12000 to 1e9",
            Self::FieldOfView => "a number of degrees above 0 and below 180",
            Self::Contrast => "0.05 or 0.02",
            Self::PatchStrength => "a number from 0 to 2",
            Self::Quality => "a whole number from 1 to 100",
            Self::Whole => "a whole number, 0 or above",
        }
    }

    /// Reads a number.
    ///
    /// # Errors
    /// What is valid, for another text.
    pub fn read(self, text: &str) -> Result<f64, String> {
        match f64::from_str(text.trim()) {
            Ok(value) if self.contains(value) => Ok(value),
            _ => Err(format!("expected {}, got `{text}`", self.expected())),
        }
    }
}

type Set = fn(&mut OverlayScene, f64);

const fn number(
    name: &'static str,
    unit: &'static str,
    (spacing, domain): (Spacing, Domain),
    affects: Affects,
    set: Set,
) -> Setting {
    Setting {
        name,
        stream: name,
        kind: Kind::Number {
            unit,
            spacing,
            domain,
            set,
        },
        affects,
    }
}

const LENGTH: (Spacing, Domain) = (Spacing::Log, Domain::Length);
const POSITIVE: (Spacing, Domain) = (Spacing::Log, Domain::Positive);

/// A number that may be 0, or an angle: uniform.
const fn even(domain: Domain) -> (Spacing, Domain) {
    (Spacing::Uniform, domain)
}

fn patches(scene: &mut OverlayScene) -> &mut FogPatchesSpec {
    scene.fog_mut().patches.get_or_insert_default()
}

/// Components of a colour or a point; those that nothing sets stay NaN, which the checks of a description refuse.
fn ambient(scene: &mut OverlayScene) -> &mut [f64; 3] {
    scene.overlay.ambient.get_or_insert([f64::NAN; 3])
}

fn principal_point(scene: &mut OverlayScene) -> &mut [f64; 2] {
    scene
        .overlay
        .principal_point_px
        .get_or_insert([f64::NAN; 2])
}

use Affects::{Files, Fog, Sky};
use Domain::{
    Altitude, Any, Contrast, Elevation, FieldOfView, Fraction, MoonPhase, NotNegative,
    PatchStrength, Quality, SkyQuality, SolarFlux, Whole,
};

/// Every setting that can differ.
pub(super) static SETTINGS: [Setting; 54] = [
    number("visibility", "m", LENGTH, Fog, |s, v| {
        s.fog_mut().visibility_m = Some(v)
    }),
    number("scale-height", "m", LENGTH, Fog, |s, v| {
        s.fog_mut().scale_height_m = Some(v)
    }),
    number("base-height", "m", even(Any), Fog, |s, v| {
        s.fog_mut().base_height_m = Some(v)
    }),
    number("top", "m", LENGTH, Fog, |s, v| s.fog_mut().top_m = Some(v)),
    number("contrast", "", even(Contrast), Sky, |s, v| {
        s.scene.air.contrast = Some(v)
    }),
    number("patch-strength", "", even(PatchStrength), Fog, |s, v| {
        patches(s).strength = Some(v)
    }),
    number("patch-size", "m", LENGTH, Fog, |s, v| {
        patches(s).size_m = Some(v)
    }),
    number("patch-height", "m", LENGTH, Fog, |s, v| {
        patches(s).height_m = Some(v)
    }),
    number("patch-seed", "", even(Whole), Fog, |s, v| {
        patches(s).seed = Some(v as u64)
    }),
    number("patch-time", "s", even(Any), Fog, |s, v| {
        patches(s).time_s = Some(v)
    }),
    number("patch-wind-east", "", even(Any), Fog, |s, v| {
        patches(s).wind_m_s.get_or_insert([0.0; 2])[0] = v
    }),
    number("patch-wind-north", "", even(Any), Fog, |s, v| {
        patches(s).wind_m_s.get_or_insert([0.0; 2])[1] = v
    }),
    number("eye-height", "m", LENGTH, Sky, |s, v| {
        s.scene.observer.eye_height_m = Some(v)
    }),
    number("camera-elevation", "deg", even(Elevation), Fog, |s, v| {
        s.scene.camera.elevation_deg = Some(v)
    }),
    number("camera-azimuth", "deg", even(Any), Fog, |s, v| {
        s.scene.camera.azimuth_deg = Some(v)
    }),
    number("camera-roll", "deg", even(Any), Fog, |s, v| {
        s.scene.camera.roll_deg = Some(v)
    }),
    number("fov", "deg", even(FieldOfView), Fog, |s, v| {
        s.scene.camera.fov_deg = Some(v)
    }),
    number("focal", "px", POSITIVE, Files, |s, v| {
        s.overlay.focal_px = Some(v)
    }),
    number("principal-point-x", "px", even(Any), Fog, |s, v| {
        principal_point(s)[0] = v
    }),
    number("principal-point-y", "px", even(Any), Fog, |s, v| {
        principal_point(s)[1] = v
    }),
    number("depth-scale", "", even(Any), Files, |s, v| {
        s.overlay.depth_scale = v
    }),
    number("depth-offset", "", even(Any), Files, |s, v| {
        s.overlay.depth_offset = Some(v)
    }),
    number("far", "m", LENGTH, Files, |s, v| s.overlay.far_m = Some(v)),
    number("baseline", "m", LENGTH, Files, |s, v| {
        s.overlay.baseline_m = Some(v)
    }),
    number("near-plane", "m", LENGTH, Files, |s, v| {
        s.overlay.near_plane_m = Some(v)
    }),
    number("far-plane", "m", LENGTH, Files, |s, v| {
        s.overlay.far_plane_m = Some(v)
    }),
    number("disparity-offset", "px", even(Any), Files, |s, v| {
        s.overlay.disparity_offset_px = v
    }),
    number("ambient-red", "", even(NotNegative), Files, |s, v| {
        ambient(s)[0] = v
    }),
    number("ambient-green", "", even(NotNegative), Files, |s, v| {
        ambient(s)[1] = v
    }),
    number("ambient-blue", "", even(NotNegative), Files, |s, v| {
        ambient(s)[2] = v
    }),
    number("ambient-scale", "", POSITIVE, Fog, |s, v| {
        s.overlay.ambient_scale = v
    }),
    number("sun-elevation", "deg", even(Elevation), Sky, |s, v| {
        s.scene.sun.elevation_deg = Some(v)
    }),
    number("sun-azimuth", "deg", even(Any), Sky, |s, v| {
        s.scene.sun.azimuth_deg = Some(v)
    }),
    number("moon-elevation", "deg", even(Elevation), Sky, |s, v| {
        s.scene.night.moon_elevation_deg = Some(v)
    }),
    number("moon-azimuth", "deg", even(Any), Sky, |s, v| {
        s.scene.night.moon_azimuth_deg = Some(v)
    }),
    number("moon-phase", "deg", even(MoonPhase), Sky, |s, v| {
        s.scene.night.moon_phase_deg = Some(v)
    }),
    number("solar-flux", "", even(SolarFlux), Sky, |s, v| {
        s.scene.night.solar_flux_sfu = Some(v)
    }),
    number("sky-quality", "", even(SkyQuality), Sky, |s, v| {
        s.scene.night.sky_quality_mag = Some(v)
    }),
    number("star-latitude", "deg", even(Elevation), Sky, |s, v| {
        s.scene.night.latitude_deg = Some(v)
    }),
    number("sun-strength", "", even(NotNegative), Fog, |s, v| {
        s.overlay.sun_strength = Some(v)
    }),
    number("ground-albedo", "", even(Fraction), Sky, |s, v| {
        s.scene.air.ground_albedo = Some(v)
    }),
    number("ground-altitude", "m", even(Altitude), Sky, |s, v| {
        s.scene.air.ground_altitude_m = Some(v)
    }),
    number("aod-550", "", even(NotNegative), Sky, |s, v| {
        s.scene.air.aod_550 = Some(v)
    }),
    number("haze-visibility", "m", POSITIVE, Sky, |s, v| {
        s.scene.air.haze_visibility_m = Some(v)
    }),
    number("radiance-scale", "", POSITIVE, Fog, |s, v| {
        s.overlay.radiance_scale = Some(v)
    }),
    number("quality", "", even(Quality), Fog, |s, v| {
        s.scene.output.quality = Some(v as u8)
    }),
    number("exposure", "", even(Any), Fog, |s, v| {
        s.scene.output.exposure = Some(Exposure::Ev100(v))
    }),
    number("brighten", "", even(Any), Fog, |s, v| {
        s.scene.output.brighten = Some(v)
    }),
    number("tone-contrast", "", even(NotNegative), Fog, |s, v| {
        s.scene.output.tone_contrast = Some(v)
    }),
    number("saturation", "", even(NotNegative), Fog, |s, v| {
        s.scene.output.saturation = Some(v)
    }),
    number("white-balance", "", POSITIVE, Fog, |s, v| {
        s.scene.output.white_balance_k = Some(v)
    }),
    choice("fog-profile", "model", names::<FogProfile>, |s, name| {
        s.fog_mut().profile = name.parse().ok()
    }),
    choice("droplets", "droplets", names::<DropletKind>, |s, name| {
        s.fog_mut().droplets = name.parse().ok()
    }),
    choice(
        "fog-scattering",
        "fog-scattering",
        names::<FogScattering>,
        |s, name| s.fog_mut().scattering = name.parse().ok(),
    ),
];

const fn choice(
    name: &'static str,
    stream: &'static str,
    names: fn() -> Vec<&'static str>,
    set: fn(&mut OverlayScene, &str),
) -> Setting {
    Setting {
        name,
        stream,
        kind: Kind::Choice { names, set },
        affects: Fog,
    }
}

fn names<T: Named>() -> Vec<&'static str> {
    T::ALL.iter().map(|value| value.name()).collect()
}

impl Setting {
    /// The setting with a name, which may end in its unit.
    ///
    /// # Errors
    /// [`UnknownName`] with all names and the most similar one.
    pub fn named(name: &str) -> Result<&'static Self, UnknownName> {
        let found = SETTINGS.iter().find(|setting| setting.is_called(name));
        found.ok_or_else(|| {
            let names = SETTINGS.iter().map(|setting| setting.name);
            UnknownName::new("a setting that can vary", name, names)
        })
    }

    /// Whether a name, with or without unit, is that of this setting.
    fn is_called(&self, name: &str) -> bool {
        let Some(rest) = name.strip_prefix(self.name) else {
            return false;
        };
        match &self.kind {
            _ if rest.is_empty() => true,
            Kind::Number { unit, .. } => !unit.is_empty() && rest.strip_prefix('-') == Some(*unit),
            Kind::Choice { .. } => false,
        }
    }
}
