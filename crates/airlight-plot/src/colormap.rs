//! Colour maps: from values to colours.

/// A colour map over a range of values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colormap {
    /// Values of the first and the last colour; values outside have the colour of the nearer end.
    pub range: (f64, f64),
    /// Diverging colours (blue, white in the middle, red) instead of sequential ones (dark to bright).
    pub diverging: bool,
}

impl Colormap {
    /// Viridis from 0 (dark) to `max` (bright).
    pub fn sequential(max: f64) -> Self {
        Self {
            range: (0.0, max),
            diverging: false,
        }
    }

    /// From blue at `-max` over white at 0 to red at `max`.
    pub fn diverging(max: f64) -> Self {
        Self {
            range: (-max, max),
            diverging: true,
        }
    }

    /// 8-bit sRGB colour of a value; grey for NaN.
    pub fn colour(&self, value: f64) -> [u8; 3] {
        if value.is_nan() {
            return [128; 3];
        }
        let (low, high) = self.range;
        let part = ((value - low) / (high - low)).clamp(0.0, 1.0);
        let colour = match self.diverging {
            true => colorous::RED_BLUE.eval_continuous(1.0 - part),
            false => colorous::VIRIDIS.eval_continuous(part),
        };
        colour.as_array()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diverging_colours_are_blue_below_and_red_above() {
        let map = Colormap::diverging(2.0);
        let [r, _, b] = map.colour(-3.0);
        assert!(b > 2 * r);
        let [r, _, b] = map.colour(2.0);
        assert!(r > b);
        assert!(map.colour(0.0).iter().all(|&c| c > 225));
        assert_eq!(map.colour(f64::NAN), [128; 3]);
    }

    #[test]
    fn sequential_colours_grow_brighter() {
        let map = Colormap::sequential(1.0);
        let light = |v| map.colour(v).map(u32::from).iter().sum::<u32>();
        assert!(light(0.0) < light(0.5) && light(0.5) < light(1.0));
    }
}
