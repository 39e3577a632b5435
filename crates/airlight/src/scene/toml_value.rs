//! Deserialization of parsed TOML values.
//!
//! The deserializer of the `toml` crate also serves values with their spans and dates, for which it compiles the code of each
//! deserialized type three times. Scenes have neither, and many types.

use serde::de::{
    DeserializeSeed, Deserializer, EnumAccess, Error, IntoDeserializer, MapAccess, SeqAccess,
    Unexpected, VariantAccess, Visitor,
};
use std::borrow::Cow;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A value of a parsed document, or a part of one, to deserialize from. Dates are strings.
pub(super) struct TomlValue<'a>(Spanned<DeValue<'a>>);

/// What is wrong with a value, and the innermost key or value that it is about.
#[derive(Debug)]
pub(super) struct TomlValueError {
    pub message: String,
    pub span: Option<Range<usize>>,
}

impl TomlValueError {
    fn or_at(mut self, span: Range<usize>) -> Self {
        self.span.get_or_insert(span);
        self
    }
}

impl Error for TomlValueError {
    fn custom<T: std::fmt::Display>(message: T) -> Self {
        Self {
            message: message.to_string(),
            span: None,
        }
    }
}

impl std::error::Error for TomlValueError {}

impl std::fmt::Display for TomlValueError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl<'a> TomlValue<'a> {
    pub fn new(table: Spanned<DeTable<'a>>) -> Self {
        let span = table.span();
        Self(Spanned::new(span, DeValue::Table(table.into_inner())))
    }

    fn read<S: DeserializeSeed<'a>>(self, seed: S) -> Result<S::Value, TomlValueError> {
        let span = self.0.span();
        let at = |error: TomlValueError| error.or_at(span);
        seed.deserialize(self).map_err(at)
    }
}

impl<'de> Deserializer<'de> for TomlValue<'de> {
    type Error = TomlValueError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TomlValueError> {
        let span = self.0.span();
        match self.0.into_inner() {
            DeValue::String(Cow::Borrowed(text)) => visitor.visit_borrowed_str(text),
            DeValue::String(Cow::Owned(text)) => visitor.visit_string(text),
            DeValue::Integer(number) => {
                let (digits, radix) = (number.as_str(), number.radix());
                match (
                    i64::from_str_radix(digits, radix),
                    u64::from_str_radix(digits, radix),
                ) {
                    (Ok(number), _) => visitor.visit_i64(number),
                    (_, Ok(number)) => visitor.visit_u64(number),
                    _ => Err(Error::custom("the integer is too large")),
                }
            }
            DeValue::Float(number) => match number.as_str().parse::<f64>() {
                Ok(value) if value.is_finite() || number.as_str().ends_with(['f', 'n']) => {
                    visitor.visit_f64(value)
                }
                _ => Err(Error::custom("the number is too large")),
            },
            DeValue::Boolean(value) => visitor.visit_bool(value),
            DeValue::Datetime(date) => visitor.visit_string(date.to_string()),
            DeValue::Array(list) => visitor.visit_seq(List(list.into_iter())),
            DeValue::Table(table) => visitor.visit_map(Entries {
                entries: table.into_iter(),
                value: None,
            }),
        }
        .map_err(|error| error.or_at(span))
    }

    /// A value that is there is `Some`.
    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TomlValueError> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, TomlValueError> {
        visitor.visit_newtype_struct(self)
    }

    /// A variant is its name, or a table whose only key is its name.
    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TomlValueError> {
        let span = self.0.span();
        match self.0.into_inner() {
            DeValue::String(name) => visitor.visit_enum(Variant {
                name: Spanned::new(span.clone(), name),
                content: None,
            }),
            DeValue::Table(table) if table.len() == 1 => {
                let mut entries = table.into_iter();
                let (name, value) = entries.next().expect("one entry");
                let content = Some(TomlValue(value));
                visitor.visit_enum(Variant { name, content })
            }
            other => Err(Error::invalid_type(
                Unexpected::Other(other.type_str()),
                &"a string or a table with one key",
            )),
        }
        .map_err(|error: TomlValueError| error.or_at(span))
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map struct identifier ignored_any
    }
}

/// The rest of a list.
struct List<'a>(std::vec::IntoIter<Spanned<DeValue<'a>>>);

impl<'de> SeqAccess<'de> for List<'de> {
    type Error = TomlValueError;

    fn next_element_seed<S: DeserializeSeed<'de>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, TomlValueError> {
        let next = self.0.next().map(TomlValue);
        next.map(|value| value.read(seed)).transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

/// The rest of a table, and the value of the key read last.
struct Entries<'a> {
    entries: <DeTable<'a> as IntoIterator>::IntoIter,
    value: Option<TomlValue<'a>>,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = TomlValueError;

    fn next_key_seed<S: DeserializeSeed<'de>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, TomlValueError> {
        let Some((key, value)) = self.entries.next() else {
            return Ok(None);
        };
        self.value = Some(TomlValue(value));
        read_name(seed, key).map(Some)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(
        &mut self,
        seed: S,
    ) -> Result<S::Value, TomlValueError> {
        self.value.take().expect("a key was read before").read(seed)
    }
}

/// The name of a variant and, if it is more than a name, its content.
struct Variant<'a> {
    name: Spanned<Cow<'a, str>>,
    content: Option<TomlValue<'a>>,
}

impl<'de> EnumAccess<'de> for Variant<'de> {
    type Error = TomlValueError;
    type Variant = Content<'de>;

    fn variant_seed<S: DeserializeSeed<'de>>(
        self,
        seed: S,
    ) -> Result<(S::Value, Content<'de>), TomlValueError> {
        Ok((read_name(seed, self.name)?, Content(self.content)))
    }
}

struct Content<'a>(Option<TomlValue<'a>>);

impl<'de> Content<'de> {
    fn value(self) -> Result<TomlValue<'de>, TomlValueError> {
        let none =
            || Error::custom("the variant needs a value: write a table with its name as key");
        self.0.ok_or_else(none)
    }
}

impl<'de> VariantAccess<'de> for Content<'de> {
    type Error = TomlValueError;

    fn unit_variant(self) -> Result<(), TomlValueError> {
        match self.0 {
            None => Ok(()),
            Some(TomlValue(value)) => {
                Err(TomlValueError::custom("the variant has no value").or_at(value.span()))
            }
        }
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(
        self,
        seed: S,
    ) -> Result<S::Value, TomlValueError> {
        self.value()?.read(seed)
    }

    fn tuple_variant<V: Visitor<'de>>(
        self,
        _length: usize,
        visitor: V,
    ) -> Result<V::Value, TomlValueError> {
        self.value()?.deserialize_any(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        _fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TomlValueError> {
        self.value()?.deserialize_any(visitor)
    }
}

fn read_name<'de, S: DeserializeSeed<'de>>(
    seed: S,
    name: Spanned<Cow<'de, str>>,
) -> Result<S::Value, TomlValueError> {
    let span = name.span();
    seed.deserialize(name.into_inner().into_deserializer())
        .map_err(|error: TomlValueError| error.or_at(span))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;
    use std::collections::BTreeMap;

    #[derive(Debug, Default, PartialEq, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    struct All {
        yes: bool,
        small: u8,
        signed: i64,
        large: u64,
        number: f64,
        from_integer: f64,
        text: String,
        maybe: Option<f64>,
        never: Option<f64>,
        pair: (f64, f64),
        date: String,
        wrapped: Option<Wrapped>,
        shapes: Vec<Shape>,
        map: BTreeMap<String, f64>,
        share: Share,
    }

    /// Refuses what it has read.
    #[derive(Debug, Default, PartialEq, Deserialize)]
    #[serde(try_from = "f64")]
    struct Share(f64);

    impl TryFrom<f64> for Share {
        type Error = String;

        fn try_from(share: f64) -> Result<Self, String> {
            match (0.0..=1.0).contains(&share) {
                true => Ok(Self(share)),
                false => Err(format!("expected 0 to 1, got {share}")),
            }
        }
    }

    #[derive(Debug, PartialEq, Deserialize)]
    struct Wrapped(f64);

    #[derive(Debug, PartialEq, Deserialize)]
    enum Shape {
        Point,
        Sphere(f64),
        Pair(f64, f64),
        Cuboid { width: f64 },
    }

    fn read(text: &str) -> Result<All, TomlValueError> {
        All::deserialize(TomlValue::new(DeTable::parse(text).unwrap()))
    }

    #[test]
    fn values_are_those_of_the_toml_crate() {
        for text in [
            "number = inf",
            "number = -inf",
            "large = 0xffff",
            "number = 1_0.5e1",
        ] {
            assert_eq!(read(text).unwrap(), toml::from_str(text).unwrap(), "{text}");
        }
        let text = "yes = true\nsmall = 255\nsigned = -3\nlarge = 9_000_000_000\nnumber = 1e-3\nfrom_integer = 4\n\
            text = \"a\\u00e9\"\nmaybe = 0.5\npair = [1, 2.5]\nwrapped = 7.0\n\
            shapes = [\"Point\", { Sphere = 2.0 }, { Pair = [1.0, 2.0] }, { Cuboid = { width = 3.0 } }]\n[map]\na = 1.0\n";
        let read = read(text).unwrap();
        assert_eq!(read, toml::from_str(text).unwrap());
        assert_eq!(read.shapes[2], Shape::Pair(1.0, 2.0));
        assert_eq!((read.maybe, read.never), (Some(0.5), None));
    }

    #[test]
    fn dates_are_strings() {
        assert_eq!(read("date = 2026-06-21").unwrap().date, "2026-06-21");
    }

    #[test]
    fn errors_are_placed_at_the_innermost_value() {
        for (text, at, message) in [
            (
                "yes = 1",
                6,
                "invalid type: integer `1`, expected a boolean",
            ),
            (
                "small = 300",
                8,
                "invalid value: integer `300`, expected u8",
            ),
            ("\n  other = 1", 3, "unknown field `other`"),
            (
                "pair = [1, \"x\"]",
                11,
                "invalid type: string \"x\", expected f64",
            ),
            (
                "shapes = [\"Point\", \"Cube\"]",
                19,
                "unknown variant `Cube`",
            ),
            ("shapes = [\"Sphere\"]", 10, "the variant needs a value"),
            ("shapes = [{ Point = 1 }]", 20, "the variant has no value"),
            (
                "shapes = [1]",
                10,
                "expected a string or a table with one key",
            ),
            (
                "signed = 99999999999999999999",
                9,
                "the integer is too large",
            ),
            ("number = 1e999", 9, "the number is too large"),
            ("share = 7", 8, "expected 0 to 1, got 7"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.to_string().contains(message), "{text}: {error}");
            assert_eq!(error.span.unwrap().start, at, "{text}");
        }
    }
}
