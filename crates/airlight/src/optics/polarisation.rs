//! Polarisation by scattering.
//!
//! The scattering matrix of particles without a preferred orientation or handedness, in frames whose first axis lies in the
//! scattering plane (Hansen & Travis, Space Sci. Rev. 16, 527, 1974, eqs. 2.12 to 2.16; Bohren & Huffman, sec. 3.3):
//!
//! ```text
//! F11 F12  0    0
//! F12 F22  0    0          F11 is the phase function;
//!  0   0   F33  F34        for spheres F22 = F11 and F44 = F33
//!  0   0  -F34  F44
//! ```

use super::phase::{Depolarization, PhaseFunction};

/// Elements of the scattering matrix divided by its first element, the phase function.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MatrixRatios {
    /// Natural light to linear polarisation: `-f12` is the degree of polarisation of singly scattered natural light, positive
    /// perpendicular to the scattering plane.
    pub f12: f64,
    /// Linear polarisation parallel or perpendicular to the scattering plane, to itself.
    pub f22: f64,
    /// Linear polarisation at 45 degrees to the scattering plane, to itself.
    pub f33: f64,
    /// Circular to linear polarisation at 45 degrees.
    pub f34: f64,
    /// Circular polarisation to itself.
    pub f44: f64,
}

impl MatrixRatios {
    /// Scattering that removes all polarisation.
    pub const NONE: Self = Self {
        f12: 0.0,
        f22: 0.0,
        f33: 0.0,
        f34: 0.0,
        f44: 0.0,
    };

    /// `self + factor * other`, element by element.
    pub(super) fn plus(self, other: Self, factor: f64) -> Self {
        Self {
            f12: self.f12 + factor * other.f12,
            f22: self.f22 + factor * other.f22,
            f33: self.f33 + factor * other.f33,
            f34: self.f34 + factor * other.f34,
            f44: self.f44 + factor * other.f44,
        }
    }
}

impl Depolarization {
    /// Fraction `Delta` of the scattered light that is scattered as by isotropic molecules (the rest is unpolarised and
    /// isotropic), and the factor `Delta'` of its circular polarisation: Hansen & Travis, eq. 2.16.
    pub(crate) fn polarised_shares(self, wavelength_nm: f64) -> [f64; 2] {
        let ratio = self.ratio(wavelength_nm);
        [
            (1.0 - ratio) / (1.0 + 0.5 * ratio),
            (1.0 - 2.0 * ratio) / (1.0 - ratio),
        ]
    }
}

/// Angle of the plane of polarisation of light with the Stokes parameters `Q` and `U`, degrees in `[0, 180)`.
pub(crate) fn plane_of_polarisation_deg(q: f64, u: f64) -> f64 {
    let angle = 0.5 * u.atan2(q).to_degrees();
    // The second `rem_euclid` maps a result of 180, from rounding, to 0.
    angle.rem_euclid(180.0).rem_euclid(180.0)
}

/// Moments of degree 2 of a scattering matrix: the part of the degree-2 moments of intensity and polarisation that scattering
/// preserves and exchanges. Those of isotropic molecules are 1/10, as is the moment of degree 2 of their phase function.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PolarisedMoments {
    /// From natural light to linear polarisation and back: `-1/4` of the integral of `F12 sin^2` over solid angle. This is the
    /// coefficient `beta_1` of degree 2 in generalised spherical functions (Hovenier, van der Mee & Domke, Transfer of Polarized
    /// Light in Planetary Atmospheres, 2004, sec. 2.8) over `5 sqrt(6)`.
    pub natural_to_linear: f64,
    /// From linear polarisation to linear polarisation: `1/24` of the integral of `F22 (1 + mu^2) + 2 mu F33`, which is the
    /// coefficient `alpha_2` over 30.
    pub linear_to_linear: f64,
    /// Moment of degree 3 of linear polarisation, `(alpha_2 + alpha_3) / 14`: 0 for molecules, and 1 for a forward peak. Light
    /// polarised with more detail than degree 2 can describe remains polarised in this proportion.
    pub linear_of_degree_3: f64,
}

impl PolarisedMoments {
    /// [`Self::linear_to_linear`] of a forward peak, which scatters nothing out of its direction.
    pub const FORWARD: f64 = 1.0 / 6.0;

    /// What light scattered by one angle adds per solid angle, for the phase function `phase`.
    pub(super) fn of_angle(mu: f64, phase: f64, ratios: &MatrixRatios) -> Self {
        let even = ratios.f22 * (1.0 + mu * mu);
        // The generalised spherical function of degree 3 and orders 2, 2.
        let third = 0.25 * (1.0 + mu) * (1.0 + mu) * (3.0 * mu - 2.0);
        Self {
            natural_to_linear: -0.25 * phase * ratios.f12 * (1.0 - mu * mu),
            linear_to_linear: phase * (even + 2.0 * mu * ratios.f33) / 24.0,
            linear_of_degree_3: 0.5 * phase * (ratios.f22 + ratios.f33) * third,
        }
    }

    /// `self + factor * other`.
    pub(super) fn plus(self, other: Self, factor: f64) -> Self {
        Self {
            natural_to_linear: self.natural_to_linear + factor * other.natural_to_linear,
            linear_to_linear: self.linear_to_linear + factor * other.linear_to_linear,
            linear_of_degree_3: self.linear_of_degree_3 + factor * other.linear_of_degree_3,
        }
    }
}

impl PhaseFunction {
    /// Moments of degree 2 of the scattering matrix; 0 for scattering that removes all polarisation.
    pub(crate) fn polarised_moments(&self, wavelength_nm: f64) -> PolarisedMoments {
        match self {
            Self::Rayleigh(depolarization) => {
                let [share, _] = depolarization.polarised_shares(wavelength_nm);
                PolarisedMoments {
                    natural_to_linear: share / 10.0,
                    linear_to_linear: share / 10.0,
                    linear_of_degree_3: 0.0,
                }
            }
            Self::Tabulated(table) => table.polarised_moments(wavelength_nm),
            Self::Mixture(parts) => {
                let sum = PolarisedMoments::default();
                parts.iter().fold(sum, |sum, (weight, part)| {
                    sum.plus(part.polarised_moments(wavelength_nm), *weight)
                })
            }
            Self::Isotropic
            | Self::HenyeyGreenstein { .. }
            | Self::CornetteShanks { .. }
            | Self::Draine { .. } => PolarisedMoments::default(),
        }
    }

    /// Scattering matrix relative to the phase function, at the cosine of the scattering angle.
    ///
    /// Known for molecules (Hansen & Travis, eq. 2.15) and for tables of spheres by Lorenz-Mie theory ([`super::mie`]).
    /// All other phase functions (Henyey-Greenstein and similar, measured tables) are treated as scattering without
    /// polarisation, which is an approximation for any particle, and worst for small ones.
    pub fn matrix_ratios(&self, cos_angle: f64, wavelength_nm: f64) -> MatrixRatios {
        match self {
            Self::Rayleigh(depolarization) => {
                rayleigh(depolarization.polarised_shares(wavelength_nm), cos_angle)
            }
            Self::Tabulated(table) => table.matrix_ratios(cos_angle, wavelength_nm),
            Self::Mixture(parts) => {
                let mut sum = MatrixRatios::NONE;
                let mut whole = 0.0;
                for (weight, part) in parts {
                    let share = weight * part.evaluate(cos_angle, wavelength_nm);
                    sum = sum.plus(part.matrix_ratios(cos_angle, wavelength_nm), share);
                    whole += share;
                }
                MatrixRatios::NONE.plus(sum, 1.0 / whole)
            }
            Self::Isotropic
            | Self::HenyeyGreenstein { .. }
            | Self::CornetteShanks { .. }
            | Self::Draine { .. } => MatrixRatios::NONE,
        }
    }

    /// True if the scattering matrix is known beyond the phase function.
    pub(crate) fn knows_polarisation(&self) -> bool {
        match self {
            Self::Rayleigh(_) => true,
            Self::Tabulated(table) => table.has_matrix(),
            Self::Mixture(parts) => parts.iter().any(|(_, part)| part.knows_polarisation()),
            _ => false,
        }
    }
}

fn rayleigh([share, circular]: [f64; 2], mu: f64) -> MatrixRatios {
    let even = 0.75 * share * (1.0 + mu * mu);
    let whole = even + 1.0 - share;
    let linear = 1.5 * share * mu / whole;
    MatrixRatios {
        f12: -0.75 * share * (1.0 - mu * mu) / whole,
        f22: even / whole,
        f33: linear,
        f34: 0.0,
        f44: circular * linear,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::quadrature::GaussRule;
    use crate::optics::mie::{Particles, SizeDistribution, Sphere};
    use crate::optics::{RefractiveIndex, TabulatedPhase};
    use num_complex::Complex64;
    use std::f64::consts::TAU;

    /// Isotropic molecules fully polarise light scattered at right angles; others to `(1 - rho) / (1 + rho)`, by the definition
    /// of the ratio.
    #[test]
    fn polarisation_at_right_angles_follows_the_depolarization_ratio() {
        for rho in [0.0, 0.03, 0.2] {
            let phase = PhaseFunction::rayleigh(rho).unwrap();
            let at = |mu| phase.matrix_ratios(mu, 550.0);
            assert!((at(0.0).f12 + (1.0 - rho) / (1.0 + rho)).abs() < 1e-12);
            assert!(at(1.0).f12.abs() < 1e-12 && (at(1.0).f22 - at(1.0).f33).abs() < 1e-12);
            assert!((at(-1.0).f22 + at(-1.0).f33).abs() < 1e-12);
        }
        let ideal = PhaseFunction::rayleigh(0.0).unwrap();
        for mu in [-0.8f64, 0.1, 0.6] {
            let degree = (1.0 - mu * mu) / (1.0 + mu * mu);
            assert!((ideal.matrix_ratios(mu, 550.0).f12 + degree).abs() < 1e-12);
            assert!((ideal.matrix_ratios(mu, 550.0).f22 - 1.0).abs() < 1e-12);
        }
    }

    /// A sphere much smaller than the wavelength scatters as an isotropic molecule.
    #[test]
    fn small_spheres_scatter_as_molecules() {
        let sphere = Sphere::new(1e-3, Complex64::new(1.33, 0.0)).unwrap();
        let molecule = PhaseFunction::rayleigh(0.0).unwrap();
        for mu in [-1.0, -0.4, 0.2, 0.9] {
            let (matrix, ratios) = (sphere.matrix(mu), molecule.matrix_ratios(mu, 550.0));
            assert!((matrix.f12 / matrix.f11 - ratios.f12).abs() < 1e-5);
            assert!((matrix.f33 / matrix.f11 - ratios.f33).abs() < 1e-5);
            assert!((matrix.f34 / matrix.f11).abs() < 1e-5);
        }
    }

    /// A table of spheres reproduces their scattering matrix, also between its angles.
    #[test]
    fn tables_of_spheres_reproduce_the_scattering_matrix() {
        let sizes = SizeDistribution::log_normal(0.15, 1.6);
        let index = RefractiveIndex::constant(Complex64::new(1.45, 0.01));
        let particles = Particles::new(index, sizes).unwrap();
        let (table, _) = particles.table(&[450.0, 600.0]).unwrap();
        let cosines: Vec<f64> = (0..40)
            .map(|i| (0.08 * f64::from(i) + 0.005).cos())
            .collect();
        let exact = particles.matrices(600.0, &cosines).unwrap();
        for (mu, exact) in cosines.iter().zip(exact) {
            let got = table.matrix_ratios(*mu, 600.0);
            for (got, want) in [
                (got.f12, exact.f12),
                (got.f33, exact.f33),
                (got.f34, exact.f34),
                (got.f22, exact.f11),
                (got.f44, exact.f33),
            ] {
                assert!(
                    (got - want / exact.f11).abs() < 5e-3,
                    "{mu}: {got} {exact:?}"
                );
            }
        }
    }

    /// The closed forms of molecules, and those of spheres by quadrature over a table.
    #[test]
    fn polarised_moments_are_integrals_over_the_matrix() {
        let integral = |phase: &PhaseFunction| {
            let rule = GaussRule::new(200);
            rule.on(-1.0, 1.0)
                .fold(PolarisedMoments::default(), |sum, (mu, w)| {
                    let p = phase.evaluate(mu, 550.0);
                    let ratios = phase.matrix_ratios(mu, 550.0);
                    sum.plus(PolarisedMoments::of_angle(mu, p, &ratios), w * TAU)
                })
        };
        let sizes = SizeDistribution::log_normal(0.15, 1.6);
        let index = RefractiveIndex::constant(Complex64::new(1.45, 0.01));
        let particles = Particles::new(index, sizes).unwrap();
        let spheres = PhaseFunction::Tabulated(particles.table(&[450.0, 600.0]).unwrap().0);
        let molecules = PhaseFunction::rayleigh(0.03).unwrap();
        let both = vec![(0.25, spheres.clone()), (0.75, molecules.clone())];
        let both = PhaseFunction::mixture(both).unwrap();
        for phase in [molecules, spheres, both] {
            let (got, want) = (phase.polarised_moments(550.0), integral(&phase));
            for (got, want) in [
                (got.natural_to_linear, want.natural_to_linear),
                (got.linear_to_linear, want.linear_to_linear),
                (got.linear_of_degree_3, want.linear_of_degree_3),
            ] {
                assert!((got - want).abs() < 1e-5, "{got} {want}");
            }
        }
    }

    #[test]
    fn phase_functions_without_a_matrix_do_not_polarise() {
        let lobe = PhaseFunction::HenyeyGreenstein { g: 0.6 };
        assert!(!lobe.knows_polarisation());
        let plain = TabulatedPhase::new(vec![0.0, 180.0], vec![550.0], vec![1.0; 2]).unwrap();
        let plain = PhaseFunction::Tabulated(plain);
        assert!(!plain.knows_polarisation());
        assert_eq!(plain.matrix_ratios(0.3, 550.0), MatrixRatios::NONE);
        let half = vec![
            (0.5, PhaseFunction::rayleigh(0.0).unwrap()),
            (0.5, PhaseFunction::Isotropic),
        ];
        let half = PhaseFunction::mixture(half).unwrap();
        // At right angles, 3/4 of the isotropic phase function.
        let degree = -half.matrix_ratios(0.0, 550.0).f12;
        assert!((degree - 0.75 / 1.75).abs() < 1e-12, "{degree}");
    }
}
