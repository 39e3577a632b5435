//! Components of interleaved pixels of integers.

/// Components of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PixelLayout {
    /// 1 (grey) or 3.
    pub(super) colours: usize,
    /// Whether opacity follows the colours.
    pub(super) alpha: bool,
}

impl PixelLayout {
    /// Number of components.
    pub(super) fn count(self) -> usize {
        self.colours + usize::from(self.alpha)
    }

    /// Appends rows of interleaved values, decoded with a table; opacity is linear.
    #[inline(always)]
    pub(super) fn split<T: Copy + Into<usize>>(
        self,
        values: impl ExactSizeIterator<Item = T>,
        table: &[f32],
        rgb: &mut Vec<f32>,
        alpha: Option<&mut Vec<f32>>,
    ) {
        // The table has an entry for each value of T: the default is never used.
        let light = |v: T| table.get(v.into()).copied().unwrap_or(0.0);
        let opaque = (table.len() - 1) as f32;
        match (self.colours, alpha) {
            (3, None) => rgb.extend(values.map(light)),
            (1, None) => values.for_each(|v| rgb.extend_from_slice(&[light(v); 3])),
            (3, Some(alpha)) => {
                for (i, v) in values.enumerate() {
                    match i % 4 {
                        3 => alpha.push(v.into() as f32 / opaque),
                        _ => rgb.push(light(v)),
                    }
                }
            }
            (_, Some(alpha)) => {
                for (i, v) in values.enumerate() {
                    match i % 2 {
                        1 => alpha.push(v.into() as f32 / opaque),
                        _ => rgb.extend_from_slice(&[light(v); 3]),
                    }
                }
            }
            _ => {}
        }
    }
}
