//! What modes of particles do to light, one by one and together.

use crate::optics::mie::{BulkOptics, MieError, Particles, SizeDistribution};
use crate::optics::{RefractiveIndex, TabulatedPhase};
use std::sync::{Arc, Mutex, PoisonError};

/// Wavelengths that optics are computed at, nm. Constant beyond.
pub(super) const WAVELENGTHS_NM: [f64; 11] = [
    350.0, 400.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0, 750.0, 800.0, 850.0,
];
/// Steps over the sizes, in those of fog's drops, and the tolerance of `ln p` that angles are chosen by. Against the finest
/// steps the phase functions of types differ by less than 1 % within 20 degrees and 4 % anywhere, scattering by less than 1e-3
/// (test `quick_sums_are_good_enough`).
const WIDER: f64 = 10.0;
const TOLERANCE: f64 = 0.03;
/// So many modes are remembered, the latest first.
const MOST_REMEMBERED: usize = 48;

/// Spheres of one material in one distribution of sizes, so many of them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mode {
    /// Number in a cubic centimetre.
    pub number_per_cm3: f64,
    /// Refractive index.
    pub index: RefractiveIndex,
    /// Sizes.
    pub sizes: SizeDistribution,
}

/// What many modes do to light, at each of [`WAVELENGTHS_NM`].
#[derive(Clone, Debug)]
pub(super) struct Optics {
    /// Scattering coefficient, m^-1.
    pub scattering_per_m: Vec<f64>,
    /// Absorption coefficient, m^-1.
    pub absorption_per_m: Vec<f64>,
    /// Mean cosine of the scattering angle.
    pub asymmetry: Vec<f64>,
    /// The phase functions that make up the whole, with their shares by wavelength.
    parts: Vec<(Vec<f64>, Arc<ModeOptics>)>,
}

/// Phase function and cross-sections of a mode.
#[derive(Debug)]
struct ModeOptics {
    phase: TabulatedPhase,
    bulk: Vec<BulkOptics>,
}

impl Mode {
    /// More or fewer of it.
    pub fn times(self, factor: f64) -> Self {
        let number_per_cm3 = factor * self.number_per_cm3;
        Self {
            number_per_cm3,
            ..self
        }
    }

    /// Its optics, computed once for each process.
    fn optics(&self) -> Result<Arc<ModeOptics>, MieError> {
        static KNOWN: Mutex<Vec<(Particles, Arc<ModeOptics>)>> = Mutex::new(Vec::new());
        let particles = Particles::new(self.index.clone(), self.sizes)?;
        let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, optics)) = known().iter().find(|(key, _)| *key == particles) {
            return Ok(Arc::clone(optics));
        }
        // Not under the lock: others may want another mode meanwhile.
        let (phase, bulk) = particles.broad_table(&WAVELENGTHS_NM, WIDER, TOLERANCE)?;
        let optics = Arc::new(ModeOptics { phase, bulk });
        let mut known = known();
        known.insert(0, (particles, Arc::clone(&optics)));
        known.truncate(MOST_REMEMBERED);
        Ok(optics)
    }
}

impl Optics {
    /// The sum over modes: coefficients add up, phase functions weighted by what each mode scatters.
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

    /// The phase function of all together.
    pub fn phase(&self) -> Result<TabulatedPhase, MieError> {
        let mut angles: Vec<f64> = self
            .parts
            .iter()
            .flat_map(|(_, part)| part.phase.angles_rad().iter().map(|a| a.to_degrees()))
            .collect();
        angles.sort_by(f64::total_cmp);
        // The same angle of two modes, but for rounding.
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
