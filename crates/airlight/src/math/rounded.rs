//! Numbers to print in messages.

/// The number with 6 significant digits: 1.7 for a result of 1.6999999999999997.
pub(crate) fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::rounded;

    #[test]
    fn computed_numbers_are_printed_in_their_shortest_form() {
        for (value, text) in [
            (1.6999999999999997, "1.7"),
            (-10.000000000000002, "-10"),
            (0.0, "0"),
            (123456.7, "123457"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(rounded(value).to_string(), text);
        }
    }
}
