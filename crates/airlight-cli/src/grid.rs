//! `airlight grid`: a contact sheet of skies that a TOML file describes.

use crate::args::{GridArgs, SkyArgs};
use crate::error::CliError;
use crate::progress::PicturesBar;
use crate::report;
use crate::sky::RenderedImage;
use airlight_plot::{ContactSheet, Panel};
use clap::Parser;
use std::path::Path;
use toml::{Table, Value};

/// A cell's options, as if typed.
#[derive(Debug, Parser)]
#[command(
    no_binary_name = true,
    disable_help_flag = true,
    allow_negative_numbers = true
)]
struct Typed {
    #[command(flatten)]
    sky: SkyArgs,
}

/// What a file describes.
struct Plan {
    title: String,
    columns: usize,
    cells: Vec<(String, SkyArgs)>,
}

/// Runs the command.
///
/// # Errors
/// [`CliError`]: what was wrong with the file, or what failed.
pub fn run(args: &GridArgs) -> Result<(), CliError> {
    report::check_png(&args.output)?;
    let name = args.file.display().to_string();
    let text = std::fs::read_to_string(&args.file)
        .map_err(|error| CliError::usage(format!("cannot read `{name}`: {error}")))?;
    let plan = Plan::read(&text, args.file.parent())
        .map_err(|error| CliError::usage(format!("{name}: {error}")))?;
    let bar = PicturesBar::new(plan.cells.len() as u64);
    let mut panels = Vec::with_capacity(plan.cells.len());
    for (label, sky) in &plan.cells {
        let image = RenderedImage::new(sky)?;
        panels.push(Panel {
            title: label.clone(),
            picture: image.displayed(&image.tone),
            scale: None,
        });
        bar.one_more();
    }
    drop(bar);
    let sheet = ContactSheet {
        heading: plan.title,
        columns: plan.columns,
        panels,
        notes: Vec::new(),
    };
    report::write_contact_sheet(&args.output, &sheet)
}

impl Plan {
    /// Reads a file; files that its options name lie beside it, in `folder`.
    fn read(text: &str, folder: Option<&Path>) -> Result<Self, String> {
        let file: Table = text
            .parse()
            .map_err(|error: toml::de::Error| error.to_string())?;
        for key in file.keys() {
            if !["title", "columns", "sky", "cell"].contains(&key.as_str()) {
                return Err(format!(
                    "knows no `{key}`: there are title, columns, [sky] and [[cell]]"
                ));
            }
        }
        let title = match file.get("title") {
            None => String::new(),
            Some(Value::String(title)) => title.clone(),
            Some(_) => return Err("`title` must be a text in quotes".to_owned()),
        };
        let common = match file.get("sky") {
            None => Table::new(),
            Some(Value::Table(table)) => table.clone(),
            Some(_) => return Err("`sky` must be a table: [sky]".to_owned()),
        };
        let Some(Value::Array(cells)) = file.get("cell") else {
            return Err("describes no picture: add one with [[cell]]".to_owned());
        };
        let columns = match file.get("columns") {
            None => cells.len().min(3),
            Some(&Value::Integer(count)) if (1..=64).contains(&count) => count as usize,
            Some(_) => return Err("`columns` must be a whole number from 1 to 64".to_owned()),
        };
        let cells = (1..)
            .zip(cells)
            .map(|(number, cell)| {
                one(&common, cell, folder).map_err(|error| format!("cell {number}: {error}"))
            })
            .collect::<Result<_, _>>()?;
        Ok(Self {
            title,
            columns,
            cells,
        })
    }
}

/// A cell's label and options, those of `common` where it does not say.
fn one(common: &Table, cell: &Value, folder: Option<&Path>) -> Result<(String, SkyArgs), String> {
    let Value::Table(cell) = cell else {
        return Err("must be a table: [[cell]]".to_owned());
    };
    let dashed = |table: &Table| {
        let pairs = table
            .iter()
            .map(|(key, value)| (key.replace('_', "-"), value.clone()));
        pairs.collect::<Table>()
    };
    let mut options = dashed(common);
    options.extend(dashed(cell));
    let label = match options.remove("label") {
        None => String::new(),
        Some(value) => word("label", &value, None)?,
    };
    let mut words = Vec::new();
    for (key, value) in &options {
        let option = format!("--{key}");
        if ["--output", "--preview", "--quiet", "--until"].contains(&option.as_str()) {
            return Err(format!("`{key}` is for `airlight sky`, not for a cell"));
        }
        match value {
            Value::Boolean(false) => {}
            Value::Boolean(true) => words.push(option),
            value => words.push(format!("{option}={}", word(key, value, folder)?)),
        }
    }
    match Typed::try_parse_from(words) {
        Ok(typed) => Ok((label, typed.sky)),
        Err(error) => {
            let text = error.to_string();
            let first = text.lines().next().unwrap_or_default();
            Err(first.trim_start_matches("error: ").to_owned())
        }
    }
}

/// A value as one would type it.
fn word(key: &str, value: &Value, folder: Option<&Path>) -> Result<String, String> {
    match value {
        Value::String(text) if text.ends_with(".toml") => {
            let path = folder.unwrap_or(Path::new("")).join(text);
            Ok(path.display().to_string())
        }
        Value::String(text) => Ok(text.clone()),
        Value::Integer(number) => Ok(number.to_string()),
        Value::Float(number) => Ok(number.to_string()),
        Value::Datetime(time) => Ok(time.to_string()),
        Value::Array(values) => {
            let words: Result<Vec<_>, _> = values
                .iter()
                .map(|value| word(key, value, folder))
                .collect();
            Ok(words?.join(","))
        }
        _ => Err(format!(
            "`{key}` must be a text, a number, true or false, or a list"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_have_the_options_of_all_and_their_own() {
        let text = "title = \"Suns\"\ncolumns = 2\n[sky]\nsun_elevation = 5\nsize = \"16x8\"\n\
            [[cell]]\nlabel = \"low\"\n[[cell]]\nlabel = 2\nsun-elevation = -1.5\nat = [1, 2]\n";
        let error = Plan::read(text, None).err().unwrap();
        assert!(
            error.starts_with("cell 2: ") && error.contains("--at"),
            "{error}"
        );
        let plan = Plan::read(&text.replace("at = [1, 2]", ""), None).unwrap();
        assert_eq!((plan.title.as_str(), plan.columns), ("Suns", 2));
        let suns: Vec<_> = plan
            .cells
            .iter()
            .map(|c| (c.0.as_str(), c.1.place.sun_elevation))
            .collect();
        assert_eq!(suns, [("low", Some(5.0)), ("2", Some(-1.5))]);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_place() {
        for (text, said) in [
            ("tilte = 1", "knows no `tilte`"),
            ("title = \"x\"", "describes no picture"),
            ("columns = 0\n[[cell]]", "from 1 to 64"),
            ("[[cell]]\nsun-elevation = 500", "cell 1: invalid value"),
            ("[[cell]]\nsunny = 5", "cell 1: unexpected argument"),
            ("[[cell]]\noutput = \"x.png\"", "cell 1: `output`"),
            ("[[cell]]\nsize = { x = 1 }", "cell 1: `size` must be"),
        ] {
            let error = Plan::read(text, None).err().unwrap();
            assert!(error.contains(said), "{text}: {error}");
        }
    }
}
