//! File names of the frames of a sequence.

use airlight::sun::Moment;
use std::path::{Path, PathBuf};

/// Pattern of the file names of frames.
///
/// - `####` in the file name: the frame's number, padded with zeros to as many digits as there are number signs.
/// - `{time}`: the frame's time, UTC, as in `20240621T120000Z`.
/// - Neither: the number with 4 digits before the extension, as in `sky.0001.exr`.
///
/// Placeholders in the names of folders are not replaced.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FramePattern {
    folder: PathBuf,
    parts: Vec<Part>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Part {
    Text(String),
    Number { digits: usize },
    Time,
}

impl FramePattern {
    /// Parses a pattern. Every path is valid; bytes of a file name that are not Unicode are replaced.
    pub fn new(path: &Path) -> Self {
        let name = path
            .file_name()
            .map(|name| name.to_string_lossy().into_owned())
            .unwrap_or_default();
        let mut parts = split(&name);
        if parts.iter().all(|part| matches!(part, Part::Text(_))) {
            // A leading dot is part of the name, not an extension.
            let at = name.rfind('.').filter(|&at| at > 0).unwrap_or(name.len());
            parts = vec![
                Part::Text(format!("{}.", &name[..at])),
                Part::Number { digits: 4 },
                Part::Text(name[at..].to_owned()),
            ];
        }
        Self {
            folder: path.parent().map(Path::to_owned).unwrap_or_default(),
            parts,
        }
    }

    /// Path of the frame `number` at the time `time_s` (seconds since 1970-01-01T00:00:00Z).
    pub fn path(&self, number: u64, time_s: i64) -> PathBuf {
        let name: String = self
            .parts
            .iter()
            .map(|part| match part {
                Part::Text(text) => text.clone(),
                Part::Number { digits } => format!("{number:0digits$}"),
                Part::Time => Moment::from_unix_s(time_s as f64).basic_utc(),
            })
            .collect();
        self.folder.join(name)
    }
}

fn split(name: &str) -> Vec<Part> {
    const TIME: &str = "{time}";
    let mut parts = Vec::new();
    let mut text = String::new();
    let mut rest = name;
    while let Some(first) = rest.chars().next() {
        let taken = if rest.starts_with(TIME) {
            parts.push(Part::Text(std::mem::take(&mut text)));
            parts.push(Part::Time);
            TIME.len()
        } else if first == '#' {
            let digits = rest.bytes().take_while(|&b| b == b'#').count();
            parts.push(Part::Text(std::mem::take(&mut text)));
            // A number of 64 bits has at most 20 digits.
            parts.push(Part::Number {
                digits: digits.min(20),
            });
            digits
        } else {
            text.push(first);
            first.len_utf8()
        };
        rest = &rest[taken..];
    }
    parts.push(Part::Text(text));
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_follow_the_pattern() {
        for (pattern, name) in [
            ("sky.exr", "sky.0007.exr"),
            ("out/sky.exr", "out/sky.0007.exr"),
            ("a#b/sky_###.png", "a#b/sky_007.png"),
            ("sky-{time}.exr", "sky-20000229T000000Z.exr"),
            ("{time}_##.jpg", "20000229T000000Z_07.jpg"),
            ("sky", "sky.0007"),
            (".sky", ".sky.0007"),
            ("\u{e9}t\u{e9}.hdr", "\u{e9}t\u{e9}.0007.hdr"),
        ] {
            let path = FramePattern::new(Path::new(pattern)).path(7, 951_782_400);
            assert_eq!(path, Path::new(name));
        }
        assert_eq!(
            FramePattern::new(Path::new("sky.exr")).path(123_456, 0),
            Path::new("sky.123456.exr")
        );
    }
}
