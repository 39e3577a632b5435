//! File names with parts left open: `rgb/*_left.png`, `day/**.exr`.

use crate::error::CliError;
use std::path::{Path, PathBuf};

/// A path with `*`, which stands for one character or more of a file's or folder's name, and `**` (or `**/*`), which reaches into
/// folders as well. What they stand for in a path is its *parts*; the same parts in another pattern name the file that belongs
/// to it. Folders are separated by `/`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    text: String,
    /// Up to the last `/` before the first open part.
    base: PathBuf,
    /// Patterns of the names of folders and files below.
    levels: Vec<Vec<Token>>,
    /// All that is below.
    whole: Vec<Token>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Token {
    Text(String),
    /// `*`
    Name,
    /// `**`
    Path,
}

/// A file that a pattern names.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Match {
    /// What the open parts stand for.
    pub parts: Vec<String>,
    /// The file.
    pub path: PathBuf,
}

/// Folders inside each other that `**` follows.
const DEEPEST: usize = 64;

impl Pattern {
    /// Reads a path as a pattern; `None` where it has no `*`.
    ///
    /// # Errors
    /// [`CliError::Usage`] where it is not Unicode, or open parts touch.
    pub fn new(path: &Path) -> Result<Option<Self>, CliError> {
        if !path.as_os_str().as_encoded_bytes().contains(&b'*') {
            return Ok(None);
        }
        let text = path.to_str().ok_or_else(|| {
            CliError::usage(format!(
                "`{}` is not Unicode, as a pattern must be",
                path.display()
            ))
        })?;
        let text = text.replace(std::path::MAIN_SEPARATOR, "/");
        let open = text.find('*').unwrap_or(0);
        let start = text[..open].rfind('/').map_or(0, |at| at + 1);
        let whole = tokens(&text[start..]);
        let touches = |pair: &[Token]| pair.iter().all(|token| !matches!(token, Token::Text(_)));
        if whole.windows(2).any(touches) {
            return Err(CliError::usage(format!(
                "`{text}`: where one * ends and the next begins cannot be told: put text between them, or leave one out"
            )));
        }
        let levels = text[start..].split('/').map(tokens).collect();
        Ok(Some(Self {
            base: PathBuf::from(&text[..start]),
            levels,
            whole,
            text,
        }))
    }

    /// The pattern as it was given.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The folder that all its files are in, directly or below; empty where it is the current one.
    pub fn base(&self) -> &Path {
        &self.base
    }

    /// How many parts are open.
    pub fn open_parts(&self) -> usize {
        let open = |token: &&Token| !matches!(token, Token::Text(_));
        self.whole.iter().filter(open).count()
    }

    /// The path with these parts, which must be as many as are open.
    pub fn path(&self, parts: &[String]) -> PathBuf {
        let mut parts = parts.iter();
        let below: String = self
            .whole
            .iter()
            .map(|token| match token {
                Token::Text(text) => text.as_str(),
                _ => parts.next().map_or("", String::as_str),
            })
            .collect();
        self.base.join(below)
    }

    /// Whether it names a path, written with the same base.
    pub fn names(&self, path: &Path) -> bool {
        let below = path.strip_prefix(&self.base).ok().and_then(Path::to_str);
        below.is_some_and(|below| matched(&self.whole, below).is_some())
    }

    /// The files that it names, sorted by their parts; hidden ones, and those in hidden folders, are passed over, and `**` does
    /// not follow links to folders.
    ///
    /// # Errors
    /// [`CliError::Failure`] where a folder cannot be read or a name is not Unicode.
    pub fn files(&self) -> Result<Vec<Match>, CliError> {
        let mut found = Vec::new();
        self.walk(&self.base, "", 0, &mut found)?;
        found.sort();
        Ok(found)
    }

    fn walk(
        &self,
        folder: &Path,
        below: &str,
        depth: usize,
        found: &mut Vec<Match>,
    ) -> Result<(), CliError> {
        let deep = self
            .levels
            .iter()
            .take(depth + 1)
            .flatten()
            .any(|t| *t == Token::Path);
        for entry in entries(folder)? {
            let path = folder.join(&entry);
            let Some(name) = entry.to_str() else {
                return Err(CliError::failure(format!(
                    "the name of `{}` is not Unicode, and so cannot be matched or told in a manifest: rename it",
                    path.display()
                )));
            };
            if name.starts_with('.') {
                continue;
            }
            let here = format!("{below}{name}");
            if path.is_dir() {
                let leads = match deep {
                    true => depth < DEEPEST && !path.is_symlink(),
                    false => {
                        depth + 1 < self.levels.len()
                            && matched(&self.levels[depth], name).is_some()
                    }
                };
                if leads {
                    self.walk(&path, &format!("{here}/"), depth + 1, found)?;
                }
            } else if let Some(parts) = matched(&self.whole, &here) {
                found.push(Match { parts, path });
            }
        }
        Ok(())
    }
}

/// The names of what a folder holds.
///
/// # Errors
/// [`CliError::Failure`] where it cannot be read.
fn entries(folder: &Path) -> Result<Vec<std::ffi::OsString>, CliError> {
    let read = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    let failed = |error: std::io::Error| {
        CliError::failure(format!(
            "cannot read the folder `{}`: {error}",
            read.display()
        ))
    };
    std::fs::read_dir(read)
        .map_err(failed)?
        .map(|entry| Ok(entry.map_err(failed)?.file_name()))
        .collect()
}

fn tokens(text: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find('*') {
        if at > 0 {
            tokens.push(Token::Text(rest[..at].to_owned()));
        }
        let (token, long) = match &rest[at..] {
            open if open.starts_with("**/*") => (Token::Path, 4),
            open if open.starts_with("**") => (Token::Path, 2),
            _ => (Token::Name, 1),
        };
        tokens.push(token);
        rest = &rest[at + long..];
    }
    if !rest.is_empty() {
        tokens.push(Token::Text(rest.to_owned()));
    }
    tokens
}

/// What the open parts stand for in a text; each is as short as it can be.
fn matched(tokens: &[Token], text: &str) -> Option<Vec<String>> {
    let Some((first, rest)) = tokens.split_first() else {
        return text.is_empty().then(Vec::new);
    };
    if let Token::Text(part) = first {
        return matched(rest, text.strip_prefix(part.as_str())?);
    }
    let ends = text.char_indices().map(|(at, c)| (at + c.len_utf8(), c));
    for (end, c) in ends {
        if *first == Token::Name && c == '/' {
            return None;
        }
        if let Some(mut parts) = matched(rest, &text[end..]) {
            parts.insert(0, text[..end].to_owned());
            return Some(parts);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern(text: &str) -> Pattern {
        Pattern::new(Path::new(text)).unwrap().unwrap()
    }

    fn parts(text: &str, below: &str) -> Option<Vec<String>> {
        matched(&pattern(text).whole, below)
    }

    #[test]
    fn open_parts_are_found_and_put_elsewhere() {
        for (text, below, expected) in [
            ("rgb/*.png", "a.png", Some(vec!["a"])),
            ("rgb/*.png", ".png", None),
            ("rgb/*.png", "a/b.png", None),
            ("rgb/**.png", "a/b.png", Some(vec!["a/b"])),
            ("rgb/**/*.png", "b.png", Some(vec!["b"])),
            ("rgb/**/*_l.png", "x/y/b_l.png", Some(vec!["x/y/b"])),
            ("s*/rgb/*.png", "s12/rgb/é7.png", Some(vec!["12", "é7"])),
            ("s*/rgb/*.png", "s12/depth/7.png", None),
            ("*_*.png", "a_b_c.png", Some(vec!["a", "b_c"])),
        ] {
            let expected = expected.map(|list| list.into_iter().map(str::to_owned).collect());
            assert_eq!(parts(text, below), expected, "{text} {below}");
        }
        let moved = pattern("out/*/x-*.exr").path(&["12".to_owned(), "é7".to_owned()]);
        assert_eq!(moved, Path::new("out/12/x-é7.exr"));
    }

    #[test]
    fn what_cannot_be_told_apart_is_refused() {
        for text in ["a/***.png", "****", "**/**"] {
            assert!(Pattern::new(Path::new(text)).is_err(), "{text}");
        }
        assert_eq!(Pattern::new(Path::new("a/b.png")), Ok(None));
        assert_eq!(pattern("/a/b*/c*.png").base(), Path::new("/a"));
        assert_eq!(pattern("*.png").base(), Path::new(""));
        assert_eq!(pattern("a/*/b*").open_parts(), 2);
    }
}
