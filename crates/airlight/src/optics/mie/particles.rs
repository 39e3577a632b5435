//! Bulk optical properties of many spheres of one material.

use super::angles::adapt;
use super::angular::{Angles, LANES, Pair, pairs};
use super::coefficients::Coefficients;
use super::matrix::ScatteringMatrix;
use super::sizes::{MIN_SIZES, Steps};
use super::sphere::check_index;
use super::{LARGEST_SIZE_PARAMETER, MieError, SizeDistribution, SizeNode};
use crate::control::{Cancelled, Control};
use crate::math::parallel;
use crate::math::simd::vectorized;
use crate::optics::{RefractiveIndex, TabulatedPhase};
use std::f64::consts::{PI, TAU};

/// Steps of the sums over sizes.
///
/// The sharp resonances of clear water drops make the sums converge slowly and require the fine steps. Compared with steps a
/// fifth as wide, the phase function of droplets changes by 0.4 to 0.8 % (root mean square over all angles; at most 3 %),
/// coefficients and asymmetry by less than 5e-4; for aerosol by less than 1e-5 (test `sums_over_sizes_converge`).
const STEPS: Steps = Steps {
    size: 0.002,
    log: 0.03,
};
/// Largest number of terms of the Mie series over all sizes, more in proportion to finer steps. Limits the time for rain to
/// seconds: its steps are wider, and detail finer than the fringes of neighbouring sizes remains as noise.
const MAX_TERMS: f64 = 2e6;
/// Target error of `ln p` in the middle of the widest intervals; between the angles of the table, which are closer, the
/// error is about 5 times smaller.
const TOLERANCE: f64 = 0.01;

/// Spheres of one material with a size distribution.
#[derive(Clone, Debug, PartialEq)]
pub struct Particles {
    index: RefractiveIndex,
    sizes: SizeDistribution,
}

/// Mean optical properties of a sphere in a distribution, at one wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BulkOptics {
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// Scattering cross-section, um^2.
    pub scattering_um2: f64,
    /// Absorption cross-section, um^2.
    pub absorption_um2: f64,
    /// Mean cosine of the scattering angle.
    pub asymmetry: f64,
    /// Mean volume, um^3.
    pub volume_um3: f64,
}

impl BulkOptics {
    /// Extinction cross-section, um^2.
    pub fn extinction_um2(&self) -> f64 {
        self.scattering_um2 + self.absorption_um2
    }

    /// Single-scattering albedo: scattering divided by extinction.
    pub fn single_scattering_albedo(&self) -> f64 {
        self.scattering_um2 / self.extinction_um2()
    }

    /// Extinction coefficient, 1/m, for a number of spheres per cubic centimetre.
    pub fn extinction_per_m(&self, number_per_cm3: f64) -> f64 {
        1e-6 * number_per_cm3 * self.extinction_um2()
    }

    /// Extinction coefficient, 1/m, for a mass of spheres in grams per cubic metre and a material density in grams per cubic
    /// centimetre. For water droplets (density 1) the mass is the liquid water content.
    pub fn extinction_per_m_by_mass(&self, grams_per_m3: f64, density_g_cm3: f64) -> f64 {
        grams_per_m3 * self.extinction_um2() / (self.volume_um3 * density_g_cm3)
    }
}

/// Coefficients of spheres of all sizes at one wavelength.
struct Prepared {
    /// For each size, its scattering and the range of its coefficients in `pairs`.
    sizes: Vec<(f64, std::ops::Range<usize>)>,
    pairs: Vec<Pair>,
    max_terms: usize,
    /// Number-weighted means of `sum (2 n + 1) ...`.
    scattered: f64,
    absorbed: f64,
    forward: f64,
}

impl Particles {
    /// Spheres with a refractive index (relative to air, whose index is taken as 1) and a size distribution.
    ///
    /// # Errors
    /// [`MieError`] if the size distribution or the index at 550 nm is invalid.
    pub fn new(index: RefractiveIndex, sizes: SizeDistribution) -> Result<Self, MieError> {
        sizes.validate()?;
        check_index(index.at(550.0))?;
        Ok(Self { index, sizes })
    }

    /// Droplets of pure water with a size distribution.
    ///
    /// # Errors
    /// [`MieError`] if the size distribution is invalid.
    pub fn water(sizes: SizeDistribution) -> Result<Self, MieError> {
        Self::new(RefractiveIndex::water(), sizes)
    }

    /// Refractive index.
    pub fn index(&self) -> &RefractiveIndex {
        &self.index
    }

    /// Size distribution.
    pub fn sizes(&self) -> &SizeDistribution {
        &self.sizes
    }

    /// Cross-sections and asymmetry at a wavelength in nm.
    ///
    /// # Errors
    /// [`MieError`] if the wavelength is not positive, or a size parameter is too large.
    pub fn bulk(&self, wavelength_nm: f64) -> Result<BulkOptics, MieError> {
        self.bulk_with(wavelength_nm, Control::default())
    }

    /// As [`Particles::bulk`], with cancellation.
    ///
    /// # Errors
    /// As [`Particles::bulk`], and if the caller cancelled.
    pub fn bulk_with(
        &self,
        wavelength_nm: f64,
        control: Control<'_>,
    ) -> Result<BulkOptics, MieError> {
        let prepared = self.prepare(wavelength_nm, STEPS, control)?;
        Ok(self.bulk_of(wavelength_nm, &prepared))
    }

    fn bulk_of(&self, wavelength_nm: f64, prepared: &Prepared) -> BulkOptics {
        // pi r^2 2 / x^2, in which the radius cancels.
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

    /// Scattering matrices at cosines of the scattering angle; `f11` integrates to 1 over the sphere.
    ///
    /// # Errors
    /// As [`Particles::bulk`].
    pub fn matrices(
        &self,
        wavelength_nm: f64,
        cosines: &[f64],
    ) -> Result<Vec<ScatteringMatrix>, MieError> {
        self.matrices_with(wavelength_nm, cosines, Control::default())
    }

    /// As [`Particles::matrices`], with cancellation.
    ///
    /// # Errors
    /// As [`Particles::matrices`], and if the caller cancelled.
    pub fn matrices_with(
        &self,
        wavelength_nm: f64,
        cosines: &[f64],
        control: Control<'_>,
    ) -> Result<Vec<ScatteringMatrix>, MieError> {
        let prepared = self.prepare(wavelength_nm, STEPS, control)?;
        Ok(prepared.matrices(cosines, control)?)
    }

    /// Tables of the phase function and scattering matrix at wavelengths (nm, increasing), and the bulk properties at each.
    ///
    /// The angles are selected for the phase functions of the shortest and the longest wavelength, so that the forward peak,
    /// bows and the glory are resolved: the error between the angles is below 0.5 %.
    ///
    /// # Errors
    /// As [`Particles::bulk`]; [`MieError::Phase`] if the wavelengths are not increasing.
    pub fn table(
        &self,
        wavelengths_nm: &[f64],
    ) -> Result<(TabulatedPhase, Vec<BulkOptics>), MieError> {
        self.table_with(wavelengths_nm, Control::default())
    }

    /// As [`Particles::table`], with cancellation.
    ///
    /// # Errors
    /// As [`Particles::table`], and if the caller cancelled.
    pub fn table_with(
        &self,
        wavelengths_nm: &[f64],
        control: Control<'_>,
    ) -> Result<(TabulatedPhase, Vec<BulkOptics>), MieError> {
        self.table_in(wavelengths_nm, STEPS, TOLERANCE, control)
    }

    /// As [`Particles::table`], with sums over `finer` times as many sizes, which take as many times longer: the resonances of
    /// clear drops, and the fringes of large ones, average out better.
    ///
    /// # Errors
    /// As [`Particles::table`].
    ///
    /// # Panics
    /// If `finer` is less than 1.
    pub fn fine_table(
        &self,
        wavelengths_nm: &[f64],
        finer: f64,
    ) -> Result<(TabulatedPhase, Vec<BulkOptics>), MieError> {
        assert!(finer >= 1.0, "expected a factor of at least 1, got {finer}");
        let steps = STEPS.times(finer.recip());
        self.table_in(wavelengths_nm, steps, TOLERANCE, Control::default())
    }

    /// As [`Particles::table`], but faster, for broad distributions, which average out resonances: with size steps wider by the
    /// factor `wider`, and another tolerance of `ln p` for the angles.
    pub(crate) fn broad_table(
        &self,
        wavelengths_nm: &[f64],
        wider: f64,
        tolerance: f64,
        control: Control<'_>,
    ) -> Result<(TabulatedPhase, Vec<BulkOptics>), MieError> {
        let size = wider * STEPS.size;
        self.table_in(wavelengths_nm, Steps { size, ..STEPS }, tolerance, control)
    }

    fn table_in(
        &self,
        wavelengths_nm: &[f64],
        steps: Steps,
        tolerance: f64,
        control: Control<'_>,
    ) -> Result<(TabulatedPhase, Vec<BulkOptics>), MieError> {
        let mut angles: Vec<f64> = Vec::new();
        let matrices = |prepared: &Prepared, angles: &[f64]| {
            let cosines: Vec<f64> = angles.iter().map(|a| a.cos()).collect();
            prepared.matrices(&cosines, control)
        };
        let phase = |prepared: &Prepared, angles: &[f64]| {
            let matrices = matrices(prepared, angles)?;
            Ok(matrices.into_iter().map(|matrix| matrix.f11).collect())
        };
        let radius_um = self.sizes.mean_power(6.0).powf(1.0 / 6.0);
        if let [first, .., last] | [first @ last] = wavelengths_nm {
            for nm in [first, last] {
                let prepared = self.prepare(*nm, steps, control)?;
                let x = TAU * 1e3 * radius_um / nm;
                angles = adapt(x, &angles, tolerance, |angles| phase(&prepared, angles))?;
            }
        }
        let mut values = Vec::with_capacity(angles.len() * wavelengths_nm.len());
        let mut ratios = Vec::with_capacity(values.capacity());
        let mut bulk = Vec::with_capacity(wavelengths_nm.len());
        for &nm in wavelengths_nm {
            let prepared = self.prepare(nm, steps, control)?;
            for matrix in matrices(&prepared, &angles)? {
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

    /// Computes the coefficients of spheres of all sizes.
    fn prepare(
        &self,
        wavelength_nm: f64,
        steps: Steps,
        control: Control<'_>,
    ) -> Result<Prepared, MieError> {
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
        // Neighbouring sizes share buffers.
        /// Share of the number; scattering, absorption and forward sums; coefficients.
        type Sized = (f64, [f64; 3], Vec<Pair>);
        let parts: Vec<Vec<Sized>> = parallel::try_map_chunks(&nodes, 16, |nodes| {
            control.check()?;
            let mut coefficients = Coefficients::default();
            let sphere = |node: &SizeNode| {
                coefficients.fill(size_per_um * node.radius_um, index);
                let sums = [
                    coefficients.scattered,
                    coefficients.absorbed,
                    coefficients.forward(),
                ];
                // Scaled so that all sizes have equal scattering.
                let factor = coefficients.scattered.sqrt().recip();
                (node.share, sums, pairs(&coefficients, factor).collect())
            };
            Ok::<_, Cancelled>(nodes.iter().map(sphere).collect())
        })?;
        let mut prepared = Prepared {
            sizes: Vec::with_capacity(nodes.len()),
            pairs: Vec::new(),
            max_terms: 0,
            scattered: 0.0,
            absorbed: 0.0,
            forward: 0.0,
        };
        for (share, [scattered, absorbed, forward], pairs) in parts.into_iter().flatten() {
            prepared.scattered += share * scattered;
            prepared.absorbed += share * absorbed;
            prepared.forward += share * forward;
            prepared.max_terms = prepared.max_terms.max(pairs.len());
            let start = prepared.pairs.len();
            prepared.pairs.extend(pairs);
            let range = start..prepared.pairs.len();
            prepared.sizes.push((share * scattered, range));
        }
        Ok(prepared)
    }

    /// Radii of the size distribution, with steps wide enough for [`MAX_TERMS`].
    fn nodes(&self, wavelength_nm: f64, mut steps: Steps) -> Vec<SizeNode> {
        let max_terms = MAX_TERMS * (STEPS.size / steps.size).max(1.0);
        loop {
            let nodes = self.sizes.nodes(steps);
            let radii_um: f64 = nodes.iter().map(|node| node.radius_um).sum();
            let terms = radii_um * TAU * 1e3 / wavelength_nm;
            if terms <= max_terms || nodes.len() <= MIN_SIZES {
                return nodes;
            }
            steps = steps.times(1.05 * terms / max_terms);
        }
    }
}

impl Prepared {
    fn matrices(
        &self,
        cosines: &[f64],
        control: Control<'_>,
    ) -> Result<Vec<ScatteringMatrix>, Cancelled> {
        let scale = 0.5 / (PI * self.scattered);
        let blocks = parallel::try_map_chunks(cosines, LANES, |cosines| {
            control.check()?;
            let last = cosines[cosines.len() - 1];
            let padded = std::array::from_fn(|lane| *cosines.get(lane).unwrap_or(&last));
            Ok(self.block(&Angles::new(&padded, self.max_terms)))
        })?;
        let all = blocks.into_iter().flatten().take(cosines.len());
        Ok(all.map(|matrix| matrix.scaled(scale)).collect())
    }

    /// Sums over the sizes at a block of angles.
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
