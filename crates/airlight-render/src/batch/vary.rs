//! Variation: settings of an overlay that are drawn for each picture.

use crate::overlay::OverlayScene;
use airlight::Named;
use airlight::fog::droplets::DropletKind;
use airlight::scene::FogProfile;
use std::fmt;
use std::str::FromStr;

/// A setting that varies, and the values from which it is drawn: parsed from `NAME=LOW..HIGH`, `NAME=uniform:LOW..HIGH`,
/// `NAME=log:LOW..HIGH` or `NAME=A,B,C`.
#[derive(Clone, Debug)]
pub struct Variation {
    setting: &'static Setting,
    values: Values,
}

/// Values from which a setting is drawn.
#[derive(Clone, Debug, PartialEq)]
enum Values {
    Range(Spacing, f64, f64),
    Numbers(Vec<f64>),
    Names(Vec<&'static str>),
}

/// Distribution of values over a range.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Spacing {
    /// Uniform.
    Uniform,
    /// Uniform in the logarithm, so that all octaves are equally likely.
    Log,
}

/// A setting that can vary.
#[derive(Debug)]
struct Setting {
    /// Name without unit.
    name: &'static str,
    /// Name on which its draws depend; it remains the same if the setting is renamed.
    stream: &'static str,
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
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

/// Valid values of a number.
#[derive(Clone, Copy, Debug)]
enum Domain {
    Any,
    NotNegative,
    Positive,
    Fraction,
    Length,
    Elevation,
    /// Elevation of a sun that lights the fog.
    AboveHorizon,
}

impl Domain {
    fn contains(self, value: f64) -> bool {
        match self {
            Self::Any => value.is_finite(),
            Self::NotNegative => value.is_finite() && value >= 0.0,
            Self::Positive => value.is_finite() && value > 0.0,
            Self::Fraction => (0.0..=1.0).contains(&value),
            Self::Length => value > 0.0 && value <= 1e9,
            Self::Elevation => (-90.0..=90.0).contains(&value),
            Self::AboveHorizon => value > 0.0 && value <= 90.0,
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
            Self::AboveHorizon => "a number of degrees above 0 and at most 90",
        }
    }

    fn read(self, text: &str) -> Result<f64, String> {
        match f64::from_str(text.trim()) {
            Ok(value) if self.contains(value) => Ok(value),
            _ => Err(format!("expected {}, got `{text}`", self.expected())),
        }
    }
}

const fn number(
    name: &'static str,
    unit: &'static str,
    spacing: Spacing,
    domain: Domain,
    set: fn(&mut OverlayScene, f64),
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
    }
}

/// A length in metres, above 0: uniform in the logarithm.
const fn length(name: &'static str, set: fn(&mut OverlayScene, f64)) -> Setting {
    number(name, "m", Spacing::Log, Domain::Length, set)
}

/// An angle in degrees or a number that may be 0: uniform.
const fn even(
    name: &'static str,
    unit: &'static str,
    domain: Domain,
    set: fn(&mut OverlayScene, f64),
) -> Setting {
    number(name, unit, Spacing::Uniform, domain, set)
}

/// Every setting that can vary.
static SETTINGS: [Setting; 15] = [
    length("visibility", |s, v| s.fog_mut().visibility_m = Some(v)),
    length("scale-height", |s, v| s.fog_mut().scale_height_m = Some(v)),
    even("base-height", "m", Domain::Any, |s, v| {
        s.fog_mut().base_height_m = Some(v)
    }),
    length("top", |s, v| s.fog_mut().top_m = Some(v)),
    length("eye-height", |s, v| s.scene.observer.eye_height_m = Some(v)),
    even("camera-elevation", "deg", Domain::Elevation, |s, v| {
        s.scene.camera.elevation_deg = Some(v)
    }),
    even("camera-azimuth", "deg", Domain::Any, |s, v| {
        s.scene.camera.azimuth_deg = Some(v)
    }),
    even("camera-roll", "deg", Domain::Any, |s, v| {
        s.scene.camera.roll_deg = Some(v)
    }),
    number(
        "ambient-scale",
        "",
        Spacing::Log,
        Domain::Positive,
        |s, v| s.overlay.ambient_scale = v,
    ),
    even("sun-elevation", "deg", Domain::AboveHorizon, |s, v| {
        s.scene.sun.elevation_deg = Some(v)
    }),
    even("sun-azimuth", "deg", Domain::Any, |s, v| {
        s.scene.sun.azimuth_deg = Some(v)
    }),
    even("sun-strength", "", Domain::NotNegative, |s, v| {
        s.overlay.sun_strength = Some(v)
    }),
    even("ground-albedo", "", Domain::Fraction, |s, v| {
        s.scene.air.ground_albedo = Some(v)
    }),
    Setting {
        name: "fog-profile",
        stream: "model",
        kind: Kind::Choice {
            names: || FogProfile::ALL.iter().map(|kind| kind.name()).collect(),
            set: |s, name| s.fog_mut().profile = name.parse().ok(),
        },
    },
    Setting {
        name: "droplets",
        stream: "droplets",
        kind: Kind::Choice {
            names: || DropletKind::ALL.iter().map(|kind| kind.name()).collect(),
            set: |s, name| s.fog_mut().droplets = name.parse().ok(),
        },
    },
];

/// Settings on which a solved sky depends.
const OF_SKY: [&str; 4] = [
    "sun-elevation",
    "sun-azimuth",
    "eye-height",
    "ground-albedo",
];

/// Names of all settings that can vary.
fn variation_names() -> impl Iterator<Item = &'static str> {
    SETTINGS.iter().map(|setting| setting.name)
}

impl Variation {
    /// Name of the setting, without its unit.
    pub fn name(&self) -> &'static str {
        self.setting.name
    }

    /// Whether a solved sky depends on the setting.
    pub fn changes_sky(&self) -> bool {
        OF_SKY.contains(&self.setting.name)
    }

    /// The names from which it is drawn; `None` for numbers.
    pub(super) fn choices(&self) -> Option<&[&'static str]> {
        match &self.values {
            Values::Names(names) => Some(names),
            _ => None,
        }
    }

    /// Sets the setting to one of its names.
    pub(super) fn choose(&self, scene: &mut OverlayScene, name: &str) {
        if let Kind::Choice { set, .. } = &self.setting.kind {
            set(scene, name);
        }
    }

    /// Draws the setting for a variant of a picture; the value depends only on the arguments and the setting's name.
    pub fn draw(&self, scene: &mut OverlayScene, seed: u64, picture: &str, variant: u32) {
        self.set(
            scene,
            super::draw::fraction(seed, picture, variant, self.setting.stream),
        );
    }

    /// Sets the setting to the value at a fraction, from 0 to 1 (exclusive), of its range or list.
    pub(super) fn set(&self, scene: &mut OverlayScene, fraction: f64) {
        match (&self.values, &self.setting.kind) {
            (Values::Range(spacing, low, high), Kind::Number { set, .. }) => {
                let value = match spacing {
                    Spacing::Uniform => low + (high - low) * fraction,
                    Spacing::Log => low * libm::exp(fraction * libm::log(high / low)),
                };
                set(scene, value.clamp(*low, *high));
            }
            (Values::Numbers(values), Kind::Number { set, .. }) => {
                set(scene, pick(values, fraction))
            }
            (Values::Names(names), _) => self.choose(scene, pick(names, fraction)),
            _ => {}
        }
    }
}

/// The element at a fraction of a list that is not empty.
fn pick<T: Copy>(list: &[T], fraction: f64) -> T {
    let at = (fraction * list.len() as f64) as usize;
    list[at.min(list.len() - 1)]
}

impl fmt::Display for Variation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}=", self.setting.name)?;
        match &self.values {
            Values::Range(Spacing::Uniform, low, high) => write!(f, "uniform:{low}..{high}"),
            Values::Range(Spacing::Log, low, high) => write!(f, "log:{low}..{high}"),
            Values::Numbers(values) => {
                let values: Vec<String> = values.iter().map(f64::to_string).collect();
                f.write_str(&values.join(","))
            }
            Values::Names(names) => f.write_str(&names.join(",")),
        }
    }
}

impl FromStr for Variation {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, values) = text.split_once('=').ok_or_else(|| {
            format!("expected NAME=LOW..HIGH or NAME=A,B,C, got `{text}`; try visibility=50..500")
        })?;
        let name = name.trim();
        let setting = SETTINGS
            .iter()
            .find(|setting| setting.is_called(name))
            .ok_or_else(|| {
                let names: Vec<&str> = variation_names().collect();
                format!(
                    "expected a setting that can vary, got `{name}`; try one of {}",
                    names.join(", ")
                )
            })?;
        let values = setting
            .values(values)
            .map_err(|error| format!("{}: {error}", setting.name))?;
        Ok(Self { setting, values })
    }
}

impl Setting {
    /// Whether a name, with or without unit, is that of this setting.
    fn is_called(&self, name: &str) -> bool {
        let Some(rest) = name.strip_prefix(self.name) else {
            return false;
        };
        match &self.kind {
            Kind::Number { unit, .. } => rest.is_empty() || rest.strip_prefix('-') == Some(*unit),
            Kind::Choice { .. } => rest.is_empty(),
        }
    }

    fn values(&self, text: &str) -> Result<Values, String> {
        let (spacing, domain) = match &self.kind {
            Kind::Choice { names, .. } => return choices(&names(), text),
            Kind::Number {
                spacing, domain, ..
            } => (*spacing, *domain),
        };
        let (spacing, text) = match text.split_once(':') {
            None => (spacing, text),
            Some(("uniform", text)) => (Spacing::Uniform, text),
            Some(("log", text)) => (Spacing::Log, text),
            Some((other, _)) => {
                return Err(format!(
                    "expected a spacing, got `{other}`; try uniform: or log:"
                ));
            }
        };
        let Some((low, high)) = text.split_once("..") else {
            let values: Result<_, String> = text.split(',').map(|text| domain.read(text)).collect();
            return Ok(Values::Numbers(values?));
        };
        let (low, high) = (domain.read(low)?, domain.read(high)?);
        if low > high {
            return Err(format!(
                "expected a range from a smaller to a greater number, got {low}..{high}; try {high}..{low}"
            ));
        }
        if spacing == Spacing::Log && low <= 0.0 {
            return Err(format!(
                "expected a range above 0 for logarithmic spacing, got {low}..{high}; try leaving out log:"
            ));
        }
        Ok(Values::Range(spacing, low, high))
    }
}

fn choices(known: &[&'static str], text: &str) -> Result<Values, String> {
    let choice = |name: &str| {
        let found = known.iter().find(|known| **known == name.trim());
        found.copied().ok_or_else(|| {
            format!(
                "expected names of a list, got `{name}`; try some of {}",
                known.join(", ")
            )
        })
    };
    let names: Result<_, String> = text.split(',').map(choice).collect();
    Ok(Values::Names(names?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        text.parse::<Variation>().unwrap_err()
    }

    #[test]
    fn variations_round_trip_through_text() {
        for (text, written) in [
            ("visibility=50..500", "visibility=log:50..500"),
            ("visibility-m=50..500", "visibility=log:50..500"),
            ("eye-height-m=uniform:1..2", "eye-height=uniform:1..2"),
            ("base-height=-3..4.5", "base-height=uniform:-3..4.5"),
            ("camera-roll-deg=-2,0,2", "camera-roll=-2,0,2"),
            ("sun-strength=0..4", "sun-strength=uniform:0..4"),
            ("fog-profile=uniform, slab", "fog-profile=uniform,slab"),
            ("droplets=fine,coarse", "droplets=fine,coarse"),
        ] {
            assert_eq!(text.parse::<Variation>().unwrap().to_string(), written);
        }
    }

    #[test]
    fn invalid_variations_are_refused() {
        for (text, part) in [
            ("visibility", "NAME=LOW..HIGH"),
            ("visibility=500..50", "try 50..500"),
            ("visibility=-5..50", "above 0"),
            ("visibility=0..50", "above 0"),
            ("visibility=nan..50", "above 0"),
            ("visibility=5,x", "`x`"),
            ("visibility=cubic:5..50", "uniform: or log:"),
            (
                "visibility-km=5..50",
                "visibility, scale-height, base-height",
            ),
            ("fogginess=1..2", "visibility, scale-height, base-height"),
            ("sun-elevation=-5..20", "above 0"),
            ("base-height=log:0..20", "logarithmic"),
            ("ground-albedo=0..2", "from 0 to 1"),
            ("fog-profile=uniform,thick", "foggy-cityscapes"),
            ("droplets=soup", "radiation"),
        ] {
            assert!(refused(text).contains(part), "{text}: {}", refused(text));
        }
    }
}

#[cfg(test)]
mod guards {
    use super::*;

    /// Values drawn by version 0.1.0.
    #[test]
    fn drawn_values_do_not_change_between_versions() {
        let mut scene = OverlayScene::default();
        for text in [
            "visibility=5..50",
            "fog-profile=uniform,height,slab",
            "droplets=fine,radiation,advection",
            "camera-roll=-2,0,2",
            "top=uniform:1..5",
        ] {
            let variation: Variation = text.parse().unwrap();
            variation.draw(&mut scene, 1, "a", 2);
        }
        assert_eq!(scene.scene.camera.roll_deg, Some(-2.0));
        let fog = scene.fog_mut();
        assert_eq!(fog.visibility_m, Some(26.046302285571812));
        assert_eq!(fog.top_m, Some(1.8339384567315218));
        assert_eq!(fog.profile, Some(FogProfile::Height));
        assert_eq!(fog.droplets.map(|kind| kind.name()), Some("advection"));
    }
}
