//! Optical coefficients of an atmosphere at the N wavelengths of a block of lanes.

use crate::atmosphere::Atmosphere;
use crate::optics::PhaseFunction;
use crate::spectrum::Spectrum;
use crate::transfer::shell::{MAX_CONSTITUENTS, PerConstituent, Shell};
use std::f64::consts::PI;
use std::sync::Arc;

/// Optical coefficients of the constituents at N wavelengths.
#[derive(Clone, Debug)]
pub struct Air<const N: usize> {
    /// Geometry, shared by all blocks of wavelengths.
    pub shell: Arc<Shell>,
    /// Extinction of each constituent at density 1, 1/m.
    extinction: Vec<Spectrum<N>>,
    /// The constituents with scattering.
    pub scatterers: Vec<Scatterer<N>>,
    /// Lambertian reflectance of the ground.
    pub ground_albedo: Spectrum<N>,
    wavelengths_nm: [f64; N],
}

/// Scattering coefficients of a constituent.
#[derive(Clone, Debug)]
pub struct Scatterer<const N: usize> {
    /// Index of the constituent.
    pub constituent: usize,
    /// Scattering at density 1, 1/m; excludes the forward peak if that counts as unscattered.
    pub scattering: Spectrum<N>,
    /// Scattering at density 1, 1/m, including the forward peak, for use with the exact phase function.
    pub whole_scattering: Spectrum<N>,
    /// Legendre moments of the phase function, `moments[l]`.
    pub moments: Vec<Spectrum<N>>,
    phase: PhaseFunction,
}

impl<const N: usize> Air<N> {
    /// Samples `atmosphere` at N wavelengths, with phase-function moments up to degree `l_max + 1`.
    pub fn new(
        atmosphere: &Atmosphere,
        shell: Arc<Shell>,
        wavelengths_nm: [f64; N],
        l_max: usize,
    ) -> Self {
        let sample =
            |f: &dyn Fn(f64) -> f64| Spectrum::from_fn(|lane| f(wavelengths_nm[lane]) as f32);
        let extinction = atmosphere
            .constituents
            .iter()
            .map(|c| sample(&|nm| c.scattering_per_m.at(nm) + c.absorption_per_m.at(nm)))
            .collect();
        let scatterers = atmosphere
            .constituents
            .iter()
            .enumerate()
            .map(|(constituent, c)| {
                let by_lane = wavelengths_nm.map(|nm| c.phase.legendre_moments(l_max + 2, nm));
                let scattering = sample(&|nm| c.scattering_per_m.at(nm));
                Scatterer {
                    constituent,
                    scattering,
                    whole_scattering: scattering,
                    moments: (0..=l_max + 1)
                        .map(|l| Spectrum::from_fn(|lane| by_lane[lane][l] as f32))
                        .collect(),
                    phase: c.phase.clone(),
                }
            })
            .filter(|s| s.scattering.max_element() > 0.0)
            .collect();
        let ground_albedo = sample(&|nm| atmosphere.planet.ground_albedo.at(nm));
        Self {
            shell,
            extinction,
            scatterers,
            ground_albedo,
            wavelengths_nm,
        }
    }

    /// This air with the forward peaks of its phase functions treated as unscattered (the delta-M method: Wiscombe, J. Atmos.
    /// Sci. 34, 1408, 1977): with `f` the moment of degree `l_max + 1`, scattering is multiplied by `1 - f` and the moments
    /// become `(chi_l - f) / (1 - f)`, which is small beyond degree `l_max`.
    pub fn without_forward_peaks(&self, l_max: usize) -> Self {
        let mut air = self.clone();
        for s in &mut air.scatterers {
            let peak = s.moments[l_max + 1].map(|f| f.clamp(0.0, 0.99));
            let rest = Spectrum::ONE - peak;
            let removed = s.scattering * peak;
            air.extinction[s.constituent] -= removed;
            s.scattering -= removed;
            for moment in &mut s.moments {
                *moment = (*moment - peak) / rest;
            }
        }
        air
    }

    /// Optical depth of columns.
    #[inline(always)]
    pub fn optical_depth(&self, columns_m: &PerConstituent) -> Spectrum<N> {
        let mut depth = Spectrum::ZERO;
        for (extinction, &column) in self.extinction.iter().zip(columns_m) {
            depth = depth.scale_acc(*extinction, column as f32);
        }
        depth
    }

    /// As [`Air::optical_depth`], for columns in single precision.
    #[inline(always)]
    pub fn optical_depth_f32(&self, columns_m: &[f32; MAX_CONSTITUENTS]) -> Spectrum<N> {
        let mut depth = Spectrum::ZERO;
        for (extinction, &column) in self.extinction.iter().zip(columns_m) {
            depth = depth.scale_acc(*extinction, column);
        }
        depth
    }

    /// Transmittance through columns.
    #[inline(always)]
    pub fn transmittance(&self, columns_m: &PerConstituent) -> Spectrum<N> {
        (Spectrum::ZERO - self.optical_depth(columns_m)).exp()
    }

    /// Largest extinction of each constituent over the lanes, 1/m at density 1.
    pub fn max_extinction_per_m(&self) -> PerConstituent {
        let mut out = [0.0; MAX_CONSTITUENTS];
        for (value, extinction) in out.iter_mut().zip(&self.extinction) {
            *value = f64::from(extinction.max_element());
        }
        out
    }

    /// Radiance reflected by the ground for the irradiance `irradiance`.
    #[inline(always)]
    pub fn reflected(&self, irradiance: Spectrum<N>) -> Spectrum<N> {
        self.ground_albedo * irradiance * std::f32::consts::FRAC_1_PI
    }
}

impl<const N: usize> Scatterer<N> {
    /// Phase function at the cosine `nu` of the scattering angle, 1/sr.
    pub fn phase(&self, air: &Air<N>, nu: f64) -> Spectrum<N> {
        if self.phase.depends_on_wavelength() {
            Spectrum::from_fn(|lane| self.phase.evaluate(nu, air.wavelengths_nm[lane]) as f32)
        } else {
            Spectrum::splat(self.phase.evaluate(nu, air.wavelengths_nm[0]) as f32)
        }
    }

    /// Phase function truncated after the degree of `legendre`, whose entries are `P_l(nu)`, 1/sr.
    #[inline(always)]
    pub fn truncated_phase(&self, legendre: &[f64]) -> Spectrum<N> {
        let mut sum = Spectrum::ZERO;
        for (l, (moment, &p)) in self.moments.iter().zip(legendre).enumerate() {
            sum = sum.scale_acc(*moment, ((2 * l + 1) as f64 * p / (4.0 * PI)) as f32);
        }
        sum
    }
}
