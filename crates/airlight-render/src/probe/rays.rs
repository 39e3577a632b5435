//! [`ProbeRay`]: directions to probe, also from CSV.

/// A direction to probe, with an optional length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbeRay {
    /// Azimuth, degrees clockwise from north.
    pub azimuth_deg: f64,
    /// Elevation, degrees above the horizontal, -90 to 90.
    pub elevation_deg: f64,
    /// Length, m, above 0; `None`: to the ground or to space.
    pub distance_m: Option<f64>,
}

/// Indices of the columns.
struct Columns {
    azimuth: usize,
    elevation: usize,
    distance: Option<usize>,
    count: usize,
}

impl ProbeRay {
    /// Reads CSV with a header that names the columns azimuth_deg, elevation_deg and optionally distance_m. `distance_m` is the
    /// default for lines without a distance.
    ///
    /// # Errors
    /// A message with the line of the first error.
    pub fn list_from_csv(text: &str, distance_m: Option<f64>) -> Result<Vec<Self>, String> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut lines = (1..)
            .zip(text.lines())
            .filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
        let (number, header) = lines
            .next()
            .ok_or("line 1: expected a header, got nothing; try azimuth_deg,elevation_deg")?;
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
            "expected a header with the column {wanted} (and optionally distance_m), got {}",
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
            "expected {} fields as in the header, got {}",
            columns.count,
            fields.len()
        ));
    }
    let read = |name: &str, at: usize, right: &str, accepts: fn(f64) -> bool| {
        let value = fields[at].parse().ok().filter(|&value| accepts(value));
        value.ok_or_else(|| format!("{name}: expected {right}, got `{}`", fields[at]))
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
    fn columns_are_found_by_name() {
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
    fn errors_have_a_line() {
        for (text, part) in [
            ("", "header"),
            ("azimuth,elevation\n1,2", "azimuth_deg"),
            ("azimuth_deg,elevation_deg\n1", "line 2: expected 2 fields"),
            (
                "azimuth_deg,elevation_deg\n1,2\nx,3",
                "line 3: azimuth_deg: expected a number, got `x`",
            ),
            ("azimuth_deg,elevation_deg\n1,91", "-90 to 90"),
            ("azimuth_deg,elevation_deg,distance_m\n1,2,-3", "distance_m"),
        ] {
            let error = ProbeRay::list_from_csv(text, None).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
    }
}
