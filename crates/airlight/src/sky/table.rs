//! Tables of a view's radiance in all directions, for look-up by pixels.
//!
//! There are tables above and below the horizon, where radiance jumps; the one above it is divided where a ray grazes a jump of
//! density. Their rows and columns have the places of [`TableCoordinates`], and are interpolated with cubics. What varies fast is not
//! tabulated: light singly scattered by a constituent with a peaked phase function is stored without the phase function, which is
//! applied for each pixel.

use super::peaked::{Between, Peaked, SamplePlace, SamplePlaces};
use super::table_coordinates::TableCoordinates;
use crate::axes;
use crate::debug::debug_fields;
use crate::math::arctangent::arctangent;
use crate::math::interpolation::{cubic_weights, whole};
use crate::math::parallel;
use crate::math::real::Real;
use crate::math::rings::rings;
use crate::math::simd::vectorized;
use crate::math::slices::check_length;
use crate::spectrum::{RgbSpace, Spectrum};
use crate::transfer::residual::HalfAngle;
use glam::{DVec3, Vec4};
use std::f32::consts::FRAC_1_PI;
use std::f64::consts::{FRAC_PI_2, PI};

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
    angles: SamplePlaces<N>,
}

/// A sum of weighted cells.
trait Cell: Clone {
    /// Its values.
    fn values(&self) -> &[f32];
    /// Sets all values to 0.
    fn clear(&mut self);
    /// Adds the first values of a slice, times a weight.
    fn add(&mut self, values: &[f32], weight: f32);
}

/// A cell of a fixed width, which stays in registers.
impl<const WIDTH: usize> Cell for Spectrum<WIDTH> {
    #[inline(always)]
    fn values(&self) -> &[f32] {
        &self.0
    }

    #[inline(always)]
    fn clear(&mut self) {
        *self = Self::ZERO;
    }

    #[inline(always)]
    fn add(&mut self, values: &[f32], weight: f32) {
        let values = values.first_chunk().expect("a whole cell");
        *self = self.scale_acc(Self(*values), weight);
    }
}

/// A cell of any width.
impl Cell for Vec<f32> {
    fn values(&self) -> &[f32] {
        self
    }

    fn clear(&mut self) {
        self.fill(0.0);
    }

    #[inline(always)]
    fn add(&mut self, values: &[f32], weight: f32) {
        for (sum, value) in self.iter_mut().zip(values) {
            *sum += weight * value;
        }
    }
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
    /// Place of an angle above the horizon, negative below it, rad, among the rows of its side of the horizon.
    #[inline(always)]
    fn place<T: Real>(&self, angle: T) -> T {
        let is_below = angle < T::of(0.0);
        match self.below_kink {
            Some(_) => self.coordinates.row_place_of_angle(angle, is_below),
            None => self.coordinates.row_place_beyond_kink(angle, is_below),
        }
    }

    /// Interpolates rows at an angle above the horizon, rad, of a place among the rows of its side of it; nothing above the atmosphere's
    /// limb.
    #[inline(always)]
    fn set<const N: usize, T: Real>(&self, rows: &mut Cubics<N>, index: usize, angle: T, place: T) {
        /// Rounding of angles in single precision, rad.
        const ROUNDING: f64 = 3e-7;
        let at_zero = self.in_band(angle, |band| band.at_zero);
        let per_place = self.in_band(angle, |band| band.per_place);
        let ends = [
            self.in_band(angle, |band| band.first),
            self.in_band(angle, |band| band.last),
        ];
        rows.set(index, at_zero + place * per_place, ends);
        let of = &self.coordinates;
        let is_in_air = angle <= T::of(of.highest_rad - of.horizon_rad + ROUNDING);
        for weights in &mut rows.weights {
            weights[index] = if is_in_air { weights[index] } else { 0.0 };
        }
    }

    /// A value of the band of an angle above the horizon, rad.
    #[inline(always)]
    fn in_band<T: Real>(&self, angle: T, value: impl Fn(&Band) -> f64) -> T {
        let of = &self.coordinates;
        let of_kink = self.below_kink.as_ref().map_or(0.0, &value);
        T::of(if angle < T::of(0.0) {
            value(&self.below)
        } else if angle < T::of(of.kink_rad - of.horizon_rad) {
            of_kink
        } else {
            value(&self.above)
        })
    }
}

impl<const N: usize> Cubics<N> {
    const NONE: Self = Self {
        first: [0; N],
        weights: [[0.0; N]; 4],
    };

    /// Interpolates at a position from the node `first` to the node `last`, by the four nodes nearest to it among them.
    #[inline(always)]
    fn set<T: Real>(&mut self, index: usize, position: T, ends: [T; 2]) {
        let [position, first, last] = [position, ends[0], ends[1]].map(|of| of.to_f64() as f32);
        // Not `clamp`, whose check of the limits keeps loops out of vector registers.
        let position = position.max(first).min(last);
        let node = (position.floor() - 1.0).max(first).min(last - 3.0);
        self.first[index] = whole(node);
        let weights = cubic_weights(position - node);
        for (all, weight) in self.weights.iter_mut().zip(weights) {
            all[index] = weight;
        }
    }

    /// Interpolates at the place of a column.
    #[inline(always)]
    fn set_column(&mut self, index: usize, place: f32) {
        let position = 1.0 + place * AZIMUTHS as f32;
        self.set(index, position, [0.0, (COLUMNS - 1) as f32]);
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
            (4, 3) => self.look_up_cells(&places, Spectrum::<4>::ZERO, 3, out),
            (8, 3) => self.look_up_cells(&places, Spectrum::<8>::ZERO, 3, out),
            (16, 3) => self.look_up_cells(&places, Spectrum::<16>::ZERO, 3, out),
            (28, 3) => self.look_up_cells(&places, Spectrum::<28>::ZERO, 3, out),
            (width, channels) => self.look_up_cells(&places, vec![0.0; width], channels, out),
        }
    }

    /// The radiance at places, each interpolated in a cell like `cell`.
    #[inline(always)]
    fn look_up_cells<const N: usize>(
        &self,
        places: &Places<N>,
        cell: impl Cell,
        channels: usize,
        out: &mut [f32],
    ) {
        // In loops of their own, interpolated cells fill the widest registers, not those of the four values that are combined.
        let mut cells: [_; N] = std::array::from_fn(|_| cell.clone());
        for (i, cell) in cells.iter_mut().enumerate() {
            self.interpolate(places, i, cell);
        }
        for (i, (cell, out)) in cells.iter().zip(out.chunks_exact_mut(channels)).enumerate() {
            self.combine(cell.values(), places.angles.get(i), out);
        }
    }

    /// Values along the unit vector `direction`, first of the smooth light, then of each part without its factor, `[part][channel]`; 0
    /// above the atmosphere's limb.
    pub(super) fn parts(&self, direction: DVec3) -> Vec<f32> {
        let mut cell = vec![0.0; self.width];
        self.interpolate(&self.places(&[direction]), 0, &mut cell);
        let parts = cell.chunks_exact(self.peaked.width);
        parts
            .flat_map(|part| &part[..self.channels])
            .copied()
            .collect()
    }

    /// The places of directions in the table.
    #[inline(always)]
    fn places<const N: usize>(&self, directions: &[DVec3; N]) -> Places<N> {
        let DVec3 {
            x: sun_x, z: sun_z, ..
        } = self.sun_azimuth;
        let mut places = Places {
            rows: Cubics::NONE,
            columns: Cubics::NONE,
            angles: SamplePlaces::FORWARDS,
        };
        // Twice as many numbers of single precision fit in a vector register.
        let [mut up, mut along, mut across] = [[0.0f32; N]; 3];
        let mut half_angles = [HalfAngle::FORWARDS; N];
        for (i, &direction) in directions.iter().enumerate() {
            let DVec3 { x, y, z } = direction;
            up[i] = y as f32;
            along[i] = (x * sun_x + z * sun_z) as f32;
            across[i] = (x * sun_z - z * sun_x) as f32;
            half_angles[i] = HalfAngle::between(direction, self.sun);
        }
        // A copy stays in registers.
        let of = self.rows;
        let (sin, cos) = of.coordinates.horizon_rad.sin_cos();
        let (sin, cos) = (sin as f32, cos as f32);
        let [mut angles, mut rows, mut columns] = [[0.0f32; N]; 3];
        for i in 0..N {
            let horizontal2 = along[i] * along[i] + across[i] * across[i];
            let (horizontal, norm) = (horizontal2.sqrt(), (horizontal2 + up[i] * up[i]).sqrt());
            // Angles above the horizon, without the rounding of elevations.
            let (y, x) = (
                up[i] * cos - horizontal * sin,
                horizontal * cos + up[i] * sin,
            );
            angles[i] = arctangent(y, x, norm);
            columns[i] = arctangent(across[i].abs(), along[i], horizontal) * FRAC_1_PI;
        }
        for (row, &angle) in rows.iter_mut().zip(&angles) {
            *row = of.place(angle);
        }
        if of.coordinates.dense_share > 0.0 {
            for column in &mut columns {
                *column = of.coordinates.column_place_of(*column);
            }
        }
        for i in 0..N {
            of.set(&mut places.rows, i, angles[i], rows[i]);
        }
        for (i, &column) in columns.iter().enumerate() {
            places.columns.set_column(i, column);
        }
        for (i, &angle) in half_angles.iter().enumerate() {
            places.angles.set(i, angle);
        }
        places
    }

    /// Interpolates the cell of a place.
    #[inline(always)]
    fn interpolate<const N: usize>(&self, places: &Places<N>, index: usize, cell: &mut impl Cell) {
        let (first_row, row_weights) = places.rows.get(index);
        let (first_column, column_weights) = places.columns.get(index);
        let width = cell.values().len();
        let (stride, first) = (COLUMNS * width, first_column * width);
        cell.clear();
        for (row, row_weight) in row_weights.into_iter().enumerate() {
            let cells = &self.values[(first_row + row) * stride + first..][..4 * width];
            for (column, column_weight) in column_weights.into_iter().enumerate() {
                cell.add(&cells[column * width..], row_weight * column_weight);
            }
        }
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

    /// Applies the phase functions at an angle to the parts of a cell and sums them.
    #[inline(always)]
    fn combine(&self, cell: &[f32], angle: SamplePlace, out: &mut [f32]) {
        let factors = self.peaked.factors_at(angle);
        if let [red, green, blue] = out {
            let sum = self.sum_of_parts(cell, 4, factors, 0);
            [*red, *green, *blue, _] = sum.to_array();
            return;
        }
        for (group, out) in out.chunks_mut(4).enumerate() {
            let sum = self.sum_of_parts(cell, self.peaked.width, factors, 4 * group);
            out.copy_from_slice(&sum.to_array()[..out.len()]);
        }
    }

    /// As [`SkyTable::combine`], of four channels from an index on, in parts of a width.
    #[inline(always)]
    fn sum_of_parts(
        &self,
        cell: &[f32],
        part_width: usize,
        factors: Between<'_>,
        first: usize,
    ) -> Vec4 {
        let four = |first: usize| Vec4::from_slice(&cell[first..]);
        let mut sum = four(first);
        for part in 1..cell.len() / part_width {
            let light = four(part * part_width + first);
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
                group.columns.set_column(i, place as f32);
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
                    (4, 3) => self.draw_cells(row, columns, Spectrum::<4>::ZERO, 3, out),
                    (8, 3) => self.draw_cells(row, columns, Spectrum::<8>::ZERO, 3, out),
                    (16, 3) => self.draw_cells(row, columns, Spectrum::<16>::ZERO, 3, out),
                    (28, 3) => self.draw_cells(row, columns, Spectrum::<28>::ZERO, 3, out),
                    (width, channels) => {
                        self.draw_cells(row, columns, vec![0.0; width], channels, out)
                    }
                }
            },
        );
    }

    /// Interpolates between rows at an elevation, rad: the cells of all columns.
    #[inline(always)]
    fn row(&self, elevation: f64) -> Vec<f32> {
        let mut rows = Cubics::<1>::NONE;
        let angle = elevation - self.rows.coordinates.horizon_rad;
        self.rows.set(&mut rows, 0, angle, self.rows.place(angle));
        let mut cells = vec![0.0; COLUMNS * self.width];
        self.between_rows(rows.get(0), 0, &mut cells);
        cells
    }

    /// Evaluates the columns of a picture in a row of cells at an elevation, rad; `cell` is that of a column.
    #[inline(always)]
    fn draw_cells(
        &self,
        (elevation, cells): (f64, &[f32]),
        columns: &SkyColumns,
        mut cell: impl Cell,
        channels: usize,
        out: &mut [f32],
    ) {
        let width = cell.values().len();
        // Half the angle to the sun: its squared sine and cosine are sums of positive terms.
        let sun = axes::elevation_rad(self.sun);
        let across = (elevation.cos() * sun.cos()) as f32;
        let between = (0.5 * (elevation - sun)).sin().powi(2) as f32;
        let opposite = (0.5 * (elevation + sun)).sin().powi(2) as f32;
        let mut angles = SamplePlaces::<TOGETHER>::FORWARDS;
        let groups = out.chunks_mut(TOGETHER * channels);
        for (group, out) in columns.groups.iter().zip(groups) {
            let half_azimuths = group.half_sines2.iter().zip(&group.half_cosines2);
            for (i, (sine2, cosine2)) in half_azimuths.enumerate() {
                let angle = HalfAngle {
                    sine2: between + across * sine2,
                    cosine2: opposite + across * cosine2,
                };
                angles.set(i, angle);
            }
            for (i, out) in out.chunks_exact_mut(channels).enumerate() {
                let (first, weights) = group.columns.get(i);
                cell.clear();
                for (column, weight) in weights.into_iter().enumerate() {
                    cell.add(&cells[(first + column) * width..], weight);
                }
                self.combine(cell.values(), angles.get(i), out);
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
            columns.set_column(0, place as f32);
            let (first, weights) = columns.get(0);
            let terms = weights.iter().zip(&mirrored[first..]).map(|(w, v)| w * v);
            let (got, exact) = (terms.sum::<f32>(), (PI * place).cos() as f32);
            assert!((got - exact).abs() < 1e-6, "{place}: {got} {exact}");
        }
    }
}
