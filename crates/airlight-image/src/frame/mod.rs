//! Projections between pixels and view directions.
//!
//! Pixel coordinates are continuous: x to the right from 0 to the width, y down from 0 to the height; the centre of
//! pixel `(i, j)` is at `(i + 0.5, j + 0.5)`. Directions are unit vectors in the world axes of [`airlight::axes`]
//! (x east, y up, z south).

mod axes;
mod intrinsics;
mod lens;
mod projection;

pub use intrinsics::{Intrinsics, PixelCentres};
pub use projection::{Camera, CubeFace, Fisheye, Projection};

use crate::{ImageError, Size};
use glam::DVec3;
use lens::Lens;

/// A projection with a size in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    projection: Projection,
    size: Size,
    lens: Lens,
}

impl Frame {
    /// A frame of a projection and a size in pixels.
    ///
    /// # Errors
    /// [`ImageError::Size`], or [`ImageError::Setting`] where an angle is not finite or out of range, or a cube face
    /// is not square.
    pub fn new(projection: Projection, width: u32, height: u32) -> Result<Self, ImageError> {
        let size = Size::new(width, height)?;
        projection.check(size)?;
        Ok(Self {
            projection,
            size,
            lens: Lens::new(&projection, size),
        })
    }

    /// The whole sphere as an equirectangular picture, twice as wide as high, with north in the centre.
    ///
    /// # Errors
    /// [`ImageError::Size`] where `height` is not in `1..=32768`.
    pub fn equirectangular(height: u32) -> Result<Self, ImageError> {
        Self::new(
            Projection::Equirectangular {
                center_azimuth_deg: 0.0,
            },
            height.saturating_mul(2),
            height,
        )
    }

    /// The same view in fewer pixels, for a preview or metering: at most `longest_side`, at least 1 a side.
    pub fn preview(&self, longest_side: u32) -> Self {
        let size = self.size.shrunk_to(longest_side);
        Self {
            projection: self.projection,
            size,
            lens: Lens::new(&self.projection, size),
        }
    }

    /// The projection.
    pub fn projection(&self) -> &Projection {
        &self.projection
    }

    /// Width and height in pixels.
    pub fn size(&self) -> Size {
        self.size
    }

    /// View direction at continuous pixel coordinates; `None` outside the picture, outside the circle of a fisheye, and for
    /// numbers that are not finite.
    pub fn direction(&self, px: f64, py: f64) -> Option<DVec3> {
        let inside = (0.0..=f64::from(self.size.width())).contains(&px)
            && (0.0..=f64::from(self.size.height())).contains(&py);
        inside.then(|| self.lens.direction(px, py)).flatten()
    }

    /// View direction at the centre of pixel `(i, j)`; `None` as in [`Frame::direction`].
    pub fn pixel_direction(&self, i: u32, j: u32) -> Option<DVec3> {
        self.direction(f64::from(i) + 0.5, f64::from(j) + 0.5)
    }

    /// Elevation at the pixel centres of row `j`, rad; `None` for projections whose rows have no single elevation.
    pub fn row_elevation_rad(&self, j: u32) -> Option<f64> {
        let is_level = matches!(self.projection, Projection::Equirectangular { .. });
        is_level.then(|| self.lens.elevation(f64::from(j) + 0.5))
    }

    /// Pixel coordinates of a direction (of any length above 0); `None` outside the picture.
    pub fn pixel_of(&self, direction: DVec3) -> Option<(f64, f64)> {
        let unit = direction.try_normalize()?;
        let (px, py) = self.lens.pixel_of(unit)?;
        // Rounding may put a direction at the edge just outside.
        let (w, h) = (f64::from(self.size.width()), f64::from(self.size.height()));
        let slack = 1e-9;
        let inside = px >= -slack * w
            && px <= w * (1.0 + slack)
            && py >= -slack * h
            && py <= h * (1.0 + slack);
        inside.then(|| (px.clamp(0.0, w), py.clamp(0.0, h)))
    }

    /// Solid angle of pixel `(i, j)` in steradians; 0 outside the picture or the circle of a fisheye. Exact except for the fisheye:
    /// relative error below 1e-9 for pixels inside the circle of a picture of 64 or more pixels a side; a pixel cut by the circle
    /// counts by the fraction of its 9 sample points inside.
    pub fn pixel_solid_angle(&self, i: u32, j: u32) -> f64 {
        if i >= self.size.width() || j >= self.size.height() {
            return 0.0;
        }
        let (i, j) = (f64::from(i), f64::from(j));
        self.solid_angle((i, i + 1.0), (j, j + 1.0))
    }

    /// Solid angle in steradians of the rectangle between two columns `x` and two rows `y` in continuous pixel coordinates, which
    /// must lie in the picture; as exact as [`Frame::pixel_solid_angle`] for rectangles up to the size of a pixel.
    pub fn solid_angle(&self, x: (f64, f64), y: (f64, f64)) -> f64 {
        self.lens.solid_angle(x, y)
    }

    /// Prepares directions of whole rows: the same bits as [`Frame::pixel_direction`], without trigonometry per pixel where the
    /// projection allows it.
    pub fn rows(&self) -> FrameRows {
        FrameRows {
            frame: *self,
            columns: self.lens.columns(self.size.width()),
        }
    }
}

/// Directions of whole rows: see [`Frame::rows`].
#[derive(Clone, Debug)]
pub struct FrameRows {
    frame: Frame,
    /// Sine and cosine of the azimuth of each column; empty where columns have none.
    columns: Vec<(f64, f64)>,
}

impl FrameRows {
    /// The frame.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Writes the directions at the pixel centres of row `j` to `out` (at most one row); the zero vector outside the projection.
    pub fn fill(&self, j: u32, out: &mut [DVec3]) {
        let py = f64::from(j) + 0.5;
        if self.columns.is_empty() {
            for (i, direction) in out.iter_mut().enumerate() {
                *direction = self
                    .frame
                    .direction(i as f64 + 0.5, py)
                    .unwrap_or(DVec3::ZERO);
            }
        } else {
            let (sin, cos) = self.frame.lens.elevation(py).sin_cos();
            for (direction, &azimuth) in out.iter_mut().zip(&self.columns) {
                *direction = airlight::axes::from_sines(azimuth, (sin, cos));
            }
        }
    }
}
