//! Angular moments of the light inside the atmosphere, on a grid of altitudes and sun zenith angles.

use super::air::Air;
use super::harmonics::Harmonics;
use crate::math::interpolation::{Place, lerp};
use crate::spectrum::Spectrum;
use crate::transfer::ray::Ray;
use crate::transfer::shell::{PerConstituent, Shell};

/// Grid of the field: radii and cosines of the sun's zenith angle.
#[derive(Clone, Debug)]
pub struct FieldGrid {
    /// Radii, increasing from the ground to the top of the atmosphere, m.
    pub radii_m: Vec<f64>,
    /// Cosines of the sun's zenith angle, increasing.
    pub sun_cosines: Vec<f64>,
}

impl FieldGrid {
    /// Grid with `altitudes` radii, denser where the scatterers are, and the given zenith angles of the sun (degrees,
    /// increasing).
    pub fn new<const N: usize>(air: &Air<N>, altitudes: usize, sun_zeniths_deg: &[f64]) -> Self {
        Self {
            radii_m: radii_m(air, altitudes),
            sun_cosines: sun_zeniths_deg
                .iter()
                .rev()
                .map(|angle| angle.to_radians().cos())
                .collect(),
        }
    }

    /// Interpolation interval of a radius in m.
    #[inline(always)]
    pub fn place_of_radius(&self, radius_m: f64) -> Place {
        Place::among(&self.radii_m, radius_m)
    }

    /// Interpolation interval of a sun cosine.
    #[inline(always)]
    pub fn place_of_sun(&self, mu_sun: f64) -> Place {
        Place::among(&self.sun_cosines, mu_sun)
    }
}

/// Radii at equal steps of a measure that grows with each scatterer's column below and with altitude.
fn radii_m<const N: usize>(air: &Air<N>, count: usize) -> Vec<f64> {
    const SAMPLES: usize = 2000;
    let shell: &Shell = air.shell();
    let ground = shell.vertical_columns_m(shell.ground_radius_m);
    let share = 1.0 / air.scatterers.len().max(1) as f64;
    let measure = |x: f64| -> f64 {
        let columns = shell.vertical_columns_m(shell.radius_of_coordinate(x));
        let below: f64 = air
            .scatterers
            .iter()
            .map(|s| share * (1.0 - columns[s.constituent] / ground[s.constituent].max(1e-30)))
            .sum();
        below + x
    };
    let total = measure(1.0);
    let mut radii = vec![shell.ground_radius_m];
    for i in 1..SAMPLES {
        let x = i as f64 / SAMPLES as f64;
        if measure(x) >= total * radii.len() as f64 / (count - 1) as f64 && radii.len() < count - 1
        {
            radii.push(shell.radius_of_coordinate(x));
        }
    }
    radii.push(shell.top_radius_m);
    radii
}

/// Moments of the radiance, `A_lm = integral of L Y_lm`, at each node of a grid, and the diffuse irradiance on the ground,
/// both per unit solar irradiance.
///
/// `A_00` is stored as its logarithm and the other moments as ratios to it: light falls by orders of magnitude as the sun
/// sets, so its logarithm is interpolated.
#[derive(Clone, Debug)]
pub struct RadianceField<const N: usize> {
    /// Grid of the moments.
    pub grid: FieldGrid,
    /// Basis functions of the moments.
    pub basis: Harmonics,
    /// `[radius][sun][harmonic]`.
    moments: Vec<Spectrum<N>>,
    /// Logarithm of the diffuse irradiance on the ground for each sun cosine.
    ground_irradiance: Vec<Spectrum<N>>,
}

/// Smallest stored intensity, to keep the logarithm finite.
const MIN_INTENSITY: f32 = 1e-34;

impl<const N: usize> RadianceField<N> {
    /// Creates a field from moments, `[radius][sun][harmonic]`, and irradiances on the ground, `[sun]`.
    pub fn new(
        grid: FieldGrid,
        basis: Harmonics,
        mut moments: Vec<Spectrum<N>>,
        ground: &[Spectrum<N>],
    ) -> Self {
        for point in moments.chunks_exact_mut(basis.count()) {
            let intensity = point[0].max_scalar(MIN_INTENSITY);
            for l in 1..=basis.degree() {
                // Bound for non-negative radiance; rounding can exceed it where there is almost no light.
                let limit = ((2 * l + 1) as f32).sqrt();
                for ratio in &mut point[basis.span(l)] {
                    *ratio = (*ratio / intensity).map(|r| r.clamp(-limit, limit));
                }
            }
            point[0] = intensity.ln();
        }
        let ground_irradiance = ground
            .iter()
            .map(|e| e.max_scalar(MIN_INTENSITY).ln())
            .collect();
        Self {
            grid,
            basis,
            moments,
            ground_irradiance,
        }
    }

    #[inline(always)]
    fn point(&self, radius: usize, sun: usize) -> &[Spectrum<N>] {
        let count = self.basis.count();
        let start = (radius * self.grid.sun_cosines.len() + sun) * count;
        &self.moments[start..start + count]
    }

    /// Diffuse irradiance on the ground for the sun cosine `mu_sun`.
    #[inline(always)]
    pub fn ground_irradiance(&self, mu_sun: f64) -> Spectrum<N> {
        let at = self.grid.place_of_sun(mu_sun);
        at.value_in_f32(&self.ground_irradiance).exp()
    }

    /// Interpolates the stored form of the first `count` moments in radius, for all sun cosines, into `out`:
    /// `[sun][harmonic]`.
    #[inline(always)]
    pub fn at_radius(&self, at: Place, count: usize, out: &mut Vec<Spectrum<N>>) {
        out.clear();
        let fraction = at.fraction as f32;
        for sun in 0..self.grid.sun_cosines.len() {
            let (below, above) = (self.point(at.below, sun), self.point(at.below + 1, sun));
            for (a, b) in below[..count].iter().zip(&above[..count]) {
                out.push(lerp(*a, *b, fraction));
            }
        }
    }

    /// Source function of multiply scattered light: radiance scattered per metre into a view ray at `here` from light that has
    /// been scattered or reflected at least once, per unit solar irradiance. `harmonics` are evaluated in the ray's direction.
    #[inline(always)]
    pub fn source(
        &self,
        air: &Air<N>,
        here: &Ray,
        densities: &PerConstituent,
        harmonics: &[f32],
    ) -> Spectrum<N> {
        let radius = self.grid.place_of_radius(here.radius_m);
        let sun = self.grid.place_of_sun(here.mu_sun);
        let corners = [
            self.point(radius.below, sun.below),
            self.point(radius.below, sun.below + 1),
            self.point(radius.below + 1, sun.below),
            self.point(radius.below + 1, sun.below + 1),
        ];
        let (fr, fs) = (radius.fraction as f32, sun.fraction as f32);
        let weights = [
            (1.0 - fr) * (1.0 - fs),
            (1.0 - fr) * fs,
            fr * (1.0 - fs),
            fr * fs,
        ];
        let mut log_intensity = Spectrum::ZERO;
        for (corner, &w) in corners.iter().zip(&weights) {
            log_intensity = log_intensity.scale_acc(corner[0], w);
        }
        let mut sum = scattering_moment(air, densities, 0) * harmonics[0];
        for l in 1..=self.basis.degree() {
            let mut degree = Spectrum::ZERO;
            for k in self.basis.span(l) {
                for (corner, &w) in corners.iter().zip(&weights) {
                    degree = degree.scale_acc(corner[k], w * harmonics[k]);
                }
            }
            sum = sum.mul_acc(scattering_moment(air, densities, l), degree);
        }
        // Truncated harmonics can be negative in directions with almost no light.
        sum.max_scalar(0.0) * log_intensity.exp()
    }
}

/// Scattering coefficient times the l-th phase moment, summed over the scatterers, 1/m.
#[inline(always)]
pub fn scattering_moment<const N: usize>(
    air: &Air<N>,
    densities: &PerConstituent,
    l: usize,
) -> Spectrum<N> {
    let mut sum = Spectrum::ZERO;
    for s in &air.scatterers {
        sum = sum.scale_acc(s.scattering * s.moments[l], densities[s.constituent] as f32);
    }
    sum
}

/// Light that has been scattered or reflected at least once, other than into a forward peak.
pub struct Diffuse<const N: usize> {
    /// Moments of the light, per unit solar irradiance.
    pub field: RadianceField<N>,
    /// The air for which the field was solved, without forward peaks. The difference between sunlight attenuated by this air
    /// and by the real air is light scattered into forward peaks, which keeps the direction of the sun.
    pub air: Air<N>,
}

/// Irradiance on the ground from sun and sky at the sun cosine `mu_sun`, per unit solar irradiance.
#[inline(always)]
pub fn ground_irradiance<const N: usize>(
    air: &Air<N>,
    diffuse: Option<&Diffuse<N>>,
    mu_sun: f64,
) -> Spectrum<N> {
    match diffuse {
        Some(diffuse) => {
            diffuse.field.ground_irradiance(mu_sun) + diffuse.air.sun_on_ground(mu_sun)
        }
        None => air.sun_on_ground(mu_sun),
    }
}
