//! Many spheres of one material: what a cloud of them does to light.

use super::angles::adapt;
use super::angular::{Angles, LANES, Pair, pairs};
use super::sizes::{FEWEST_SIZES, Steps};
use super::sphere::{Coefficients, ScatteringMatrix, check_index};
use super::{LARGEST_SIZE_PARAMETER, MieError, SizeDistribution, SizeNode};
use crate::math::parallel;
use crate::math::simd::vectorized;
use crate::optics::{RefractiveIndex, TabulatedPhase};
use std::f64::consts::{PI, TAU};

/// Steps of the sums over sizes.
///
/// A drop of clear water rings at sharp resonances, so the sums converge slowly: the fine steps are for them. Against steps
/// a fifth as wide the phase function of droplets changes by 0.4 to 0.8 % (root mean square over all angles; 3 % where it
/// changes most), coefficients and asymmetry by less than 5e-4; of aerosol by less than 1e-5 (test
/// `sums_over_sizes_converge`).
const STEPS: Steps = Steps {
    size: 0.002,
    log: 0.03,
};
/// No more terms of Mie's series than this, over all sizes, so that drops of rain take seconds and not hours: their steps
/// are wider, and what is finer than the fringes of neighbouring sizes is left as noise.
const MOST_TERMS: f64 = 2e6;
/// The error aimed at in `ln p` in the middle of the widest intervals that are kept; between the angles of the table, which
/// lie closer, it is some 5 times less.
const TOLERANCE: f64 = 0.01;

/// Spheres of one material in a distribution of sizes.
#[derive(Clone, Debug, PartialEq)]
pub struct Particles {
    index: RefractiveIndex,
    sizes: SizeDistribution,
}

/// What spheres do to light of one wavelength, on the mean for one of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BulkOptics {
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// Scattering cross-section, square micrometres.
    pub scattering_um2: f64,
    /// Absorption cross-section, square micrometres.
    pub absorption_um2: f64,
    /// Mean cosine of the scattering angle.
    pub asymmetry: f64,
    /// Mean volume, cubic micrometres.
    pub volume_um3: f64,
}

impl BulkOptics {
    /// Extinction cross-section, square micrometres.
    pub fn extinction_um2(&self) -> f64 {
        self.scattering_um2 + self.absorption_um2
    }

    /// Scattering over extinction.
    pub fn single_scattering_albedo(&self) -> f64 {
        self.scattering_um2 / self.extinction_um2()
    }

    /// Extinction coefficient (1/m) of a number of spheres in a cubic centimetre.
    pub fn extinction_per_m(&self, number_per_cm3: f64) -> f64 {
        1e-6 * number_per_cm3 * self.extinction_um2()
    }

    /// Extinction coefficient (1/m) of a mass of spheres in a cubic metre, grams, of a density in grams per cubic
    /// centimetre: of water droplets (density 1) by the liquid water content.
    pub fn extinction_per_m_by_mass(&self, grams_per_m3: f64, density_g_cm3: f64) -> f64 {
        grams_per_m3 * self.extinction_um2() / (self.volume_um3 * density_g_cm3)
    }
}

/// Spheres of all sizes at one wavelength.
struct Prepared {
    /// For each size what it scatters and where its coefficients lie in `pairs`.
    sizes: Vec<(f64, std::ops::Range<usize>)>,
    pairs: Vec<Pair>,
    most_terms: usize,
    /// Means over the number of `sum (2 n + 1) ...`.
    scattered: f64,
    absorbed: f64,
    forward: f64,
}

impl Particles {
    /// Spheres of a refractive index (relative to air, taken as 1) and of these sizes.
    ///
    /// # Errors
    /// [`MieError`] where the sizes cannot be, or the index at 550 nm.
    pub fn new(index: RefractiveIndex, sizes: SizeDistribution) -> Result<Self, MieError> {
        sizes.validate()?;
        check_index(index.at(550.0))?;
        Ok(Self { index, sizes })
    }

    /// Droplets of pure water.
    ///
    /// # Errors
    /// [`MieError`] where the sizes cannot be.
    pub fn water(sizes: SizeDistribution) -> Result<Self, MieError> {
        Self::new(RefractiveIndex::water(), sizes)
    }

    /// The refractive index.
    pub fn index(&self) -> &RefractiveIndex {
        &self.index
    }

    /// The sizes.
    pub fn sizes(&self) -> &SizeDistribution {
        &self.sizes
    }

    /// Cross-sections and asymmetry at a wavelength.
    ///
    /// # Errors
    /// [`MieError`] for a wavelength that is not positive, and for spheres that are too large for it.
    pub fn bulk(&self, wavelength_nm: f64) -> Result<BulkOptics, MieError> {
        Ok(self.bulk_of(wavelength_nm, &self.prepare(wavelength_nm, STEPS)?))
    }

    fn bulk_of(&self, wavelength_nm: f64, prepared: &Prepared) -> BulkOptics {
        // pi r^2 2 / x^2, which the radius drops out of.
        let wavelength_um = 1e-3 * wavelength_nm;
        let area = wavelength_um * wavelength_um / TAU;
        BulkOptics {
            wavelength_nm,
            scattering_um2: area * prepared.scattered,
            absorption_um2: area * prepared.absorbed,
            asymmetry: 2.0 * prepared.forward / prepared.scattered,
            volume_um3: self.sizes.mean_volume_um3(),
        }
    }

    /// The scattering matrix at cosines of the scattering angle; `f11` integrates to 1 over the sphere.
    ///
    /// # Errors
    /// As [`Particles::bulk`].
    pub fn matrices(
        &self,
        wavelength_nm: f64,
        cosines: &[f64],
    ) -> Result<Vec<ScatteringMatrix>, MieError> {
        Ok(self.prepare(wavelength_nm, STEPS)?.matrices(cosines))
    }

    /// The phase function as a table at these wavelengths (nm, rising) with the rest of the scattering matrix, and what else
    /// is known of each.
    ///
    /// The angles are chosen by the phase functions of the shortest and the longest wavelength, so that forward peak,
    /// bows and glory are kept: the table's error between its angles is below 0.5 %.
    ///
    /// # Errors
    /// As [`Particles::bulk`]; [`MieError::Phase`] where the wavelengths do not rise.
    pub fn table(
        &self,
        wavelengths_nm: &[f64],
    ) -> Result<(TabulatedPhase, Vec<BulkOptics>), MieError> {
        self.table_in(wavelengths_nm, STEPS, TOLERANCE)
    }

    /// As [`Particles::table`], but quicker, for broad distributions, whose sizes blur each other's resonances: with steps
    /// over the sizes that are `wider` times as wide, and angles as far apart as another tolerance of `ln p` lets them be.
    pub(crate) fn broad_table(
        &self,
        wavelengths_nm: &[f64],
        wider: f64,
        tolerance: f64,
    ) -> Result<(TabulatedPhase, Vec<BulkOptics>), MieError> {
        let size = wider * STEPS.size;
        self.table_in(wavelengths_nm, Steps { size, ..STEPS }, tolerance)
    }

    fn table_in(
        &self,
        wavelengths_nm: &[f64],
        steps: Steps,
        tolerance: f64,
    ) -> Result<(TabulatedPhase, Vec<BulkOptics>), MieError> {
        let mut angles: Vec<f64> = Vec::new();
        let matrices = |prepared: &Prepared, angles: &[f64]| {
            let cosines: Vec<f64> = angles.iter().map(|a| a.cos()).collect();
            prepared.matrices(&cosines)
        };
        let phase = |prepared: &Prepared, angles: &[f64]| {
            let matrices = matrices(prepared, angles);
            matrices.into_iter().map(|matrix| matrix.f11).collect()
        };
        let radius_um = self.sizes.mean_power(6.0).powf(1.0 / 6.0);
        if let [first, .., last] | [first @ last] = wavelengths_nm {
            for nm in [first, last] {
                let prepared = self.prepare(*nm, steps)?;
                let x = TAU * 1e3 * radius_um / nm;
                angles = adapt(x, &angles, tolerance, |angles| phase(&prepared, angles));
            }
        }
        let mut values = Vec::with_capacity(angles.len() * wavelengths_nm.len());
        let mut ratios = Vec::with_capacity(values.capacity());
        let mut bulk = Vec::with_capacity(wavelengths_nm.len());
        for &nm in wavelengths_nm {
            let prepared = self.prepare(nm, steps)?;
            for matrix in matrices(&prepared, &angles) {
                values.push(matrix.f11);
                ratios.push([matrix.f12, matrix.f33, matrix.f34].map(|f| f / matrix.f11));
            }
            bulk.push(self.bulk_of(nm, &prepared));
        }
        let degrees = |angle: &f64| match *angle == PI {
            true => 180.0,
            false => angle.to_degrees(),
        };
        let angles_deg = angles.iter().map(degrees).collect();
        let table = TabulatedPhase::new(angles_deg, wavelengths_nm.to_vec(), values)?;
        Ok((table.with_matrix(&ratios)?, bulk))
    }

    /// The coefficients of spheres of all sizes.
    fn prepare(&self, wavelength_nm: f64, steps: Steps) -> Result<Prepared, MieError> {
        if !(wavelength_nm.is_finite() && wavelength_nm > 0.0) {
            return Err(MieError::Wavelength(wavelength_nm));
        }
        let index = self.index.at(wavelength_nm);
        check_index(index)?;
        let size_per_um = TAU * 1e3 / wavelength_nm;
        let nodes = self.nodes(wavelength_nm, steps);
        let largest = size_per_um * nodes[nodes.len() - 1].radius_um;
        if largest > LARGEST_SIZE_PARAMETER {
            return Err(MieError::SizeParameter(largest));
        }
        // Neighbours in size share the room for their functions.
        /// Share of a size, what it scatters, absorbs and sends straight on, and its coefficients.
        type Sized = (f64, [f64; 3], Vec<Pair>);
        let parts: Vec<Vec<Sized>> = parallel::map_chunks(&nodes, 16, |nodes| {
            let mut coefficients = Coefficients::default();
            let sphere = |node: &SizeNode| {
                coefficients.fill(size_per_um * node.radius_um, index);
                let sums = [
                    coefficients.scattered,
                    coefficients.absorbed,
                    coefficients.forward(),
                ];
                // Scaled to scatter as much as any other, whatever its size.
                let factor = coefficients.scattered.sqrt().recip();
                (node.share, sums, pairs(&coefficients, factor).collect())
            };
            nodes.iter().map(sphere).collect()
        });
        let mut prepared = Prepared {
            sizes: Vec::with_capacity(nodes.len()),
            pairs: Vec::new(),
            most_terms: 0,
            scattered: 0.0,
            absorbed: 0.0,
            forward: 0.0,
        };
        for (share, [scattered, absorbed, forward], pairs) in parts.into_iter().flatten() {
            prepared.scattered += share * scattered;
            prepared.absorbed += share * absorbed;
            prepared.forward += share * forward;
            prepared.most_terms = prepared.most_terms.max(pairs.len());
            let start = prepared.pairs.len();
            prepared.pairs.extend(pairs);
            let range = start..prepared.pairs.len();
            prepared.sizes.push((share * scattered, range));
        }
        Ok(prepared)
    }

    /// Radii, never more than [`MOST_TERMS`] allow.
    fn nodes(&self, wavelength_nm: f64, mut steps: Steps) -> Vec<SizeNode> {
        loop {
            let nodes = self.sizes.nodes(steps);
            let radii_um: f64 = nodes.iter().map(|node| node.radius_um).sum();
            let terms = radii_um * TAU * 1e3 / wavelength_nm;
            if terms <= MOST_TERMS || nodes.len() <= FEWEST_SIZES {
                return nodes;
            }
            steps.size *= 1.05 * terms / MOST_TERMS;
            steps.log *= 1.05 * terms / MOST_TERMS;
        }
    }
}

impl Prepared {
    fn matrices(&self, cosines: &[f64]) -> Vec<ScatteringMatrix> {
        let scale = 0.5 / (PI * self.scattered);
        let blocks = parallel::map_chunks(cosines, LANES, |cosines| {
            let last = cosines[cosines.len() - 1];
            let padded = std::array::from_fn(|lane| *cosines.get(lane).unwrap_or(&last));
            self.block(&Angles::new(&padded, self.most_terms))
        });
        let all = blocks.into_iter().flatten().take(cosines.len());
        all.map(|matrix| matrix.scaled(scale)).collect()
    }

    /// Sums over the sizes at a few angles.
    fn block(&self, angles: &Angles) -> [ScatteringMatrix; LANES] {
        vectorized(
            #[inline(always)]
            || {
                let mut sum = [ScatteringMatrix::ZERO; LANES];
                for (scattered, range) in &self.sizes {
                    angles.add(&self.pairs[range.clone()], *scattered, &mut sum);
                }
                sum
            },
        )
    }
}

#[cfg(test)]
mod tests;
