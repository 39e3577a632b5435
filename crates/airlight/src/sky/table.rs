//! All directions of one view, tabulated: a picture's pixel costs a table look-up.
//!
//! Two tables, above and below the horizon (where radiance jumps), with rows crowding towards it as the square of an
//! even coordinate, interpolated with third-degree polynomials. Everything that varies fast is kept out of the tables:
//! light scattered once by a constituent with a peaked phase function is stored without it, and the phase function is
//! applied for each pixel.

use super::block::{ChannelMatrix, TableRow};
use super::fan::Fan;
use super::quadrature::GaussRule;
use super::view::View;
use crate::medium::Constituent;
use crate::spectrum::{RgbSpace, rgb};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// What the channels of a table are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableChannels {
    /// Linear red, green and blue; luminance in cd/m^2 where (1, 1, 1) is 1 cd/m^2 of the space's white.
    Rgb(RgbSpace),
    /// Radiance at each wavelength of the sky's grid, W m^-2 sr^-1 nm^-1.
    Spectral,
}

/// Steps in azimuth from the sun's to the opposite one.
const AZIMUTHS: usize = 64;
/// Rows from the horizon to the zenith.
const ROWS_ABOVE: usize = 128;
/// Rows from the horizon to the nadir.
const ROWS_BELOW: usize = 96;
/// Samples of a phase function in the sine of half the scattering angle.
const PHASE_SAMPLES: usize = 4096;

/// The widest cell that is interpolated without allocating: 16 wavelengths and three peaked scatterers.
const SMALL_WIDTH: usize = 64;

/// A view's radiance in every direction, without the sun's disc.
pub struct SkyTable {
    channels: usize,
    /// Values in a cell of the table: every channel of every part, padded for vector loads.
    width: usize,
    sun: DVec3,
    sun_azimuth: DVec3,
    horizon_elevation: f64,
    above: Half,
    below: Half,
    /// For each peaked scatterer, its phase function at even steps of the sine of half the scattering angle.
    phases: Vec<Vec<f32>>,
}

/// The part of a table on one side of the horizon.
struct Half {
    /// Signed angle from the horizon to the last row, rad.
    span: f64,
    rows: usize,
    /// `[row][azimuth][channel of each part]`.
    values: Vec<f32>,
}

/// Where the columns of a picture lie in the table: worked out once for pictures whose columns keep their azimuth.
pub struct SkyColumns {
    columns: Vec<Column>,
}

struct Column {
    nodes: [usize; 4],
    weights: [f32; 4],
    /// Squared sine of half the angle between this azimuth and the sun's.
    half_sine2: f64,
}

impl SkyTable {
    pub(super) fn new(view: &View<'_>, channels: TableChannels) -> Self {
        let sky = view.sky();
        let shell = sky.shell();
        let radius_m = view.radius_m();
        let horizon_elevation = -(shell.ground_radius_m / radius_m).min(1.0).acos();
        // From outside the air, nothing is seen above the line that grazes its top.
        let ceiling = if radius_m > shell.top_radius_m {
            -(shell.top_radius_m / radius_m).acos()
        } else {
            FRAC_PI_2
        };
        let matrices = channel_matrices(view, channels);
        let peaked = peaked_constituents(view);
        let channel_count = matrices[0].weights.len();
        let width = (channel_count * (1 + peaked.len())).next_multiple_of(4);
        let half = |span: f64, rows: usize| {
            let table_rows = half_rows(view, horizon_elevation, span, rows);
            let mut values = vec![0.0; rows * (AZIMUTHS + 1) * width];
            for (block, matrix) in sky.blocks.iter().zip(&matrices) {
                block.fill(&table_rows, matrix, &peaked, width, &mut values);
            }
            Half { span, rows, values }
        };
        // Blocks of wavelengths must agree on the phase function that pixels will be multiplied by: the first one's.
        let phases = peaked
            .iter()
            .map(|&constituent| {
                (0..=PHASE_SAMPLES)
                    .map(|i| {
                        let half_sine = i as f64 / PHASE_SAMPLES as f64;
                        sky.blocks[0].peaked_phase(constituent, 1.0 - 2.0 * half_sine * half_sine)
                            as f32
                    })
                    .collect()
            })
            .collect();
        let horizontal = DVec3::new(view.sun().x, 0.0, view.sun().z);
        Self {
            channels: channel_count,
            width,
            sun: view.sun(),
            sun_azimuth: if horizontal.length() > 1e-9 {
                horizontal.normalize()
            } else {
                DVec3::X
            },
            horizon_elevation,
            above: half(ceiling - horizon_elevation, ROWS_ABOVE),
            below: half(-FRAC_PI_2 - horizon_elevation, ROWS_BELOW),
            phases,
        }
    }

    /// Number of channels.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Elevation of the horizon, rad (0 on the ground, negative above it).
    pub fn horizon_elevation_rad(&self) -> f64 {
        self.horizon_elevation
    }

    /// Writes the radiance along the unit vector `direction` into `out`, one value a channel.
    #[inline]
    pub fn sample(&self, direction: DVec3, out: &mut [f32]) {
        let horizontal = (direction.x * direction.x + direction.z * direction.z).sqrt();
        let elevation = direction.y.atan2(horizontal);
        let cos_azimuth = if horizontal > 0.0 {
            (direction.x * self.sun_azimuth.x + direction.z * self.sun_azimuth.z) / horizontal
        } else {
            1.0
        };
        let (nodes, weights) = cubic_mirrored(cos_azimuth.clamp(-1.0, 1.0).acos() / PI);
        let half_sine = 0.5 * direction.distance(self.sun);
        match self.place(elevation) {
            Some((half, row)) => self.interpolate(half, row, &nodes, &weights, half_sine, out),
            None => out[..self.channels].fill(0.0),
        }
    }

    /// Prepares columns of a picture: `azimuths_rad` are measured from the sun's azimuth.
    pub fn columns(&self, azimuths_rad: impl Iterator<Item = f64>) -> SkyColumns {
        let columns = azimuths_rad
            .map(|azimuth| {
                let (sin, cos) = azimuth.sin_cos();
                let (nodes, weights) = cubic_mirrored(sin.abs().atan2(cos) / PI);
                Column {
                    nodes,
                    weights,
                    half_sine2: (0.5 * azimuth).sin().powi(2),
                }
            })
            .collect();
        SkyColumns { columns }
    }

    /// Writes the radiance at one elevation (rad) in every prepared column into `out`, one value a channel and column:
    /// several times faster than [`SkyTable::sample`].
    pub fn sample_row(&self, elevation_rad: f64, columns: &SkyColumns, out: &mut [f32]) {
        let Some((half, row)) = self.place(elevation_rad) else {
            out.fill(0.0);
            return;
        };
        let stride = (AZIMUTHS + 1) * self.width;
        let (first, weights) = cubic(row, half.rows);
        let mut line = vec![0.0f32; stride];
        for (i, w) in weights.iter().enumerate() {
            let values = &half.values[(first + i) * stride..][..stride];
            for (sum, value) in line.iter_mut().zip(values) {
                *sum += w * value;
            }
        }
        let sun_elevation = crate::axes::elevation_deg(self.sun).to_radians();
        let half_sine2 = (0.5 * (elevation_rad - sun_elevation)).sin().powi(2);
        let cosines = elevation_rad.cos() * sun_elevation.cos();
        let mut cell = vec![0.0f32; self.width];
        for (column, out) in columns
            .columns
            .iter()
            .zip(out.chunks_exact_mut(self.channels))
        {
            cell.fill(0.0);
            for (node, w) in column.nodes.iter().zip(&column.weights) {
                for (sum, value) in cell
                    .iter_mut()
                    .zip(&line[node * self.width..][..self.width])
                {
                    *sum += w * value;
                }
            }
            self.combine(
                &cell,
                (half_sine2 + cosines * column.half_sine2).sqrt(),
                out,
            );
        }
    }

    /// Irradiance, one value a channel, of a surface with the unit normal `normal` from all that the table holds: sky
    /// and ground, without the sun's disc (W m^-2 nm^-1, or lux for RGB channels).
    ///
    /// A sum over about 25 000 directions, rows crowding towards the horizon as in the table: good to 0.1 % for skies
    /// whose aureole is wider than a degree.
    pub fn irradiance(&self, normal: DVec3) -> Vec<f32> {
        const AROUND: usize = 256;
        let rule = GaussRule::new(48);
        let mut sum = vec![0.0f64; self.channels];
        let mut radiance = vec![0.0f32; self.channels];
        for half in [&self.above, &self.below] {
            for (x, w) in rule.on(0.0, 1.0) {
                let elevation = self.horizon_elevation + half.span * x * x;
                let (sin, cos) = elevation.sin_cos();
                let solid_angle = w * 2.0 * x * half.span.abs() * cos * 2.0 * PI / AROUND as f64;
                for k in 0..AROUND {
                    let (z, x) = (2.0 * PI * (k as f64 + 0.5) / AROUND as f64).sin_cos();
                    let direction = DVec3::new(cos * x, sin, cos * z);
                    let cosine = direction.dot(normal);
                    if cosine > 0.0 {
                        self.sample(direction, &mut radiance);
                        for (sum, &radiance) in sum.iter_mut().zip(&radiance) {
                            *sum += solid_angle * cosine * f64::from(radiance);
                        }
                    }
                }
            }
        }
        sum.into_iter().map(|e| e as f32).collect()
    }

    /// The half of the table that holds an elevation, and the row coordinate in `[0, 1]`; `None` where no air is seen.
    #[inline(always)]
    fn place(&self, elevation: f64) -> Option<(&Half, f64)> {
        let half = if elevation >= self.horizon_elevation {
            &self.above
        } else {
            &self.below
        };
        let depth = (elevation - self.horizon_elevation) / half.span;
        (depth <= 1.0 + 1e-12).then(|| (half, depth.clamp(0.0, 1.0).sqrt()))
    }

    #[inline(always)]
    fn interpolate(
        &self,
        half: &Half,
        row: f64,
        columns: &[usize; 4],
        column_weights: &[f32; 4],
        half_sine: f64,
        out: &mut [f32],
    ) {
        let stride = (AZIMUTHS + 1) * self.width;
        let (first_row, row_weights) = cubic(row, half.rows);
        // Four values at a time stay in one register over all sixteen cells.
        let mut small = [0.0f32; SMALL_WIDTH];
        let mut large = Vec::new();
        let cell = if self.width <= SMALL_WIDTH {
            &mut small[..self.width]
        } else {
            large.resize(self.width, 0.0);
            &mut large[..]
        };
        for (part, sums) in cell.chunks_exact_mut(4).enumerate() {
            let mut sum = [0.0f32; 4];
            for (i, &wr) in row_weights.iter().enumerate() {
                for (&column, &wc) in columns.iter().zip(column_weights) {
                    let start = (first_row + i) * stride + column * self.width + 4 * part;
                    let values = &half.values[start..start + 4];
                    let w = wr * wc;
                    for k in 0..4 {
                        sum[k] += w * values[k];
                    }
                }
            }
            sums.copy_from_slice(&sum);
        }
        self.combine(cell, half_sine, out);
    }

    /// Applies the phase functions and adds up the parts of a cell.
    #[inline(always)]
    fn combine(&self, cell: &[f32], half_sine: f64, out: &mut [f32]) {
        let position = (half_sine * PHASE_SAMPLES as f64).clamp(0.0, PHASE_SAMPLES as f64 - 1e-6);
        let below = position as usize;
        let fraction = (position - below as f64) as f32;
        out[..self.channels].copy_from_slice(&cell[..self.channels]);
        for (phase, values) in self
            .phases
            .iter()
            .zip(cell[self.channels..].chunks_exact(self.channels))
        {
            let phase = phase[below] * (1.0 - fraction) + phase[below + 1] * fraction;
            for (out, value) in out.iter_mut().zip(values) {
                *out += phase * value;
            }
        }
    }
}

/// The constituents whose phase function is too peaked to be tabulated.
fn peaked_constituents(view: &View<'_>) -> Vec<usize> {
    let wavelengths = view.sky().grid().wavelengths_nm();
    let scatters = |c: &Constituent| {
        wavelengths
            .iter()
            .any(|&nm| c.scattering_per_m.at(nm) > 0.0)
    };
    let peaked = |c: &Constituent| {
        wavelengths
            .iter()
            .any(|&nm| c.phase.asymmetry(nm).abs() > 0.1)
    };
    let constituents = view.sky().atmosphere().constituents.iter().enumerate();
    constituents
        .filter(|(_, c)| scatters(c) && peaked(c))
        .map(|(place, _)| place)
        .collect()
}

/// The rays of one half of the table.
fn half_rows(view: &View<'_>, horizon: f64, span: f64, rows: usize) -> Vec<TableRow> {
    let mu_sun = view.ray(view.sun()).mu;
    let sin_sun = ((1.0 - mu_sun) * (1.0 + mu_sun)).max(0.0).sqrt();
    (0..rows)
        .map(|row| {
            let x = row as f64 / (rows - 1) as f64;
            // The horizon itself is a jump: start a hair's breadth from it.
            let (mu, cos_elevation) = (horizon + span * (x * x).max(1e-9)).sin_cos();
            let mut fan = Fan::default();
            for azimuth in 0..=AZIMUTHS {
                let cos_azimuth = (PI * azimuth as f64 / AZIMUTHS as f64).cos();
                fan.push(
                    mu_sun,
                    (mu * mu_sun + cos_elevation * sin_sun * cos_azimuth).clamp(-1.0, 1.0),
                );
            }
            TableRow {
                start: (view.radius_m(), mu),
                fan,
            }
        })
        .collect()
}

/// For each block of wavelengths, the weights that turn its lanes into the table's channels.
fn channel_matrices(view: &View<'_>, channels: TableChannels) -> Vec<ChannelMatrix> {
    let solar = view.solar_irradiance();
    let grid = view.sky().grid();
    let rows: Vec<Vec<f32>> = match channels {
        TableChannels::Spectral => (0..solar.len())
            .map(|channel| {
                let mut row = vec![0.0; solar.len()];
                row[channel] = solar[channel];
                row
            })
            .collect(),
        TableChannels::Rgb(space) => {
            let from_xyz = space.from_xyz_matrix();
            let lanes: Vec<[f64; 3]> = grid
                .xyz_weights()
                .iter()
                .map(|&w| rgb::apply(&from_xyz, w))
                .collect();
            (0..3)
                .map(|c| {
                    lanes
                        .iter()
                        .zip(&solar)
                        .map(|(w, &e)| (w[c] * f64::from(e)) as f32)
                        .collect()
                })
                .collect()
        }
    };
    let mut first = 0;
    view.sky()
        .blocks
        .iter()
        .map(|block| {
            let lanes = first..first + block.lanes();
            first = lanes.end;
            ChannelMatrix {
                weights: rows.iter().map(|row| row[lanes.clone()].to_vec()).collect(),
            }
        })
        .collect()
}

/// First node and weights of third-degree Lagrange interpolation at `x` in `[0, 1]` among `count` even nodes.
#[inline(always)]
fn cubic(x: f64, count: usize) -> (usize, [f32; 4]) {
    let position = x * (count - 1) as f64;
    let first = (position as usize).saturating_sub(1).min(count - 4);
    (first, cubic_weights((position - first as f64) as f32))
}

/// The same in azimuth, where the table is its own mirror image beyond both ends.
#[inline(always)]
fn cubic_mirrored(x: f64) -> ([usize; 4], [f32; 4]) {
    let position = x * AZIMUTHS as f64;
    let first = (position as isize).min(AZIMUTHS as isize - 1) - 1;
    let nodes = std::array::from_fn(|k| {
        let node = (first + k as isize).unsigned_abs();
        if node > AZIMUTHS {
            2 * AZIMUTHS - node
        } else {
            node
        }
    });
    (nodes, cubic_weights((position - first as f64) as f32))
}

#[inline(always)]
fn cubic_weights(t: f32) -> [f32; 4] {
    let (a, b, c, d) = (t, t - 1.0, t - 2.0, t - 3.0);
    [
        -b * c * d / 6.0,
        a * c * d / 2.0,
        -a * b * d / 2.0,
        a * b * c / 6.0,
    ]
}
