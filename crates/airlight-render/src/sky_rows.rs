//! Rows of sky and sun's disc.

use crate::channels::PixelChannels;
use crate::pixels::{directions_within, pixel_reach};
use crate::star_points::StarPoints;
use crate::sun_disc::SunDiscImage;
use airlight::scene::{RadianceView, RowSampler, StarField};
use airlight_image::frame::FrameRows;
use airlight_image::{Frame, Projection, RowSource};
use glam::DVec3;
use std::cell::OnceCell;

/// Part of the light that is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// Sky, objects and the sun's disc.
    All,
    /// Sky and objects without the sun's disc.
    Sky,
    /// Only the sun's disc.
    Disc,
}

/// Source of the sky's radiance.
#[derive(Clone, Copy, Debug)]
pub enum SkyValues<'a> {
    /// A view, evaluated in each direction.
    View(&'a dyn RadianceView),
    /// Values of the pixels of rows in the channels of a view.
    Stored {
        /// Values, row by row.
        values: &'a [f32],
        /// The row with which they begin.
        first_row: u32,
    },
}

/// What is drawn of a sky.
#[derive(Clone, Copy, Debug)]
pub struct SkySources<'a> {
    /// Diffuse light.
    pub sky: SkyValues<'a>,
    /// Discs of sun and moon.
    pub discs: &'a [SunDiscImage],
    /// Single stars, part of the sky.
    pub stars: Option<&'a StarField>,
}

/// Rows of the sky in one frame.
#[derive(Debug)]
pub struct SkyRows<'a> {
    sky: Option<SkyValues<'a>>,
    sampler: Option<Box<dyn RowSampler>>,
    discs: &'a [SunDiscImage],
    stars: Option<StarPoints<'a>>,
    channels: &'a PixelChannels,
    rows: FrameRows,
    scale: f32,
    pixel_reach: f64,
}

/// A row of pixels with its directions, which are computed where they are needed.
struct Row<'a> {
    rows: &'a FrameRows,
    y: u32,
    directions: OnceCell<Vec<DVec3>>,
}

impl Row<'_> {
    fn directions(&self) -> &[DVec3] {
        self.directions.get_or_init(|| {
            let width = self.rows.frame().size().width() as usize;
            let mut directions = vec![DVec3::ZERO; width];
            self.rows.fill(self.y, &mut directions);
            directions
        })
    }
}

impl<'a> SkyRows<'a> {
    /// Rows of a layer of `frame`; values are radiance or luminance multiplied by `scale`.
    pub fn new(
        frame: &Frame,
        layer: Layer,
        sources: SkySources<'a>,
        channels: &'a PixelChannels,
        scale: f32,
    ) -> Self {
        let sky = (layer != Layer::Disc).then_some(sources.sky);
        let stars = sources.stars.filter(|_| layer != Layer::Disc);
        Self {
            stars: stars.map(|stars| StarPoints::new(frame, stars)),
            sampler: match sky {
                Some(SkyValues::View(view)) => row_sampler(frame, view),
                _ => None,
            },
            sky,
            discs: match layer {
                Layer::Sky => &[],
                _ => sources.discs,
            },
            channels,
            rows: frame.rows(),
            scale,
            pixel_reach: pixel_reach(frame),
        }
    }

    /// Sets the pixels of a row to the radiance of a view.
    fn draw_view(&self, view: &dyn RadianceView, row: &Row<'_>, out: &mut [f32]) {
        if self.channels.are_those_of_views() {
            self.sample_row(view, row, out);
            if self.scale != 1.0 {
                out.iter_mut().for_each(|value| *value *= self.scale);
            }
        } else {
            out.fill(0.0);
            let width = self.rows.frame().size().width() as usize;
            let mut values = vec![0.0; width * self.channels.view_count()];
            self.sample_row(view, row, &mut values);
            self.add(&values, out);
        }
    }

    /// Adds radiance in the channels of the view to pixels.
    fn add(&self, values: &[f32], out: &mut [f32]) {
        let pixels = out.chunks_exact_mut(self.channels.count());
        let values = values.chunks_exact(self.channels.view_count());
        for (values, pixel) in values.zip(pixels) {
            self.channels.add(values, self.scale, pixel);
        }
    }

    /// Radiance of a row in the channels of the view.
    fn sample_row(&self, view: &dyn RadianceView, row: &Row<'_>, values: &mut [f32]) {
        let at_horizon = |elevation_rad: f64| {
            let height = elevation_rad - view.horizon_elevation_rad();
            view.averages_horizon() && height.abs() < self.pixel_reach
        };
        match (&self.sampler, self.rows.frame().row_elevation_rad(row.y)) {
            (Some(sampler), Some(elevation_rad)) if !at_horizon(elevation_rad) => {
                sampler.sample_row(elevation_rad, values);
            }
            _ => {
                let directions = row.directions();
                view.radiance(directions, values);
                let crossed: Vec<u32> = (0..)
                    .zip(directions)
                    .filter(|(_, direction)| {
                        **direction != DVec3::ZERO
                            && at_horizon(direction.y.clamp(-1.0, 1.0).asin())
                    })
                    .map(|(i, _)| i)
                    .collect();
                self.average_pixels(view, (&crossed, row.y), values);
            }
        }
    }

    /// Replaces the values of pixels of row `y` that the horizon crosses by their means over each pixel.
    fn average_pixels(
        &self,
        view: &dyn RadianceView,
        (columns, y): (&[u32], u32),
        values: &mut [f32],
    ) {
        /// Number of pixels whose directions are evaluated together.
        const TOGETHER: usize = 64;
        let count = view.channel_count();
        for columns in columns.chunks(TOGETHER) {
            let mut directions = Vec::new();
            let mut ends = Vec::new();
            for &i in columns {
                directions.extend(directions_within(self.rows.frame(), (i, y)));
                ends.push(directions.len());
            }
            let mut radiance = vec![0.0; directions.len() * count];
            view.radiance(&directions, &mut radiance);
            let mut start = 0;
            for (&i, end) in columns.iter().zip(ends) {
                let mean = &mut values[i as usize * count..][..count];
                mean.fill(0.0);
                for sample in radiance[start * count..end * count].chunks_exact(count) {
                    mean.iter_mut().zip(sample).for_each(|(sum, v)| *sum += v);
                }
                let points = (end - start).max(1) as f32;
                mean.iter_mut().for_each(|sum| *sum /= points);
                start = end;
            }
        }
    }
}

impl RowSource for SkyRows<'_> {
    fn channels(&self) -> usize {
        self.channels.count()
    }

    fn fill_row(&self, y: u32, out: &mut [f32]) {
        let row = Row {
            rows: &self.rows,
            y,
            directions: OnceCell::new(),
        };
        let frame = self.rows.frame();
        match self.sky {
            None => out.fill(0.0),
            Some(SkyValues::Stored { values, first_row }) => {
                out.fill(0.0);
                let row = frame.size().width() as usize * self.channels.view_count();
                self.add(&values[(y - first_row) as usize * row..][..row], out);
            }
            Some(SkyValues::View(view)) => self.draw_view(view, &row, out),
        }
        if let Some(stars) = &self.stars {
            stars.add_row(y, self.scale, self.channels, out);
        }
        for disc in self.discs {
            if disc.reaches_row(frame, y, self.pixel_reach) {
                let reach_and_scale = (self.pixel_reach, self.scale);
                let directions = row.directions();
                disc.add_row((frame, y), directions, reach_and_scale, self.channels, out);
            }
        }
    }
}

/// Row sampler for projections with constant azimuth in each column; `None` for others.
fn row_sampler(frame: &Frame, view: &dyn RadianceView) -> Option<Box<dyn RowSampler>> {
    let Projection::Equirectangular { center_azimuth_deg } = *frame.projection() else {
        return None;
    };
    let width = f64::from(frame.size().width());
    let azimuth = |i: u32| {
        let turn = (f64::from(i) + 0.5) / width - 0.5;
        (center_azimuth_deg + 360.0 * turn).to_radians()
    };
    let azimuths: Vec<f64> = (0..frame.size().width()).map(azimuth).collect();
    view.row_sampler(&azimuths)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_view::TestView;
    use airlight::axes;
    use airlight::spectrum::RgbSpace;
    use airlight_image::Fisheye;

    fn row(frame: &Frame, sky: SkyValues<'_>, layer: Layer, y: u32) -> Vec<f32> {
        let channels = PixelChannels::rgb(RgbSpace::Srgb);
        let sources = SkySources {
            sky,
            discs: &[],
            stars: None,
        };
        let rows = SkyRows::new(frame, layer, sources, &channels, 2.0);
        let mut out = vec![f32::NAN; 3 * frame.size().width() as usize];
        rows.fill_row(y, &mut out);
        out
    }

    #[test]
    fn pixels_on_the_horizon_are_means_of_sky_and_ground() {
        let view = TestView::with_sun(axes::direction(0.0, 30.0));
        let frame = Frame::new(
            Projection::Equirectangular {
                center_azimuth_deg: 0.0,
            },
            18,
            9,
        )
        .unwrap();
        let green = |y| row(&frame, SkyValues::View(&view), Layer::All, y)[1];
        assert_eq!(
            [green(0), green(8)],
            [2.0 * TestView::SKY, 2.0 * TestView::GROUND]
        );
        assert_eq!(green(4), TestView::SKY + TestView::GROUND);
    }

    #[test]
    fn pixels_outside_a_fisheye_and_hidden_discs_are_black() {
        let view = TestView::with_sun(axes::direction(0.0, 30.0));
        let frame = Frame::new(Projection::AngularFisheye(Fisheye::ALL_SKY), 9, 9).unwrap();
        let first = row(&frame, SkyValues::View(&view), Layer::All, 0);
        assert_eq!(first[..3], [0.0; 3]);
        assert!(first[3 * 4] > 0.0);
        let disc = row(&frame, SkyValues::View(&view), Layer::Disc, 4);
        assert!(disc.iter().all(|v| *v == 0.0));
    }

    #[test]
    fn stored_values_replace_the_view() {
        let frame = Frame::equirectangular(2).unwrap();
        let stored: Vec<f32> = (0..3 * 4 * 2).map(|i| i as f32).collect();
        let from = |first_row| SkyValues::Stored {
            values: &stored,
            first_row,
        };
        let second = row(&frame, from(0), Layer::Sky, 1);
        assert_eq!(second[..3], [24.0, 26.0, 28.0]);
        let begun = row(&frame, from(1), Layer::Sky, 1);
        assert_eq!(begun[..3], [0.0, 2.0, 4.0]);
    }
}
