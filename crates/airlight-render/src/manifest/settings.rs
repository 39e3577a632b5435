//! Settings in the lines of a manifest, and their differences.

use serde::Serialize;
use serde_json::{Map, Value};

/// Key of the table of a line that holds all on which the picture depends, and nothing else.
pub(super) const SCENE: &str = "scene";

/// Differences between the settings in a line and those of a picture, such as `fog.visibility_m was 50.0, is 60.0`.
///
/// # Errors
/// [`serde_json::Error`] if the settings cannot be written as a JSON object.
pub(super) fn differences(
    line: &Map<String, Value>,
    settings: &impl Serialize,
) -> serde_json::Result<Vec<String>> {
    // Written and read as lines are.
    let is: Map<String, Value> = serde_json::from_slice(&serde_json::to_vec(settings)?)?;
    let mut differences = Vec::new();
    let none = Map::new();
    let was = line.get(SCENE).and_then(Value::as_object);
    compare(None, was.unwrap_or(&none), &is, &mut differences);
    Ok(differences)
}

/// Adds the differences between two tables; one that is missing has no values.
fn compare(
    path: Option<&str>,
    was: &Map<String, Value>,
    is: &Map<String, Value>,
    differences: &mut Vec<String>,
) {
    let removed = was.keys().filter(|key| !is.contains_key(*key));
    for key in is.keys().chain(removed) {
        let name = match path {
            Some(path) => format!("{path}.{key}"),
            None => key.clone(),
        };
        let [was, is] = [was, is].map(|table| table.get(key).unwrap_or(&Value::Null));
        let none = Map::new();
        match (was, is) {
            (was, is) if was == is => {}
            (Value::Object(was), Value::Object(is)) => compare(Some(&name), was, is, differences),
            (Value::Object(was), Value::Null) => compare(Some(&name), was, &none, differences),
            (Value::Null, Value::Object(is)) => compare(Some(&name), &none, is, differences),
            (was, is) => {
                let shown = |value: &Value| match value {
                    Value::Null => "not set".to_owned(),
                    value => value.to_string(),
                };
                differences.push(format!("{name} was {}, is {}", shown(was), shown(is)));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn differences_name_each_setting_with_its_table() {
        let table = |value: Value| value.as_object().cloned().unwrap();
        let was = table(json!({
            "air": {"aod_550": 0.3},
            "fog": {"visibility_m": 8.0, "profile": "height", "layers": [1]},
            "camera": {"roll_deg": 2.0, "fov_deg": null},
            "solver": {"paths": null}
        }));
        let is = table(json!({
            "fog": {"visibility_m": 9.0, "profile": "height", "layers": [1, 2]},
            "camera": {"size": null},
            "sun": {"elevation_deg": 5.0}
        }));
        let mut differences = Vec::new();
        compare(None, &was, &is, &mut differences);
        differences.sort();
        assert_eq!(
            differences,
            [
                "air.aod_550 was 0.3, is not set",
                "camera.roll_deg was 2.0, is not set",
                "fog.layers was [1], is [1,2]",
                "fog.visibility_m was 8.0, is 9.0",
                "sun.elevation_deg was not set, is 5.0",
            ]
        );
    }
}
