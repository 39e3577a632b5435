//! Cameras by calibration: focal length and principal point in pixels.

use super::{
    Camera, Size,
    axes::CameraAxes,
    projection::{check_azimuth, check_elevation},
};
use crate::ImageError;
use glam::DVec3;

/// Pixel coordinates of a calibration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PixelCentres {
    /// The centre of pixel `(i, j)` is at `(i + 0.5, j + 0.5)`, as everywhere in [`crate::frame`].
    #[default]
    Halves,
    /// The centre is at `(i, j)`, as in OpenCV and most data sets (Middlebury, KITTI).
    Whole,
}

/// A pinhole camera with square or rectangular pixels and any principal point. By default it looks north, level.
///
/// Depth along the axis (z-depth) times [`Intrinsics::ray_length_per_z`] is the distance along the ray of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intrinsics {
    size: Size,
    focal_px: (f64, f64),
    principal_px: (f64, f64),
    axes: CameraAxes,
}

impl Intrinsics {
    /// A camera for pictures of this size from the horizontal and vertical focal length and the principal point (right, down from
    /// the upper left corner), in pixels.
    ///
    /// # Errors
    /// [`ImageError::Setting`] where a focal length is not above 0, or a number is not finite or beyond 1e9.
    pub fn new(
        size: Size,
        focal_px: (f64, f64),
        principal_px: (f64, f64),
        centres: PixelCentres,
    ) -> Result<Self, ImageError> {
        for focal in [focal_px.0, focal_px.1] {
            ImageError::require(
                (1e-3..=1e9).contains(&focal),
                "the focal length in pixels",
                focal,
                "between 0.001 and 1e9",
            )?;
        }
        for principal in [principal_px.0, principal_px.1] {
            ImageError::require(
                principal.abs() <= 1e9,
                "the principal point in pixels",
                principal,
                "a finite number within 1e9",
            )?;
        }
        let shift = match centres {
            PixelCentres::Halves => 0.0,
            PixelCentres::Whole => 0.5,
        };
        Ok(Self {
            size,
            focal_px,
            principal_px: (principal_px.0 + shift, principal_px.1 + shift),
            axes: CameraAxes::new(0.0, 0.0, 0.0),
        })
    }

    /// A camera with square pixels and a central principal point, from the angle between the left and the right edge
    /// in degrees.
    ///
    /// # Errors
    /// [`ImageError::Setting`] where the angle is not above 0 and below 180.
    pub fn from_horizontal_fov(size: Size, degrees: f64) -> Result<Self, ImageError> {
        Self::across(size, f64::from(size.width()), degrees)
    }

    /// The same from the angle between the top and the bottom edge.
    ///
    /// # Errors
    /// [`ImageError::Setting`] where the angle is not above 0 and below 180.
    pub fn from_vertical_fov(size: Size, degrees: f64) -> Result<Self, ImageError> {
        Self::across(size, f64::from(size.height()), degrees)
    }

    /// The same camera as a [`Camera`] in a picture of this size.
    ///
    /// # Errors
    /// [`ImageError::Setting`] where one of its angles is out of range.
    pub fn of_camera(camera: &Camera, size: Size) -> Result<Self, ImageError> {
        Self::from_vertical_fov(size, camera.vertical_fov_deg)?.looking(
            camera.azimuth_deg,
            camera.elevation_deg,
            camera.roll_deg,
        )
    }

    fn across(size: Size, side: f64, degrees: f64) -> Result<Self, ImageError> {
        ImageError::require(
            degrees > 0.0 && degrees < 180.0,
            "the camera's field of view in degrees",
            degrees,
            "above 0 and below 180",
        )?;
        let focal = side / 2.0 / (degrees.to_radians() / 2.0).tan();
        let middle = (
            f64::from(size.width()) / 2.0,
            f64::from(size.height()) / 2.0,
        );
        Self::new(size, (focal, focal), middle, PixelCentres::Halves)
    }

    /// The same camera with its axis at an azimuth (degrees clockwise from north) and an elevation above the horizon (degrees),
    /// and with a roll about the axis (degrees, clockwise as seen by the photographer).
    ///
    /// # Errors
    /// [`ImageError::Setting`] where an angle is not finite or the elevation outside `[-90, 90]`.
    pub fn looking(
        self,
        azimuth_deg: f64,
        elevation_deg: f64,
        roll_deg: f64,
    ) -> Result<Self, ImageError> {
        check_azimuth(azimuth_deg)?;
        check_elevation(elevation_deg)?;
        ImageError::require(
            roll_deg.is_finite(),
            "the roll in degrees",
            roll_deg,
            "a finite number",
        )?;
        Ok(Self {
            axes: CameraAxes::new(azimuth_deg, elevation_deg, roll_deg),
            ..self
        })
    }

    /// The same camera with pixels of this width over height; the horizontal focal length stays.
    ///
    /// # Errors
    /// [`ImageError::Setting`] where the vertical focal length is then out of range.
    pub fn with_pixel_aspect(self, aspect: f64) -> Result<Self, ImageError> {
        let (focal, principal) = (self.focal_px, self.principal_px);
        let focal = (focal.0, focal.0 * aspect);
        Ok(Self {
            axes: self.axes,
            ..Self::new(self.size, focal, principal, PixelCentres::Halves)?
        })
    }

    /// Width and height in pixels.
    pub fn size(&self) -> Size {
        self.size
    }

    /// Horizontal and vertical focal length in pixels.
    pub fn focal_px(&self) -> (f64, f64) {
        self.focal_px
    }

    /// Principal point: pixels to the right and down from the upper left corner.
    pub fn principal_px(&self) -> (f64, f64) {
        self.principal_px
    }

    /// Unit vector along the optical axis, in the world axes of [`airlight::axes`].
    pub fn axis(&self) -> DVec3 {
        self.axes.forward
    }

    /// View direction at the centre of pixel `(i, j)`: a unit vector in the world axes of [`airlight::axes`].
    pub fn pixel_direction(&self, i: u32, j: u32) -> DVec3 {
        self.ray(i, self.y(j)).0
    }

    /// Distance along the ray of pixel `(i, j)` per depth along the axis: 1 or more.
    pub fn ray_length_per_z(&self, i: u32, j: u32) -> f64 {
        self.ray(i, self.y(j)).1
    }

    /// Cosine of the angle between the ray of pixel `(i, j)` and the axis: above 0, at most 1.
    pub fn cos_to_axis(&self, i: u32, j: u32) -> f64 {
        1.0 / self.ray_length_per_z(i, j)
    }

    /// Writes the directions at the pixel centres of row `j` and their ray lengths per depth (slices of at most one row), the same
    /// bits as [`Intrinsics::pixel_direction`] and [`Intrinsics::ray_length_per_z`].
    pub fn fill(&self, j: u32, directions: &mut [DVec3], lengths: &mut [f64]) {
        let y = self.y(j);
        for (i, (direction, length)) in directions.iter_mut().zip(lengths).enumerate() {
            (*direction, *length) = self.ray(i as u32, y);
        }
    }

    /// Writes the ray lengths per depth of row `j` alone, the same bits as [`Intrinsics::ray_length_per_z`].
    pub fn fill_lengths(&self, j: u32, lengths: &mut [f64]) {
        let y = self.y(j);
        for (i, length) in (0..).zip(lengths) {
            *length = self.ray(i, y).1;
        }
    }

    /// Tangent of the vertical angle at the centre of row `j`.
    fn y(&self, j: u32) -> f64 {
        (self.principal_px.1 - (f64::from(j) + 0.5)) / self.focal_px.1
    }

    #[inline(always)]
    fn ray(&self, i: u32, y: f64) -> (DVec3, f64) {
        // A loop over columns divides once.
        let per_px = 1.0 / self.focal_px.0;
        let x = (f64::from(i) + 0.5 - self.principal_px.0) * per_px;
        let length = (1.0 + x * x + y * y).sqrt();
        let ray = self.axes.forward + self.axes.right * x + self.axes.up * y;
        // One division instead of three.
        (ray * (1.0 / length), length)
    }
}
