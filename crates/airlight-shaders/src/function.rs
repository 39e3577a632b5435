//! The functions of the library with their documentation.

use crate::part::Part;

/// A function of the shader library.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Function {
    /// The file that defines it.
    pub part: Part,
    /// Its name.
    pub name: &'static str,
    /// Its WGSL signature, on one line.
    pub signature: String,
    /// Its documentation, one paragraph an element, without cost and error.
    pub documentation: Vec<String>,
    /// Its cost: exponentials, and texture reads if there are any, in words.
    pub cost: String,
    /// Its largest error compared with f64.
    pub error: ErrorBound,
}

/// Bound of an error: `|got - exact| <= relative |exact| + absolute`.
///
/// Absolute errors are in metres for lengths, and for light in the unit of light whose sources are 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ErrorBound {
    /// Relative to the exact value.
    pub relative: f64,
    /// In the unit of the value.
    pub absolute: f64,
}

impl ErrorBound {
    /// Reads `3e-7 relative plus 1e-3 absolute`, or either half.
    fn parse(text: &str) -> Option<Self> {
        let mut bound = Self::default();
        for half in text.split(" plus ") {
            let (number, kind) = half.split_once(' ')?;
            let number = number.parse().ok()?;
            match kind {
                "relative" => bound.relative = number,
                "absolute" => bound.absolute = number,
                _ => return None,
            }
        }
        Some(bound)
    }
}

/// The functions of a part, in the order of the file.
///
/// # Panics
/// Never: the test `every_function_states_its_cost_and_error` reads all files.
pub fn functions(part: Part) -> Vec<Function> {
    let mut functions = Vec::new();
    let mut comment: Vec<&'static str> = Vec::new();
    let mut lines = part.text().lines();
    while let Some(line) = lines.next() {
        if let Some(text) = line.strip_prefix("///") {
            comment.push(text.trim());
            continue;
        }
        if let Some(rest) = line.strip_prefix("fn ") {
            let mut signature = line.to_owned();
            while !signature.ends_with('{') {
                signature.push(' ');
                signature.push_str(lines.next().expect("the body of a function").trim());
            }
            let signature = signature.trim_end_matches(['{', ' ']).to_owned();
            let name = &rest[..rest.find('(').expect("the parameters of a function")];
            let (documentation, cost, error) =
                documented(&comment).unwrap_or_else(|| panic!("the cost and the error of {name}"));
            functions.push(Function {
                part,
                name,
                signature,
                documentation,
                cost,
                error,
            });
        }
        comment.clear();
    }
    functions
}

/// Paragraphs, cost and error of a comment, whose last paragraph is `Cost: .. Error: ..`.
fn documented(comment: &[&str]) -> Option<(Vec<String>, String, ErrorBound)> {
    let mut paragraphs: Vec<String> = comment
        .split(|line| line.is_empty())
        .map(|lines| lines.join(" "))
        .collect();
    let last = paragraphs.pop()?;
    let (cost, error) = last.strip_prefix("Cost: ")?.split_once(". Error: ")?;
    let error = ErrorBound::parse(error.strip_suffix('.')?)?;
    Some((paragraphs, cost.to_owned(), error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::Named;

    #[test]
    fn every_function_states_its_cost_and_error() {
        for &part in Part::ALL {
            for function in functions(part) {
                let ErrorBound { relative, absolute } = function.error;
                assert!(relative + absolute > 0.0, "{}", function.name);
                assert!(!function.documentation.is_empty(), "{}", function.name);
                assert!(
                    function.signature.contains(") -> "),
                    "{}",
                    function.signature
                );
            }
        }
    }

    #[test]
    fn errors_are_read_from_their_text() {
        let bound = |text| ErrorBound::parse(text).map(|b| (b.relative, b.absolute));
        assert_eq!(bound("2e-6 relative"), Some((2e-6, 0.0)));
        assert_eq!(bound("2e-6 relative plus 40 absolute"), Some((2e-6, 40.0)));
        assert_eq!(bound("2e-6"), None);
        assert_eq!(bound("small relative"), None);
    }
}
