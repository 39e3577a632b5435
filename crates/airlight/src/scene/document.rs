//! Deserialization of scenes and other tables from TOML; errors carry line, column, key and the most similar valid key.

use super::toml_value::TomlValue;
use super::{ObjectSpec, Scene, SceneError};
use crate::atmosphere::{ConfigError, ConfigProblem};
use crate::names::nearest;
use serde::de::DeserializeOwned;
use std::borrow::Cow;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A TOML text from which scenes and other tables are read.
///
/// Tables are layered: each layer is given by its path in the text, such as `scene` or `cell[2].scene` (empty: the whole
/// text), and later layers override earlier ones key by key, down to the innermost tables.
#[derive(Clone, Debug)]
pub struct SceneDocument {
    text: String,
}

impl SceneDocument {
    /// Parses a text.
    ///
    /// # Errors
    /// [`ConfigError`] if it is not TOML.
    pub fn new(text: impl Into<String>) -> Result<Self, ConfigError> {
        let document = Self { text: text.into() };
        document.table()?;
        Ok(document)
    }

    /// Reads a scene from layered tables. Top-level keys in `others` are ignored; read them with [`SceneDocument::read`].
    ///
    /// # Errors
    /// [`SceneError::Toml`] for unknown keys and values of the wrong type, [`SceneError::At`] for numbers out of range.
    pub fn scene(&self, layers: &[&str], others: &[&str]) -> Result<Scene, SceneError> {
        let scene = self.partial_scene(layers, others)?;
        scene
            .validate()
            .map_err(|error| self.located(layers, error))?;
        Ok(scene)
    }

    /// Reads layered tables as [`SceneDocument::scene`] does, without validation: a single layer need not be a valid scene.
    ///
    /// # Errors
    /// [`ConfigError`] for unknown keys and values of the wrong type.
    pub fn partial_scene(&self, layers: &[&str], others: &[&str]) -> Result<Scene, ConfigError> {
        self.read(layers, others)
    }

    /// Deserializes layered tables. Top-level keys in `others` are ignored; a layer that is not in the text is empty.
    ///
    /// # Errors
    /// [`ConfigError`] for unknown keys and values of the wrong type.
    pub fn read<T: DeserializeOwned>(
        &self,
        layers: &[&str],
        others: &[&str],
    ) -> Result<T, ConfigError> {
        T::deserialize(TomlValue::new(self.merged(layers, others)?))
            .map_err(|error| self.config_error(error.span, &error.message))
    }

    /// Number of tables in the list at a path, such as `cell`.
    ///
    /// # Errors
    /// [`ConfigError`] if the value is not a list of tables.
    pub fn count(&self, path: &str) -> Result<usize, ConfigError> {
        let document = self.table()?;
        let Some(value) = find(document.get_ref(), path) else {
            return Ok(0);
        };
        match value.get_ref() {
            DeValue::Array(list) if list.iter().all(|item| item.get_ref().is_table()) => {
                Ok(list.len())
            }
            other => Err(self.wrong_type(path, value.span(), "a list of tables", other)),
        }
    }

    fn table(&self) -> Result<Spanned<DeTable<'_>>, ConfigError> {
        DeTable::parse(&self.text).map_err(|error| self.config_error(error.span(), error.message()))
    }

    fn wrong_type(
        &self,
        path: &str,
        span: Range<usize>,
        expected: &'static str,
        got: &DeValue<'_>,
    ) -> ConfigError {
        let got = got.type_str();
        ConfigError::at(
            &self.text,
            span.start,
            path.to_owned(),
            ConfigProblem::WrongType { expected, got },
        )
    }

    /// Merges the tables at the paths; later ones override earlier ones.
    fn merged(
        &self,
        layers: &[&str],
        others: &[&str],
    ) -> Result<Spanned<DeTable<'_>>, ConfigError> {
        let document = self.table()?;
        let mut merged = DeTable::new();
        let mut span = document.span();
        for path in layers {
            let layer = match path.is_empty() {
                true => document.get_ref(),
                false => match find(document.get_ref(), path) {
                    None => continue,
                    Some(value) => {
                        span = value.span();
                        value.get_ref().as_table().ok_or_else(|| {
                            self.wrong_type(path, value.span(), "a table", value.get_ref())
                        })?
                    }
                },
            };
            let mut layer = layer.clone();
            for key in others {
                // Keys are compared without their spans.
                layer.remove(&Spanned::new(0..0, Cow::Owned((*key).to_owned())));
            }
            merge(&mut merged, layer);
        }
        Ok(Spanned::new(span, merged))
    }

    /// A scene's error with the line and column of its key.
    fn located(&self, layers: &[&str], error: SceneError) -> SceneError {
        let place = error.key().and_then(|key| {
            let merged = self.merged(layers, &[]).ok()?;
            // An error about a missing key is placed at its table.
            let (mut key, mut found) = (key, None);
            while found.is_none() && !key.is_empty() {
                found = find_key(merged.get_ref(), key);
                key = key.rsplit_once(['.', '[']).map_or("", |(outer, _)| outer);
            }
            found
        });
        match place {
            None => error,
            Some(byte) => {
                let (line, column) = ConfigError::place(&self.text, byte);
                SceneError::At {
                    line,
                    column,
                    error: Box::new(error),
                }
            }
        }
    }

    /// Converts an error of the parser or of deserialization, with the key that it is about.
    fn config_error(&self, span: Option<Range<usize>>, message: &str) -> ConfigError {
        let at = span.map_or(0, |span| span.start);
        let key = DeTable::parse(&self.text)
            .ok()
            .and_then(|table| key_at(table.get_ref(), at))
            .unwrap_or_default();
        ConfigError::at(&self.text, at, key, problem(message))
    }
}

impl Scene {
    /// Reads a scene from TOML. Files that it names are read by [`Scene::inline_files`].
    ///
    /// # Errors
    /// [`SceneError`] with line, column, key and the most similar valid key.
    pub fn from_toml(text: &str) -> Result<Self, SceneError> {
        SceneDocument::new(text)?.scene(&[""], &[])
    }

    /// Reads the files that the scene names, the atmosphere and the objects, into the scene. `load` returns the text of a
    /// file; paths are passed as written in the scene, usually relative to the scene file.
    ///
    /// # Errors
    /// [`SceneError::Refused`] for a file that `load` cannot read, and for an invalid file of objects.
    pub fn inline_files<E: std::fmt::Display>(
        &mut self,
        mut load: impl FnMut(&str) -> Result<String, E>,
    ) -> Result<(), SceneError> {
        let air = &mut self.air;
        if let (true, None, Some(file)) = (air.names_file(), &air.atmosphere_toml, &air.atmosphere)
        {
            let text = load(file).map_err(|error| SceneError::refused("air.atmosphere", error))?;
            air.atmosphere_toml = Some(text);
        }
        let Some(objects) = &mut self.objects else {
            return Ok(());
        };
        if let Some(file) = objects.file.take() {
            let text = load(&file).map_err(|error| SceneError::refused("objects.file", error))?;
            let refused = |error| SceneError::refused("objects.file", format!("{file}: {error}"));
            objects
                .object
                .extend(ObjectSpec::list_from_toml(&text).map_err(refused)?);
        }
        Ok(())
    }

    /// Writes the scene as TOML; fields that are not set are omitted.
    ///
    /// # Errors
    /// [`SceneError::Refused`] for values that TOML cannot represent, such as a seed of 2^63 or more.
    pub fn to_toml(&self) -> Result<String, SceneError> {
        toml::to_string(self).map_err(|error| SceneError::refused("scene", error))
    }
}

impl ObjectSpec {
    /// Reads a list of objects, `[[object]]`, from TOML.
    ///
    /// # Errors
    /// [`ConfigError`] with line, column, key and the most similar valid key.
    pub fn list_from_toml(text: &str) -> Result<Vec<Self>, ConfigError> {
        /// A file of objects.
        #[derive(serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        struct File {
            #[serde(default)]
            object: Vec<ObjectSpec>,
        }
        let file: File = SceneDocument::new(text)?.read(&[""], &[])?;
        Ok(file.object)
    }
}

/// Overrides the keys of a table by those of another.
fn merge<'a>(under: &mut DeTable<'a>, over: DeTable<'a>) {
    for (key, value) in over {
        let value = match (under.remove(&key), value.get_ref().is_table()) {
            (Some(old), true) if old.get_ref().is_table() => {
                let span = value.span();
                let mut inner = table(old);
                merge(&mut inner, table(value));
                Spanned::new(span, DeValue::Table(inner))
            }
            _ => value,
        };
        under.insert(key, value);
    }
}

fn table(value: Spanned<DeValue<'_>>) -> DeTable<'_> {
    match value.into_inner() {
        DeValue::Table(table) => table,
        _ => DeTable::new(),
    }
}

/// The value at a path such as `fog.layers[1].top_m`.
fn find<'t, 'a>(table: &'t DeTable<'a>, path: &str) -> Option<&'t Spanned<DeValue<'a>>> {
    let mut found: Option<&Spanned<DeValue<'a>>> = None;
    for step in path.split('.') {
        let (name, places) = step.split_once('[').unwrap_or((step, ""));
        let here = match found {
            None => table,
            Some(value) => value.get_ref().as_table()?,
        };
        let mut value = entry(here, name)?.1;
        for place in places.split('[').filter(|place| !place.is_empty()) {
            let place: usize = place.trim_end_matches(']').parse().ok()?;
            value = value.get_ref().as_array()?.get(place)?;
        }
        found = Some(value);
    }
    found
}

/// Byte position of the key at a path.
fn find_key(table: &DeTable<'_>, path: &str) -> Option<usize> {
    let (outer, name) = path.rsplit_once('.').unwrap_or(("", path));
    if name.ends_with(']') {
        return find(table, path).map(|value| value.span().start);
    }
    let table = match outer {
        "" => table,
        outer => find(table, outer)?.get_ref().as_table()?,
    };
    entry(table, name).map(|(start, _)| start)
}

fn entry<'t, 'a>(table: &'t DeTable<'a>, name: &str) -> Option<(usize, &'t Spanned<DeValue<'a>>)> {
    table
        .iter()
        .find(|(key, _)| key.get_ref() == name)
        .map(|(key, value)| (key.span().start, value))
}

/// The path of the key whose name or value contains a byte of the text.
fn key_at(table: &DeTable<'_>, byte: usize) -> Option<String> {
    let joined = |outer: &str, inner: String| match inner.is_empty() {
        true => outer.to_owned(),
        false => format!("{outer}.{inner}"),
    };
    for (key, value) in table.iter() {
        let name = key.get_ref().as_ref();
        if let Some(inner) = value
            .get_ref()
            .as_table()
            .and_then(|inner| key_at(inner, byte))
        {
            return Some(joined(name, inner));
        }
        if let Some(list) = value.get_ref().as_array() {
            for (i, item) in list.iter().enumerate() {
                if let Some(inner) = item
                    .get_ref()
                    .as_table()
                    .and_then(|inner| key_at(inner, byte))
                {
                    return Some(joined(&format!("{name}[{i}]"), inner));
                }
            }
        }
        if key.span().contains(&byte) || value.span().contains(&byte) {
            return Some(name.to_owned());
        }
    }
    None
}

/// Converts a message of serde to the form `expected ..., got ...`.
fn problem(message: &str) -> ConfigProblem {
    let quoted = |text: &str| -> Vec<String> {
        text.split('`')
            .skip(1)
            .step_by(2)
            .map(str::to_owned)
            .collect()
    };
    let names = quoted(message);
    if let [got, valid @ ..] = &names[..] {
        let nearest = nearest(got, valid.iter().map(String::as_str)).map(str::to_owned);
        if message.starts_with("unknown field") {
            return ConfigProblem::UnknownKey {
                nearest,
                valid: valid.to_vec(),
            };
        }
        if message.starts_with("unknown variant") {
            return ConfigProblem::UnknownValue {
                got: got.clone(),
                nearest,
                valid: valid.to_vec(),
            };
        }
    }
    let plain = [
        ("expected f64", "expected a number"),
        ("expected u8", "expected a whole number from 0 to 255"),
        ("expected u32", "expected a whole number, 0 or above"),
        ("expected u64", "expected a whole number, 0 or above"),
        ("expected usize", "expected a whole number, 0 or above"),
        ("expected a string", "expected a string in quotes"),
        ("expected a boolean", "expected true or false"),
        ("expected struct ", "expected a table: "),
    ];
    let mut message = message.trim_end().to_owned();
    if let Some((got, expected)) = message
        .strip_prefix("invalid type: ")
        .and_then(|rest| rest.split_once(", "))
    {
        message = format!("{expected}, got {got}");
    }
    for (serde, words) in plain {
        message = message.replace(serde, words);
    }
    ConfigProblem::Syntax(message)
}
