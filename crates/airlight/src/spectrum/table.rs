//! Parser for the tables embedded in the crate.

/// Parses a table of `N` blank-separated numbers on each line; lines that start with `#` are comments.
///
/// # Panics
/// On a malformed line. Only for files compiled into the crate, all of which are read by tests.
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
                    .unwrap_or_else(|| {
                        panic!("expected {N} numbers on a line of an embedded table, got '{line}'")
                    })
            })
        })
        .collect()
}
