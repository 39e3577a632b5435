//! Names of values in kebab case: listing, parsing and the error for an unknown name.

use std::fmt;

/// A closed set of values, each of which has a name in kebab case.
///
/// `Display` writes the name, `FromStr` reads it; with the feature `serde` it is the serialized form.
///
/// ```
/// use airlight::{Named, spectrum::RgbSpace};
///
/// let names: Vec<&str> = RgbSpace::ALL.iter().map(|space| space.name()).collect();
/// assert_eq!(names, ["srgb", "rec2020", "acescg", "acescg-unadapted"]);
/// let error = "rec2o20".parse::<RgbSpace>().unwrap_err();
/// assert_eq!(error.to_string(), "expected an RGB space (srgb, rec2020, acescg, acescg-unadapted), got \"rec2o20\"; try \"rec2020\"");
/// ```
pub trait Named: Copy + PartialEq + 'static {
    /// What a value is, with its article, for error messages: "an RGB space".
    const WHAT: &'static str;

    /// All values, in the order in which they are listed.
    const ALL: &'static [Self];

    /// Further names, which are read but not listed.
    const ALIASES: &'static [(&'static str, Self)] = &[];

    /// The name in kebab case.
    fn name(self) -> &'static str;

    /// Description in one line.
    fn summary(self) -> &'static str;

    /// The value with this name or alias.
    ///
    /// # Errors
    /// [`UnknownName`] with all names and the most similar one.
    fn from_name(name: &str) -> Result<Self, UnknownName> {
        let listed = || Self::ALL.iter().map(|&value| (value.name(), value));
        listed()
            .chain(Self::ALIASES.iter().copied())
            .find_map(|(known, value)| (known == name).then_some(value))
            .ok_or_else(|| UnknownName::new(Self::WHAT, name, listed().map(|(known, _)| known)))
    }
}

/// Error for a name that no value of a set has.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct UnknownName {
    /// What the name should stand for, with its article.
    pub what: &'static str,
    /// The name that was given.
    pub name: String,
    /// All names of the set.
    pub names: Vec<String>,
    /// The most similar name, if one is similar.
    pub nearest: Option<String>,
}

impl UnknownName {
    /// An error for `name`, where `what` is one of `names`.
    pub fn new<'a>(
        what: &'static str,
        name: &str,
        names: impl IntoIterator<Item = &'a str>,
    ) -> Self {
        let names: Vec<&str> = names.into_iter().collect();
        Self {
            what,
            name: name.to_owned(),
            nearest: nearest(name, names.iter().copied()).map(str::to_owned),
            names: names.into_iter().map(str::to_owned).collect(),
        }
    }
}

impl fmt::Display for UnknownName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            what, name, names, ..
        } = self;
        write!(f, "expected {what} ({}), got \"{name}\"", names.join(", "))?;
        match &self.nearest {
            Some(nearest) => write!(f, "; try \"{nearest}\""),
            None => Ok(()),
        }
    }
}

impl std::error::Error for UnknownName {}

/// Implements [`Named`], `Display`, `FromStr` and, with their features, serde's traits and `JsonSchema` of an enum:
/// `(name, (variant), description)` for each value, then `(alias, (variant))` for further names.
#[doc(hidden)]
#[macro_export]
macro_rules! named {
    ($type:ty, $what:literal, [$(($name:literal, ($($value:tt)+), $summary:literal)),+ $(,)?]
        $(, aliases [$(($alias:literal, ($($meant:tt)+))),+])?) => {
        impl $crate::Named for $type {
            const WHAT: &'static str = $what;
            const ALL: &'static [Self] = &[$(Self::$($value)+),+];
            $(const ALIASES: &'static [(&'static str, Self)] = &[$(($alias, Self::$($meant)+)),+];)?

            fn name(self) -> &'static str {
                match self {
                    $(Self::$($value)+ => $name),+
                }
            }

            fn summary(self) -> &'static str {
                match self {
                    $(Self::$($value)+ => $summary),+
                }
            }
        }

        $crate::written_by_name!($type);
    };
}

/// Implements `Display`, `FromStr` and, with their features, serde's traits and `JsonSchema` of a [`Named`] type.
#[doc(hidden)]
#[macro_export]
macro_rules! written_by_name {
    ($type:ty) => {
        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad($crate::Named::name(*self))
            }
        }

        impl std::str::FromStr for $type {
            type Err = $crate::UnknownName;

            fn from_str(name: &str) -> Result<Self, Self::Err> {
                $crate::Named::from_name(name)
            }
        }

        $crate::serialized_by_name!($type);
        $crate::listed_in_schema!($type);
    };
}

// The features of this crate decide, not those of the crate in which the macros are used.
#[cfg(feature = "serde")]
#[doc(hidden)]
#[macro_export]
macro_rules! serialized_by_name {
    ($type:ty) => {
        impl $crate::dependencies::serde::Serialize for $type {
            fn serialize<S>(&self, serializer: S) -> Result<S::Ok, S::Error>
            where
                S: $crate::dependencies::serde::Serializer,
            {
                serializer.serialize_str($crate::Named::name(*self))
            }
        }

        impl<'de> $crate::dependencies::serde::Deserialize<'de> for $type {
            fn deserialize<D>(deserializer: D) -> Result<Self, D::Error>
            where
                D: $crate::dependencies::serde::Deserializer<'de>,
            {
                use $crate::dependencies::serde::{Deserialize, de::Error};
                let name = <std::borrow::Cow<'de, str> as Deserialize>::deserialize(deserializer)?;
                name.parse().map_err(Error::custom)
            }
        }
    };
}

#[cfg(not(feature = "serde"))]
#[doc(hidden)]
#[macro_export]
macro_rules! serialized_by_name {
    ($type:ty) => {};
}

#[cfg(feature = "schema")]
#[doc(hidden)]
#[macro_export]
macro_rules! listed_in_schema {
    ($type:ty) => {
        impl $crate::dependencies::schemars::JsonSchema for $type {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($type).into()
            }

            fn json_schema(
                _: &mut $crate::dependencies::schemars::SchemaGenerator,
            ) -> $crate::dependencies::schemars::Schema {
                let values = <Self as $crate::Named>::ALL;
                let names: Vec<&str> = values.iter().map(|&v| $crate::Named::name(v)).collect();
                $crate::dependencies::schemars::json_schema!({ "type": "string", "enum": names })
            }
        }
    };
}

#[cfg(not(feature = "schema"))]
#[doc(hidden)]
#[macro_export]
macro_rules! listed_in_schema {
    ($type:ty) => {};
}

pub(crate) use {named, written_by_name};

/// The candidate with the smallest edit distance to `word` (insertions, deletions, replacements and swaps of adjacent
/// letters), ignoring case; `None` if the distance exceeds about a third of the word's length.
pub(crate) fn nearest<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let word: Vec<char> = word.to_lowercase().chars().take(64).collect();
    candidates
        .into_iter()
        .map(|candidate| {
            (
                distance(&word, &candidate.to_lowercase().chars().collect::<Vec<_>>()),
                candidate,
            )
        })
        .min_by_key(|(distance, _)| *distance)
        .filter(|(distance, candidate)| *distance <= 1 + candidate.len().max(word.len()) / 3)
        .map(|(_, candidate)| candidate)
}

/// Optimal string alignment distance.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut rows = [
        vec![0; b.len() + 1],
        (0..=b.len()).collect::<Vec<usize>>(),
        vec![0; b.len() + 1],
    ];
    for i in 1..=a.len() {
        rows[2][0] = i;
        for j in 1..=b.len() {
            let replaced = rows[1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = replaced.min(rows[1][j] + 1).min(rows[2][j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(rows[0][j - 2] + 1);
            }
            rows[2][j] = best;
        }
        rows.rotate_left(1);
    }
    rows[1][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misspelled_words_are_found() {
        let words = ["clear", "average", "hazy", "mars"];
        for (typed, meant) in [
            ("claer", "clear"),
            ("Mars", "mars"),
            ("avrage", "average"),
            ("hazzy", "hazy"),
        ] {
            assert_eq!(nearest(typed, words), Some(meant));
        }
        assert_eq!(nearest("spectrometer", words), None);
        assert_eq!(nearest("", []), None);
    }
}
