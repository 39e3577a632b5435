//! Optics of modes of particles, single and summed.

use crate::control::Control;
use crate::optics::mie::{BulkOptics, MieError, Particles, SizeDistribution};
use crate::optics::{RefractiveIndex, TabulatedPhase};
use std::sync::{Arc, Mutex, PoisonError};

/// Wavelengths at which optics are computed, nm; constant beyond.
pub(super) const WAVELENGTHS_NM: [f64; 11] = [
    350.0, 400.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0, 750.0, 800.0, 850.0,
];
/// Step of the sum over sizes, in steps used for fog droplets, and the tolerance of `ln p` by which angles are chosen.
/// Compared with the finest steps, phase functions of types differ by less than 1 % within 20 degrees and 4 % anywhere,
/// scattering by less than 1e-3 (test `coarse_sums_are_accurate`).
const WIDER: f64 = 10.0;
const TOLERANCE: f64 = 0.03;
/// Number of modes in the cache; the oldest is dropped first.
const CACHED_MODES: usize = 48;

/// Spheres of one material and size distribution, with their number density.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mode {
    /// Number of particles per cubic centimetre.
    pub number_per_cm3: f64,
    /// Refractive index.
    pub index: RefractiveIndex,
    /// Size distribution.
    pub sizes: SizeDistribution,
}

/// Optics of a sum of modes at each of [`WAVELENGTHS_NM`].
#[derive(Clone, Debug)]
pub(super) struct Optics {
    /// Scattering coefficient, m^-1.
    pub scattering_per_m: Vec<f64>,
    /// Absorption coefficient, m^-1.
    pub absorption_per_m: Vec<f64>,
    /// Mean cosine of the scattering angle.
    pub asymmetry: Vec<f64>,
    /// Phase functions of the modes, each with its scattering coefficients by wavelength.
    parts: Vec<(Vec<f64>, Arc<ModeOptics>)>,
}

/// Phase function and cross-sections of a mode.
#[derive(Debug)]
struct ModeOptics {
    phase: TabulatedPhase,
    bulk: Vec<BulkOptics>,
}

impl Mode {
    /// The mode with its number density multiplied by `factor`.
    pub fn times(self, factor: f64) -> Self {
        let number_per_cm3 = factor * self.number_per_cm3;
        Self {
            number_per_cm3,
            ..self
        }
    }

    /// Optics of the mode, cached for the process.
    fn optics(&self) -> Result<Arc<ModeOptics>, MieError> {
        static CACHE: Mutex<Vec<(Particles, Arc<ModeOptics>)>> = Mutex::new(Vec::new());
        let particles = Particles::new(self.index.clone(), self.sizes)?;
        let cache = || CACHE.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, optics)) = cache().iter().find(|(key, _)| *key == particles) {
            return Ok(Arc::clone(optics));
        }
        // Without the lock, so that other threads can compute other modes.
        let control = Control::default();
        let (phase, bulk) = particles.broad_table(&WAVELENGTHS_NM, WIDER, TOLERANCE, control)?;
        let optics = Arc::new(ModeOptics { phase, bulk });
        let mut cache = cache();
        cache.insert(0, (particles, Arc::clone(&optics)));
        cache.truncate(CACHED_MODES);
        Ok(optics)
    }
}

impl Optics {
    /// Sum of modes: coefficients are added, phase functions weighted by scattering coefficients.
    pub fn of(modes: &[Mode]) -> Result<Self, MieError> {
        let count = WAVELENGTHS_NM.len();
        let mut sum = Self {
            scattering_per_m: vec![0.0; count],
            absorption_per_m: vec![0.0; count],
            asymmetry: vec![0.0; count],
            parts: Vec::new(),
        };
        for mode in modes {
            let optics = mode.optics()?;
            let per_m = 1e-6 * mode.number_per_cm3;
            let mut scattered = Vec::with_capacity(count);
            for (i, bulk) in optics.bulk.iter().enumerate() {
                scattered.push(per_m * bulk.scattering_um2);
                sum.scattering_per_m[i] += scattered[i];
                sum.absorption_per_m[i] += per_m * bulk.absorption_um2;
                sum.asymmetry[i] += scattered[i] * bulk.asymmetry;
            }
            sum.parts.push((scattered, optics));
        }
        for (g, scattered) in sum.asymmetry.iter_mut().zip(&sum.scattering_per_m) {
            *g /= scattered;
        }
        Ok(sum)
    }

    /// Phase function of the sum.
    pub fn phase(&self) -> Result<TabulatedPhase, MieError> {
        let mut angles: Vec<f64> = self
            .parts
            .iter()
            .flat_map(|(_, part)| part.phase.angles_rad().iter().map(|a| a.to_degrees()))
            .collect();
        angles.sort_by(f64::total_cmp);
        // Angles of two modes that differ by rounding only.
        angles.dedup_by(|next, kept| *next - *kept < 1e-9);
        let last = angles.len() - 1;
        angles[last] = 180.0;
        let mut values = Vec::with_capacity(angles.len() * WAVELENGTHS_NM.len());
        let mut ratios = Vec::with_capacity(values.capacity());
        for (i, &nm) in WAVELENGTHS_NM.iter().enumerate() {
            for angle in &angles {
                let cos = angle.to_radians().cos();
                let (mut whole, mut matrix) = (0.0, [0.0; 3]);
                for (scattered, part) in &self.parts {
                    let share = scattered[i] * part.phase.evaluate(cos, nm);
                    let of = part.phase.matrix_ratios(cos, nm);
                    whole += share;
                    for (sum, ratio) in matrix.iter_mut().zip([of.f12, of.f33, of.f34]) {
                        *sum += share * ratio;
                    }
                }
                values.push(whole);
                ratios.push(matrix.map(|sum| sum / whole));
            }
        }
        let table = TabulatedPhase::new(angles, WAVELENGTHS_NM.to_vec(), values)?;
        Ok(table.with_matrix(&ratios)?)
    }
}
