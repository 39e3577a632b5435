//! Directions from the command line and from CSV files.

use crate::args::ProbeArgs;
use crate::error::CliError;
use std::io::Read;
use std::path::Path;

/// A direction to look in, and how far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AskedView {
    /// Degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Degrees above the horizontal.
    pub elevation_deg: f64,
    /// Metres; `None` to the ground or to space.
    pub distance_m: Option<f64>,
}

/// The directions that the options ask for, those of the command line first.
///
/// # Errors
/// [`CliError::Failure`] for a file that cannot be read, [`CliError::Usage`] for one that says something wrong.
pub fn read(args: &ProbeArgs) -> Result<Vec<AskedView>, CliError> {
    let from_line = args.view.iter().map(|view| AskedView {
        azimuth_deg: view.azimuth_deg,
        elevation_deg: view.elevation_deg,
        distance_m: args.distance_m,
    });
    let mut views: Vec<AskedView> = from_line.collect();
    if let Some(path) = &args.views {
        let text = load(path)?;
        let found = parse(&text, args.distance_m).map_err(|error| {
            CliError::usage(format!("the views of `{}`, {error}", path.display()))
        })?;
        views.extend(found);
    }
    Ok(views)
}

fn load(path: &Path) -> Result<String, CliError> {
    let mut bytes = Vec::new();
    match path == Path::new("-") {
        true => std::io::stdin().lock().read_to_end(&mut bytes).map(|_| ()),
        false => std::fs::read(path).map(|read| bytes = read),
    }
    .map_err(|error| {
        CliError::failure(format!(
            "cannot read the views `{}`: {error}",
            path.display()
        ))
    })?;
    String::from_utf8(bytes).map_err(|_| {
        CliError::usage(format!(
            "the views `{}` must be a text in UTF-8",
            path.display()
        ))
    })
}

/// Which column holds what.
struct Columns {
    azimuth: usize,
    elevation: usize,
    distance: Option<usize>,
    count: usize,
}

/// Reads a CSV text; where it has no distances, or leaves one empty, `distance_m` holds.
fn parse(text: &str, distance_m: Option<f64>) -> Result<Vec<AskedView>, String> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = (1..)
        .zip(text.lines())
        .filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let (number, header) = lines
        .next()
        .ok_or("line 1: there must be a header such as azimuth_deg,elevation_deg")?;
    let columns = columns(header).map_err(|error| format!("line {number}: {error}"))?;
    lines
        .map(|(number, line)| {
            view(line, &columns, distance_m).map_err(|error| format!("line {number}: {error}"))
        })
        .collect()
}

fn columns(header: &str) -> Result<Columns, String> {
    let names: Vec<&str> = fields(header).collect();
    let find = |wanted: &str| names.iter().position(|name| *name == wanted);
    let need = |wanted: &str| {
        find(wanted).ok_or(format!(
            "the header must name a column {wanted} (and may name distance_m), it names {}",
            names.join(", ")
        ))
    };
    Ok(Columns {
        azimuth: need("azimuth_deg")?,
        elevation: need("elevation_deg")?,
        distance: find("distance_m"),
        count: names.len(),
    })
}

fn view(line: &str, columns: &Columns, distance_m: Option<f64>) -> Result<AskedView, String> {
    let fields: Vec<&str> = fields(line).collect();
    if fields.len() != columns.count {
        return Err(format!(
            "there must be {} fields as in the header, there are {}",
            columns.count,
            fields.len()
        ));
    }
    let read = |name: &str, at: usize, parser: fn(&str) -> Result<f64, String>| {
        parser(fields[at]).map_err(|error| format!("{name} {error}, got `{}`", fields[at]))
    };
    let distance = columns.distance.filter(|&at| !fields[at].is_empty());
    Ok(AskedView {
        azimuth_deg: read("azimuth_deg", columns.azimuth, crate::parse::number)?,
        elevation_deg: read(
            "elevation_deg",
            columns.elevation,
            crate::parse::elevation_deg,
        )?,
        distance_m: match distance {
            Some(at) => Some(read("distance_m", at, crate::parse::length_m)?),
            None => distance_m,
        },
    })
}

fn fields(line: &str) -> impl Iterator<Item = &str> {
    line.split(',')
        .map(|field| field.trim().trim_matches('"').trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_read_by_the_names_of_their_columns() {
        let text = "\u{feff}elevation_deg, name, azimuth_deg, distance_m\r\n# remark\n10,a,20,\n-5,\"b\",350,1e3\n\n";
        let views = parse(text, Some(7.0)).unwrap();
        assert_eq!(views.len(), 2);
        assert_eq!(
            views[0],
            AskedView {
                azimuth_deg: 20.0,
                elevation_deg: 10.0,
                distance_m: Some(7.0)
            }
        );
        assert_eq!(
            views[1],
            AskedView {
                azimuth_deg: 350.0,
                elevation_deg: -5.0,
                distance_m: Some(1e3)
            }
        );
    }

    #[test]
    fn mistakes_are_told_with_their_line() {
        for (text, part) in [
            ("", "header"),
            ("azimuth,elevation\n1,2", "azimuth_deg"),
            (
                "azimuth_deg,elevation_deg\n1",
                "line 2: there must be 2 fields",
            ),
            (
                "azimuth_deg,elevation_deg\n1,2\nx,3",
                "line 3: azimuth_deg must be a number, got `x`",
            ),
            ("azimuth_deg,elevation_deg\n1,91", "-90 to 90"),
            ("azimuth_deg,elevation_deg,distance_m\n1,2,-3", "distance_m"),
        ] {
            let error = parse(text, None).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
    }
}
