//! Reads the tables embedded in the crate.

/// The rows of a table of `N` numbers a line, blank-separated; lines that start with `#` are comments.
///
/// Only for files compiled into the crate, whose tests read every one of them: a malformed line is a defect of the
/// build, so it panics and names the line.
pub(crate) fn embedded<const N: usize>(text: &str) -> Vec<[f64; N]> {
    text.lines()
        .map(str::trim)
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
        .map(|line| {
            let mut fields = line.split_ascii_whitespace();
            std::array::from_fn(|_| {
                fields
                    .next()
                    .and_then(|field| field.parse().ok())
                    .unwrap_or_else(|| panic!("an embedded table has the bad line '{line}'"))
            })
        })
        .collect()
}
