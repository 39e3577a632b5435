//! Directions to probe, and reading them from CSV.

/// A direction to look in, and how far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbeRay {
    /// Degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Degrees above the horizontal, -90 to 90.
    pub elevation_deg: f64,
    /// Metres, above 0; `None`: to the ground or to space.
    pub distance_m: Option<f64>,
}

/// Which column holds what.
struct Columns {
    azimuth: usize,
    elevation: usize,
    distance: Option<usize>,
    count: usize,
}

impl ProbeRay {
    /// Reads a CSV text with a header that names the columns azimuth_deg, elevation_deg and perhaps distance_m; where it has
    /// no distance, `distance_m` holds.
    ///
    /// # Errors
    /// What is wrong, with its line.
    pub fn list_from_csv(text: &str, distance_m: Option<f64>) -> Result<Vec<Self>, String> {
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
                ray(line, &columns, distance_m).map_err(|error| format!("line {number}: {error}"))
            })
            .collect()
    }
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

fn ray(line: &str, columns: &Columns, distance_m: Option<f64>) -> Result<ProbeRay, String> {
    let fields: Vec<&str> = fields(line).collect();
    if fields.len() != columns.count {
        return Err(format!(
            "there must be {} fields as in the header, there are {}",
            columns.count,
            fields.len()
        ));
    }
    let read = |name: &str, at: usize, right: &str, accepts: fn(f64) -> bool| {
        let value = fields[at].parse().ok().filter(|&value| accepts(value));
        value.ok_or_else(|| format!("{name} must be {right}, got `{}`", fields[at]))
    };
    let distance = columns.distance.filter(|&at| !fields[at].is_empty());
    Ok(ProbeRay {
        azimuth_deg: read("azimuth_deg", columns.azimuth, "a number", f64::is_finite)?,
        elevation_deg: read(
            "elevation_deg",
            columns.elevation,
            "a number of degrees from -90 to 90",
            |v| (-90.0..=90.0).contains(&v),
        )?,
        distance_m: match distance {
            Some(at) => Some(read(
                "distance_m",
                at,
                "a number of metres above 0 and at most 1e9",
                |v| v > 0.0 && v <= 1e9,
            )?),
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
        let rays = ProbeRay::list_from_csv(text, Some(7.0)).unwrap();
        assert_eq!(rays.len(), 2);
        assert_eq!(
            rays[0],
            ProbeRay {
                azimuth_deg: 20.0,
                elevation_deg: 10.0,
                distance_m: Some(7.0)
            }
        );
        assert_eq!(
            rays[1],
            ProbeRay {
                azimuth_deg: 350.0,
                elevation_deg: -5.0,
                distance_m: Some(1e3)
            }
        );
    }

    #[test]
    fn mistakes_are_named_with_their_line() {
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
            let error = ProbeRay::list_from_csv(text, None).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
    }
}
