//! Parsing of durations such as `90s`, `10m`, `1h30m` and `2d`.

/// Parses a duration such as `90s`, `10m`, `1h30m` or `2d`, in whole seconds above 0.
///
/// # Errors
/// A description of the values allowed.
pub fn parse_span_s(text: &str) -> Result<i64, String> {
    let right =
        "a duration above 0 in days, hours, minutes and whole seconds, such as 10m, 1h30m or 45s";
    let mut total = 0i64;
    let mut rest = text.trim();
    while !rest.is_empty() {
        let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
        let count: i64 = rest[..digits].parse().map_err(|_| right)?;
        let mut after = rest[digits..].chars();
        let unit = match after.next() {
            Some('d') => 86_400,
            Some('h') => 3_600,
            Some('m') => 60,
            Some('s') => 1,
            _ => return Err(right.to_owned()),
        };
        total = count
            .checked_mul(unit)
            .and_then(|s| total.checked_add(s))
            .ok_or(right)?;
        rest = after.as_str();
    }
    match total > 0 {
        true => Ok(total),
        false => Err(right.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_are_sums_of_their_parts() {
        for (text, s) in [("10m", 600), ("1h30m", 5400), ("90s", 90), ("2d", 172_800)] {
            assert_eq!(parse_span_s(text), Ok(s));
        }
        for text in [
            "",
            "10",
            "m",
            "0s",
            "-1m",
            "1y",
            "1h30",
            "99999999999999999999s",
            "9223372036854775807d",
            "1\u{e9}",
        ] {
            assert!(parse_span_s(text).is_err(), "{text}");
        }
    }
}
