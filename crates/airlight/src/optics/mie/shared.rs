//! Cached tables of published drop distributions.

use super::droplets::Drops;
use super::{BulkOptics, MieError, Particles};
use crate::optics::TabulatedPhase;
use crate::spectrum::WavelengthGrid;
use crate::spectrum::rgb::{self, RgbSpace};
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// Optical properties of one kind of drops, at several wavelengths or in red, green and blue.
#[derive(Clone, Debug, PartialEq)]
pub struct DropTable {
    /// Phase function with the scattering matrix.
    pub phase: TabulatedPhase,
    /// Cross-sections and asymmetry at each wavelength, in increasing order.
    pub bulk: Vec<BulkOptics>,
    /// Cross-sections and asymmetry at 550 nm, the wavelength for which visibility is defined.
    pub green: BulkOptics,
}

/// Key of a cached table.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Key {
    /// Drops and the bits of the wavelengths.
    Wavelengths(Drops, Vec<u64>),
    /// Drops and the RGB space.
    Rgb(Drops, RgbSpace),
}

/// No lock is held while a table is built, because building waits for other threads, which may need the cache too. Two
/// threads that request the same table at the same time may both build it, with equal results.
static TABLES: LazyLock<Mutex<HashMap<Key, Arc<DropTable>>>> = LazyLock::new(Mutex::default);

fn shared(
    key: Key,
    build: impl FnOnce() -> Result<DropTable, MieError>,
) -> Result<Arc<DropTable>, MieError> {
    let tables = || TABLES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(table) = tables().get(&key).cloned() {
        return Ok(table);
    }
    let built = Arc::new(build()?);
    Ok(tables().entry(key).or_insert(built).clone())
}

impl Drops {
    /// Table at wavelengths (nm, increasing), built once in a process and cached. Building takes 0.1 to 0.5 s per wavelength on
    /// two cores, 1.5 s for rain (example `spheres`).
    ///
    /// # Errors
    /// As [`Particles::table`].
    pub fn table(self, wavelengths_nm: &[f64]) -> Result<Arc<DropTable>, MieError> {
        let bits = wavelengths_nm.iter().map(|nm| nm.to_bits()).collect();
        shared(Key::Wavelengths(self, bits), || {
            let water = Particles::water(self.sizes())?;
            let (phase, bulk) = water.table(wavelengths_nm)?;
            let green = water.bulk(550.0)?;
            Ok(DropTable { phase, bulk, green })
        })
    }

    /// Table for a linear RGB space in sunlight, at the wavelengths [`rgb::DOMINANT_NM`] in increasing order. Each channel is the
    /// mean over the standard grid ([`WavelengthGrid::standard`]), weighted by the channel's response to sunlight (for phase
    /// functions, to scattered light). For singly scattered white sunlight this is the spectral result, whereas three single
    /// wavelengths give bows and glories that are too colourful.
    ///
    /// # Errors
    /// As [`Particles::table`].
    pub fn rgb_table(self, space: RgbSpace) -> Result<Arc<DropTable>, MieError> {
        shared(Key::Rgb(self, space), || {
            let grid = WavelengthGrid::standard();
            let spectral = self.table(grid.wavelengths_nm())?;
            let weights = channel_weights(&grid, space);
            in_channels(&spectral, &grid, &weights)
        })
    }
}

/// Weight of each wavelength in the blue, green and red of sunlight.
fn channel_weights(grid: &WavelengthGrid, space: RgbSpace) -> [Vec<f64>; 3] {
    let from_xyz = space.from_xyz_matrix();
    let sunlight: Vec<[f64; 3]> = grid
        .xyz_weights()
        .iter()
        .zip(grid.solar_irradiance())
        .map(|(w, e)| rgb::apply(&from_xyz, w.map(|w| w * e)))
        .collect();
    [2, 1, 0].map(|channel| {
        let whole: f64 = sunlight.iter().map(|rgb| rgb[channel]).sum();
        sunlight.iter().map(|rgb| rgb[channel] / whole).collect()
    })
}

/// Means over the wavelengths in the channels.
///
/// A channel has negative weights if its primary lies inside the spectral locus. Phase functions vary too little between
/// wavelengths to make such a mean negative; they are clamped to a thousandth of the plain mean.
fn in_channels(
    spectral: &DropTable,
    grid: &WavelengthGrid,
    weights: &[Vec<f64>; 3],
) -> Result<DropTable, MieError> {
    let angles = spectral.phase.angles_rad();
    let (mut values, mut bulk) = (Vec::new(), Vec::new());
    let mut nm = rgb::DOMINANT_NM;
    nm.reverse();
    for (weights, wavelength_nm) in weights.iter().zip(nm) {
        let mean = |of: &dyn Fn(&BulkOptics) -> f64| -> f64 {
            weights
                .iter()
                .zip(&spectral.bulk)
                .map(|(w, b)| w * of(b))
                .sum()
        };
        let scattering_um2 = mean(&|b| b.scattering_um2);
        bulk.push(BulkOptics {
            wavelength_nm,
            scattering_um2,
            absorption_um2: mean(&|b| b.absorption_um2).max(0.0),
            asymmetry: mean(&|b| b.scattering_um2 * b.asymmetry) / scattering_um2,
            volume_um3: spectral.green.volume_um3,
        });
        for angle in angles {
            let p = |b: &BulkOptics| spectral.phase.evaluate(angle.cos(), b.wavelength_nm);
            let plain: f64 = spectral.bulk.iter().map(p).sum::<f64>() / grid.len() as f64;
            let weighted = mean(&|b| b.scattering_um2 * p(b)) / scattering_um2;
            values.push(weighted.max(1e-3 * plain));
        }
    }
    let degrees = |(i, angle): (usize, &f64)| match i + 1 == angles.len() {
        true => 180.0,
        false => angle.to_degrees(),
    };
    let angles_deg = angles.iter().enumerate().map(degrees).collect();
    Ok(DropTable {
        phase: TabulatedPhase::new(angles_deg, nm.to_vec(), values)?,
        bulk,
        green: spectral.green,
    })
}
