//! Sky and sun's disc, row by row.

use super::channels::RgbWeights;
use super::disc::Disc;
use super::fog::Fog;
use airlight::sky::{SkyColumns, SkyTable};
use airlight_image::frame::FrameRows;
use airlight_image::{Frame, Projection, RowSource};
use airlight_render::pixels::{directions_within, pixel_reach};
use glam::DVec3;

/// What of the light is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// Sky and sun's disc.
    All,
    /// The sky without the disc.
    Sky,
    /// The disc alone.
    Disc,
}

/// One moment's sky in one frame.
pub struct SkyRows<'a> {
    table: &'a SkyTable,
    fog: Option<&'a Fog>,
    disc: Option<&'a Disc>,
    /// Weights of wavelengths in RGB, for a table of spectra.
    spectral: Option<&'a RgbWeights>,
    draws_sky: bool,
    rows: FrameRows,
    /// For projections whose columns keep their azimuth.
    columns: Option<SkyColumns>,
    scale: f32,
    /// Values of all pixels in the table's channels, where another solver has made them.
    solved: Option<&'a [f32]>,
    /// How far a pixel's corners lie from its middle at most (rad), with some to spare.
    pixel_reach: f64,
}

impl<'a> SkyRows<'a> {
    /// Rows of `frame`, of a table and the fog before it; values are `scale` times those of the table.
    pub fn new(
        frame: &Frame,
        layer: Layer,
        (table, fog): (&'a SkyTable, Option<&'a Fog>),
        disc: Option<&'a Disc>,
        spectral: Option<&'a RgbWeights>,
        sun: DVec3,
        scale: f32,
    ) -> Self {
        Self {
            table,
            fog,
            disc: disc.filter(|_| layer != Layer::Sky),
            spectral,
            draws_sky: layer != Layer::Disc,
            rows: frame.rows(),
            columns: columns(frame, table, sun),
            scale,
            solved: None,
            pixel_reach: pixel_reach(frame),
        }
    }

    /// With the sky that another solver has made, row after row in the table's channels, instead of the table's.
    pub fn with_solved(self, solved: Option<&'a [f32]>) -> Self {
        Self { solved, ..self }
    }

    fn frame(&self) -> &Frame {
        self.rows.frame()
    }

    /// Light from one direction.
    fn at(&self, direction: DVec3, values: &mut [f32]) {
        self.table.sample(direction, values);
        if let Some(fog) = self.fog {
            fog.cover(direction, values);
        }
    }

    /// Light of one pixel: the mean over the pixel where the horizon runs through.
    fn sample(&self, direction: DVec3, (i, j): (u32, u32), values: &mut [f32]) {
        if !self.is_at_horizon(direction) {
            self.at(direction, values);
            return;
        }
        let mut sum = vec![0.0; values.len()];
        let mut count = 0.0f32;
        for direction in directions_within(self.frame(), (i, j)) {
            self.at(direction, values);
            count += 1.0;
            sum.iter_mut()
                .zip(values.iter())
                .for_each(|(sum, value)| *sum += value);
        }
        values
            .iter_mut()
            .zip(&sum)
            .for_each(|(value, sum)| *value = sum / count.max(1.0));
    }

    fn is_at_horizon(&self, direction: DVec3) -> bool {
        let height = direction.y.clamp(-1.0, 1.0).asin() - self.table.horizon_elevation_rad();
        height.abs() < self.pixel_reach
    }

    /// Light of a whole row, one after the other.
    fn sample_row(&self, y: u32, directions: &[DVec3], values: &mut [f32]) {
        let n = self.table.channels();
        match (&self.columns, directions.first()) {
            (Some(columns), Some(&first)) if !self.is_at_horizon(first) => {
                let elevation = first.y.atan2(first.x.hypot(first.z));
                self.table.sample_row(elevation, columns, values);
                if let Some(fog) = self.fog {
                    for (&direction, values) in directions.iter().zip(values.chunks_exact_mut(n)) {
                        fog.cover(direction, values);
                    }
                }
            }
            _ => {
                for ((i, &direction), values) in
                    (0..).zip(directions).zip(values.chunks_exact_mut(n))
                {
                    if direction != DVec3::ZERO {
                        self.sample(direction, (i, y), values);
                    }
                }
            }
        }
    }
}

/// From a table's values to a pixel's, which are RGB, or with weights RGB and then the values themselves.
pub fn put(values: &[f32], weights: Option<&RgbWeights>, scale: f32, pixel: &mut [f32]) {
    match weights {
        None => pixel
            .iter_mut()
            .zip(values)
            .for_each(|(p, v)| *p = v * scale),
        Some(weights) => {
            let (rgb, spectrum) = pixel.split_at_mut(3);
            rgb.fill(0.0);
            for ((value, weight), radiance) in values.iter().zip(weights).zip(spectrum) {
                *radiance = value * scale;
                rgb.iter_mut()
                    .zip(weight)
                    .for_each(|(c, w)| *c += w * *radiance);
            }
        }
    }
}

impl RowSource for SkyRows<'_> {
    fn channels(&self) -> usize {
        3 + self.spectral.map_or(0, Vec::len)
    }

    fn fill_row(&self, y: u32, out: &mut [f32]) {
        let width = self.frame().size().width() as usize;
        let mut directions = vec![DVec3::ZERO; width];
        self.rows.fill(y, &mut directions);
        out.fill(0.0);
        if self.draws_sky {
            let n = self.table.channels();
            let mut values = vec![0.0; width * n];
            match self.solved {
                Some(solved) => {
                    values.copy_from_slice(&solved[y as usize * width * n..][..width * n])
                }
                None => self.sample_row(y, &directions, &mut values),
            }
            for (values, pixel) in values
                .chunks_exact(n)
                .zip(out.chunks_exact_mut(self.channels()))
            {
                put(values, self.spectral, self.scale, pixel);
            }
        }
        if let Some(disc) = self.disc {
            disc.add_row(
                (self.frame(), y),
                &directions,
                (self.pixel_reach, self.scale),
                out,
            );
        }
    }
}

fn columns(frame: &Frame, table: &SkyTable, sun: DVec3) -> Option<SkyColumns> {
    let Projection::Equirectangular { center_azimuth_deg } = *frame.projection() else {
        return None;
    };
    let sun_azimuth = airlight::axes::azimuth_deg(sun);
    let width = f64::from(frame.size().width());
    let azimuths = (0..frame.size().width()).map(|i| {
        let turn = (f64::from(i) + 0.5) / width - 0.5;
        (center_azimuth_deg - sun_azimuth + 360.0 * turn).to_radians()
    });
    Some(table.columns(azimuths))
}
