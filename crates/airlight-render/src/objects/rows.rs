//! Rows of objects in front of a sky, and their depth.

use super::lit::{LitObjects, Scratch, ViewRay};
use crate::channels::PixelChannels;
use crate::layout::PictureFile;
use crate::pixels::{POINTS, directions_within};
use crate::sky_rows::Layer;
use airlight_image::output::exr::{self, ExrOptions, SamplePrecision};
use airlight_image::output::{Metadata, Written};
use airlight_image::rows::{RowFn, RowsFrom};
use airlight_image::{Control, Frame, ImageError, Projection, RowSource};
use glam::DVec3;
use std::fmt;

/// Rows of objects in front of rows of a sky.
pub struct ObjectRows<'a> {
    sky: Box<dyn RowSource + 'a>,
    objects: &'a LitObjects,
    draws_objects: bool,
    frame: Frame,
    channels: &'a PixelChannels,
    scale: f32,
}

impl fmt::Debug for ObjectRows<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ObjectRows")
            .field("draws_objects", &self.draws_objects)
            .field("frame", &self.frame)
            .field("scale", &self.scale)
            .finish_non_exhaustive()
    }
}

impl<'a> ObjectRows<'a> {
    /// Objects in front of `sky`; values are radiance or luminance multiplied by `scale`. In the layer of the sun's disc, objects
    /// hide the disc and are black.
    pub fn new(
        sky: Box<dyn RowSource + 'a>,
        objects: &'a LitObjects,
        (frame, layer): (&Frame, Layer),
        channels: &'a PixelChannels,
        scale: f32,
    ) -> Self {
        Self {
            sky,
            objects,
            draws_objects: layer != Layer::Disc,
            frame: *frame,
            channels,
            scale,
        }
    }

    /// Draws objects over the value of a pixel.
    fn cover(&self, (i, j): (u32, u32), pixel: &mut [f32], buffers: &mut Buffers<'a>) {
        let Buffers {
            directions,
            rays,
            covered,
            scratch,
        } = buffers;
        directions.clear();
        directions.extend(directions_within(&self.frame, (i, j)));
        let width = || (self.frame.pixel_solid_angle(i, j) / f64::from(POINTS)).sqrt();
        self.objects.hits(directions, width, scratch, rays);
        if rays.is_empty() {
            return;
        }
        let all = POINTS as f32;
        let open = 1.0 - rays.len() as f32 / all;
        covered.fill(0.0);
        if self.draws_objects {
            let sum = self.objects.radiance(rays, scratch);
            self.channels.add(sum, self.scale / all, covered);
        }
        for (value, covered) in pixel.iter_mut().zip(covered) {
            *value = open * *value + *covered;
        }
    }
}

/// Buffers for the pixels of a row.
struct Buffers<'a> {
    directions: Vec<DVec3>,
    rays: Vec<ViewRay<'a>>,
    covered: Vec<f32>,
    scratch: Scratch,
}

impl RowSource for ObjectRows<'_> {
    fn channels(&self) -> usize {
        self.sky.channels()
    }

    fn fill_row(&self, y: u32, out: &mut [f32]) {
        self.sky.fill_row(y, out);
        let mut buffers = Buffers {
            directions: Vec::with_capacity(POINTS as usize),
            rays: Vec::with_capacity(POINTS as usize),
            covered: vec![0.0; self.channels.count()],
            scratch: self.objects.scratch(),
        };
        for (i, pixel) in (0..).zip(out.chunks_exact_mut(self.channels.count())) {
            self.cover((i, y), pixel, &mut buffers);
        }
    }
}

/// Writes the depth of objects at the centre of each pixel as OpenEXR, in metres: `Z` along the camera's axis for perspective
/// pictures, `distance` along the ray for others; infinite for sky.
///
/// # Errors
/// [`ImageError`] if the file cannot be written.
pub fn write_depth(
    file: &PictureFile,
    objects: &LitObjects,
    control: Control<'_>,
) -> Result<Written, ImageError> {
    let frame = &file.frame;
    let rows = frame.rows();
    let size = frame.size();
    let centre = frame.direction(
        0.5 * f64::from(size.width()),
        0.5 * f64::from(size.height()),
    );
    let (name, axis) = match (frame.projection(), centre) {
        (Projection::Perspective(_), Some(axis)) => ("Z", Some(axis)),
        _ => ("distance", None),
    };
    let depths = RowFn::new(1, |y, out: &mut [f32]| {
        let mut directions = vec![DVec3::ZERO; out.len()];
        rows.fill(y, &mut directions);
        for (depth, direction) in out.iter_mut().zip(directions) {
            let ray = match direction == DVec3::ZERO {
                true => None,
                false => objects.hit(direction, 0.0),
            };
            *depth = ray.map_or(f32::INFINITY, |ray| {
                let along = axis.map_or(1.0, |axis| direction.dot(axis));
                (along * ray.hit.distance_m) as f32
            });
        }
    });
    let options = ExrOptions {
        precision: SamplePrecision::Float,
        ..ExrOptions::default()
    };
    let metadata = Metadata {
        band: file.band(),
        ..Metadata::default().with_frame(frame)
    };
    let depths = RowsFrom::new(&depths, file.rows().start);
    let path = file.map_path("depth");
    exr::write(
        &path,
        file.size(),
        &[name],
        &depths,
        &options,
        &metadata,
        control,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::objects::Objects;
    use crate::test_view::TestView;
    use airlight::axes;
    use airlight::scene::RadianceView;
    use airlight::spectrum::RgbSpace;
    use airlight_image::rows::StoredRows;
    use airlight_image::{Camera, Size};
    use std::f64::consts::PI;
    use std::sync::Arc;

    const PLANE: &str = "[[object]]\nshape = \"ground\"\nreflectance = 0.3\n";

    fn lit(text: &str, sun: DVec3, shadows: bool) -> LitObjects {
        let view: Arc<dyn RadianceView> = Arc::new(TestView::with_sun(sun));
        let objects = Arc::new(Objects::from_toml(text).unwrap());
        LitObjects::new(objects, (2.0, view.clone()), vec![(1.0, view)], shadows)
    }

    /// A camera that looks north.
    fn camera(elevation_deg: f64, fov_deg: f64, side: u32) -> Frame {
        let size = Size::new(side, side).unwrap();
        let camera = Camera::with_horizontal_fov(0.0, elevation_deg, fov_deg, size);
        Frame::new(Projection::Perspective(camera), side, side).unwrap()
    }

    /// Green of the middle pixel of objects over a black sky.
    fn middle(objects: &LitObjects, frame: &Frame, layer: Layer) -> f32 {
        let side = frame.size().width();
        let channels = PixelChannels::rgb(RgbSpace::Srgb);
        let black = vec![100.0; 3 * (side * side) as usize];
        let sky = Box::new(StoredRows::new(side, 3, black).unwrap());
        let rows = ObjectRows::new(sky, objects, (frame, layer), &channels, 1.0);
        let mut row = vec![0.0; 3 * side as usize];
        rows.fill_row(side / 2, &mut row);
        row[3 * (side as usize / 2) + 1]
    }

    #[test]
    fn a_plane_reflects_sun_and_sky_through_the_air() {
        let sun = axes::direction(150.0, 35.0);
        let objects = lit(PLANE, sun, true);
        let frame = camera(-40.0, 0.1, 9);
        let got = f64::from(middle(&objects, &frame, Layer::All));
        let e = TestView::with_sun(sun).disc_irradiance_above_horizon();
        let distance_m = 2.0 / 40f64.to_radians().sin();
        let want = 0.3 / PI * (e * sun.y + PI * f64::from(TestView::SKY))
            + f64::from(TestView::AIR_PER_M) * distance_m;
        assert!((got / want - 1.0).abs() < 1e-4, "{got} {want}");
        assert_eq!(middle(&objects, &frame, Layer::Disc), 0.0);
    }

    #[test]
    fn shadows_can_be_disabled() {
        let solid = "\n[[object]]\nshape = \"sphere\"\nat_m = [0, 30, -2.4]\nradius_m = 8\n";
        let (text, frame) = (format!("{PLANE}{solid}"), camera(-40.0, 1.0, 9));
        let at = |shadows| {
            middle(
                &lit(&text, axes::direction(180.0, 89.0), shadows),
                &frame,
                Layer::All,
            )
        };
        assert!(at(false) > 3.0 * at(true) && at(true) > 0.0);
    }

    #[test]
    fn objects_hide_the_sky_and_have_depth() {
        let solid = "[[object]]\nshape = \"sphere\"\nat_m = [0, 2, -20]\nradius_m = 2\n\
            reflectance = [0.5, 0.1, 0.1]\n";
        let objects = lit(solid, axes::direction(170.0, 20.0), true);
        let frame = camera(5.0, 40.0, 33);
        let level = 5f64.to_radians();
        let ahead = objects.hit(-DVec3::Z, 0.0).unwrap();
        assert!((ahead.hit.distance_m - 18.0).abs() < 1e-9);
        let path =
            std::env::temp_dir().join(format!("airlight-objects-{}.exr", std::process::id()));
        let file = PictureFile::whole(path, frame, Layer::All);
        let path = file.map_path("depth");
        write_depth(&file, &objects, Control::default()).unwrap();
        let options = airlight_image::DepthOptions {
            unknown: airlight_image::input::UnknownDepth::Far,
            ..Default::default()
        };
        let depth = airlight_image::read_depth(&path, &options).unwrap();
        std::fs::remove_file(&path).unwrap();
        let (x, y) = frame.pixel_of(-DVec3::Z).unwrap();
        let at = |x: f64, y: f64| f64::from(depth.metres[33 * y as usize + x as usize]);
        assert!((at(x, y) - 18.0 * level.cos()).abs() < 0.1, "{}", at(x, y));
        assert_eq!(at(0.0, 0.0), f64::INFINITY);
    }
}
