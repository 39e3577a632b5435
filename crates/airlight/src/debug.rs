//! `Debug` of types that hold large tables: some of their fields, and dots for the rest.

/// Implements `Debug` with the listed fields.
macro_rules! debug_fields {
    ($type:ident $(<const $n:ident: usize>)? { $($field:ident),* }) => {
        impl $(<const $n: usize>)? std::fmt::Debug for $type $(<$n>)? {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.debug_struct(stringify!($type))
                    $(.field(stringify!($field), &self.$field))*
                    .finish_non_exhaustive()
            }
        }
    };
}

pub(crate) use debug_fields;

/// A number to print in a message, with 6 significant digits: 1.7 for a result of 1.6999999999999997.
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
