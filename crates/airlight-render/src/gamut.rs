//! Colours outside an RGB space, moved into it.

use airlight::spectrum::RgbSpace;
use airlight_image::RowSource;
use airlight_image::tone::without_negatives;

/// Rows whose negative components of red, green and blue are removed: such a colour moves towards grey of the same luminance until
/// its least component is 0.
pub(crate) struct InGamut<'a> {
    rows: Box<dyn RowSource + 'a>,
    /// Luminance of red, green and blue.
    weights: [f32; 3],
}

impl<'a> InGamut<'a> {
    /// Rows whose first three channels are colours of a space.
    pub fn new(rows: Box<dyn RowSource + 'a>, space: RgbSpace) -> Self {
        Self {
            rows,
            weights: space.to_xyz_matrix()[1].map(|weight| weight as f32),
        }
    }
}

impl RowSource for InGamut<'_> {
    fn channels(&self) -> usize {
        self.rows.channels()
    }

    fn fill_row(&self, y: u32, out: &mut [f32]) {
        self.rows.fill_row(y, out);
        for pixel in out.chunks_exact_mut(self.rows.channels()) {
            let moved = without_negatives([pixel[0], pixel[1], pixel[2]], self.weights);
            pixel[..3].copy_from_slice(&moved);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight_image::rows::StoredRows;

    #[test]
    fn colours_move_into_the_gamut_and_keep_their_luminance() {
        let pixels = vec![
            2e9, 1e8, -5e5, 1.0, 2.0, 3.0, -1.0, 0.5, 0.25, -1.0, -1.0, -1.0,
        ];
        let rows = StoredRows::new(4, 3, pixels.clone()).unwrap();
        let mut out = vec![0.0; 12];
        InGamut::new(Box::new(rows), RgbSpace::Srgb).fill_row(0, &mut out);
        assert_eq!(out[3..6], pixels[3..6]);
        assert_eq!(out[9..], [0.0; 3]);
        for at in [0, 6] {
            let luminance =
                |rgb: &[f32]| RgbSpace::Srgb.luminance([0, 1, 2].map(|c| rgb[c].into()));
            let (before, after) = (luminance(&pixels[at..]), luminance(&out[at..]));
            assert!((after / before - 1.0).abs() < 1e-5, "{before} {after}");
            assert!(
                out[at..at + 3].iter().all(|c| *c >= 0.0),
                "{:?}",
                &out[at..at + 3]
            );
        }
    }
}
