//! [`Variation`], [`Each`]: settings of an overlay that are drawn for each picture, and settings of which each picture gets every
//! value.

use super::settings::{Affects, Domain, Kind, Setting, Spacing};
use crate::overlay::OverlayScene;
use serde::Serialize;
use std::collections::HashSet;
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

impl Variation {
    /// Name of the setting, without its unit.
    pub fn name(&self) -> &'static str {
        self.setting.name
    }

    /// What the setting changes besides the fog.
    pub(super) fn affects(&self) -> Affects {
        self.setting.affects
    }

    /// Scenes with every value of a list, or with both ends of a range.
    pub(super) fn extremes(&self, scene: &OverlayScene) -> Vec<OverlayScene> {
        let values: Vec<Value> = match &self.values {
            Values::Range(_, low, high) => vec![Value::Number(*low), Value::Number(*high)],
            list => (0..list.len()).map(|at| list.value(at)).collect(),
        };
        let with = |value: Value| {
            let mut scene = scene.clone();
            self.setting.set(&mut scene, value);
            scene
        };
        values.into_iter().map(with).collect()
    }

    /// The names from which it is drawn; `None` for numbers.
    pub(super) fn choices(&self) -> Option<&[&'static str]> {
        match &self.values {
            Values::Names(names) => Some(names),
            _ => None,
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
        let value = match &self.values {
            Values::Range(spacing, low, high) => Value::Number(match spacing {
                _ if self.setting.is_whole() => (low + (high - low + 1.0) * fraction).floor(),
                Spacing::Uniform => low + (high - low) * fraction,
                Spacing::Log => low * libm::exp(fraction * libm::log(high / low)),
            })
            .clamped(*low, *high),
            list => {
                let at = (fraction * list.len() as f64) as usize;
                list.value(at.min(list.len() - 1))
            }
        };
        self.setting.set(scene, value);
    }
}

/// A value of a setting.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub(super) enum Value {
    Number(f64),
    Name(&'static str),
}

impl Value {
    fn clamped(self, low: f64, high: f64) -> Self {
        match self {
            Self::Number(value) => Self::Number(value.clamp(low, high)),
            name => name,
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(value) => write!(f, "{value}"),
            Self::Name(name) => f.write_str(name),
        }
    }
}

impl Values {
    /// Number of values in a list; 0 for a range.
    fn len(&self) -> usize {
        match self {
            Self::Range(..) => 0,
            Self::Numbers(values) => values.len(),
            Self::Names(values) => values.len(),
        }
    }

    /// A value of a list; the lower end of a range.
    fn value(&self, at: usize) -> Value {
        match self {
            Self::Range(_, low, _) => Value::Number(*low),
            Self::Numbers(values) => Value::Number(values[at]),
            Self::Names(values) => Value::Name(values[at]),
        }
    }
}

/// A setting and the values of which every picture gets each: parsed from `NAME=A,B,C`.
#[derive(Clone, Debug)]
pub struct Each(Variation);

impl Each {
    /// Name of the setting, without its unit.
    pub fn name(&self) -> &'static str {
        self.0.name()
    }

    /// The setting with its list.
    pub(super) fn variation(&self) -> &Variation {
        &self.0
    }

    /// Number of values, at least 1.
    pub(super) fn count(&self) -> usize {
        self.0.values.len()
    }

    /// A value of the list.
    pub(super) fn value(&self, at: usize) -> Value {
        self.0.values.value(at)
    }

    /// Sets the setting to a value of the list.
    pub(super) fn set(&self, scene: &mut OverlayScene, at: usize) {
        self.0.setting.set(scene, self.value(at));
    }
}

impl fmt::Display for Each {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl FromStr for Each {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let variation: Variation = text.parse()?;
        let (name, list) = (variation.name(), &variation.values);
        if let Values::Range(_, low, high) = list {
            return Err(format!(
                "{name}: expected a list of values, got {low}..{high}; try {name}={low},{high}, or vary to draw from the range"
            ));
        }
        let mut known = HashSet::new();
        for at in 0..list.len() {
            let value = list.value(at).to_string();
            if known.contains(&value) {
                return Err(format!(
                    "{name}: expected each value once, got {value} twice; try leaving one out"
                ));
            }
            known.insert(value);
        }
        Ok(Self(variation))
    }
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
        let setting = Setting::named(name).map_err(|error| error.to_string())?;
        let values = setting
            .values(values)
            .map_err(|error| format!("{}: {error}", setting.name))?;
        Ok(Self { setting, values })
    }
}

impl Setting {
    fn is_whole(&self) -> bool {
        matches!(&self.kind, Kind::Number { domain, .. } if Domain::is_whole(*domain))
    }

    /// Sets the setting of a scene.
    fn set(&self, scene: &mut OverlayScene, value: Value) {
        match (&self.kind, value) {
            (Kind::Number { set, .. }, Value::Number(value)) => set(scene, value),
            (Kind::Choice { set, .. }, Value::Name(name)) => set(scene, name),
            _ => {}
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
            ("focal-px=500..800", "focal=log:500..800"),
            ("patch-seed=0..9", "patch-seed=uniform:0..9"),
            ("ambient-red=0.5..0.7", "ambient-red=uniform:0.5..0.7"),
            ("patch-wind-east=-2..2", "patch-wind-east=uniform:-2..2"),
            ("principal-point-x-px=3,4", "principal-point-x=3,4"),
        ] {
            assert_eq!(text.parse::<Variation>().unwrap().to_string(), written);
        }
    }

    #[test]
    fn whole_numbers_are_drawn_evenly_up_to_both_ends() {
        let variation: Variation = "patch-seed=3..6".parse().unwrap();
        let mut counts = [0; 4];
        for variant in 0..4000 {
            let mut scene = OverlayScene::default();
            variation.draw(&mut scene, 1, "a", variant);
            let seed = scene.fog().patches.as_ref().unwrap().seed.unwrap();
            counts[seed as usize - 3] += 1;
        }
        // Within five standard deviations.
        assert!(counts.iter().all(|n| (860..1140).contains(n)), "{counts:?}");
    }

    #[test]
    fn components_of_colours_and_points_vary_by_themselves() {
        let mut scene = OverlayScene::default();
        scene.fog_mut().visibility_m = Some(50.0);
        scene.overlay.ambient = Some([0.1; 3]);
        let draw = |scene: &mut OverlayScene, text: &str| {
            text.parse::<Variation>().unwrap().draw(scene, 1, "a", 0);
        };
        draw(&mut scene, "ambient-green=0.5..0.6");
        draw(&mut scene, "patch-wind-north=3");
        let [red, green, blue] = scene.overlay.ambient.unwrap();
        assert!(red == 0.1 && (0.5..0.6).contains(&green) && blue == 0.1);
        assert_eq!(patches(&scene), Some([0.0, 3.0]));
        assert!(scene.check().is_ok());
        // What nothing sets is refused.
        for (text, part) in [
            (
                "ambient-blue=0.5",
                "overlay.ambient: expected red, green and blue, 0 or above, got NaN,NaN,0.5",
            ),
            (
                "principal-point-y=40",
                "overlay.principal_point_px: expected two numbers of pixels, got NaN,40",
            ),
        ] {
            let mut scene = scene.clone();
            scene.overlay.ambient = None;
            scene.overlay.focal_px = Some(100.0);
            draw(&mut scene, text);
            let error = scene.check().unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
    }

    fn patches(scene: &OverlayScene) -> Option<[f64; 2]> {
        scene.fog().patches.as_ref()?.wind_m_s
    }

    #[test]
    fn lists_of_each_value_are_read_or_refused() {
        let each: Each = "visibility-m=5,10,2.5".parse().unwrap();
        assert_eq!(
            (each.to_string().as_str(), each.count()),
            ("visibility=5,10,2.5", 3)
        );
        let mut scene = OverlayScene::default();
        each.set(&mut scene, 2);
        assert_eq!(scene.fog().visibility_m, Some(2.5));
        for (text, part) in [
            ("visibility=5..50", "try visibility=5,50, or vary"),
            ("visibility=5,6,5.0", "got 5 twice"),
            ("visibility=5,-6", "above 0"),
            ("visibilty=5,6", "try \"visibility\""),
            ("visibility", "NAME=A,B,C"),
        ] {
            let said = text.parse::<Each>().unwrap_err();
            assert!(said.contains(part), "{text}: {said}");
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
            ("visibility-km=5..50", "try \"visibility\""),
            ("fogginess=1..2", "visibility, scale-height, base-height"),
            ("patch-strenght=1..2", "try \"patch-strength\""),
            ("patch-seed=0.5..2", "a whole number"),
            ("patch-strength=0..3", "from 0 to 2"),
            ("quality=50..101", "1 to 100"),
            ("fov=60..180", "below 180"),
            ("sun-elevation=-95..20", "-90 to 90"),
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
    use airlight::Named;
    use airlight::scene::FogProfile;

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
