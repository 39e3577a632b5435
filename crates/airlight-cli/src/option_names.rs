//! Names of options in messages of the library, which knows settings by the names of scene files.

use crate::error::flag;
use airlight::UnknownName;
use clap::{ArgMatches, Command};
use std::path::Path;
use std::sync::OnceLock;

/// Long options of the command that runs.
static OPTIONS: OnceLock<Vec<String>> = OnceLock::new();
/// Names of its options and arguments, each with a value given for it.
static GIVEN: OnceLock<Vec<(String, String)>> = OnceLock::new();

/// Remembers the options of the command that was given.
pub fn install(command: &Command, matches: &ArgMatches) {
    let (mut options, mut given) = (Vec::new(), Vec::new());
    let (mut command, mut matches) = (command, matches);
    loop {
        options.extend(
            command
                .get_arguments()
                .filter_map(|arg| arg.get_long())
                .map(str::to_owned),
        );
        for argument in command.get_arguments() {
            let name = match (argument.get_long(), argument.get_value_names()) {
                (Some(long), _) => format!("--{long}"),
                (None, Some([name, ..])) => name.to_string(),
                _ => continue,
            };
            let values = matches.try_get_raw(argument.get_id().as_str());
            let values = values.ok().flatten().into_iter().flatten();
            let words = values.map(|value| value.to_string_lossy().into_owned());
            given.extend(words.map(|word| (name.clone(), word)));
        }
        let Some((name, inner)) = matches.subcommand() else {
            break;
        };
        let Some(inner_command) = command.find_subcommand(name) else {
            break;
        };
        (command, matches) = (inner_command, inner);
    }
    // Only the first command of the process has options.
    let _ = OPTIONS.set(options);
    let _ = GIVEN.set(given);
}

/// A message in which settings are named as options of the command, and a file that cannot be read with its option.
pub fn in_message(message: &str) -> String {
    let message = named(message, OPTIONS.get().map_or(&[], Vec::as_slice));
    let given = GIVEN.get().map_or(&[][..], Vec::as_slice);
    let lines: Vec<String> = message.lines().map(|line| of_file(line, given)).collect();
    lines.join("\n")
}

/// [`in_message`] for an error, with the option of a file whose contents are wrong.
pub fn in_error(message: &str) -> String {
    let given = GIVEN.get().map_or(&[][..], Vec::as_slice);
    let message = in_message(message);
    let file = message
        .strip_prefix('`')
        .and_then(|rest| rest.split_once('`'));
    match file.and_then(|(file, _)| option_of(file, given)) {
        Some(option) => format!("{option}: {message}"),
        None => message,
    }
}

/// The option that a value is given for.
fn option_of<'a>(value: &str, given: &'a [(String, String)]) -> Option<&'a str> {
    let option = given.iter().find(|(_, given)| given == value)?;
    Some(&option.0)
}

/// A line that a file cannot be read or written, also one of a list of failed pictures, with the option that names the file, and
/// with a file that is there if there is none of that name.
fn of_file(message: &str, given: &[(String, String)]) -> String {
    const SENTENCES: [&str; 2] = ["cannot read `", "cannot write `"];
    let quoted = SENTENCES.iter().find_map(|sentence| {
        let begin = message.find(sentence)?;
        let (before, rest) = message.split_at(begin);
        let (file, reason) = rest[sentence.len()..].split_once('`')?;
        (before.is_empty() || before.ends_with("`: ")).then_some((before, rest, file, reason))
    });
    let Some((before, rest, file, reason)) = quoted else {
        return message.to_owned();
    };
    let option = option_of(file, given).map_or(String::new(), |option| format!("{option}: "));
    let advice = if reason.contains("there is no folder") {
        "; create it first".to_owned()
    } else if reason.contains("os error 2)") {
        similar_file(Path::new(file)).map_or(String::new(), |name| format!("; try `{name}`"))
    } else {
        String::new()
    };
    format!("{before}{option}{rest}{advice}")
}

/// The file of the most similar name in the same folder; of those with the same ending, any where there is only one.
fn similar_file(missing: &Path) -> Option<String> {
    let name = missing.file_name()?.to_str()?;
    let folder = missing.parent()?;
    let listed = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    let files = std::fs::read_dir(listed).ok()?.flatten();
    let mut names: Vec<String> = files
        .filter_map(|file| file.file_name().into_string().ok())
        .collect();
    names.sort();
    let nearest = UnknownName::new("a file", name, names.iter().map(String::as_str)).nearest;
    let ending = missing.extension()?;
    let mut alike = names
        .iter()
        .filter(|name| Path::new(name).extension() == Some(ending));
    let only = match (alike.next(), alike.next()) {
        (Some(only), None) => Some(only.clone()),
        _ => None,
    };
    let found = folder.join(nearest.or(only)?);
    Some(found.display().to_string())
}

/// Names settings in a message as options: `key = value` of scene files becomes `--key value`, `some-option` becomes
/// `--some-option`, and `option` does so at the beginning of the message, after the name of a file and in advice. Quoted text
/// stays as it is.
fn named(message: &str, options: &[String]) -> String {
    let is_option = |name: &str| options.iter().any(|option| option == name);
    let mut text = String::with_capacity(message.len() + 16);
    let mut rest = message;
    while let Some(first) = rest.chars().next() {
        if let Some(length) = quoted(rest, first) {
            text.push_str(&rest[..length]);
            rest = &rest[length..];
            continue;
        }
        let length = rest.find(|c| !is_of_name(c)).unwrap_or(rest.len());
        if length == 0 {
            text.push(first);
            rest = &rest[first.len_utf8()..];
            continue;
        }
        let (word, after) = rest.split_at(length);
        let name = word.trim_end_matches(['.', '-', '_']);
        let flag = flag(name);
        let value = after
            .strip_prefix(" = ")
            .filter(|_| is_option(flag.trim_start_matches('-')));
        if let Some((value, remainder)) = value.and_then(value_of) {
            text.push_str(&format!("{flag} {value}"));
            rest = remainder;
            continue;
        }
        let is_named = match name.contains('-') {
            true => !text.ends_with('/'),
            false => match text.is_empty() || text.ends_with("`: ") {
                true => heads(after),
                false => ["try ", " or ", "leaving out "]
                    .iter()
                    .any(|before| text.ends_with(before)),
            },
        };
        if is_named && is_option(name) {
            text.push_str("--");
        }
        text.push_str(word);
        rest = after;
    }
    text
}

fn is_of_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.')
}

/// Length of the quoted text that begins here.
fn quoted(text: &str, first: char) -> Option<usize> {
    match first {
        '`' | '"' => text[1..].find(first).map(|end| end + 2),
        _ => None,
    }
}

/// Whether a word at the beginning of a message is its subject: `word:` or `word value:`.
fn heads(after: &str) -> bool {
    match after.split_once(": ") {
        Some((between, _)) => {
            between.is_empty() || (between.starts_with(' ') && !between[1..].contains(' '))
        }
        None => false,
    }
}

/// The number or quoted text of a TOML file with which a text begins, as an argument, and what follows; `None` for lists.
fn value_of(text: &str) -> Option<(String, &str)> {
    if let Some(inner) = text.strip_prefix('"') {
        let (value, rest) = inner.split_once('"')?;
        return Some(match value.contains(' ') {
            true => (format!("\"{value}\""), rest),
            false => (value.to_owned(), rest),
        });
    }
    let end = text.find([' ', ',', ';', ')']).unwrap_or(text.len());
    let is_number = text[..end].parse::<f64>().is_ok();
    is_number.then(|| (text[..end].to_owned(), &text[end..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_with_their_options() {
        let given = [("--depth", "none/10"), ("--output", "none/a.png")];
        let given = given.map(|(option, value)| (option.to_owned(), value.to_owned()));
        for (message, right) in [
            (
                "cannot read `none/10`: No such file or directory (os error 2)",
                "--depth: cannot read `none/10`: No such file or directory (os error 2)",
            ),
            (
                "  `a.png`: cannot read `none/10`: it is a folder",
                "  `a.png`: --depth: cannot read `none/10`: it is a folder",
            ),
            (
                "cannot write `none/a.png`: there is no folder `none`",
                "--output: cannot write `none/a.png`: there is no folder `none`; create it first",
            ),
            (
                "they cannot read `none/10`: no",
                "they cannot read `none/10`: no",
            ),
            ("cannot read `b.png`: no", "cannot read `b.png`: no"),
        ] {
            assert_eq!(of_file(message, &given), right);
        }
    }

    #[test]
    fn settings_are_named_as_options() {
        let options = [
            "visibility-m",
            "every",
            "tone",
            "vary",
            "overwrite",
            "layers",
            "fog-profile",
            "depth",
            "baseline-m",
            "focal-px",
            "solver",
            "negative",
        ]
        .map(str::to_owned);
        for (message, right) in [
            ("try visibility_m = 200", "try --visibility-m 200"),
            ("got none; try every = \"10m\"", "got none; try --every 10m"),
            ("try output.tone = \"camera\"", "try --tone camera"),
            (
                "vary visibility: expected a drawn visibility, as visibility-m is 100",
                "--vary visibility: expected a drawn visibility, as --visibility-m is 100",
            ),
            (
                "try visibility-m 100, or vary visibility=5..9 in a batch",
                "try --visibility-m 100, or --vary visibility=5..9 in a batch",
            ),
            (
                "layers: expected an OpenEXR output, got `layers/focal-px`",
                "--layers: expected an OpenEXR output, got `layers/focal-px`",
            ),
            (
                "solver monte-carlo: expected fog",
                "--solver monte-carlo: expected fog",
            ),
            (
                "try overwrite to make them again",
                "try --overwrite to make them again",
            ),
            (
                "try focal-px with baseline-m",
                "try --focal-px with --baseline-m",
            ),
            (
                "  `a/b.png`: depth: expected the size",
                "  `a/b.png`: --depth: expected the size",
            ),
            // Nothing is changed twice, and nothing that is not an option.
            ("--layers: try --depth FILE", "--layers: try --depth FILE"),
            ("try radius_m = 3", "try radius_m = 3"),
            (
                "depth map resized from 60 x 40 to 12 x 8: a",
                "depth map resized from 60 x 40 to 12 x 8: a",
            ),
            ("one `", "one `"),
        ] {
            assert_eq!(named(message, &options), right);
        }
    }
}
