//! A probe's answer as JSON: an object a line and deeper, lists of numbers on one line.

use super::values::Answer;
use crate::error::CliError;
use serde::Serialize;
use serde_json::ser::{Formatter, PrettyFormatter, Serializer};
use std::io::{self, Write};

/// The whole text.
///
/// # Errors
/// [`CliError::Failure`] where the answer cannot be put into JSON.
pub fn text(answer: &Answer) -> Result<String, CliError> {
    let mut bytes = Vec::new();
    let formatter = ShortLists(PrettyFormatter::new());
    answer
        .serialize(&mut Serializer::with_formatter(&mut bytes, formatter))
        .map_err(|error| CliError::failure(format!("cannot put the answer into JSON: {error}")))?;
    bytes.push(b'\n');
    String::from_utf8(bytes)
        .map_err(|error| CliError::failure(format!("the JSON is no text: {error}")))
}

/// Pretty objects, lists without line breaks.
struct ShortLists(PrettyFormatter<'static>);

impl Formatter for ShortLists {
    fn begin_array_value<W: ?Sized + Write>(
        &mut self,
        writer: &mut W,
        first: bool,
    ) -> io::Result<()> {
        if first {
            Ok(())
        } else {
            writer.write_all(b", ")
        }
    }

    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.begin_object(writer)
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_object(writer)
    }

    fn begin_object_key<W: ?Sized + Write>(
        &mut self,
        writer: &mut W,
        first: bool,
    ) -> io::Result<()> {
        self.0.begin_object_key(writer, first)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.begin_object_value(writer)
    }

    fn end_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_object_value(writer)
    }
}
