//! Width and height of pictures.

use crate::ImageError;

/// Width and height of a picture in pixels, each in `1..=65536`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Size {
    width: u32,
    height: u32,
}

impl Size {
    /// Largest width and height.
    pub const MAX: u32 = 65536;

    /// A size of `width` times `height` pixels.
    ///
    /// # Errors
    /// [`ImageError::Size`] where one is 0 or above 65536.
    pub fn new(width: u32, height: u32) -> Result<Self, ImageError> {
        let fits = |n| (1..=Self::MAX).contains(&n);
        if fits(width) && fits(height) {
            Ok(Self { width, height })
        } else {
            Err(ImageError::Size { width, height })
        }
    }

    /// Number of pixels in a row.
    pub fn width(self) -> u32 {
        self.width
    }

    /// Number of rows.
    pub fn height(self) -> u32 {
        self.height
    }

    /// Height and width exchanged.
    pub(crate) fn transposed(self) -> Self {
        Self {
            width: self.height,
            height: self.width,
        }
    }

    /// The same aspect ratio in fewer pixels: at most `longest_side`, at least 1 a side.
    pub fn shrunk_to(self, longest_side: u32) -> Self {
        let longest = self.width.max(self.height);
        let side = longest_side.clamp(1, longest);
        let scaled = |n: u32| {
            let n = u64::from(n) * u64::from(side) + u64::from(longest) / 2;
            (n / u64::from(longest)).max(1) as u32
        };
        Self {
            width: scaled(self.width),
            height: scaled(self.height),
        }
    }
}
