//! An atmosphere at the N wavelengths of a block of lanes.

use crate::atmosphere::Atmosphere;
use crate::optics::{PhaseFunction, PolarisedMoments};
use crate::spectrum::Spectrum;
use crate::transfer::coefficients::Coefficients;
use crate::transfer::columns::SlantColumns;
use crate::transfer::delta_m::peak_fraction;
use crate::transfer::residual::{ONE_STREAM, Residual, STREAMS, Shares};
use crate::transfer::shell::{Shell, divided};
use std::f64::consts::PI;
use std::sync::Arc;

/// Geometry, optical coefficients and phase functions of an atmosphere at N wavelengths.
#[derive(Clone, Debug)]
pub struct Air<const N: usize> {
    /// Geometry and slant columns, shared by all blocks of wavelengths.
    pub columns: Arc<SlantColumns>,
    /// Extinction and ground albedo.
    pub coefficients: Coefficients<Spectrum<N>>,
    /// The constituents with scattering.
    pub scatterers: Vec<Scatterer<N>>,
    /// Boundaries of the quadrature panels of rays: those of the shell, and more where sunlight is extinguished over a small
    /// change of altitude.
    pub panel_radii_m: Arc<[f64]>,
    /// Extinction by the forward peaks that count as unscattered, in which `coefficients` differ from those of the real air.
    pub peaks: Coefficients<Spectrum<N>>,
    /// Extinction by the further forward peaks that count as unscattered for polarised light, which is only described to degree 2.
    pub linear_peaks: Coefficients<Spectrum<N>>,
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
    /// Moments of degree 2 of the scattering matrix: from natural light to linear polarisation and back, and from linear polarisation
    /// to itself, without the forward peak that counts as unscattered for polarised light.
    pub polarised: [Spectrum<N>; 2],
    /// Fraction of polarised light that counts as unscattered.
    linear_peak: Spectrum<N>,
    /// Streams of singly scattered light, if a forward peak counts as unscattered.
    residual: Option<Arc<Residual<N>>>,
    /// The element `F12` of the scattering matrix (1/sr) at equal steps of the cosine of the scattering angle; `None` if scattering
    /// removes all polarisation.
    f12: Option<Arc<[Spectrum<N>]>>,
    phase: PhaseFunction,
}

/// Number of intervals of the element F12, which is smooth.
const F12_INTERVALS: usize = 256;

impl<const N: usize> Air<N> {
    /// Samples `atmosphere` at N wavelengths, with phase-function moments up to degree `l_max + 1`, for sunlight that arrives
    /// through these air masses.
    pub fn new(
        atmosphere: &Atmosphere,
        columns: Arc<SlantColumns>,
        wavelengths_nm: [f64; N],
        l_max: usize,
        air_masses: &[f64],
    ) -> Self {
        let coefficients = Coefficients::in_lanes(atmosphere, &wavelengths_nm);
        let scatterers = atmosphere
            .constituents
            .iter()
            .zip(&coefficients.scattering_per_m)
            .enumerate()
            .filter(|(_, (_, scattering))| scattering.max_element() > 0.0)
            .map(|(constituent, (part, &scattering))| {
                let by_lane = wavelengths_nm.map(|nm| part.phase.legendre_moments(l_max + 2, nm));
                let polarised = wavelengths_nm.map(|nm| part.phase.polarised_moments(nm));
                Scatterer {
                    constituent,
                    scattering,
                    whole_scattering: scattering,
                    moments: (0..=l_max + 1)
                        .map(|l| Spectrum::from_fn(|lane| by_lane[lane][l] as f32))
                        .collect(),
                    polarised: [
                        Spectrum::from_fn(|lane| polarised[lane].natural_to_linear as f32),
                        Spectrum::from_fn(|lane| polarised[lane].linear_to_linear as f32),
                    ],
                    linear_peak: Spectrum::from_fn(|lane| {
                        polarised[lane].linear_of_degree_3.clamp(0.0, 1.0) as f32
                    }),
                    residual: None,
                    f12: f12(&part.phase, &wavelengths_nm),
                    phase: part.phase.clone(),
                }
            })
            .collect();
        Self {
            panel_radii_m: panel_radii_m(&columns.shell, &coefficients, air_masses).into(),
            peaks: Coefficients::none(coefficients.extinction_per_m.len()),
            linear_peaks: Coefficients::none(coefficients.extinction_per_m.len()),
            columns,
            coefficients,
            scatterers,
            wavelengths_nm,
        }
    }

    /// This air with the forward peaks of its phase functions treated as unscattered ([`crate::transfer::delta_m`]), which leaves
    /// small moments beyond degree `l_max`.
    pub fn without_forward_peaks(&self, l_max: usize) -> Self {
        let mut air = self.clone();
        for s in &mut air.scatterers {
            let peak = s.moments[l_max + 1].map(peak_fraction);
            let rest = Spectrum::ONE - peak;
            let removed = s.scattering * peak;
            air.coefficients.extinction_per_m[s.constituent] -= removed;
            air.peaks.extinction_per_m[s.constituent] = removed;
            air.peaks.scattering_per_m[s.constituent] = removed;
            s.scattering -= removed;
            s.residual = Residual::new(&s.phase, &self.wavelengths_nm, l_max, 0.0).map(Arc::new);
            for moment in &mut s.moments {
                *moment = (*moment - peak) / rest;
            }
            let [natural, linear] = &mut s.polarised;
            let linear_peak = ((s.linear_peak - peak) / rest).max_scalar(0.0);
            let kept = peak + rest * linear_peak;
            *natural = *natural / rest;
            *linear = (*linear - kept * PolarisedMoments::FORWARD as f32) / rest;
            air.linear_peaks.extinction_per_m[s.constituent] = s.scattering * linear_peak;
        }
        air
    }

    /// Geometry and density profiles.
    #[inline(always)]
    pub fn shell(&self) -> &Shell {
        &self.columns.shell
    }

    /// Transmittance from a radius to the sun at the zenith cosine `mu_sun`, where the planet does not hide it.
    #[inline(always)]
    pub fn transmittance_to_sun(&self, radius_m: f64, mu_sun: f64) -> Spectrum<N> {
        let columns = self.columns.to_space_m(radius_m, mu_sun);
        self.coefficients.transmittance(&columns)
    }

    /// Shares of the streams in the light of each scatterer at the cosine `nu` of the scattering angle.
    pub fn shares(&self, nu: f64) -> Vec<Shares<N>> {
        self.scatterers.iter().map(|s| s.shares(nu)).collect()
    }

    /// Irradiance on the ground from the sun alone at the zenith cosine `mu_sun`, per unit solar irradiance.
    #[inline(always)]
    pub fn sun_on_ground(&self, mu_sun: f64) -> Spectrum<N> {
        if mu_sun <= 0.0 {
            return Spectrum::ZERO;
        }
        self.transmittance_to_sun(self.shell().ground_radius_m, mu_sun) * mu_sun as f32
    }
}

impl<const N: usize> Scatterer<N> {
    /// Legendre moments of the whole phase function, `[lane][l]`.
    pub fn legendre_moments(&self, air: &Air<N>, count: usize) -> [Vec<f64>; N] {
        air.wavelengths_nm
            .map(|nm| self.phase.legendre_moments(count, nm))
    }

    /// Phase function at the cosine `nu` of the scattering angle, 1/sr.
    pub fn phase(&self, air: &Air<N>, nu: f64) -> Spectrum<N> {
        self.phase.in_lanes(nu, &air.wavelengths_nm)
    }

    /// True unless scattering removes all polarisation.
    pub fn polarises(&self) -> bool {
        self.f12.is_some()
    }

    /// True if the polarisation of singly scattered light varies with direction as slowly as that of light scattered by molecules. Only
    /// then does it pass through the forward peak for polarised light.
    pub fn polarises_smoothly(&self) -> bool {
        self.linear_peak.max_element() <= 0.0
    }

    /// The element `F12` of the scattering matrix at the cosine `nu` of the scattering angle, 1/sr: light polarised parallel to the
    /// scattering plane, which is negative for light polarised across it; `None` if it is 0 at all angles.
    #[inline(always)]
    pub fn f12(&self, nu: f64) -> Option<Spectrum<N>> {
        let table = self.f12.as_ref()?;
        let x = (0.5 * (nu + 1.0)).clamp(0.0, 1.0) * F12_INTERVALS as f64;
        let below = (x as usize).min(F12_INTERVALS - 1);
        let t = (x - below as f64) as f32;
        Some((table[below] * (1.0 - t)).scale_acc(table[below + 1], t))
    }

    /// Shares of the streams in singly scattered light at the cosine `nu` of the scattering angle.
    pub fn shares(&self, nu: f64) -> Shares<N> {
        match &self.residual {
            Some(residual) => residual.shares(nu),
            None => ONE_STREAM.map(Spectrum::splat),
        }
    }

    /// Number of streams of singly scattered light.
    pub fn streams(&self) -> usize {
        self.residual.as_ref().map_or(1, |_| STREAMS)
    }

    /// The phase function cut off after the degree of `legendre`, whose entries are `P_l(nu)`, 1/sr.
    #[inline(always)]
    pub fn truncated_phase(&self, legendre: &[f64]) -> Spectrum<N> {
        let mut sum = Spectrum::ZERO;
        for (l, (moment, &p)) in self.moments.iter().zip(legendre).enumerate() {
            sum = sum.scale_acc(*moment, ((2 * l + 1) as f64 * p / (4.0 * PI)) as f32);
        }
        sum
    }
}

/// Samples of the element F12 of a scattering matrix.
fn f12<const N: usize>(
    phase: &PhaseFunction,
    wavelengths_nm: &[f64; N],
) -> Option<Arc<[Spectrum<N>]>> {
    phase.knows_polarisation().then(|| {
        (0..=F12_INTERVALS)
            .map(|k| {
                let mu = 2.0 * k as f64 / F12_INTERVALS as f64 - 1.0;
                let element = |nm| phase.matrix_ratios(mu, nm).f12 * phase.evaluate(mu, nm);
                Spectrum(wavelengths_nm.map(|nm| element(nm) as f32))
            })
            .collect()
    })
}

/// The panels of a shell, divided until the optical depth of the air above, times any of the air masses, changes by at most
/// [`SUN_STEP`] in each, in the lanes with the least and the most extinction.
fn panel_radii_m<const N: usize>(
    shell: &Shell,
    coefficients: &Coefficients<Spectrum<N>>,
    air_masses: &[f64],
) -> Vec<f64> {
    /// Largest change of the optical depth towards the sun in a panel.
    const SUN_STEP: f64 = 3.0;
    /// Optical depth beyond which no sunlight matters.
    const DARK: f64 = 16.0;
    let depths = |radius_m: f64| {
        let depth = coefficients.extinction(&shell.vertical_columns_m(radius_m));
        [depth.min_element(), depth.max_element()].map(f64::from)
    };
    let fine = |deep: [f64; 2], shallow: [f64; 2]| {
        air_masses.iter().all(|mass| {
            deep.iter().zip(&shallow).all(|(deep, shallow)| {
                (deep * mass).min(DARK) - (shallow * mass).min(DARK) <= SUN_STEP
            })
        })
    };
    divided(&shell.panel_radii_m, |below, above| {
        fine(depths(below), depths(above))
    })
}
