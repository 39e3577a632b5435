//! Optical coefficients of an atmosphere at some wavelengths.

use crate::atmosphere::Atmosphere;
use crate::spectrum::Spectrum;
use crate::transfer::shell::{MAX_CONSTITUENTS, PerConstituent};

/// Extinction and scattering of each constituent at density 1, and the albedo of the ground, at the wavelengths of a
/// container `V`.
#[derive(Clone, Debug)]
pub struct Coefficients<V> {
    /// Extinction of each constituent, 1/m.
    pub extinction_per_m: Vec<V>,
    /// Scattering of each constituent, 1/m.
    pub scattering_per_m: Vec<V>,
    /// Lambertian albedo of the ground.
    pub ground_albedo: V,
}

impl<V> Coefficients<V> {
    /// Samples an atmosphere; `sample` evaluates a function of wavelength (nm) at all wavelengths.
    pub fn sample(atmosphere: &Atmosphere, sample: impl Fn(&dyn Fn(f64) -> f64) -> V) -> Self {
        let parts = &atmosphere.constituents;
        Self {
            extinction_per_m: parts
                .iter()
                .map(|part| sample(&|nm| part.extinction_per_m(nm)))
                .collect(),
            scattering_per_m: parts
                .iter()
                .map(|part| sample(&|nm| part.scattering_per_m.at(nm)))
                .collect(),
            ground_albedo: sample(&|nm| atmosphere.planet.ground_albedo.at(nm)),
        }
    }
}

impl<const N: usize> Coefficients<Spectrum<N>> {
    /// Coefficients in the lanes of these wavelengths.
    pub fn in_lanes(atmosphere: &Atmosphere, wavelengths_nm: &[f64; N]) -> Self {
        Self::sample(atmosphere, |f| {
            Spectrum::from_fn(|lane| f(wavelengths_nm[lane]) as f32)
        })
    }

    /// Coefficients of constituents that are transparent, above black ground.
    pub fn none(constituents: usize) -> Self {
        Self {
            extinction_per_m: vec![Spectrum::ZERO; constituents],
            scattering_per_m: vec![Spectrum::ZERO; constituents],
            ground_albedo: Spectrum::ZERO,
        }
    }

    /// Optical depth of columns (m at density 1); extinction coefficient (1/m) of relative densities.
    #[inline(always)]
    pub fn extinction(&self, columns_m: &PerConstituent) -> Spectrum<N> {
        let mut depth = Spectrum::ZERO;
        for (extinction, &column) in self.extinction_per_m.iter().zip(columns_m) {
            depth = depth.scale_acc(*extinction, column as f32);
        }
        depth
    }

    /// [`Coefficients::extinction`] of columns in single precision.
    #[inline(always)]
    pub fn extinction_f32(&self, columns_m: &[f32; MAX_CONSTITUENTS]) -> Spectrum<N> {
        let mut depth = Spectrum::ZERO;
        for (extinction, &column) in self.extinction_per_m.iter().zip(columns_m) {
            depth = depth.scale_acc(*extinction, column);
        }
        depth
    }

    /// Transmittance of columns.
    #[inline(always)]
    pub fn transmittance(&self, columns_m: &PerConstituent) -> Spectrum<N> {
        (Spectrum::ZERO - self.extinction(columns_m)).exp()
    }

    /// Largest extinction of each constituent over the lanes, 1/m at density 1.
    pub fn max_extinction_per_m(&self) -> PerConstituent {
        let mut out = [0.0; MAX_CONSTITUENTS];
        for (value, extinction) in out.iter_mut().zip(&self.extinction_per_m) {
            *value = f64::from(extinction.max_element());
        }
        out
    }

    /// Radiance reflected by the ground under an irradiance.
    #[inline(always)]
    pub fn reflected(&self, irradiance: Spectrum<N>) -> Spectrum<N> {
        self.ground_albedo * irradiance * std::f32::consts::FRAC_1_PI
    }
}
