//! Sky and things, row by row, and their depth.

use super::super::channels::RgbWeights;
use super::super::layout::PictureFile;
use super::super::rows::{Layer, put};
use super::LitScene;
use super::lit::ViewRay;
use crate::error::CliError;
use crate::interrupt::STOP;
use airlight_image::frame::FrameRows;
use airlight_image::output::Metadata;
use airlight_image::output::exr::{self, ExrOptions, ExrSample};
use airlight_image::rows::RowFn;
use airlight_image::{Control, Frame, Projection, RowSource};
use airlight_render::objects::Ray;
use airlight_render::pixels::{POINTS, directions_within, tagged_path};
use glam::DVec3;

/// A picture of things before the picture of a sky.
pub struct ObjectRows<'a> {
    sky: Box<dyn RowSource + 'a>,
    objects: &'a LitScene,
    draws_things: bool,
    frame: Frame,
    /// Weights of wavelengths in RGB, for pictures with a channel a wavelength.
    spectral: Option<&'a RgbWeights>,
    scale: f32,
}

impl<'a> ObjectRows<'a> {
    /// Things before `sky`; values are `scale` times those of radiance or luminance.
    pub fn new(
        sky: Box<dyn RowSource + 'a>,
        objects: &'a LitScene,
        (frame, layer): (&Frame, Layer),
        spectral: Option<&'a RgbWeights>,
        scale: f32,
    ) -> Self {
        Self {
            sky,
            objects,
            draws_things: layer != Layer::Disc,
            frame: *frame,
            spectral,
            scale,
        }
    }

    /// Puts what of a pixel is covered over what is there.
    fn cover(&self, (i, j): (u32, u32), pixel: &mut [f32], scratch: &mut Scratch) {
        let across = self.frame.pixel_solid_angle(i, j).sqrt();
        let width = across / f64::from(POINTS).sqrt();
        let sights: Vec<ViewRay<'_>> = directions_within(&self.frame, (i, j))
            .filter_map(|direction| self.objects.look(direction, width))
            .collect();
        if sights.is_empty() {
            return;
        }
        let all = POINTS as f32;
        let open = 1.0 - sights.len() as f32 / all;
        if self.draws_things {
            let objects = self.objects;
            let sum = &mut scratch.sum;
            objects.paint.paint(&objects.objects, &sights, sum);
            put(sum, self.spectral, self.scale / all, &mut scratch.pixel);
        }
        for (value, covered) in pixel.iter_mut().zip(&scratch.pixel) {
            *value = open * *value + covered;
        }
    }
}

/// Room for the values of a pixel.
struct Scratch {
    /// Over all lines of sight, in the channels of a table.
    sum: Vec<f32>,
    /// In the picture's channels.
    pixel: Vec<f32>,
}

impl RowSource for ObjectRows<'_> {
    fn channels(&self) -> usize {
        self.sky.channels()
    }

    fn fill_row(&self, y: u32, out: &mut [f32]) {
        self.sky.fill_row(y, out);
        let channels = self.spectral.map_or(3, Vec::len);
        let mut scratch = Scratch {
            sum: vec![0.0; channels],
            pixel: vec![0.0; self.channels()],
        };
        for (i, pixel) in (0..).zip(out.chunks_exact_mut(self.channels())) {
            self.cover((i, y), pixel, &mut scratch);
        }
    }
}

impl LitScene {
    /// What a line of sight meets.
    fn look(&self, direction: DVec3, width: f64) -> Option<ViewRay<'_>> {
        let ray = Ray {
            origin: self.eye,
            direction,
        };
        self.objects.hit(&ray).map(|hit| ViewRay {
            hit,
            direction,
            width,
        })
    }
}

/// Writes the depth of things at the middle of each pixel beside a picture, in metres: `Z` along the camera's axis of a perspective
/// picture, `distance` along the ray of others; infinite where there is only sky.
///
/// # Errors
/// [`CliError`] where it cannot be written.
pub fn write_depth(objects: &LitScene, file: &PictureFile) -> Result<(), CliError> {
    let rows: FrameRows = file.frame.rows();
    let size = file.frame.size();
    let centre = file.frame.direction(
        0.5 * f64::from(size.width()),
        0.5 * f64::from(size.height()),
    );
    let (name, axis) = match (file.frame.projection(), centre) {
        (Projection::Perspective(_), Some(axis)) => ("Z", Some(axis)),
        _ => ("distance", None),
    };
    let depths = RowFn::new(1, |y, out: &mut [f32]| {
        let mut directions = vec![DVec3::ZERO; out.len()];
        rows.fill(y, &mut directions);
        for (depth, direction) in out.iter_mut().zip(directions) {
            let met = match direction == DVec3::ZERO {
                true => None,
                false => objects.look(direction, 0.0),
            };
            *depth = met.map_or(f32::INFINITY, |sight| {
                let along = axis.map_or(1.0, |axis| direction.dot(axis));
                (along * sight.hit.distance_m) as f32
            });
        }
    });
    let options = ExrOptions {
        sample: ExrSample::Float,
        ..ExrOptions::default()
    };
    let metadata = Metadata::default().with_frame(&file.frame);
    exr::write(
        &tagged_path(&file.path, "depth").with_extension("exr"),
        size,
        &[name],
        &depths,
        &options,
        &metadata,
        Control::cancelled_by(&STOP),
    )?;
    Ok(())
}
