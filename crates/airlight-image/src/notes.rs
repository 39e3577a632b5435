//! Notes about what was converted, repaired or passed over while files were read and written, for one line to the user.

use std::fmt;

/// Notes about one file, or about many: equal ones are added up.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Notes(Vec<Note>);

#[derive(Clone, Debug, PartialEq, Eq)]
struct Note {
    text: String,
    /// What the text counts, such as samples; 0 for a text without a number.
    count: u64,
    files: u64,
}

impl Notes {
    /// Adds a text, such as "colours converted from Display P3 to sRGB".
    pub fn add(&mut self, text: impl Into<String>) {
        self.push(text.into(), 0, 1);
    }

    /// Adds a text that follows a number and whose first word in -s is the noun counted, such as "NaN samples repaired"; nothing for
    /// 0.
    pub fn count(&mut self, count: u64, text: impl Into<String>) {
        if count > 0 {
            self.push(text.into(), count, 1);
        }
    }

    /// Adds the notes about another file.
    pub fn merge(&mut self, other: &Self) {
        for note in &other.0 {
            self.push(note.text.clone(), note.count, note.files);
        }
    }

    /// True where there is nothing to report.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn push(&mut self, text: String, count: u64, files: u64) {
        match self.0.iter_mut().find(|note| note.text == text) {
            Some(note) => {
                note.count += count;
                note.files += files;
            }
            None => self.0.push(Note { text, count, files }),
        }
    }
}

impl fmt::Display for Notes {
    /// All notes in one line, with the number of files where there are several.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, note) in self.0.iter().enumerate() {
            if i > 0 {
                f.write_str("; ")?;
            }
            match note.count {
                0 => f.write_str(&note.text)?,
                1 => write!(f, "1 {}", singular(&note.text))?,
                count => write!(f, "{count} {}", note.text)?,
            }
            if note.files > 1 {
                write!(f, " (in {} files)", note.files)?;
            }
        }
        Ok(())
    }
}

/// A text with its first plural as a singular.
fn singular(text: &str) -> String {
    match text.find("s ") {
        Some(end) => format!("{}{}", &text[..end], &text[end + 1..]),
        None => text.to_owned(),
    }
}
