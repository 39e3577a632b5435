//! Tables of a view's radiance in all directions, for look-up by pixels.
//!
//! There are tables above and below the horizon, where radiance jumps; the one above it is divided where a ray grazes a jump of
//! density. Their rows and columns have the places of [`TableCoordinates`], and are interpolated with cubics. What varies fast is not
//! tabulated: light singly scattered by a constituent with a peaked phase function is stored without the phase function, which is
//! applied for each pixel.

use super::peaked::{Between, Peaked, SamplePlace};
use super::table_coordinates::TableCoordinates;
use crate::axes;
use crate::debug::debug_fields;
use crate::math::arctangent::arctangent;
use crate::math::interpolation::cubic_weights;
use crate::math::parallel;
use crate::math::rings::rings;
use crate::math::simd::vectorized;
use crate::math::slices::check_length;
use crate::spectrum::RgbSpace;
use crate::transfer::residual::HalfAngle;
use glam::{DVec3, Vec4};
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, PI};

/// Channels of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableChannels {
    /// Linear red, green and blue; luminance in cd/m^2 where (1, 1, 1) is 1 cd/m^2 of the space's white.
    Rgb(RgbSpace),
    /// Radiance at each wavelength of the sky's grid, W m^-2 sr^-1 nm^-1.
    Spectral,
}

/// Number of azimuth steps from that of the sun to the opposite one.
pub(super) const AZIMUTHS: usize = 64;
/// Number of steps between rows from the horizon to the zenith.
pub(super) const STEPS_ABOVE: usize = 4 * TableCoordinates::ROW_STEPS;
/// Number of steps between rows from the horizon to the nadir.
pub(super) const STEPS_BELOW: usize = 95;

/// Number of stored columns: there is one more at either end, mirrored, so that cubics are not cut off there.
const COLUMNS: usize = AZIMUTHS + 3;

/// Number of directions or pixels that are looked up together.
const TOGETHER: usize = 64;

/// Widest cell that is interpolated without allocation: 16 wavelengths and one peaked scatterer.
const SMALL_WIDTH: usize = 64;

/// Table of a view's radiance in all directions, without the sun's disc.
pub struct SkyTable {
    pub(super) channels: usize,
    /// Whether the channels are radiances, which are not negative.
    pub(super) is_spectral: bool,
    /// Number of values in a cell: those of the smooth light and of all parts, each padded for vector loads.
    pub(super) width: usize,
    pub(super) sun: DVec3,
    pub(super) sun_azimuth: DVec3,
    pub(super) rows: Rows,
    /// `[row][column][part][channel]`.
    pub(super) values: Vec<f32>,
    /// Phase functions of peaked scatterers.
    pub(super) peaked: Peaked,
}

debug_fields! { SkyTable { channels, sun, rows } }

/// Where the rows are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows {
    pub coordinates: TableCoordinates,
    /// From the kink to the highest air.
    pub above: Band,
    /// From the horizon to the kink, if there is one.
    pub below_kink: Option<Band>,
    /// Below the horizon.
    pub below: Band,
}

/// The rows between two elevations at which light bends or jumps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Band {
    /// Index of the first row and of the last.
    first: f64,
    last: f64,
    /// Rows per place among those of the band's side of the horizon, and the row at place 0.
    per_place: f64,
    at_zero: f64,
}

/// Interpolation weights for the columns of a picture, computed once for pictures whose columns have constant azimuth.
#[derive(Clone, Debug)]
pub struct SkyColumns {
    groups: Vec<ColumnGroup>,
}

/// Columns of a picture that are looked up together.
#[derive(Clone, Debug)]
struct ColumnGroup {
    columns: Cubics<TOGETHER>,
    /// Squared sines and cosines of half the azimuth from the sun.
    half_sines2: [f32; TOGETHER],
    half_cosines2: [f32; TOGETHER],
}

/// Interpolation among four rows or columns each.
#[derive(Clone, Debug)]
struct Cubics<const N: usize> {
    /// Indices of the first of the four.
    first: [i32; N],
    weights: [[f32; N]; 4],
}

/// Places of directions in the table.
struct Places<const N: usize> {
    rows: Cubics<N>,
    columns: Cubics<N>,
    /// Angles from the sun.
    angles: [SamplePlace; N],
}

impl Band {
    /// Rows from an index on, at even places from the first to the last.
    pub(super) fn new([from, to]: [f64; 2], first: usize, steps: usize) -> Self {
        let per_place = steps as f64 / (to - from);
        Self {
            first: first as f64,
            last: (first + steps) as f64,
            per_place,
            at_zero: first as f64 - from * per_place,
        }
    }
}

impl Rows {
    /// Place of an elevation, rad, among the rows of its side of the horizon.
    #[inline(always)]
    fn place(&self, elevation: f64) -> f64 {
        let is_below = elevation < self.coordinates.horizon_rad;
        match self.below_kink {
            Some(_) => self.coordinates.row_place(elevation, is_below),
            None => self.coordinates.row_place_beyond_kink(elevation, is_below),
        }
    }

    /// Interpolates rows at an elevation, rad, of a place among the rows of its side of the horizon; nothing above the atmosphere's limb.
    #[inline(always)]
    fn set<const N: usize>(&self, rows: &mut Cubics<N>, index: usize, elevation: f64, place: f64) {
        /// Rounding of elevations, rad.
        const ROUNDING: f64 = 1e-13;
        let at_zero = self.in_band(elevation, |band| band.at_zero);
        let per_place = self.in_band(elevation, |band| band.per_place);
        let first = self.in_band(elevation, |band| band.first);
        let last = self.in_band(elevation, |band| band.last);
        rows.set(index, at_zero + place * per_place, [first, last]);
        let is_in_air = elevation <= self.coordinates.highest_rad + ROUNDING;
        for weights in &mut rows.weights {
            weights[index] = if is_in_air { weights[index] } else { 0.0 };
        }
    }

    /// A value of the band of an elevation, rad.
    #[inline(always)]
    fn in_band(&self, elevation: f64, value: impl Fn(&Band) -> f64) -> f64 {
        let of = &self.coordinates;
        let of_kink = self.below_kink.as_ref().map_or(0.0, &value);
        if elevation < of.horizon_rad {
            value(&self.below)
        } else if elevation < of.kink_rad {
            of_kink
        } else {
            value(&self.above)
        }
    }
}

impl<const N: usize> Cubics<N> {
    const NONE: Self = Self {
        first: [0; N],
        weights: [[0.0; N]; 4],
    };

    /// Interpolates at a position from the node `first` to the node `last`, by the four nodes nearest to it among them.
    #[inline(always)]
    fn set(&mut self, index: usize, position: f64, [first, last]: [f64; 2]) {
        let position = position.clamp(first, last);
        let node = (position.floor() - 1.0).clamp(first, last - 3.0);
        // Conversions from single precision run in vector registers.
        self.first[index] = node as f32 as i32;
        let weights = cubic_weights((position - node) as f32);
        for (all, weight) in self.weights.iter_mut().zip(weights) {
            all[index] = weight;
        }
    }

    /// Interpolates at the place of a column.
    #[inline(always)]
    fn set_column(&mut self, index: usize, place: f64) {
        let position = 1.0 + place * AZIMUTHS as f64;
        self.set(index, position, [0.0, (COLUMNS - 1) as f64]);
    }

    /// Index of the first of the four, and their weights.
    #[inline(always)]
    fn get(&self, index: usize) -> (usize, [f32; 4]) {
        let weights = std::array::from_fn(|k| self.weights[k][index]);
        (self.first[index] as usize, weights)
    }
}

/// Rows with one more column at either end, mirrored, of rows of `width` values in each column.
pub(super) fn with_mirrored_columns(rows: &[f32], width: usize) -> Vec<f32> {
    let mut mirrored = Vec::with_capacity(rows.len() / (AZIMUTHS + 1) * COLUMNS);
    for row in rows.chunks_exact((AZIMUTHS + 1) * width) {
        mirrored.extend(&row[width..][..width]);
        mirrored.extend(row);
        mirrored.extend(&row[(AZIMUTHS - 1) * width..][..width]);
    }
    mirrored
}

impl SkyTable {
    /// Number of channels.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Elevation of the horizon, rad: 0 on the ground, negative above it.
    pub fn horizon_elevation_rad(&self) -> f64 {
        self.rows.coordinates.horizon_rad
    }

    /// Places of rows and columns.
    pub fn coordinates(&self) -> &TableCoordinates {
        &self.rows.coordinates
    }

    /// Evaluates the radiance along the unit vector `direction` into `out`, one value per channel.
    #[inline]
    pub fn sample(&self, direction: DVec3, out: &mut [f32]) {
        self.look_up(&[direction], &mut out[..self.channels]);
    }

    /// [`SkyTable::sample`] of many directions, on all threads; `out` is `[direction][channel]`.
    ///
    /// # Panics
    /// Where `out` has another length.
    pub fn samples(&self, directions: &[DVec3], out: &mut [f32]) {
        let width = self.channels();
        check_length(out, directions.len() * width);
        parallel::for_each_chunk(out, TOGETHER * width, |index, out| {
            let count = out.len() / width;
            self.samples_on_this_thread(&directions[index * TOGETHER..][..count], out);
        });
    }

    /// As [`SkyTable::samples`], on the calling thread.
    pub(crate) fn samples_on_this_thread(&self, directions: &[DVec3], out: &mut [f32]) {
        let width = self.channels();
        let (whole, rest) = directions.as_chunks::<TOGETHER>();
        let (out, out_of_rest) = out.split_at_mut(whole.len() * TOGETHER * width);
        for (directions, out) in whole.iter().zip(out.chunks_exact_mut(TOGETHER * width)) {
            vectorized(
                #[inline(always)]
                || self.look_up(directions, out),
            );
        }
        for (&direction, out) in rest.iter().zip(out_of_rest.chunks_exact_mut(width)) {
            self.sample(direction, out);
        }
    }

    /// The radiance in directions; `out` is `[direction][channel]`.
    #[inline(always)]
    fn look_up<const N: usize>(&self, directions: &[DVec3; N], out: &mut [f32]) {
        let places = self.places(directions);
        // Cells of a fixed width stay in registers.
        match (self.width, self.channels) {
            (4, 3) => self.look_up_cells(&places, &mut [0.0; 16], 3, out),
            (8, 3) => self.look_up_cells(&places, &mut [0.0; 32], 3, out),
            (16, 3) => self.look_up_cells(&places, &mut [0.0; 64], 3, out),
            (28, 3) => self.look_up_cells(&places, &mut [0.0; 112], 3, out),
            (width, channels) if width <= SMALL_WIDTH => {
                let mut small = [0.0; 4 * SMALL_WIDTH];
                self.look_up_cells(&places, &mut small[..4 * width], channels, out);
            }
            (width, channels) => {
                self.look_up_cells(&places, &mut vec![0.0; 4 * width], channels, out);
            }
        }
    }

    /// The radiance at places, with the four cells at each interpolated between rows in `cells`.
    #[inline(always)]
    fn look_up_cells<const N: usize>(
        &self,
        places: &Places<N>,
        cells: &mut [f32],
        channels: usize,
        out: &mut [f32],
    ) {
        for (i, out) in out.chunks_exact_mut(channels).enumerate() {
            let column_weights = self.interpolate_rows(places, i, cells);
            let factors = self.peaked.factors_at(places.angles[i]);
            self.combine(cells, column_weights, factors, &mut out[..channels]);
        }
    }

    /// Values along the unit vector `direction`, first of the smooth light, then of each part without its factor, `[part][channel]`; 0
    /// above the atmosphere's limb.
    pub(super) fn parts(&self, direction: DVec3) -> Vec<f32> {
        let mut cells = vec![0.0; 4 * self.width];
        let weights = self.interpolate_rows(&self.places(&[direction]), 0, &mut cells);
        let in_part = |first: usize| {
            let groups = (first..first + self.channels).step_by(4);
            let values =
                groups.flat_map(|first| between_columns(&cells, weights, first).to_array());
            values.take(self.channels).collect::<Vec<_>>()
        };
        let parts = (0..self.width).step_by(self.peaked.width);
        parts.flat_map(in_part).collect()
    }

    /// The places of directions in the table.
    #[inline(always)]
    fn places<const N: usize>(&self, directions: &[DVec3; N]) -> Places<N> {
        let DVec3 {
            x: sun_x, z: sun_z, ..
        } = self.sun_azimuth;
        let (mut elevations, mut rows, mut columns) = ([0.0; N], [0.0; N], [0.0; N]);
        let mut places = Places {
            rows: Cubics::NONE,
            columns: Cubics::NONE,
            angles: [SamplePlace::FORWARDS; N],
        };
        for (i, &direction) in directions.iter().enumerate() {
            let DVec3 { x, y, z } = direction;
            let horizontal = (x * x + z * z).sqrt();
            let (along, across) = (x * sun_x + z * sun_z, x * sun_z - z * sun_x);
            elevations[i] = arctangent(y, horizontal, (x * x + y * y + z * z).sqrt());
            columns[i] = arctangent(across.abs(), along, horizontal) * FRAC_1_PI;
            places.angles[i] = SamplePlace::of(HalfAngle::between(direction, self.sun));
        }
        // A copy stays in registers.
        let of = self.rows;
        for (row, &elevation) in rows.iter_mut().zip(&elevations) {
            *row = of.place(elevation);
        }
        if of.coordinates.dense_share > 0.0 {
            for column in &mut columns {
                *column = of.coordinates.column_place(*column);
            }
        }
        for i in 0..N {
            of.set(&mut places.rows, i, elevations[i], rows[i]);
        }
        for (i, &column) in columns.iter().enumerate() {
            places.columns.set_column(i, column);
        }
        places
    }

    /// Interpolates between rows the cells of the four columns of a place into `cells`; returns the weights of the columns.
    #[inline(always)]
    fn interpolate_rows<const N: usize>(
        &self,
        places: &Places<N>,
        index: usize,
        cells: &mut [f32],
    ) -> [f32; 4] {
        let (first_column, column_weights) = places.columns.get(index);
        self.between_rows(places.rows.get(index), first_column, cells);
        column_weights
    }

    /// Interpolates cells of neighbouring columns, from one on, between four rows.
    #[inline(always)]
    fn between_rows(
        &self,
        (first_row, weights): (usize, [f32; 4]),
        first_column: usize,
        cells: &mut [f32],
    ) {
        let stride = COLUMNS * self.width;
        let first = first_row * stride + first_column * self.width;
        let values = &self.values[first..][..3 * stride + cells.len()];
        cells.fill(0.0);
        for (k, weight) in weights.into_iter().enumerate() {
            for (sum, value) in cells.iter_mut().zip(&values[k * stride..]) {
                *sum += weight * value;
            }
        }
    }

    /// Interpolates the four cells of neighbouring columns, applies the phase functions and sums the parts.
    #[inline(always)]
    fn combine(&self, cells: &[f32], weights: [f32; 4], factors: Between<'_>, out: &mut [f32]) {
        if let [red, green, blue] = out {
            let sum = self.sum_of_parts((cells, 4), weights, factors, 0);
            [*red, *green, *blue, _] = sum.to_array();
            return;
        }
        for (group, out) in out.chunks_mut(4).enumerate() {
            let cells = (cells, self.peaked.width);
            let sum = self.sum_of_parts(cells, weights, factors, 4 * group);
            out.copy_from_slice(&sum.to_array()[..out.len()]);
        }
    }

    /// As [`SkyTable::combine`], of four channels from an index on, in parts of a width.
    #[inline(always)]
    fn sum_of_parts(
        &self,
        (cells, part_width): (&[f32], usize),
        weights: [f32; 4],
        factors: Between<'_>,
        first: usize,
    ) -> Vec4 {
        let mut sum = between_columns(cells, weights, first);
        for part in 1..cells.len() / 4 / part_width {
            let light = between_columns(cells, weights, part * part_width + first);
            sum += light * factors.four((part - 1) * part_width + first);
        }
        // Cubics undershoot where the light ends, such as at the top of the air; other channels may be negative.
        if self.is_spectral {
            sum = sum.max(Vec4::ZERO);
        }
        sum
    }

    /// Prepares the columns of a picture; `azimuths_rad` are relative to the sun's azimuth.
    pub fn columns(&self, azimuths_rad: impl Iterator<Item = f64>) -> SkyColumns {
        let azimuths_rad: Vec<f64> = azimuths_rad.collect();
        let group = |azimuths_rad: &[f64]| {
            let mut group = ColumnGroup {
                columns: Cubics::NONE,
                half_sines2: [0.0; TOGETHER],
                half_cosines2: [0.0; TOGETHER],
            };
            for (i, azimuth) in azimuths_rad.iter().enumerate() {
                let (sin, cos) = azimuth.sin_cos();
                let place = self
                    .rows
                    .coordinates
                    .column_place(sin.abs().atan2(cos) / PI);
                group.columns.set_column(i, place);
                let (sin, cos) = (0.5 * azimuth).sin_cos();
                group.half_sines2[i] = (sin * sin) as f32;
                group.half_cosines2[i] = (cos * cos) as f32;
            }
            group
        };
        SkyColumns {
            groups: azimuths_rad.chunks(TOGETHER).map(group).collect(),
        }
    }

    /// Evaluates the radiance at one elevation (rad) in all prepared columns into `out`, one value per channel and column.
    pub fn sample_row(&self, elevation_rad: f64, columns: &SkyColumns, out: &mut [f32]) {
        vectorized(
            #[inline(always)]
            || {
                let row = (elevation_rad, &self.row(elevation_rad)[..]);
                match (self.width, self.channels) {
                    (4, 3) => self.draw_cells(row, columns, (4, 3), out),
                    (8, 3) => self.draw_cells(row, columns, (8, 3), out),
                    (16, 3) => self.draw_cells(row, columns, (16, 3), out),
                    (28, 3) => self.draw_cells(row, columns, (28, 3), out),
                    widths => self.draw_cells(row, columns, widths, out),
                }
            },
        );
    }

    /// Interpolates between rows at an elevation, rad: the cells of all columns.
    #[inline(always)]
    fn row(&self, elevation: f64) -> Vec<f32> {
        let mut rows = Cubics::<1>::NONE;
        let place = self.rows.place(elevation);
        self.rows.set(&mut rows, 0, elevation, place);
        let mut cells = vec![0.0; COLUMNS * self.width];
        self.between_rows(rows.get(0), 0, &mut cells);
        cells
    }

    /// Evaluates the columns of a picture in a row of cells of `width` values at an elevation, rad.
    #[inline(always)]
    fn draw_cells(
        &self,
        (elevation, cells): (f64, &[f32]),
        columns: &SkyColumns,
        (width, channels): (usize, usize),
        out: &mut [f32],
    ) {
        // Half the angle to the sun: its squared sine and cosine are sums of positive terms.
        let sun = axes::elevation_rad(self.sun);
        let across = (elevation.cos() * sun.cos()) as f32;
        let between = (0.5 * (elevation - sun)).sin().powi(2) as f32;
        let opposite = (0.5 * (elevation + sun)).sin().powi(2) as f32;
        let mut angles = [SamplePlace::FORWARDS; TOGETHER];
        let groups = out.chunks_mut(TOGETHER * channels);
        for (group, out) in columns.groups.iter().zip(groups) {
            let half_azimuths = group.half_sines2.iter().zip(&group.half_cosines2);
            for (angle, (sine2, cosine2)) in angles.iter_mut().zip(half_azimuths) {
                *angle = SamplePlace::of(HalfAngle {
                    sine2: between + across * sine2,
                    cosine2: opposite + across * cosine2,
                });
            }
            for (i, out) in out.chunks_exact_mut(channels).enumerate() {
                let (first, weights) = group.columns.get(i);
                let cells = &cells[first * width..][..4 * width];
                let factors = self.peaked.factors_at(angles[i]);
                self.combine(cells, weights, factors, &mut out[..channels]);
            }
        }
    }

    /// Irradiance on a surface with the unit normal `normal` from sky and ground, without the sun's disc, one value per channel
    /// (W m^-2 nm^-1, or lux for RGB channels).
    ///
    /// A sum over rings of 128 directions, 1024 beside the sun, which are dense there and at the horizon; accurate to 0.1 %, also in dust
    /// with an aureole of a degree.
    pub fn irradiance(&self, normal: DVec3) -> Vec<f32> {
        let mut out = vec![0.0; self.channels];
        self.irradiances(&[normal], &mut out);
        out
    }

    /// [`SkyTable::irradiance`] on surfaces with the unit normals `normals`, which share the evaluation of the sky; `out` is
    /// `[normal][channel]`.
    ///
    /// # Panics
    /// Where `out` has another length.
    pub fn irradiances(&self, normals: &[DVec3], out: &mut [f32]) {
        /// Number of elevations on each side of the sun, and of azimuths away from it.
        const NODES: usize = 32;
        const STEPS: usize = 128;
        check_length(out, normals.len() * self.channels);
        let mut sums = vec![0.0f64; out.len()];
        let sun_rad = crate::axes::elevation_rad(self.sun);
        let TableCoordinates {
            horizon_rad,
            highest_rad,
            ..
        } = self.rows.coordinates;
        // What reaches an upward-facing surface ends at the horizontal.
        let level_rad = highest_rad.clamp(horizon_rad, 0.0);
        for span in [
            (horizon_rad, -FRAC_PI_2),
            (horizon_rad, level_rad),
            (level_rad, highest_rad),
        ] {
            for ring in rings(span, sun_rad, NODES) {
                let (sin, cos) = ring.elevation_rad.sin_cos();
                let reaches = |n: &DVec3| sin * n.y + cos * n.x.hypot(n.z) > 0.0;
                if !normals.iter().any(reaches) {
                    continue;
                }
                let azimuths = ring.steps(STEPS);
                let solid_angle = ring.solid_angle / azimuths as f64;
                let ring: Vec<DVec3> = (0..azimuths)
                    .map(|k| {
                        let (z, x) = (2.0 * PI * (k as f64 + 0.5) / azimuths as f64).sin_cos();
                        DVec3::new(cos * x, sin, cos * z)
                    })
                    .collect();
                let mut radiance = vec![0.0f32; azimuths * self.channels];
                self.samples(&ring, &mut radiance);
                parallel::for_each_chunk(&mut sums, self.channels, |index, sums| {
                    for (direction, radiance) in
                        ring.iter().zip(radiance.chunks_exact(self.channels))
                    {
                        let cosine = direction.dot(normals[index]);
                        if cosine > 0.0 {
                            for (sum, &radiance) in sums.iter_mut().zip(radiance) {
                                *sum += solid_angle * cosine * f64::from(radiance);
                            }
                        }
                    }
                });
            }
        }
        for (out, sum) in out.iter_mut().zip(sums) {
            *out = sum as f32;
        }
    }
}

/// Four values of a cell, from an index on, interpolated between the cells of four neighbouring columns.
#[inline(always)]
fn between_columns(cells: &[f32], weights: [f32; 4], first: usize) -> Vec4 {
    let width = cells.len() / 4;
    let mut sum = Vec4::ZERO;
    for (k, weight) in weights.into_iter().enumerate() {
        sum += weight * Vec4::from_slice(&cells[k * width + first..]);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cosines over half a turn are mirror-symmetric at both ends.
    #[test]
    fn columns_are_even_beyond_the_ends() {
        let cosines: Vec<f32> = (0..=AZIMUTHS)
            .map(|k| (PI * k as f64 / AZIMUTHS as f64).cos() as f32)
            .collect();
        let mirrored = with_mirrored_columns(&cosines, 1);
        assert_eq!(mirrored.len(), COLUMNS);
        for place in [0.0, 0.004, 0.5, 0.993, 1.0] {
            let mut columns = Cubics::<1>::NONE;
            columns.set_column(0, place);
            let (first, weights) = columns.get(0);
            let terms = weights.iter().zip(&mirrored[first..]).map(|(w, v)| w * v);
            let (got, exact) = (terms.sum::<f32>(), (PI * place).cos() as f32);
            assert!((got - exact).abs() < 1e-6, "{place}: {got} {exact}");
        }
    }
}
