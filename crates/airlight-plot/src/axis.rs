//! What axes show.

/// One curve: its name and its points.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Its name.
    pub name: String,
    /// Places and values; around a point: angles (rad) and distances.
    pub points: Vec<(f64, f64)>,
}

/// What an axis shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The quantity and its unit.
    pub name: String,
    /// Whether it goes by powers of ten; values must then be above 0.
    pub by_powers: bool,
    /// Its ends, where they are not those of the values.
    pub ends: Option<(f64, f64)>,
}

impl Axis {
    /// An axis in even steps.
    pub fn even(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            by_powers: false,
            ends: None,
        }
    }

    /// An axis by powers of ten.
    pub fn powers(name: impl Into<String>) -> Self {
        Self {
            by_powers: true,
            ..Self::even(name)
        }
    }

    /// The same from one value to another.
    pub fn between(self, low: f64, high: f64) -> Self {
        Self {
            ends: Some((low, high)),
            ..self
        }
    }

    pub(crate) fn place(&self, value: f64) -> f64 {
        match self.by_powers {
            true => value.log10(),
            false => value,
        }
    }

    /// Both ends as places: those told, or those of the values.
    pub(crate) fn ends_of(&self, values: impl Iterator<Item = f64>) -> (f64, f64) {
        match self.ends {
            Some((low, high)) => (self.place(low), self.place(high)),
            None => values
                .map(|value| self.place(value))
                .filter(|place| place.is_finite())
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), place| {
                    (low.min(place), high.max(place))
                }),
        }
    }

    /// What is written at a place.
    pub(crate) fn label(&self, place: f64) -> String {
        match self.by_powers {
            true if (place - place.round()).abs() > 1e-6 => String::new(),
            true => power(place.round() as i32),
            false => ((place * 1e6).round() / 1e6)
                .to_string()
                .replace('-', "\u{2212}"),
        }
    }
}

/// A power of ten as one reads it: small powers written out.
fn power(exponent: i32) -> String {
    const DIGITS: [char; 10] = [
        '\u{2070}', '\u{b9}', '\u{b2}', '\u{b3}', '\u{2074}', '\u{2075}', '\u{2076}', '\u{2077}',
        '\u{2078}', '\u{2079}',
    ];
    if (-2..=3).contains(&exponent) {
        return 10f64.powi(exponent).to_string();
    }
    let sign = if exponent < 0 { "\u{207b}" } else { "" };
    let digits: String = exponent
        .unsigned_abs()
        .to_string()
        .bytes()
        .map(|digit| DIGITS[usize::from(digit - b'0')])
        .collect();
    format!("10{sign}{digits}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_written_as_powers() {
        let axis = Axis::powers("x");
        for (place, text) in [
            (0.0, "1"),
            (-2.0, "0.01"),
            (-12.0, "10⁻¹²"),
            (5.0, "10⁵"),
            (0.5, ""),
        ] {
            assert_eq!(axis.label(place), text);
        }
        assert_eq!(Axis::even("x").label(-0.25), "\u{2212}0.25");
    }

    #[test]
    fn ends_are_those_of_values_or_those_told() {
        let values = || [1.0, 100.0, f64::NAN].into_iter();
        assert_eq!(Axis::powers("x").ends_of(values()), (0.0, 2.0));
        assert_eq!(
            Axis::even("x").between(0.0, 5.0).ends_of(values()),
            (0.0, 5.0)
        );
    }
}
