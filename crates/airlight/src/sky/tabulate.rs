//! Computation of a view's table.

use super::between_azimuths::BetweenAzimuths;
use super::block::{ChannelMatrix, TableRow};
use super::peaked::{Peaked, Scattered};
use super::ray_bundle::RayBundle;
use super::table::{
    AZIMUTHS, Band, Rows, STEPS_ABOVE, STEPS_BELOW, SkyTable, TableChannels, with_mirrored_columns,
};
use super::table_coordinates::TableCoordinates;
use super::view::View;
use crate::atmosphere::Constituent;
use crate::axes;
use crate::control::{Cancelled, Control};
use crate::spectrum::{WavelengthGrid, rgb};
use glam::DVec3;
use std::f64::consts::PI;

impl View {
    /// Tabulates the radiance in all directions.
    pub fn table(&self, channels: TableChannels) -> SkyTable {
        self.table_with(channels, Control::default())
            .expect("nothing cancels it")
    }

    /// As [`View::table`], with cancellation.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn table_with(
        &self,
        channels: TableChannels,
        control: Control<'_>,
    ) -> Result<SkyTable, Cancelled> {
        SkyTable::new(self, channels, control)
    }
}

impl SkyTable {
    fn new(view: &View, channels: TableChannels, control: Control<'_>) -> Result<Self, Cancelled> {
        let sky = view.sky();
        let coordinates = view.table_coordinates();
        let matrices = channel_matrices(view, channels);
        let channel_count = matrices[0].weights.len();
        let peaked = Peaked::of(view, channel_count, |spectrum| {
            in_channels(&matrices, spectrum)
        });
        let width = peaked.width * (1 + peaked.parts.len());
        let azimuth_rad = |k| PI * coordinates.azimuth(k as f64 / AZIMUTHS as f64);
        let azimuths_rad: Vec<f64> = (0..=AZIMUTHS).map(azimuth_rad).collect();
        let between = between_azimuths(view, &coordinates);
        let mut values = Vec::new();
        let mut band = |places: [f64; 2], steps: usize, is_below: bool| {
            let first = values.len() / (AZIMUTHS + 1) / width;
            let rows = steps + 1;
            let elevations = (0..rows).map(|row| {
                let part = row as f64 / steps as f64;
                let place = places[0] + (places[1] - places[0]) * part;
                coordinates.elevation_rad(place, is_below)
            });
            let row = |elevation_rad| TableRow::new(view, elevation_rad, &azimuths_rad);
            let table_rows: Vec<TableRow> = elevations.map(row).collect();
            let mut filled = vec![0.0; rows * (AZIMUTHS + 1) * width];
            for (block, matrix) in sky.blocks().iter().zip(&matrices) {
                block.fill(
                    (&table_rows, &between),
                    matrix,
                    &peaked,
                    width,
                    &mut filled,
                    control,
                )?;
            }
            values.append(&mut filled);
            Ok(Band::new(places, first, steps))
        };
        let kink = coordinates.kink_place;
        let steps_below_kink = (kink * STEPS_ABOVE as f64).round() as usize;
        let below_kink = match steps_below_kink {
            0 => None,
            steps => Some(band([0.0, kink], steps, false)?),
        };
        let above = band([kink, 1.0], STEPS_ABOVE - steps_below_kink, false)?;
        let below = band([0.0, 1.0], STEPS_BELOW, true)?;
        let horizontal = DVec3::new(view.sun().x, 0.0, view.sun().z);
        Ok(Self {
            channels: channel_count,
            is_spectral: matches!(channels, TableChannels::Spectral),
            width,
            sun: view.sun(),
            sun_azimuth: if horizontal.length() > 1e-9 {
                horizontal.normalize()
            } else {
                DVec3::X
            },
            rows: Rows {
                coordinates,
                above,
                below_kink,
                below,
            },
            values: with_mirrored_columns(&values, width),
            peaked,
        })
    }
}

/// Interpolation of light that varies slowly with the azimuth: in daylight it varies by little, in twilight and from space by orders of
/// magnitude.
fn between_azimuths(view: &View, coordinates: &TableCoordinates) -> BetweenAzimuths {
    /// Elevation of the sun from which it is day, degrees.
    const DAY_DEG: f64 = 2.0;
    let has_even_columns = coordinates.dense_share == 0.0;
    match axes::elevation_deg(view.sun()) >= DAY_DEG && has_even_columns {
        true => BetweenAzimuths::ends(AZIMUTHS, 4),
        false => BetweenAzimuths::halfway(AZIMUTHS),
    }
}

impl Peaked {
    /// Peaked constituents of a view's atmosphere, in the channels that `convert` makes of a value at each wavelength.
    pub fn of(view: &View, channels: usize, convert: impl Fn(&[f32]) -> Vec<f32> + Sync) -> Self {
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
        let all = view.sky().atmosphere().constituents.iter().enumerate();
        let constituents = all
            .filter(|(_, c)| scatters(c) && peaked(c))
            .map(|(place, _)| place);
        let blocks = view.sky().blocks();
        let with_streams = |constituent: usize| {
            let streams = blocks.iter().map(|block| block.streams(constituent)).max();
            (constituent, streams.unwrap_or(1))
        };
        let constituents: Vec<_> = constituents.map(with_streams).collect();
        let scattered = |constituent: usize, nu: f64| {
            let mut all = Scattered::default();
            for block in blocks {
                let lanes = block.scattered(constituent, nu);
                all.coefficient.extend(lanes.coefficient);
                all.phase.extend(lanes.phase);
                for (all, share) in all.shares.iter_mut().zip(lanes.shares) {
                    all.extend(share);
                }
            }
            all
        };
        Self::new(&constituents, scattered, channels, convert)
    }
}

impl TableRow {
    /// Rays of a view at an elevation, rad, and at azimuths from that of the sun to the opposite one, rad.
    pub(super) fn new(view: &View, elevation_rad: f64, azimuths_rad: &[f64]) -> Self {
        let mu_sun = view.ray(view.sun()).mu;
        let sin_sun = ((1.0 - mu_sun) * (1.0 + mu_sun)).max(0.0).sqrt();
        let (mu, cos_elevation) = elevation_rad.sin_cos();
        let mut bundle = RayBundle::default();
        for azimuth_rad in azimuths_rad {
            let nu = mu * mu_sun + cos_elevation * sin_sun * azimuth_rad.cos();
            bundle.push(mu_sun, nu.clamp(-1.0, 1.0));
        }
        Self {
            start: (view.radius_m(), mu),
            bundle,
        }
    }
}

/// For each channel, the weights of the wavelengths, for radiance divided by the solar irradiance `solar`.
pub(crate) fn channel_weights(
    grid: &WavelengthGrid,
    solar: &[f32],
    channels: TableChannels,
) -> Vec<Vec<f32>> {
    match channels {
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
                        .zip(solar)
                        .map(|(w, &e)| (w[c] * f64::from(e)) as f32)
                        .collect()
                })
                .collect()
        }
    }
}

/// For each block of wavelengths, the weights from its lanes to the channels of the table.
fn channel_matrices(view: &View, channels: TableChannels) -> Vec<ChannelMatrix> {
    let rows = channel_weights(view.sky().grid(), &view.solar_irradiance(), channels);
    let mut first = 0;
    view.sky()
        .blocks()
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

/// Channels of a spectrum.
fn in_channels(matrices: &[ChannelMatrix], spectrum: &[f32]) -> Vec<f32> {
    let mut channels = vec![0.0; matrices[0].weights.len()];
    let mut rest = spectrum;
    for matrix in matrices {
        let (lanes, beyond) = rest.split_at(matrix.weights[0].len());
        rest = beyond;
        for (channel, weights) in channels.iter_mut().zip(&matrix.weights) {
            *channel += weights.iter().zip(lanes).map(|(w, v)| w * v).sum::<f32>();
        }
    }
    channels
}
