//! `--vary`: options of `airlight fog` that are drawn anew for each picture.

use super::fog::DropletsArg;
use super::overlay::{ModelArg, OverlayArgs};
use crate::parse;
use clap::ValueEnum;

/// One option, and from what it is drawn.
#[derive(Clone, Debug)]
pub struct Variation {
    /// Its name without the unit.
    pub name: &'static str,
    draw: Draw,
}

#[derive(Clone, Debug)]
enum Draw {
    /// From the first number to the second.
    Range(Number, Spacing, f64, f64),
    /// One of some numbers.
    Numbers(Number, Vec<f64>),
    Models(Vec<ModelArg>),
    Droplets(Vec<DropletsArg>),
}

/// How numbers lie in a range.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Spacing {
    /// Evenly.
    Uniform,
    /// Their logarithms lie evenly: each octave comes as often as any other.
    Log,
}

/// An option that takes a number.
#[derive(Clone, Copy, Debug)]
struct Number {
    unit: &'static str,
    spacing: Spacing,
    check: fn(&str) -> Result<f64, String>,
    set: fn(&mut OverlayArgs, f64),
}

/// Every option that takes a number and may vary, in the order of the help. What must be above 0 is spaced by logarithms.
const NUMBERS: [(&str, Number); 13] = [
    (
        "visibility",
        length(|args, value| args.visibility_m = value),
    ),
    (
        "scale-height",
        length(|args, value| args.scale_height_m = value),
    ),
    (
        "base-height",
        even("m", parse::number, |args, value| args.base_height_m = value),
    ),
    ("top", length(|args, value| args.top_m = value)),
    (
        "eye-height",
        length(|args, value| args.eye_height_m = value),
    ),
    (
        "camera-elevation",
        even("deg", parse::elevation_deg, |args, value| {
            args.camera_elevation = value;
        }),
    ),
    (
        "camera-azimuth",
        even("deg", parse::number, |args, value| {
            args.camera_azimuth = value
        }),
    ),
    (
        "camera-roll",
        even("deg", parse::number, |args, value| args.camera_roll = value),
    ),
    (
        "ambient-scale",
        Number {
            unit: "",
            spacing: Spacing::Log,
            check: parse::positive,
            set: |args, value| args.ambient_scale = value,
        },
    ),
    (
        "sun-elevation",
        even("deg", above_horizon_deg, |args, value| {
            args.sun_elevation = Some(value);
        }),
    ),
    (
        "sun-azimuth",
        even("deg", parse::number, |args, value| args.sun_azimuth = value),
    ),
    (
        "sun-strength",
        even("", parse::not_negative, |args, value| {
            args.sun_strength = value
        }),
    ),
    (
        "ground-albedo",
        even("", parse::fraction, |args, value| {
            args.ground_albedo = Some(value)
        }),
    ),
];

const fn length(set: fn(&mut OverlayArgs, f64)) -> Number {
    Number {
        unit: "m",
        spacing: Spacing::Log,
        check: parse::length_m,
        set,
    }
}

const fn even(
    unit: &'static str,
    check: fn(&str) -> Result<f64, String>,
    set: fn(&mut OverlayArgs, f64),
) -> Number {
    Number {
        unit,
        spacing: Spacing::Uniform,
        check,
        set,
    }
}

/// Whether something varies that the sky of `--sky-light` depends on.
pub fn changes_the_sky(vary: &[Variation]) -> bool {
    const OF_SKY: [&str; 4] = [
        "sun-elevation",
        "sun-azimuth",
        "eye-height",
        "ground-albedo",
    ];
    vary.iter()
        .any(|variation| OF_SKY.contains(&variation.name))
}

/// An elevation of a sun that shines on fog.
fn above_horizon_deg(text: &str) -> Result<f64, String> {
    match parse::elevation_deg(text) {
        Ok(elevation) if elevation > 0.0 => Ok(elevation),
        _ => Err("must be a number of degrees above 0 and at most 90".to_owned()),
    }
}

/// `NAME=LOW..HIGH`, `NAME=uniform:LOW..HIGH`, `NAME=log:LOW..HIGH` or `NAME=A,B,C`; NAME is that of the option, with its unit
/// or without.
///
/// # Errors
/// What would be right.
pub fn parse(text: &str) -> Result<Variation, String> {
    let (name, values) = text
        .split_once('=')
        .ok_or("must be NAME=LOW..HIGH or NAME=A,B,C: visibility=50..500")?;
    let name = name.trim();
    match name {
        "model" => {
            return Ok(Variation {
                name: "model",
                draw: Draw::Models(kinds(name, values)?),
            });
        }
        "droplets" => {
            return Ok(Variation {
                name: "droplets",
                draw: Draw::Droplets(kinds(name, values)?),
            });
        }
        _ => {}
    }
    let of_name = |(known, number): &&(&'static str, Number)| {
        name == *known || name.strip_prefix(known) == Some(&format!("-{}", number.unit))
    };
    let &(name, number) = NUMBERS
        .iter()
        .find(of_name)
        .ok_or_else(|| format!("has no option `{name}` to vary: there are {}", names()))?;
    let draw = numbers(number, values).map_err(|right| format!("`{name}` {right}"))?;
    Ok(Variation { name, draw })
}

/// The names of all options that may vary.
fn names() -> String {
    let numbers = NUMBERS.iter().map(|(name, _)| *name);
    numbers
        .chain(["model", "droplets"])
        .collect::<Vec<_>>()
        .join(", ")
}

fn numbers(number: Number, text: &str) -> Result<Draw, String> {
    let (spacing, text) = match text.split_once(':') {
        None => (number.spacing, text),
        Some(("uniform", text)) => (Spacing::Uniform, text),
        Some(("log", text)) => (Spacing::Log, text),
        Some((other, _)) => {
            return Err(format!(
                "knows no spacing `{other}`: there are uniform: and log:"
            ));
        }
    };
    let Some((low, high)) = text.split_once("..") else {
        let values: Result<Vec<f64>, String> = text.split(',').map(number.check).collect();
        return Ok(Draw::Numbers(number, values?));
    };
    let (low, high) = ((number.check)(low)?, (number.check)(high)?);
    if low > high {
        return Err(format!(
            "must go from a smaller to a greater number: {high}..{low}"
        ));
    }
    if spacing == Spacing::Log && low <= 0.0 {
        return Err(format!(
            "must be above 0 to be spaced by logarithms: leave out log:, or begin above {low}"
        ));
    }
    Ok(Draw::Range(number, spacing, low, high))
}

fn kinds<T: ValueEnum>(name: &str, text: &str) -> Result<Vec<T>, String> {
    let known = || {
        let all = T::value_variants().iter().filter_map(T::to_possible_value);
        all.map(|value| value.get_name().to_owned())
            .collect::<Vec<_>>()
            .join(",")
    };
    text.split(',')
        .map(|kind| {
            T::from_str(kind.trim(), false)
                .map_err(|_| format!("knows no {name} `{kind}`: there are {}", known()))
        })
        .collect()
}

impl Variation {
    /// The models that it draws from, where it is of the model.
    pub fn models(&self) -> Option<&[ModelArg]> {
        match &self.draw {
            Draw::Models(models) => Some(models),
            _ => None,
        }
    }

    /// The drops that it draws from, where it is of the drops.
    pub fn droplets(&self) -> Option<&[DropletsArg]> {
        match &self.draw {
            Draw::Droplets(droplets) => Some(droplets),
            _ => None,
        }
    }

    /// Sets the option to what `part`, from 0 to 1 (exclusive), of the way through its range or list says.
    pub fn set(&self, args: &mut OverlayArgs, part: f64) {
        match &self.draw {
            Draw::Range(number, spacing, low, high) => {
                let value = match spacing {
                    Spacing::Uniform => low + (high - low) * part,
                    Spacing::Log => low * libm::exp(part * libm::log(high / low)),
                };
                (number.set)(args, value.clamp(*low, *high));
            }
            Draw::Numbers(number, values) => (number.set)(args, pick(values, part)),
            Draw::Models(models) => args.model = pick(models, part),
            Draw::Droplets(droplets) => args.droplets = pick(droplets, part),
        }
    }
}

/// One of a list that is never empty.
fn pick<T: Copy>(list: &[T], part: f64) -> T {
    let at = (part * list.len() as f64) as usize;
    list[at.min(list.len() - 1)]
}
