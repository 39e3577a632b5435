//! Values that work, for errors of options whose value is missing or invalid.

use crate::parse;
use airlight_render::batch::Each;
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, Command, Error};
use std::path::Path;

/// Adds an example to an error of an option of `command` whose value is missing or, where the sentence does not say what would work,
/// invalid.
pub fn explain(error: &mut Error, command: &Command) {
    let sentence = match error.kind() {
        ErrorKind::InvalidValue => String::new(),
        ErrorKind::ValueValidation => error.to_string(),
        _ => return,
    };
    // Errors of names list or suggest the names.
    let lists_values = matches!(error.get(ContextKind::ValidValue), Some(ContextValue::Strings(values)) if !values.is_empty());
    if lists_values || sentence.contains("such as ") || sentence.contains("try \"") {
        return;
    }
    let Some(ContextValue::String(usage)) = error.get(ContextKind::InvalidArg) else {
        return;
    };
    let Some(long) = usage
        .strip_prefix("--")
        .and_then(|usage| usage.split([' ', '=']).next())
    else {
        return;
    };
    let mut arguments = command.get_arguments();
    let argument = arguments.find(|arg| arg.get_long() == Some(long));
    let each = sentence
        .contains(parse::SEVERAL)
        .then(|| each(long, error))
        .flatten();
    let example = || {
        let value = argument.and_then(|argument| value(argument, command))?;
        Some(format!("for example: --{long} {value}"))
    };
    if let Some(tip) = each.or_else(example) {
        let tip = StyledStr::from(tip);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip]));
    }
}

/// The option that makes a picture with each value of a list that was given for an option of one number.
fn each(long: &str, error: &Error) -> Option<String> {
    let Some(ContextValue::String(list)) = error.get(ContextKind::InvalidValue) else {
        return None;
    };
    // Settings are named without units.
    let names = [
        long.strip_suffix("-m"),
        long.strip_suffix("-px"),
        Some(long),
    ];
    let mut all = names.iter().flatten().map(|name| format!("{name}={list}"));
    let each = all.find(|each| each.parse::<Each>().is_ok())?;
    Some(format!(
        "airlight fog makes a picture with each of several values: --each {each}"
    ))
}

/// Adds a pattern in quotes to an error of several pictures that a shell has put in place of a pattern.
pub fn explain_pattern(error: &mut Error, command: &Command) {
    let Some(ContextValue::String(second)) = error.get(ContextKind::InvalidArg) else {
        return;
    };
    let path = Path::new(second);
    let is_one_of_several =
        error.kind() == ErrorKind::UnknownArgument && command.get_name() == "fog" && path.exists();
    if let (true, Some(ending)) = (is_one_of_several, path.extension()) {
        let pattern = path.with_file_name(format!("*.{}", ending.to_string_lossy()));
        let tip = format!(
            "for several pictures, give their folder, or a pattern in quotes: airlight fog '{}'",
            pattern.display()
        );
        let tips = ContextValue::StyledStrs(vec![tip.into()]);
        error.insert(ContextKind::Suggested, tips);
    }
}

/// A value of an option, quoted for a shell where necessary: the first of its names, that of the examples of its command, or one
/// from the list of this file.
fn value(argument: &Arg, command: &Command) -> Option<String> {
    let long = argument.get_long()?;
    let name = argument.get_possible_values().into_iter().next();
    name.map(|name| name.get_name().to_owned())
        .or_else(|| in_examples(&format!("--{long}"), command))
        .or_else(|| in_examples(&format!("-{}", argument.get_short()?), command))
        .or_else(|| usual(long).map(str::to_owned))
}

/// The value that follows an option in the examples of a command.
fn in_examples(option: &str, command: &Command) -> Option<String> {
    let help = command.get_after_long_help().or(command.get_after_help())?;
    let help = help.to_string();
    let begin = help.find(&format!(" {option} "))? + option.len() + 2;
    let text = help[begin..].trim_start();
    let value = match text.strip_prefix('\'') {
        Some(inner) => &text[..inner.find('\'')? + 2],
        None => text.split_whitespace().next()?,
    };
    (value != "\\").then(|| value.to_owned())
}

/// A usual value of an option that takes numbers, times, texts or files.
fn usual(long: &str) -> Option<&'static str> {
    Some(match long {
        "aerosol" => "urban",
        "air-density" => "1.1",
        "air-thickness-m" => "8000",
        "altitude-m" => "1500",
        "ambient" => "0.7,0.8,0.9",
        "ambient-scale" => "1.5",
        "aod-550" => "0.2",
        "at" => "48.8584,2.2945",
        "atmosphere" => "hazy",
        "base-height-m" => "20",
        "baseline-m" => "0.12",
        "brighten" => "0.5",
        "camera-azimuth" => "90",
        "camera-elevation" => "10",
        "camera-roll" => "5",
        "colour-layer" => "ViewLayer.Combined",
        "contrast" => "0.05",
        "depth" => "depth.png",
        "depth-channel" => "Z",
        "depth-offset" => "0.5",
        "depth-scale" => "0.001",
        "disparity-offset-px" => "30",
        "distance-m" => "20000",
        "each" => "visibility=5,10,20",
        "every" => "10m",
        "exposure" => "14.5",
        "eye-height-m" => "1.7",
        "far-m" => "500",
        "far-plane-m" => "1000",
        "focal-px" => "1200",
        "fov" => "60",
        "ground-albedo" => "0.2",
        "ground-altitude-m" => "300",
        "haze-extinction-per-m" => "1e-4",
        "haze-thickness-m" => "1000",
        "haze-visibility-m" => "20000",
        "humidity" => "0.8",
        "index" => "1.333",
        "jobs" | "threads" => "4",
        "layer" => "'visibility=500 scale-height=20'",
        "light" => "'pixel=320,120 distance=6 intensity=3'",
        "manifest" => "manifest.jsonl",
        "map-percent" => "10",
        "moon" | "polarisation-correction" | "refraction" | "stars" => "off",
        "moon-azimuth" | "sun-azimuth" => "120",
        "moon-elevation" | "sun-elevation" => "30",
        "moon-phase" => "40",
        "near-plane-m" => "0.1",
        "objects" => "objects.toml",
        "openjd" => "job.json",
        "output" => "picture.png",
        "ozone-du" => "300",
        "patch-height-m" => "20",
        "patch-interval-s" => "0.04",
        "patch-seed" | "seed" => "7",
        "patch-size-m" => "50",
        "patch-strength" => "0.5",
        "patch-time-s" => "10",
        "patch-wind" => "3,-1",
        "paths" => "256",
        "principal-point" => "311.2,254.9",
        "quality" => "92",
        "radiance-scale" => "100",
        "saturation" => "1.2",
        "save-scene" | "scene" => "scene.toml",
        "scale" => "0.001",
        "scale-height-m" => "50",
        "shard" => "3/16",
        "size" => "2048x1024",
        "size-parameter" => "1,10,100",
        "sky-quality" => "21.6",
        "solar-flux" => "140",
        "star-latitude" => "48.8",
        "sun-strength" => "3",
        "terrain-spacing-m" => "30",
        "to" => "50",
        "to-m" => "300",
        "tone-contrast" => "1.3",
        "tasks" => "8",
        "top-m" => "40",
        "turbidity" => "3",
        "until" => "+6h",
        "variant" => "corrected",
        "variants" => "3",
        "vary" => "visibility=50..500",
        "view" => "180,45",
        "views" => "views.csv",
        "visibility-m" => "200",
        "wavelength-nm" => "550",
        "wavelengths" => "440,550,680",
        "when" => "2026-06-21T21:15:00+02:00",
        "white-balance" => "4000",
        "zenith-deg" => "0,60,85",
        "zenith-lux" => "120000",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::short_help;

    /// Every option of a command and its subcommands that takes a value, with the words that name the command.
    fn options_with_values(command: &Command, words: &[String]) -> Vec<(Vec<String>, String)> {
        let takes_value = |argument: &&Arg| argument.get_action().takes_values();
        let options = command.get_arguments().filter(takes_value);
        let mut found: Vec<_> = options
            .filter_map(|option| Some((words.to_vec(), option.get_long()?.to_owned())))
            .collect();
        for inner in command.get_subcommands() {
            let words = [words, &[inner.get_name().to_owned()]].concat();
            found.extend(options_with_values(inner, &words));
        }
        found
    }

    /// The error of a command line, with the example that the program adds.
    fn error_of(cli: &mut Command, words: &[String], option: String) -> Option<Error> {
        let words = words.iter().chain([&option]);
        let words: Vec<_> = words.map(Into::into).collect();
        let mut error = cli.try_get_matches_from_mut(&words).err()?;
        explain(&mut error, short_help::named_command(cli, &words));
        Some(error)
    }

    #[test]
    fn suns_below_the_horizon_are_given_as_numbers() {
        let mut cli = short_help::command();
        cli.build();
        let mut commands: Vec<&Command> = cli.get_subcommands().collect();
        let mut found = 0;
        while let Some(command) = commands.pop() {
            commands.extend(command.get_subcommands());
            let is_elevation = |option: &Arg| option.get_long() == Some("sun-elevation");
            if command.get_arguments().any(is_elevation) {
                found += 1;
                let name = command.get_name();
                assert!(command.is_allow_negative_numbers_set(), "{name}");
            }
        }
        assert!(found >= 5, "{found}");
    }

    #[test]
    fn every_option_without_its_value_shows_one_that_is_accepted() {
        let mut cli = short_help::command();
        cli.build();
        let options = options_with_values(&cli, &["airlight".to_owned()]);
        assert!(options.len() > 250, "{}", options.len());
        for (words, long) in options {
            let error = error_of(&mut cli, &words, format!("--{long}")).unwrap();
            let sentence = error.to_string();
            if let Some((_, listed)) = sentence.split_once("[possible values: ") {
                assert!(!listed.starts_with(']'), "{words:?}: {sentence}");
                continue;
            }
            let example = sentence.split_once(&format!("for example: --{long} "));
            let (_, value) = example.unwrap_or_else(|| panic!("{words:?}: {sentence}"));
            let value = value.lines().next().unwrap().trim_matches('\'');
            // Other arguments are missing, which is found after the values are parsed.
            let missing = [
                ErrorKind::MissingRequiredArgument,
                ErrorKind::MissingSubcommand,
                ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand,
            ];
            if let Some(error) = error_of(&mut cli, &words, format!("--{long}={value}")) {
                let kind = error.kind();
                assert!(missing.contains(&kind), "{words:?} {value}: {error}");
            }
        }
    }

    #[test]
    fn invalid_values_show_one_that_is_accepted() {
        let mut cli = short_help::command();
        let words = ["airlight".to_owned(), "sky".to_owned()];
        for (option, right) in [
            ("--seed=x", "--seed 7"),
            ("--ground-albedo=2", "--ground-albedo 0.2"),
            ("--sun-elevation=95", "--sun-elevation 3"),
            ("--shard=5/2", "--shard 1/4"),
            ("--white-balance=warm", "--white-balance 4000"),
            ("--visibility-m=-5", "--visibility-m 150"),
            ("--size=3", "such as 2048x1024"),
            ("--sun-elevation=5,10", "--each sun-elevation=5,10"),
            ("--visibility-m=5,10,20", "--each visibility=5,10,20"),
            ("--ozone-du=5,10,20", "for example: --ozone-du "),
        ] {
            let sentence = error_of(&mut cli, &words, option.to_owned())
                .unwrap()
                .to_string();
            assert!(sentence.contains(right), "{option}: {sentence}");
            let tips = ["such as", "for example", "--each"];
            let count: usize = tips.iter().map(|tip| sentence.matches(tip).count()).sum();
            assert_eq!(count, 1, "{sentence}");
        }
    }
}
