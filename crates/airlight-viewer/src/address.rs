//! A [`State`] as the fragment of a web address: its version, and what is set, as `table.key=value`, separated by `&`. Values are in the
//! notation of scene files, with strings in single quotes, which addresses may contain.

use crate::state::State;
use std::fmt::Write;
use toml::{Table, Value};

/// Version of the fragments that this viewer reads and writes.
const VERSION: &str = "1";

impl State {
    /// The state as a fragment, without `#`. Numbers keep seven digits.
    pub fn to_fragment(&self) -> String {
        let table = self.to_toml().ok();
        let table: Table = table.and_then(|t| t.parse().ok()).unwrap_or_default();
        let mut pairs = vec![VERSION.to_owned()];
        flatten(&mut pairs, "", &table);
        encoded(&pairs.join("\n"))
    }

    /// The state of a fragment.
    ///
    /// # Errors
    /// Why there is none, as a sentence.
    pub fn from_fragment(fragment: &str) -> Result<Self, String> {
        let text = decoded(fragment).ok_or("expected an encoded scene in the address")?;
        let (version, scene) = text.split_once('\n').unwrap_or((&text, ""));
        if version != VERSION {
            return Err(format!(
                "expected a scene of version {VERSION} in the address, got {version:?}"
            ));
        }
        Self::from_toml(scene).map_err(|error| error.to_string())
    }
}

/// Appends the values of a table as `table.key=value`.
fn flatten(pairs: &mut Vec<String>, prefix: &str, table: &Table) {
    for (key, value) in table {
        match value {
            Value::Table(inner) => flatten(pairs, &format!("{prefix}{key}."), inner),
            Value::String(text) if !text.contains(['\'', '\n', '\r']) => {
                pairs.push(format!("{prefix}{key}='{text}'"));
            }
            Value::Float(number) => pairs.push(format!("{prefix}{key}={}", short(*number))),
            other => pairs.push(format!("{prefix}{key}={other}")),
        }
    }
}

/// A number with seven digits at most, as scene files write it.
fn short(number: f64) -> String {
    let rounded: f64 = format!("{number:.6e}").parse().unwrap_or(number);
    Value::Float(rounded).to_string()
}

/// A text for a fragment: lines are separated by `&`.
fn encoded(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for byte in text.bytes() {
        match byte {
            b'\n' => out.push('&'),
            b'a'..=b'z'
            | b'A'..=b'Z'
            | b'0'..=b'9'
            | b'-'
            | b'.'
            | b'_'
            | b'~'
            | b'='
            | b'\''
            | b','
            | b':'
            | b'/' => out.push(char::from(byte)),
            _ => write!(out, "%{byte:02X}").expect("text in memory"),
        }
    }
    out
}

/// The text of a fragment.
fn decoded(fragment: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(fragment.len());
    let mut rest = fragment.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'&' => b'\n',
            b'%' => {
                let mut digit = || char::from(rest.next()?).to_digit(16);
                let (high, low) = (digit()?, digit()?);
                (16 * high + low) as u8
            }
            other => other,
        });
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::{Compare, CompareMode, Terrain};
    use airlight::scene::Scene;

    #[test]
    fn states_return_from_addresses() {
        let text = "sun.latitude_deg = 48.8584\nsun.longitude_deg = 2.2945\nsun.time = \"2026-06-21T21:15:00+02:00\"\n\
            air.atmosphere = \"hazy\"\n[fog]\nvisibility_m = 500\n[[fog.layers]]\nvisibility_m = 2000.0\nbase_height_m = 30";
        let scene = Scene::from_toml(text).unwrap();
        let compared = State {
            compare: Some(Compare {
                left: Some("orders".to_owned()),
                model: "preetham".to_owned(),
                mode: CompareMode::Luminance,
                split: 0.5,
            }),
            terrain: Some(Terrain {
                file: Some("alps 1.png".to_owned()),
                spacing_m: Some(25.0),
                east_m: -1200.5,
                south_m: 0.0,
            }),
            ..State::default()
        };
        let camera = "output = { exposure = \"f/8 1/125 s ISO 100\", white_balance_k = 5000 }";
        let photograph = State::of_scene(Scene::from_toml(camera).unwrap());
        for state in [
            State::default(),
            compared,
            photograph,
            State::of_scene(scene),
        ] {
            let fragment = state.to_fragment();
            let allowed = |c: char| c.is_ascii_alphanumeric() || "-._~=',:/&%".contains(c);
            assert!(fragment.starts_with("1&"), "{fragment}");
            assert!(fragment.chars().all(allowed), "{fragment}");
            assert_eq!(State::from_fragment(&fragment), Ok(state));
        }
    }

    #[test]
    fn numbers_keep_seven_digits() {
        let mut state = State::default();
        state.scene.sun.elevation_deg = Some(12.345_678_901_23);
        let fragment = state.to_fragment();
        assert!(
            fragment.contains("sun.elevation_deg=12.34568&"),
            "{fragment}"
        );
        let again = State::from_fragment(&fragment).unwrap();
        assert_eq!(again.to_fragment(), fragment);
    }

    #[test]
    fn other_addresses_are_refused() {
        for wrong in [
            "",
            "2&sun.elevation_deg=3",
            "1&sun.elevation=3",
            "1&%",
            "1&%zz",
            "1&sun",
        ] {
            let error = State::from_fragment(wrong).unwrap_err();
            assert!(!error.is_empty(), "{wrong}");
        }
    }
}
