//! Typed access to TOML tables, with errors that carry line, column and key.

use super::error::{ConfigError, ConfigProblem};
use crate::names::{Named, UnknownName, nearest};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A table of the text, with its path.
pub(super) struct Section<'a> {
    text: &'a str,
    table: &'a DeTable<'a>,
    path: String,
    start: usize,
}

impl<'a> Section<'a> {
    /// A table at the top level of the text.
    pub fn new(text: &'a str, table: &'a DeTable<'a>, path: String) -> Self {
        let start = table.keys().map(|key| key.span().start).min().unwrap_or(0);
        Self {
            text,
            table,
            path,
            start,
        }
    }

    /// Full path of a key.
    fn path_of(&self, key: &str) -> String {
        match self.path.is_empty() {
            true => key.to_owned(),
            false => format!("{}.{key}", self.path),
        }
    }

    fn get(&self, key: &str) -> Option<&'a Spanned<DeValue<'a>>> {
        self.table
            .iter()
            .find(|(name, _)| name.get_ref() == key)
            .map(|(_, value)| value)
    }

    /// Whether the table has this key.
    pub fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    /// An error about a key, placed at its value, or at the start of the table if the key is missing.
    pub fn error(&self, key: &str, problem: ConfigProblem) -> ConfigError {
        let at = self.get(key).map_or(self.start, |value| value.span().start);
        ConfigError::at(self.text, at, self.path_of(key), problem)
    }

    /// An error about a missing key.
    pub fn missing(&self, key: &str, expected: &'static str) -> ConfigError {
        self.error(key, ConfigProblem::Missing(expected))
    }

    /// An error about an unknown name; `what` is what it should stand for, with its article.
    pub fn unknown(
        &self,
        key: &str,
        what: &'static str,
        got: &str,
        valid: Vec<&str>,
    ) -> ConfigError {
        let unknown = UnknownName::new(what, got, valid);
        self.error(key, ConfigProblem::UnknownName(unknown))
    }

    /// A value parsed from its name.
    pub fn named<T: Named>(&self, key: &str) -> Result<Option<T>, ConfigError> {
        let Some(name) = self.text(key)? else {
            return Ok(None);
        };
        let unknown = |error| self.error(key, ConfigProblem::UnknownName(error));
        T::from_name(name).map(Some).map_err(unknown)
    }

    fn wrong_type(&self, key: &str, expected: &'static str, got: &DeValue<'_>) -> ConfigError {
        let got = got.type_str();
        self.error(key, ConfigProblem::WrongType { expected, got })
    }

    /// Rejects keys other than these.
    pub fn check_keys(&self, valid: &[&str]) -> Result<(), ConfigError> {
        let unknown = self
            .table
            .keys()
            .filter(|name| !valid.contains(&name.get_ref().as_ref()))
            .min_by_key(|name| name.span().start);
        match unknown {
            None => Ok(()),
            Some(name) => {
                let problem = ConfigProblem::UnknownKey {
                    nearest: nearest(name.get_ref(), valid.iter().copied()).map(str::to_owned),
                    valid: valid.iter().map(|key| (*key).to_owned()).collect(),
                };
                Err(ConfigError::at(
                    self.text,
                    name.span().start,
                    self.path_of(name.get_ref()),
                    problem,
                ))
            }
        }
    }

    /// A number for which `allowed` is true.
    pub fn number(
        &self,
        key: &str,
        expected: &'static str,
        allowed: impl Fn(f64) -> bool,
    ) -> Result<Option<f64>, ConfigError> {
        let Some(value) = self.get(key) else {
            return Ok(None);
        };
        let got = number(value.get_ref())
            .ok_or_else(|| self.wrong_type(key, "a number", value.get_ref()))?;
        match allowed(got) {
            true => Ok(Some(got)),
            false => Err(self.error(key, ConfigProblem::OutOfRange { expected, got })),
        }
    }

    /// A finite number above 0.
    pub fn positive(&self, key: &str) -> Result<Option<f64>, ConfigError> {
        self.number(key, "a finite number above 0", |x| x.is_finite() && x > 0.0)
    }

    /// A finite number not below 0.
    pub fn not_negative(&self, key: &str) -> Result<Option<f64>, ConfigError> {
        self.number(key, "a finite number not below 0", |x| {
            x.is_finite() && x >= 0.0
        })
    }

    /// A finite number.
    pub fn finite(&self, key: &str) -> Result<Option<f64>, ConfigError> {
        self.number(key, "a finite number", f64::is_finite)
    }

    /// A finite number, required.
    pub fn required(&self, key: &str) -> Result<f64, ConfigError> {
        self.finite(key)?
            .ok_or_else(|| self.missing(key, "a number"))
    }

    /// A string.
    pub fn text(&self, key: &str) -> Result<Option<&'a str>, ConfigError> {
        match self.get(key) {
            None => Ok(None),
            Some(value) => match value.get_ref().as_str() {
                Some(text) => Ok(Some(text)),
                None => Err(self.wrong_type(key, "a string", value.get_ref())),
            },
        }
    }

    /// A list of strings.
    pub fn texts(&self, key: &str) -> Result<Option<Vec<&'a str>>, ConfigError> {
        let Some(value) = self.get(key) else {
            return Ok(None);
        };
        let list = value.get_ref().as_array();
        let texts = list.and_then(|list| list.iter().map(|item| item.get_ref().as_str()).collect());
        texts
            .map(Some)
            .ok_or_else(|| self.wrong_type(key, "a list of strings", value.get_ref()))
    }

    /// A list of numbers; nested lists are concatenated.
    pub fn numbers(&self, key: &str) -> Result<Option<Vec<f64>>, ConfigError> {
        let Some(value) = self.get(key) else {
            return Ok(None);
        };
        let mut numbers = Vec::new();
        let list = value.get_ref().as_array();
        let list =
            list.ok_or_else(|| self.wrong_type(key, "a list of numbers", value.get_ref()))?;
        for item in list.iter() {
            match item.get_ref() {
                DeValue::Array(inner) => {
                    for item in inner.iter() {
                        numbers.push(self.item(key, item)?);
                    }
                }
                _ => numbers.push(self.item(key, item)?),
            }
        }
        Ok(Some(numbers))
    }

    fn item(&self, key: &str, item: &Spanned<DeValue<'_>>) -> Result<f64, ConfigError> {
        number(item.get_ref()).ok_or_else(|| {
            let problem = ConfigProblem::WrongType {
                expected: "a number",
                got: item.get_ref().type_str(),
            };
            ConfigError::at(self.text, item.span().start, self.path_of(key), problem)
        })
    }

    /// A list of numbers, required.
    pub fn required_numbers(&self, key: &str) -> Result<Vec<f64>, ConfigError> {
        self.numbers(key)?
            .ok_or_else(|| self.missing(key, "a list of numbers"))
    }

    /// Whether the value is a table.
    pub fn is_section(&self, key: &str) -> bool {
        self.get(key)
            .is_some_and(|value| value.get_ref().is_table())
    }

    /// A table inside this one.
    pub fn section(&self, key: &str) -> Result<Option<Section<'a>>, ConfigError> {
        match self.get(key) {
            None => Ok(None),
            Some(value) => match self.inner(self.path_of(key), value) {
                Some(section) => Ok(Some(section)),
                None => Err(self.wrong_type(key, "a table", value.get_ref())),
            },
        }
    }

    /// A list of tables inside this one; empty without the key.
    pub fn sections(&self, key: &str) -> Result<Vec<Section<'a>>, ConfigError> {
        let Some(value) = self.get(key) else {
            return Ok(vec![]);
        };
        let list = value
            .get_ref()
            .as_array()
            .map(|list| list.iter().enumerate());
        let inner = |(i, item)| self.inner(format!("{}[{i}]", self.path_of(key)), item);
        let sections = list.and_then(|mut list| list.by_ref().map(inner).collect());
        sections.ok_or_else(|| self.wrong_type(key, "a list of tables", value.get_ref()))
    }

    fn inner(&self, path: String, value: &'a Spanned<DeValue<'a>>) -> Option<Section<'a>> {
        Some(Section {
            text: self.text,
            table: value.get_ref().as_table()?,
            path,
            start: value.span().start,
        })
    }
}

/// An integer or a float.
fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix())
            .ok()
            .map(|i| i as f64),
        DeValue::Float(float) => float.as_str().parse().ok(),
        _ => None,
    }
}
