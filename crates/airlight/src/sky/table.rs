//! Tables of a view's radiance in all directions, for look-up by pixels.
//!
//! There are tables above and below the horizon, where radiance jumps; the one above it is divided where a ray grazes a jump of
//! density. Their rows and columns have the places of [`TableCoordinates`], and are interpolated with cubics. What varies fast is not
//! tabulated: light singly scattered by a constituent with a peaked phase function is stored without the phase function, which is
//! applied for each pixel.

use super::peaked::Peaked;
use super::table_coordinates::TableCoordinates;
use crate::debug::debug_fields;
use crate::math::arctangent::arctangent;
use crate::math::interpolation::{cubic_f32, cubic_mirrored};
use crate::math::parallel;
use crate::math::rings::rings;
use crate::math::simd::vectorized;
use crate::math::slices::check_length;
use crate::spectrum::RgbSpace;
use glam::DVec3;
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
pub(super) const AZIMUTHS: usize = 63;
/// Number of steps between rows from the horizon to the zenith.
pub(super) const STEPS_ABOVE: usize = 4 * TableCoordinates::ROW_STEPS;
/// Number of steps between rows from the horizon to the nadir.
pub(super) const STEPS_BELOW: usize = 95;

/// Number of directions that are looked up together.
const TOGETHER: usize = 64;

/// Widest cell that is interpolated without allocation: 16 wavelengths and one peaked scatterer.
const SMALL_WIDTH: usize = 64;

/// Table of a view's radiance in all directions, without the sun's disc.
pub struct SkyTable {
    pub(super) channels: usize,
    /// Whether the channels are radiances, which are not negative.
    pub(super) is_spectral: bool,
    /// Number of values in a cell: all channels of all parts, padded for vector loads.
    pub(super) width: usize,
    pub(super) sun: DVec3,
    pub(super) sun_azimuth: DVec3,
    pub(super) coordinates: TableCoordinates,
    /// From the kink to the highest air, from the horizon to the kink if there is one, and below the horizon.
    pub(super) above: Band,
    pub(super) below_kink: Option<Band>,
    pub(super) below: Band,
    /// Phase functions of peaked scatterers.
    pub(super) peaked: Peaked,
}

debug_fields! { SkyTable { channels, sun, coordinates } }

/// The table between two elevations at which light bends or jumps.
pub(super) struct Band {
    /// Place of the first row, and the inverse of the difference of the last one's from it.
    pub(super) first: f64,
    pub(super) per_place: f64,
    pub(super) rows: usize,
    /// `[row][azimuth][channel of each part]`.
    pub(super) values: Vec<f32>,
}

/// Interpolation weights for the columns of a picture, computed once for pictures whose columns have constant azimuth.
#[derive(Clone, Debug)]
pub struct SkyColumns {
    columns: Vec<Column>,
}

#[derive(Clone, Copy, Debug)]
struct Column {
    nodes: [usize; 4],
    weights: [f32; 4],
    /// Squared sine of half the azimuth from the sun.
    half_sine2: f64,
}

/// Angles of directions, as the table's coordinates need them.
struct Angles<const N: usize> {
    /// Elevations, rad.
    elevations: [f64; N],
    /// Places of the elevations among the rows of their side of the horizon.
    rows: [f64; N],
    /// Places of the azimuths from that of the sun, to either side; 1 is the opposite one.
    columns: [f64; N],
    /// Sines of half the angle to the sun.
    half_sines: [f64; N],
}

impl SkyTable {
    /// Number of channels.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Elevation of the horizon, rad: 0 on the ground, negative above it.
    pub fn horizon_elevation_rad(&self) -> f64 {
        self.coordinates.horizon_rad
    }

    /// Places of rows and columns.
    pub fn coordinates(&self) -> &TableCoordinates {
        &self.coordinates
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
        let angles = self.angles(directions);
        let mut small = [0.0f32; SMALL_WIDTH];
        // Cells of a fixed width stay in registers.
        match self.width {
            4 => self.look_up_cells(&angles, &mut [0.0; 4], out),
            8 => self.look_up_cells(&angles, &mut [0.0; 8], out),
            12 => self.look_up_cells(&angles, &mut [0.0; 12], out),
            width => match small.get_mut(..width) {
                Some(cell) => self.look_up_cells(&angles, cell, out),
                None => self.look_up_cells(&angles, &mut vec![0.0; width], out),
            },
        }
    }

    /// The angles of directions.
    #[inline(always)]
    fn angles<const N: usize>(&self, directions: &[DVec3; N]) -> Angles<N> {
        let DVec3 {
            x: sun_x, z: sun_z, ..
        } = self.sun_azimuth;
        let mut angles = Angles {
            elevations: [0.0; N],
            rows: [0.0; N],
            columns: [0.0; N],
            half_sines: [0.0; N],
        };
        for (i, &DVec3 { x, y, z }) in directions.iter().enumerate() {
            let horizontal = (x * x + z * z).sqrt();
            let (along, across) = (x * sun_x + z * sun_z, x * sun_z - z * sun_x);
            angles.elevations[i] = arctangent(y, horizontal, (x * x + y * y + z * z).sqrt());
            angles.columns[i] = arctangent(across.abs(), along, horizontal) * FRAC_1_PI;
            let [x, y, z] = [x - self.sun.x, y - self.sun.y, z - self.sun.z];
            angles.half_sines[i] = 0.5 * (x * x + y * y + z * z).sqrt();
        }
        let of = &self.coordinates;
        let has_kink = self.below_kink.is_some();
        for (row, &elevation) in angles.rows.iter_mut().zip(&angles.elevations) {
            let is_below = elevation < of.horizon_rad;
            *row = match has_kink {
                true => of.row_place(elevation, is_below),
                false => of.row_place_beyond_kink(elevation, is_below),
            };
        }
        if of.dense_share > 0.0 {
            for column in &mut angles.columns {
                *column = of.column_place(*column);
            }
        }
        angles
    }

    /// The radiance in directions, interpolated in `cell`.
    #[inline(always)]
    fn look_up_cells<const N: usize>(&self, angles: &Angles<N>, cell: &mut [f32], out: &mut [f32]) {
        for (i, out) in out.chunks_exact_mut(self.channels).enumerate() {
            let place = (angles.elevations[i], angles.rows[i]);
            if self.interpolate(place, angles.columns[i], cell) {
                self.combine(cell, angles.half_sines[i], out);
            } else {
                out.fill(0.0);
            }
        }
    }

    /// Values along the unit vector `direction`, first of the smooth light, then of each part without its factor; 0 above the
    /// atmosphere's limb.
    pub(super) fn parts(&self, direction: DVec3) -> Vec<f32> {
        let Angles {
            elevations: [elevation],
            rows: [row],
            columns: [column],
            ..
        } = self.angles(&[direction]);
        let mut cell = vec![0.0; self.width];
        self.interpolate((elevation, row), column, &mut cell);
        cell
    }

    /// Prepares the columns of a picture; `azimuths_rad` are relative to the sun's azimuth.
    pub fn columns(&self, azimuths_rad: impl Iterator<Item = f64>) -> SkyColumns {
        let columns = azimuths_rad
            .map(|azimuth| {
                let (sin, cos) = azimuth.sin_cos();
                let place = self.coordinates.column_place(sin.abs().atan2(cos) / PI);
                let (nodes, weights) = cubic_mirrored(place, AZIMUTHS);
                Column {
                    nodes,
                    weights,
                    half_sine2: (0.5 * azimuth).sin().powi(2),
                }
            })
            .collect();
        SkyColumns { columns }
    }

    /// Evaluates the radiance at one elevation (rad) in all prepared columns into `out`, one value per channel and column.
    pub fn sample_row(&self, elevation_rad: f64, columns: &SkyColumns, out: &mut [f32]) {
        let Some((band, row)) = self.place(elevation_rad) else {
            out.fill(0.0);
            return;
        };
        vectorized(
            #[inline(always)]
            || {
                let line = self.line(band, row);
                let row = (&line[..], elevation_rad);
                match self.width {
                    4 => self.cells(row, columns, &mut [0.0; 4], out),
                    8 => self.cells(row, columns, &mut [0.0; 8], out),
                    12 => self.cells(row, columns, &mut [0.0; 12], out),
                    width => self.cells(row, columns, &mut vec![0.0; width], out),
                }
            },
        );
    }

    /// Interpolates the table to a row coordinate: the cells of all azimuths.
    #[inline(always)]
    fn line(&self, band: &Band, row: f64) -> Vec<f32> {
        let stride = (AZIMUTHS + 1) * self.width;
        let (first, weights) = cubic_f32(row, band.rows);
        let mut line = vec![0.0f32; stride];
        for (i, w) in weights.iter().enumerate() {
            let values = &band.values[(first + i) * stride..][..stride];
            for (sum, value) in line.iter_mut().zip(values) {
                *sum += w * value;
            }
        }
        line
    }

    /// Coefficients of the squared sine of half the angle to the sun at one elevation: `a + b * column.half_sine2`.
    #[inline(always)]
    fn half_sines2(&self, elevation_rad: f64) -> (f64, f64) {
        let sun_elevation = crate::axes::elevation_deg(self.sun).to_radians();
        let between = (0.5 * (elevation_rad - sun_elevation)).sin();
        (between * between, elevation_rad.cos() * sun_elevation.cos())
    }

    /// Evaluates the columns of one row, interpolated in `cell`.
    #[inline(always)]
    fn cells(
        &self,
        (line, elevation_rad): (&[f32], f64),
        columns: &SkyColumns,
        cell: &mut [f32],
        out: &mut [f32],
    ) {
        let (a, b) = self.half_sines2(elevation_rad);
        let out = out.chunks_exact_mut(self.channels);
        for (column, out) in columns.columns.iter().zip(out) {
            cell.fill(0.0);
            for (node, w) in column.nodes.iter().zip(&column.weights) {
                let values = &line[node * cell.len()..][..cell.len()];
                for (sum, value) in cell.iter_mut().zip(values) {
                    *sum += w * value;
                }
            }
            self.combine(cell, (a + b * column.half_sine2).sqrt(), out);
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
        } = self.coordinates;
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

    /// The band of the table that contains an elevation, and the row coordinate in `[0, 1]`; `None` above the atmosphere's limb.
    #[inline(always)]
    fn place(&self, elevation: f64) -> Option<(&Band, f64)> {
        let of = &self.coordinates;
        self.row_of_band(
            elevation,
            of.row_place(elevation, elevation < of.horizon_rad),
        )
    }

    /// The same, given the place of the elevation among the rows of its side of the horizon.
    #[inline(always)]
    fn row_of_band(&self, elevation: f64, place: f64) -> Option<(&Band, f64)> {
        /// Rounding of elevations, rad.
        const ROUNDING: f64 = 1e-13;
        let of = &self.coordinates;
        if elevation > of.highest_rad + ROUNDING {
            return None;
        }
        let band = match &self.below_kink {
            _ if elevation < of.horizon_rad => &self.below,
            Some(band) if elevation < of.kink_rad => band,
            _ => &self.above,
        };
        let row = (place - band.first) * band.per_place;
        Some((band, row.clamp(0.0, 1.0)))
    }

    /// Interpolates all values of a cell at an elevation (rad), its place among the rows and the place of a column; false above the atmosphere's limb.
    #[inline(always)]
    fn interpolate(&self, (elevation, place): (f64, f64), column: f64, cell: &mut [f32]) -> bool {
        let Some((band, row)) = self.row_of_band(elevation, place) else {
            return false;
        };
        let width = cell.len();
        let (columns, column_weights) = cubic_mirrored(column, AZIMUTHS);
        let (first_row, row_weights) = cubic_f32(row, band.rows);
        let stride = (AZIMUTHS + 1) * width;
        let rows: [&[f32]; 4] =
            std::array::from_fn(|i| &band.values[(first_row + i) * stride..][..stride]);
        // Groups of four values stay in a register over all sixteen cells.
        let (groups, _) = cell.as_chunks_mut::<4>();
        for (group, sums) in groups.iter_mut().enumerate() {
            let mut sum = [0.0f32; 4];
            for (row, row_weight) in rows.iter().zip(&row_weights) {
                for (&column, column_weight) in columns.iter().zip(&column_weights) {
                    let values = &row[column * width + 4 * group..][..4];
                    let w = row_weight * column_weight;
                    for (sum, value) in sum.iter_mut().zip(values) {
                        *sum += w * value;
                    }
                }
            }
            *sums = sum;
        }
        true
    }

    /// Applies the phase functions and sums the parts of a cell.
    #[inline(always)]
    fn combine(&self, cell: &[f32], half_sine: f64, out: &mut [f32]) {
        match out.first_chunk_mut() {
            Some(rgb) if self.channels == 3 && !self.is_spectral => {
                self.combine_rgb(cell, half_sine, rgb)
            }
            _ => self.combine_channels(cell, half_sine, out),
        }
    }

    #[inline(always)]
    fn combine_rgb(&self, cell: &[f32], half_sine: f64, out: &mut [f32; 3]) {
        let (parts, _) = cell.as_chunks::<3>();
        *out = parts[0];
        if self.peaked.parts.is_empty() {
            return;
        }
        let factors = self.peaked.factors(half_sine);
        for (part, values) in parts[1..][..self.peaked.parts.len()].iter().enumerate() {
            let factors = factors.channels::<3>(part);
            for (channel, out) in out.iter_mut().enumerate() {
                *out += factors[channel] * values[channel];
            }
        }
    }

    fn combine_channels(&self, cell: &[f32], half_sine: f64, out: &mut [f32]) {
        let out = &mut out[..self.channels];
        out.copy_from_slice(&cell[..self.channels]);
        if !self.peaked.parts.is_empty() {
            let factors = self.peaked.factors(half_sine);
            for part in 0..self.peaked.parts.len() {
                let first = part * self.channels;
                let values = &cell[self.channels + first..][..self.channels];
                for (channel, (out, value)) in out.iter_mut().zip(values).enumerate() {
                    *out += factors.get(first + channel) * value;
                }
            }
        }
        if self.is_spectral {
            // Cubics undershoot where the light ends, such as at the top of the air.
            for out in &mut out[..self.channels] {
                *out = if *out > 0.0 { *out } else { 0.0 };
            }
        }
    }
}
