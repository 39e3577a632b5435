//! Orientation of stored pictures, by the numbers of EXIF.

use crate::Size;

/// How the rows and columns of a file lie in the upright picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Orientation(u8);

impl Default for Orientation {
    fn default() -> Self {
        Self::UPRIGHT
    }
}

impl Orientation {
    /// The file is stored upright.
    pub const UPRIGHT: Self = Self(1);

    /// From the value of the EXIF tag, 1 to 8.
    pub fn from_exif(value: u16) -> Option<Self> {
        (1..=8).contains(&value).then_some(Self(value as u8))
    }

    /// Value of the EXIF tag.
    pub fn exif(self) -> u8 {
        self.0
    }

    /// True where width and height of the file are height and width of the picture.
    pub fn swaps_sides(self) -> bool {
        self.0 >= 5
    }

    /// Size of a picture after turning it upright; also of an upright one as it is stored.
    pub fn turned(self, size: Size) -> Size {
        match self.swaps_sides() {
            true => size.transposed(),
            false => size,
        }
    }

    /// Turns the samples of a picture of `size` upright, `channels` to a pixel.
    pub(crate) fn apply(self, size: Size, channels: usize, samples: Vec<f32>) -> Vec<f32> {
        if self == Self::UPRIGHT {
            return samples;
        }
        let (width, height) = (size.width() as usize, size.height() as usize);
        let upright = self.turned(size);
        let mut out = Vec::with_capacity(samples.len());
        for y in 0..upright.height() as usize {
            for x in 0..upright.width() as usize {
                let (column, row) = match self.0 {
                    2 => (width - 1 - x, y),
                    3 => (width - 1 - x, height - 1 - y),
                    4 => (x, height - 1 - y),
                    5 => (y, x),
                    6 => (y, height - 1 - x),
                    7 => (width - 1 - y, height - 1 - x),
                    8 => (width - 1 - y, x),
                    _ => (x, y),
                };
                let at = (row * width + column) * channels;
                out.extend_from_slice(&samples[at..at + channels]);
            }
        }
        out
    }
}
