//! Axes of charts, and curves over them.

/// A named series of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name in the legend.
    pub name: String,
    /// Position on the horizontal axis and value; in a polar plot angle (rad) and distance.
    pub points: Vec<(f64, f64)>,
}

/// Label, scale and range of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// Logarithmic scale; values must be above 0.
    pub logarithmic: bool,
    /// First and last value shown; the range of the data where `None`.
    pub range: Option<(f64, f64)>,
}

impl Axis {
    /// An axis with a linear scale.
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            logarithmic: false,
            range: None,
        }
    }

    /// An axis with a logarithmic scale and ticks at powers of ten.
    pub fn logarithmic(label: impl Into<String>) -> Self {
        Self {
            logarithmic: true,
            ..Self::linear(label)
        }
    }

    /// The same axis with a fixed range.
    pub fn with_range(self, low: f64, high: f64) -> Self {
        Self {
            range: Some((low, high)),
            ..self
        }
    }

    /// Position of a value on the axis: the value, or its decimal logarithm.
    pub(crate) fn position(&self, value: f64) -> f64 {
        match self.logarithmic {
            true => value.log10(),
            false => value,
        }
    }

    /// Positions of both ends: those of the fixed range, or of the finite values.
    pub(crate) fn extent(&self, values: impl Iterator<Item = f64>) -> (f64, f64) {
        match self.range {
            Some((low, high)) => (self.position(low), self.position(high)),
            None => values
                .map(|value| self.position(value))
                .filter(|position| position.is_finite())
                .fold(
                    (f64::INFINITY, f64::NEG_INFINITY),
                    |(low, high), position| (low.min(position), high.max(position)),
                ),
        }
    }

    /// Label of a tick at a position; empty between powers of ten.
    pub(crate) fn tick_label(&self, position: f64) -> String {
        match self.logarithmic {
            true if (position - position.round()).abs() > 1e-6 => String::new(),
            true => power_of_ten(position.round() as i32),
            false => number(position),
        }
    }
}

/// A number to a millionth, with a minus sign instead of a hyphen.
pub(crate) fn number(value: f64) -> String {
    ((value * 1e6).round() / 1e6)
        .to_string()
        .replace('-', "\u{2212}")
}

/// `10^exponent` with a superscript exponent; written out from 0.01 to 1000.
fn power_of_ten(exponent: i32) -> String {
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
    fn logarithmic_ticks_are_powers_of_ten() {
        let axis = Axis::logarithmic("x");
        for (position, label) in [
            (0.0, "1"),
            (-2.0, "0.01"),
            (-12.0, "10⁻¹²"),
            (5.0, "10⁵"),
            (0.5, ""),
        ] {
            assert_eq!(axis.tick_label(position), label);
        }
        assert_eq!(Axis::linear("x").tick_label(-0.25), "\u{2212}0.25");
    }

    #[test]
    fn the_extent_is_the_range_or_that_of_the_values() {
        let values = || [1.0, 100.0, f64::NAN].into_iter();
        assert_eq!(Axis::logarithmic("x").extent(values()), (0.0, 2.0));
        assert_eq!(
            Axis::linear("x").with_range(0.0, 5.0).extent(values()),
            (0.0, 5.0)
        );
    }
}
