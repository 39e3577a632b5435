//! Optical coefficients of the air at the N wavelengths of a block of lanes.

use crate::atmosphere::Atmosphere;
use crate::math::random::Random;
#[cfg(doc)]
use crate::optics::Depolarization;
use crate::optics::{MatrixRatios, PhaseFunction, PhaseSampler};
use crate::spectrum::Spectrum;
use crate::transfer::coefficients::Coefficients;
use crate::transfer::shell::{MAX_CONSTITUENTS, PerConstituent};

/// One spectrum for each constituent.
pub type PerScatterer<const N: usize> = [Spectrum<N>; MAX_CONSTITUENTS];

/// Optical coefficients of the constituents at N wavelengths.
#[derive(Clone, Debug)]
pub struct Lanes<const N: usize> {
    /// Wavelength of each lane, nm.
    pub wavelengths_nm: [f64; N],
    /// Extinction, scattering and ground albedo.
    pub coefficients: Coefficients<Spectrum<N>>,
    /// Extinction of each constituent at density 1 in double precision, lane by lane, 1/m.
    extinction_of_lane: [PerConstituent; N],
    phases: Vec<Phase<N>>,
}

/// Elements of a scattering matrix relative to the phase function in all lanes, as [`MatrixRatios`].
#[derive(Clone, Copy, Debug)]
pub struct Ratios<const N: usize> {
    /// Natural light to linear polarisation.
    pub f12: Spectrum<N>,
    /// Linear polarisation parallel or perpendicular to the scattering plane, to itself.
    pub f22: Spectrum<N>,
    /// Linear polarisation at 45 degrees, to itself.
    pub f33: Spectrum<N>,
    /// Circular to linear polarisation at 45 degrees.
    pub f34: Spectrum<N>,
    /// Circular polarisation to itself.
    pub f44: Spectrum<N>,
}

/// A phase function in all lanes.
#[derive(Clone, Debug)]
struct Phase<const N: usize> {
    function: PhaseFunction,
    /// For molecules, [`Depolarization::polarised_shares`].
    molecules: Option<[Spectrum<N>; 2]>,
    polarises: bool,
    shape: Shape<N>,
    /// One sampler for all lanes, or one for each lane.
    samplers: Vec<PhaseSampler>,
}

/// Dependence of a phase function on the lane.
#[derive(Clone, Debug)]
enum Shape<const N: usize> {
    /// The same in all lanes.
    Same,
    /// `a + b mu^2`.
    Square(Spectrum<N>, Spectrum<N>),
    /// An arbitrary function in each lane.
    ByLane,
}

impl<const N: usize> Phase<N> {
    fn new(function: &PhaseFunction, wavelengths_nm: &[f64; N]) -> Self {
        let at = |mu: f64, nm: f64| function.evaluate(mu, nm);
        let (shape, samplers) = match (function, function.depends_on_wavelength()) {
            (_, false) => (Shape::Same, 1),
            (PhaseFunction::Rayleigh(_), true) => {
                let constant = Spectrum::from_fn(|i| at(0.0, wavelengths_nm[i]) as f32);
                let ends = Spectrum::from_fn(|i| at(1.0, wavelengths_nm[i]) as f32);
                (Shape::Square(constant, ends - constant), N)
            }
            _ => (Shape::ByLane, N),
        };
        let molecules = match function {
            PhaseFunction::Rayleigh(kind) => Some([0, 1].map(|i| {
                Spectrum::from_fn(|lane| kind.polarised_shares(wavelengths_nm[lane])[i] as f32)
            })),
            _ => None,
        };
        Self {
            function: function.clone(),
            molecules,
            polarises: function.knows_polarisation(),
            shape,
            samplers: wavelengths_nm[..samplers]
                .iter()
                .map(|&nm| PhaseSampler::new(function, nm))
                .collect(),
        }
    }

    #[inline(always)]
    fn evaluate(&self, mu: f64, wavelengths_nm: &[f64; N]) -> Spectrum<N> {
        match &self.shape {
            Shape::Same => Spectrum::splat(self.function.evaluate(mu, wavelengths_nm[0]) as f32),
            Shape::Square(constant, square) => constant.scale_acc(*square, (mu * mu) as f32),
            Shape::ByLane => self.function.in_lanes(mu, wavelengths_nm),
        }
    }
}

impl<const N: usize> Ratios<N> {
    /// Scattering that removes all polarisation.
    pub const NONE: Self = Self {
        f12: Spectrum::ZERO,
        f22: Spectrum::ZERO,
        f33: Spectrum::ZERO,
        f34: Spectrum::ZERO,
        f44: Spectrum::ZERO,
    };

    /// Matrix of molecules (Hansen & Travis 1974, eq. 2.15) with the values of [`Depolarization::polarised_shares`].
    #[inline(always)]
    fn of_molecules([share, circular]: [Spectrum<N>; 2], mu: f32) -> Self {
        let even = share * (0.75 * (1.0 + mu * mu));
        let whole = even + (Spectrum::ONE - share);
        let f33 = share * (1.5 * mu) / whole;
        Self {
            f12: share * (0.75 * (mu * mu - 1.0)) / whole,
            f22: even / whole,
            f33,
            f34: Spectrum::ZERO,
            f44: circular * f33,
        }
    }

    /// Gathers the lanes.
    fn by_lane(of: impl Fn(usize) -> MatrixRatios) -> Self {
        let mut all = Self::NONE;
        for lane in 0..N {
            let one = of(lane);
            all.f12[lane] = one.f12 as f32;
            all.f22[lane] = one.f22 as f32;
            all.f33[lane] = one.f33 as f32;
            all.f34[lane] = one.f34 as f32;
            all.f44[lane] = one.f44 as f32;
        }
        all
    }

    /// Adds `share * other`.
    #[inline(always)]
    fn add(&mut self, other: &Self, share: Spectrum<N>) {
        self.f12 = self.f12.mul_acc(other.f12, share);
        self.f22 = self.f22.mul_acc(other.f22, share);
        self.f33 = self.f33.mul_acc(other.f33, share);
        self.f34 = self.f34.mul_acc(other.f34, share);
        self.f44 = self.f44.mul_acc(other.f44, share);
    }
}

impl<const N: usize> Lanes<N> {
    /// Samples `atmosphere` at N wavelengths.
    pub fn new(atmosphere: &Atmosphere, wavelengths_nm: [f64; N]) -> Self {
        let parts = &atmosphere.constituents;
        let mut extinction_of_lane = [[0.0; MAX_CONSTITUENTS]; N];
        for (all, &nm) in extinction_of_lane.iter_mut().zip(&wavelengths_nm) {
            for (value, part) in all.iter_mut().zip(parts) {
                *value = part.extinction_per_m(nm);
            }
        }
        Self {
            wavelengths_nm,
            coefficients: Coefficients::in_lanes(atmosphere, &wavelengths_nm),
            extinction_of_lane,
            phases: parts
                .iter()
                .map(|part| Phase::new(&part.phase, &wavelengths_nm))
                .collect(),
        }
    }

    /// Extinction of each constituent in one lane, 1/m at density 1.
    #[inline(always)]
    pub fn extinction_of(&self, lane: usize) -> &PerConstituent {
        &self.extinction_of_lane[lane]
    }

    /// Scattering coefficient of each constituent at the given densities, 1/m.
    #[inline(always)]
    pub fn scattering(&self, densities: &PerConstituent) -> PerScatterer<N> {
        let mut out = [Spectrum::ZERO; MAX_CONSTITUENTS];
        let scattering = &self.coefficients.scattering_per_m;
        for ((out, scattering), &density) in out.iter_mut().zip(scattering).zip(densities) {
            *out = *scattering * density as f32;
        }
        out
    }

    /// Phase function of each scattering constituent, 1/sr.
    #[inline(always)]
    pub fn phases(&self, mu: f64) -> PerScatterer<N> {
        let mut out = [Spectrum::ZERO; MAX_CONSTITUENTS];
        let scattering = &self.coefficients.scattering_per_m;
        for ((out, phase), scattering) in out.iter_mut().zip(&self.phases).zip(scattering) {
            if scattering.max_element() > 0.0 {
                *out = phase.evaluate(mu, &self.wavelengths_nm);
            }
        }
        out
    }

    /// Scattering matrix of the mixture of all constituents relative to its phase function, at the cosine `mu`, for the
    /// scattering coefficients and phase functions of the constituents.
    #[inline(always)]
    pub fn ratios(
        &self,
        scattering: &PerScatterer<N>,
        phases: &PerScatterer<N>,
        mu: f64,
    ) -> Ratios<N> {
        let mut sum = Ratios::NONE;
        let whole = phased(scattering, phases).max_scalar(f32::MIN_POSITIVE);
        for (c, phase) in self.phases.iter().enumerate() {
            if !phase.polarises || scattering[c].max_element() <= 0.0 {
                continue;
            }
            let ratios = match phase.molecules {
                Some(shares) => Ratios::of_molecules(shares, mu as f32),
                None => {
                    let at =
                        |lane: usize| phase.function.matrix_ratios(mu, self.wavelengths_nm[lane]);
                    Ratios::by_lane(at)
                }
            };
            sum.add(&ratios, scattering[c] * phases[c] / whole);
        }
        sum
    }

    /// Draws the cosine of a scattering angle in `lane`: selects a constituent by its scattering coefficient, then samples its
    /// phase function.
    #[inline(always)]
    pub fn sample(&self, scattering: &PerScatterer<N>, lane: usize, random: &mut Random) -> f64 {
        let whole: f32 = scattering.iter().map(|s| s[lane]).sum();
        let mut remaining = random.unit() as f32 * whole;
        let mut last = 0;
        for (c, s) in scattering.iter().enumerate().take(self.phases.len()) {
            if s[lane] > 0.0 {
                last = c;
                remaining -= s[lane];
                if remaining <= 0.0 {
                    break;
                }
            }
        }
        let samplers = &self.phases[last].samplers;
        samplers[lane.min(samplers.len() - 1)].sample(&mut || random.unit())
    }
}

/// `1 - exp(-depth)` in each lane without cancellation.
#[inline(always)]
pub fn absorbed<const N: usize>(depth: Spectrum<N>) -> Spectrum<N> {
    let transmittance = (Spectrum::ZERO - depth).exp();
    Spectrum::from_fn(|i| {
        let x = depth[i];
        // The next term of the series is below 1e-8 of the sum.
        let series = x
            * (1.0
                - x * (0.5
                    - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0 - x * (1.0 / 720.0))))));
        if x < 0.1 {
            series
        } else {
            1.0 - transmittance[i]
        }
    })
}

/// Sum over the constituents.
#[inline(always)]
pub fn sum<const N: usize>(parts: &PerScatterer<N>) -> Spectrum<N> {
    parts.iter().fold(Spectrum::ZERO, |sum, part| sum + *part)
}

/// Sum over the constituents of scattering coefficient times phase function.
#[inline(always)]
pub fn phased<const N: usize>(
    scattering: &PerScatterer<N>,
    phases: &PerScatterer<N>,
) -> Spectrum<N> {
    let mut sum = Spectrum::ZERO;
    for (s, p) in scattering.iter().zip(phases) {
        sum = sum.mul_acc(*s, *p);
    }
    sum
}
