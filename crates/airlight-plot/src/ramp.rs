//! Values into colours.

/// How values become colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ramp {
    /// The values at both ends; what lies beyond has the end's colour.
    pub ends: (f64, f64),
    /// Whether colours part at the middle: blue below, white, red above.
    pub diverging: bool,
}

impl Ramp {
    /// From 0, dark, to `most`, bright.
    pub fn from_zero(most: f64) -> Self {
        Self {
            ends: (0.0, most),
            diverging: false,
        }
    }

    /// From `-most`, blue, over 0, white, to `most`, red.
    pub fn both_ways(most: f64) -> Self {
        Self {
            ends: (-most, most),
            diverging: true,
        }
    }

    /// The colour of a value; grey where it is no number.
    pub fn colour(&self, value: f64) -> [u8; 3] {
        if value.is_nan() {
            return [128; 3];
        }
        let (low, high) = self.ends;
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
    fn blue_is_below_and_red_above() {
        let ramp = Ramp::both_ways(2.0);
        let [r, _, b] = ramp.colour(-3.0);
        assert!(b > 2 * r);
        let [r, _, b] = ramp.colour(2.0);
        assert!(r > b);
        assert!(ramp.colour(0.0).iter().all(|&c| c > 225));
        assert_eq!(ramp.colour(f64::NAN), [128; 3]);
    }

    #[test]
    fn brighter_is_more() {
        let ramp = Ramp::from_zero(1.0);
        let light = |v| ramp.colour(v).map(u32::from).iter().sum::<u32>();
        assert!(light(0.0) < light(0.5) && light(0.5) < light(1.0));
    }
}
