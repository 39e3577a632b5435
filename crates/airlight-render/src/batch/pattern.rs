//! File name patterns with wildcards: `rgb/*_left.png`, `day/**.exr`.

use super::BatchError;
use std::path::{Path, PathBuf};

/// A path with the wildcards `*`, which matches one or more characters of a file or folder name, and `**` (or `**/*`), which
/// also matches across folders. The texts that they match are the *captures* of a path; inserted into another pattern they give
/// the path of the corresponding file. Folders are separated by `/`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    text: String,
    /// Up to the last `/` before the first wildcard.
    base: PathBuf,
    /// Patterns of the folder and file names below the base.
    levels: Vec<Vec<Token>>,
    /// Pattern of the whole path below the base.
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

/// A file that a pattern matches.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Match {
    /// Texts matched by the wildcards, in order.
    pub captures: Vec<String>,
    /// The file.
    pub path: PathBuf,
}

/// Depth of folders to which `**` descends.
const MAX_DEPTH: usize = 64;

impl Pattern {
    /// Parses a path as a pattern; `None` if it has no `*`.
    ///
    /// # Errors
    /// [`BatchError::NotUnicode`] or [`BatchError::AdjacentWildcards`] for an invalid pattern.
    pub fn new(path: &Path) -> Result<Option<Self>, BatchError> {
        if !path.as_os_str().as_encoded_bytes().contains(&b'*') {
            return Ok(None);
        }
        let text = path
            .to_str()
            .ok_or_else(|| BatchError::NotUnicode(path.to_owned()))?;
        let text = text.replace(std::path::MAIN_SEPARATOR, "/");
        let open = text.find('*').unwrap_or(0);
        let start = text[..open].rfind('/').map_or(0, |at| at + 1);
        let whole = tokens(&text[start..]);
        let touches = |pair: &[Token]| pair.iter().all(|token| !matches!(token, Token::Text(_)));
        if whole.windows(2).any(touches) {
            return Err(BatchError::AdjacentWildcards(text));
        }
        let levels = text[start..].split('/').map(tokens).collect();
        Ok(Some(Self {
            base: PathBuf::from(&text[..start]),
            levels,
            whole,
            text,
        }))
    }

    /// The pattern as given.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The folder that contains all matching files, directly or in subfolders; empty for the current folder.
    pub fn base(&self) -> &Path {
        &self.base
    }

    /// Number of wildcards.
    pub fn wildcards(&self) -> usize {
        let wildcard = |token: &&Token| !matches!(token, Token::Text(_));
        self.whole.iter().filter(wildcard).count()
    }

    /// Checks that the number of wildcards is that of the colour pattern; `role` is the purpose of the pattern.
    ///
    /// # Errors
    /// [`BatchError::WildcardCount`] for another number.
    pub(super) fn check_wildcards(
        &self,
        expected: usize,
        role: &'static str,
    ) -> Result<(), BatchError> {
        match self.wildcards() {
            got if got == expected => Ok(()),
            got => Err(BatchError::WildcardCount {
                role,
                pattern: self.text.clone(),
                expected,
                got,
            }),
        }
    }

    /// The path with each wildcard replaced by its capture.
    pub fn path(&self, captures: &[String]) -> PathBuf {
        let mut captures = captures.iter();
        let below: String = self
            .whole
            .iter()
            .map(|token| match token {
                Token::Text(text) => text.as_str(),
                _ => captures.next().map_or("", String::as_str),
            })
            .collect();
        self.base.join(below)
    }

    /// Whether the pattern matches a path that begins with the same base.
    pub fn matches(&self, path: &Path) -> bool {
        let below = path.strip_prefix(&self.base).ok().and_then(Path::to_str);
        below.is_some_and(|below| matched(&self.whole, below).is_some())
    }

    /// Matching files, sorted by their captures, without hidden files and folders; `**` does not follow links to folders.
    ///
    /// # Errors
    /// [`BatchError::File`] if a folder cannot be read, [`BatchError::NotUnicode`] for a name that is not Unicode.
    pub fn files(&self) -> Result<Vec<Match>, BatchError> {
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
    ) -> Result<(), BatchError> {
        let deep = self
            .levels
            .iter()
            .take(depth + 1)
            .flatten()
            .any(|t| *t == Token::Path);
        for entry in entries(folder)? {
            let path = folder.join(&entry);
            let Some(name) = entry.to_str() else {
                return Err(BatchError::NotUnicode(path));
            };
            if name.starts_with('.') {
                continue;
            }
            let here = format!("{below}{name}");
            if path.is_dir() {
                let leads = match deep {
                    true => depth < MAX_DEPTH && !path.is_symlink(),
                    false => {
                        depth + 1 < self.levels.len()
                            && matched(&self.levels[depth], name).is_some()
                    }
                };
                if leads {
                    self.walk(&path, &format!("{here}/"), depth + 1, found)?;
                }
            } else if let Some(captures) = matched(&self.whole, &here) {
                found.push(Match { captures, path });
            }
        }
        Ok(())
    }
}

/// Names of the entries of a folder.
///
/// # Errors
/// [`BatchError::File`] if it cannot be read.
fn entries(folder: &Path) -> Result<Vec<std::ffi::OsString>, BatchError> {
    let read = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    let failed = |source: std::io::Error| BatchError::File {
        action: "read the folder",
        path: read.to_owned(),
        source,
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

/// Texts matched by the wildcards, each as short as possible.
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
        if let Some(mut captures) = matched(rest, &text[end..]) {
            captures.insert(0, text[..end].to_owned());
            return Some(captures);
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

    fn captures(text: &str, below: &str) -> Option<Vec<String>> {
        matched(&pattern(text).whole, below)
    }

    #[test]
    fn captures_are_found_and_inserted_into_another_pattern() {
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
            assert_eq!(captures(text, below), expected, "{text} {below}");
        }
        let moved = pattern("out/*/x-*.exr").path(&["12".to_owned(), "é7".to_owned()]);
        assert_eq!(moved, Path::new("out/12/x-é7.exr"));
    }

    #[test]
    fn adjacent_wildcards_are_refused() {
        for text in ["a/***.png", "****", "**/**"] {
            assert!(Pattern::new(Path::new(text)).is_err(), "{text}");
        }
        assert!(Pattern::new(Path::new("a/b.png")).unwrap().is_none());
        assert_eq!(pattern("/a/b*/c*.png").base(), Path::new("/a"));
        assert_eq!(pattern("*.png").base(), Path::new(""));
        assert_eq!(pattern("a/*/b*").wildcards(), 2);
    }
}
