//! Moments of polarised light.
//!
//! Scattering polarises light, and polarised light is scattered otherwise than natural light. A molecule scatters as a dipole: it
//! responds to the tensor of the electric field, which is the sum over all directions from which light arrives. Its trace is the
//! intensity; its traceless part consists of the moments `A_2m` of the intensity, and of the moments of the linear polarisation
//!
//! ```text
//! E_m = integral of Q q_m + U u_m,  m = 0, 1, 2,
//! ```
//!
//! where `q_m` and `u_m` are the tensor harmonics of degree 2 below, in the convention that makes a molecule scatter polarised light
//! as it scatters an intensity with the moments `E_m`:
//!
//! ```text
//! I' = b (... + g sum of E_m Y_2m),   Q' = b sum of (g A_2m + a E_m) q_m,   U' = b sum of (g A_2m + a E_m) u_m,
//! ```
//!
//! with the scattering coefficient `b`, and `g = a = 1/10` for isotropic molecules ([`PolarisedMoments`]). In air that only consists
//! of molecules these three numbers hold all there is to know about polarisation: the solution is that of the vector equation of
//! transfer (Chandrasekhar, Radiative Transfer, 1960, sec. 16 to 18). Particles scatter further moments of polarised light. What they
//! keep of the moments of degree 3 counts as unscattered, as a forward peak does ([`crate::transfer::delta_m`]), so that polarised
//! light passes through haze as it should; the rest of the further moments is neglected. Circular polarisation arises only from the
//! linear polarisation of light that particles scatter, and is neglected.
//!
//! `Q` and `U` are those of frames whose first axis lies in the vertical plane of the direction and points up, and whose second axis is
//! horizontal. A straight ray remains in its vertical plane, so its frame does not turn.
//!
//! [`PolarisedMoments`]: crate::optics::PolarisedMoments

use crate::spectrum::Spectrum;

/// Number of moments of polarised light.
pub const POLARISED: usize = 3;

/// `sqrt(5 / (16 pi))`, `sqrt(15 / (4 pi))` and `sqrt(15 / (16 pi))`: the factors of the harmonics `Y_20`, `Y_21`, `Y_22`.
const FACTORS: [f32; POLARISED] = [0.315_391_57, 1.092_548_4, 0.546_274_2];

/// Largest magnitude of a moment relative to the moment `A_00` of the same light: `sqrt(15)`.
pub const MAX_RATIO: f32 = 3.872_983_3;

/// Tensor harmonics in a direction: the factors of Q vary with the azimuth as `cos(m azimuth)`, those of U as `sin(m azimuth)`.
#[derive(Clone, Copy, Debug)]
pub struct TensorHarmonics {
    /// Factors of Q.
    pub q: [f32; POLARISED],
    /// Factors of U.
    pub u: [f32; POLARISED],
}

impl TensorHarmonics {
    /// Factors of the cosines and sines of the azimuth, for the cosine `mu` of the zenith angle.
    #[inline(always)]
    pub fn amplitudes(mu: f32) -> Self {
        let sin2 = (1.0 - mu * mu).max(0.0);
        let sin = sin2.sqrt();
        let [f0, f1, f2] = FACTORS;
        Self {
            q: [-3.0 * f0 * sin2, f1 * mu * sin, -f2 * (1.0 + mu * mu)],
            u: [0.0, f1 * sin, -2.0 * f2 * mu],
        }
    }

    /// Harmonics with these amplitudes at the cosine of the azimuth from the sun's vertical plane, on the side where the sine of the
    /// azimuth is not negative. On the other side, U changes its sign.
    #[inline(always)]
    pub fn at(&self, cos_azimuth: f32) -> Self {
        let sin_azimuth = (1.0 - cos_azimuth * cos_azimuth).max(0.0).sqrt();
        let cosines = [1.0, cos_azimuth, 2.0 * cos_azimuth * cos_azimuth - 1.0];
        let sines = [0.0, sin_azimuth, 2.0 * sin_azimuth * cos_azimuth];
        Self {
            q: std::array::from_fn(|m| self.q[m] * cosines[m]),
            u: std::array::from_fn(|m| self.u[m] * sines[m]),
        }
    }

    /// Q and U of light with these moments.
    #[inline(always)]
    pub fn of_moments<const N: usize>(
        &self,
        moments: &[Spectrum<N>; POLARISED],
    ) -> [Spectrum<N>; 2] {
        [&self.q, &self.u].map(|factors| {
            let [a, b, c] = moments;
            (*a * factors[0])
                .scale_acc(*b, factors[1])
                .scale_acc(*c, factors[2])
        })
    }

    /// Adds the moments of light from this direction, with `weight` solid angle.
    #[inline(always)]
    pub fn add_moments<const N: usize>(
        &self,
        [q, u]: [Spectrum<N>; 2],
        weight: f32,
        moments: &mut [Spectrum<N>],
    ) {
        for (moment, (fq, fu)) in moments.iter_mut().zip(self.q.iter().zip(&self.u)) {
            *moment = moment.scale_acc(q, fq * weight).scale_acc(u, fu * weight);
        }
    }
}

/// Cosine and sine of twice the angle from the vertical plane of a view ray to its scattering plane with the sun, on the side where
/// the sine of the azimuth is not negative: light polarised parallel to the scattering plane has `Q` and `U` in this proportion.
/// Arguments are the cosines of the zenith angles of the ray and of the sun, and of the azimuth between them.
#[inline(always)]
pub fn scattering_plane(mu: f32, mu_sun: f32, cos_azimuth: f32) -> [f32; 2] {
    let [sin, sin_sun] = [mu, mu_sun].map(|mu| (1.0 - mu * mu).max(0.0).sqrt());
    let sin_azimuth = (1.0 - cos_azimuth * cos_azimuth).max(0.0).sqrt();
    // The sun's direction in the frame of the ray.
    let up = sin * mu_sun - mu * sin_sun * cos_azimuth;
    let across = -sin_sun * sin_azimuth;
    let square = up * up + across * across;
    match square > 1e-12 {
        true => [
            (up * up - across * across) / square,
            2.0 * up * across / square,
        ],
        // Scattering exactly forwards or backwards does not polarise.
        false => [0.0, 0.0],
    }
}
