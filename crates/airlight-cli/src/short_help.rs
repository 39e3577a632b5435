//! The command line with a short help (`-h`) that fits one screen for each command: the usual options. `--help` prints all options,
//! their values and examples.

use crate::args::Cli;
use clap::{Arg, Command, CommandFactory};
use std::ffi::OsString;

/// Options of a scene that most pictures need.
const SCENE: [&str; 11] = [
    "scene",
    "at",
    "when",
    "sun_elevation",
    "sun_azimuth",
    "altitude_m",
    "atmosphere",
    "aod_550",
    "solver",
    "visibility_m",
    "top_m",
];

/// Commands with many options, and those of their options that the short help lists besides [`SCENE`].
const USUAL: [(&[&str], &[&str]); 7] = [
    (
        &["sky"],
        &[
            "output",
            "until",
            "every",
            "projection",
            "size",
            "camera_azimuth",
            "camera_elevation",
            "fov",
            "orientation",
            "sun_disc",
            "exposure",
            "objects",
        ],
    ),
    (
        &["fog"],
        &[
            "colour",
            "depth",
            "output",
            "vary",
            "each",
            "seed",
            "depth_kind",
            "depth_scale",
            "fov",
            "fog_profile",
            "scale_height_m",
            "droplets",
            "patch_strength",
            "ambient",
            "light",
            "sky_light",
        ],
    ),
    (
        &["probe"],
        &["view", "views", "distance_m", "format", "output"],
    ),
    (
        &["compare"],
        &["first", "second", "output", "format", "projection", "size"],
    ),
    (
        &["view"],
        &[
            "file",
            "screenshot",
            "no_panel",
            "terrain",
            "size",
            "camera_azimuth",
            "camera_elevation",
            "fov",
            "exposure",
        ],
    ),
    (&["plot", "spectrum"], &["output", "view"]),
    (&["plot", "transmittance"], &["output", "zenith_deg", "map"]),
];

/// The command line of the program.
pub fn command() -> Command {
    USUAL.iter().fold(Cli::command(), |cli, (path, usual)| {
        with_short_help(cli, path, usual)
    })
}

fn with_short_help(command: Command, path: &[&str], usual: &[&str]) -> Command {
    if let [name, rest @ ..] = path {
        return command.mut_subcommand(*name, |command| with_short_help(command, rest, usual));
    }
    let examples = command.get_after_help().cloned().unwrap_or_default();
    let command = command
        .after_long_help(examples)
        .after_help("--help lists all options with their values, and examples.");
    command.mut_args(|arg| {
        let id = arg.get_id().as_str();
        let is_usual = usual.contains(&id) || SCENE.contains(&id);
        first_clause(arg).hide_short_help(!is_usual)
    })
}

/// The option with the first clause of its help as short help; `--help` prints all of it.
fn first_clause(arg: Arg) -> Arg {
    let Some(help) = arg.get_help().map(ToString::to_string) else {
        return arg;
    };
    let ends = [": ", "; ", " (", " [default", ", as in "];
    let end = ends.iter().filter_map(|end| help.find(end)).min();
    let short = help[..end.unwrap_or(help.len())].to_owned();
    let long = arg.get_long_help().map_or(help, ToString::to_string);
    arg.help(short).long_help(long)
}

/// The command that words name.
pub fn named_command<'a>(command: &'a Command, words: &[OsString]) -> &'a Command {
    let mut command = command;
    for word in words {
        let named = word.to_str().and_then(|word| command.find_subcommand(word));
        command = named.unwrap_or(command);
    }
    command
}

/// The first example of a command, on one line.
pub fn example(command: &Command) -> Option<String> {
    let help = command.get_after_long_help().or(command.get_after_help())?;
    let help = help.to_string().replace("\\\n", " ");
    let lines = help.lines().map(str::trim);
    let example = lines
        .into_iter()
        .find(|line| line.starts_with("airlight "))?;
    Some(example.split_whitespace().collect::<Vec<_>>().join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The command with its subcommands.
    fn check(command: &mut Command, name: &str) {
        /// Lines of a terminal window.
        const SCREEN: usize = 60;
        let help = command.render_help().to_string();
        let lines = help.lines().count();
        assert!(lines <= SCREEN, "{name} -h has {lines} lines:\n{help}");
        let subcommands: Vec<String> = command
            .get_subcommands()
            .map(|command| command.get_name().to_owned())
            .collect();
        for subcommand in subcommands {
            let command = command.find_subcommand_mut(&subcommand).unwrap();
            check(command, &format!("{name} {subcommand}"));
        }
    }

    #[test]
    fn short_help_fits_one_screen() {
        let mut command = command().term_width(100);
        command.build();
        check(&mut command, "airlight");
    }

    #[test]
    fn the_usual_options_exist() {
        for (path, usual) in USUAL {
            let mut command = command();
            command.build();
            let mut found = &command;
            for name in path {
                found = found.find_subcommand(name).unwrap();
            }
            let ids: Vec<&str> = found
                .get_arguments()
                .map(|arg| arg.get_id().as_str())
                .collect();
            for id in usual {
                assert!(ids.contains(id), "{path:?} {id}: {ids:?}");
            }
        }
    }

    #[test]
    fn the_commands_of_the_recipes_are_valid() {
        let commands = crate::topics::TOPICS
            .lines()
            .filter_map(|line| line.strip_prefix("    airlight "));
        let mut count = 0;
        for line in commands {
            // Words, of which one may be quoted.
            let words = line
                .split('\'')
                .enumerate()
                .flat_map(|(k, part)| match k % 2 {
                    0 => part.split_whitespace().map(str::to_owned).collect(),
                    _ => vec![part.to_owned()],
                });
            let words = std::iter::once("airlight".to_owned()).chain(words);
            if let Err(error) = command().try_get_matches_from(words) {
                panic!("{line}: {error}");
            }
            count += 1;
        }
        assert!(count >= 10, "{count}");
    }
}
