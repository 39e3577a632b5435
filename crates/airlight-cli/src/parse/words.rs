//! Argument values that consist of `KEY=VALUE` pairs.

/// `KEY=VALUE` pairs, each with another key.
pub struct Words<'a>(Vec<(&'a str, &'a str)>);

impl<'a> Words<'a> {
    /// Splits a text at spaces.
    ///
    /// # Errors
    /// A message for a word that is not `KEY=VALUE`, and for a key that is unknown or repeated.
    pub fn new(text: &'a str, keys: &[&str]) -> Result<Self, String> {
        let mut words = Vec::new();
        for word in text.split_whitespace() {
            let (key, value) = word.split_once('=').ok_or_else(|| {
                format!(
                    "expected KEY=VALUE with keys of {}, got \"{word}\"",
                    keys.join(", ")
                )
            })?;
            if !keys.contains(&key) {
                return Err(format!(
                    "expected a known key, got {key}; try {}",
                    keys.join(", ")
                ));
            }
            if words.iter().any(|(known, _)| *known == key) {
                return Err(format!("expected {key} once, got it twice"));
            }
            words.push((key, value));
        }
        Ok(Self(words))
    }

    /// Takes the value of a key, parsed by `parse`; `None` if it is not given.
    ///
    /// # Errors
    /// The error of `parse`, with the key.
    pub fn take<T>(
        &mut self,
        key: &str,
        parse: impl FnOnce(&str) -> Result<T, String>,
    ) -> Result<Option<T>, String> {
        let Some(at) = self.0.iter().position(|(known, _)| *known == key) else {
            return Ok(None);
        };
        let (_, value) = self.0.swap_remove(at);
        match parse(value) {
            Ok(value) => Ok(Some(value)),
            Err(error) => Err(format!("{key}: {error}")),
        }
    }
}
