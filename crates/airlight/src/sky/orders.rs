//! Successive orders of scattering in spherical geometry.
//!
//! The light of order n is the light of order n - 1, scattered or reflected once more. Each order is integrated along
//! straight rays from the nodes of the grid in a fixed set of directions and projected onto angular moments, from which the
//! source of the next order follows with each constituent's phase function. Rays, transmittances and quadrature nodes
//! depend only on the altitude and zenith angle: they are computed once for all sun angles, azimuths and orders.

use super::air::Air;
use super::field::{Diffuse, FieldGrid, RadianceField};
use super::harmonics::Harmonics;
use super::ray_bundle::{Path, RayBundle, Scratch};
use crate::control::{Cancelled, Control};
use crate::math::legendre::legendre;
use crate::math::parallel;
use crate::math::quadrature::GaussRule;
use crate::math::simd::vectorized;
use crate::spectrum::Spectrum;
use crate::transfer::march::Marcher;
use std::f64::consts::PI;

/// Resolution and convergence of the successive orders.
#[derive(Clone, Debug, PartialEq)]
pub struct OrderSettings {
    /// Degree of the angular moments.
    pub degree: usize,
    /// Degree, at least `degree`, above which the moments of a phase function are treated as a forward peak, and the light in
    /// it as unscattered. Higher values improve the light near the sun; lower values reduce ringing elsewhere if the air
    /// contains much forward-scattering dust.
    pub peak_degree: usize,
    /// Degree, at most `degree`, of the moments that are scattered again while solving; the final field keeps all moments.
    pub rescattered_degree: usize,
    /// Directions for singly scattered light, which contains the forward peak of the aerosol and needs the most.
    pub first: Directions,
    /// Directions for all later orders, which are smoother.
    pub later: Directions,
    /// Relative contribution of an order to the sum below which the remaining orders are extrapolated.
    pub tolerance: f32,
    /// Largest number of orders.
    pub max_orders: usize,
}

/// Resolution of a set of directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Directions {
    /// Number of zenith angles below the horizon, just above it, and higher up.
    pub zenith_nodes: [usize; 3],
    /// Number of azimuths from that of the sun to the opposite one.
    pub azimuths: usize,
    /// Number of quadrature nodes in a panel of a ray.
    pub panel_nodes: usize,
}

/// Solves for all light scattered or reflected at least once; `report` receives the fraction of the work done.
///
/// # Errors
/// [`Cancelled`] soon after cancellation.
pub fn solve<const N: usize>(
    real_air: &Air<N>,
    grid: FieldGrid,
    settings: &OrderSettings,
    control: Control<'_>,
    report: impl Fn(f64),
) -> Result<Diffuse<N>, Cancelled> {
    // Approximate progress after the first order, and after the paths of later orders are prepared.
    const FIRST: f64 = 0.2;
    const PATHS: f64 = 0.3;
    let air = real_air.without_forward_peaks(settings.peak_degree);
    let basis = Harmonics::new(settings.degree);
    let transport =
        |degree, directions| Transport::new((&air, &grid, &basis), degree, directions, control);
    let mut sum = transport(0, &settings.first)?.first_order()?;
    report(FIRST);
    let transport = transport(settings.rescattered_degree, &settings.later)?;
    report(PATHS);
    let mut order = sum.clone();
    // The remaining light falls by a nearly constant factor with each order.
    let mut converged = 0.0f64;
    for _ in 2..=settings.max_orders {
        let next = transport.next_order(&order.field(&grid, &basis))?;
        let growth = sum.add(&next);
        let ratio = next.ratio_to(&order);
        order = next;
        if growth < settings.tolerance {
            sum.add_geometric_tail(&order, &ratio);
            break;
        }
        converged = converged.max(f64::from(growth.ln() / settings.tolerance.ln()));
        report(PATHS + (1.0 - PATHS) * converged.min(1.0));
    }
    let field = sum.field(&grid, &basis);
    Ok(Diffuse { field, air })
}

/// Light of one order, or a sum of orders: moments `[radius][sun][harmonic]` and irradiances on the ground `[sun]`.
#[derive(Clone)]
struct Order<const N: usize> {
    /// Number of moments at each grid point.
    count: usize,
    moments: Vec<Spectrum<N>>,
    ground: Vec<Spectrum<N>>,
}

impl<const N: usize> Order<N> {
    /// Moments at each grid point.
    fn points(&self) -> impl Iterator<Item = &[Spectrum<N>]> {
        self.moments.chunks_exact(self.count)
    }

    fn field(&self, grid: &FieldGrid, basis: &Harmonics) -> RadianceField<N> {
        RadianceField::new(
            grid.clone(),
            basis.clone(),
            self.moments.clone(),
            &self.ground,
        )
    }

    /// Adds another order; returns its largest relative contribution to the intensity at any point.
    fn add(&mut self, other: &Self) -> f32 {
        let mut growth = 0.0f32;
        for (sum, point) in self
            .moments
            .chunks_exact_mut(self.count)
            .zip(other.points())
        {
            for (a, b) in sum.iter_mut().zip(point) {
                *a += *b;
            }
            growth = growth.max((point[0] / sum[0].max_scalar(1e-30)).max_element());
        }
        for (a, b) in self.ground.iter_mut().zip(&other.ground) {
            *a += *b;
        }
        growth
    }

    /// Ratio of the intensity of this order to that of the previous one, at each point.
    fn ratio_to(&self, previous: &Self) -> Vec<Spectrum<N>> {
        self.points()
            .zip(previous.points())
            .map(|(a, b)| a[0] / b[0].max_scalar(1e-34))
            .collect()
    }

    /// Extrapolates the orders after `last` as a geometric series: late orders keep their shape and decrease by a constant
    /// factor.
    fn add_geometric_tail(&mut self, last: &Self, ratio: &[Spectrum<N>]) {
        let factor = |r: Spectrum<N>| r.map(|r| if r < 0.95 { r / (1.0 - r) } else { 19.0 });
        let count = self.count;
        for ((sum, point), &r) in self
            .moments
            .chunks_exact_mut(count)
            .zip(last.points())
            .zip(ratio)
        {
            for (a, b) in sum.iter_mut().zip(point) {
                *a = a.mul_acc(factor(r), *b);
            }
        }
        // The first row of points is on the ground.
        for ((a, b), &r) in self.ground.iter_mut().zip(&last.ground).zip(ratio) {
            *a = a.mul_acc(factor(r), *b);
        }
    }
}

struct Transport<'a, const N: usize> {
    air: &'a Air<N>,
    grid: &'a FieldGrid,
    basis: &'a Harmonics,
    /// Harmonics up to the degree that is scattered again.
    rescattered: Harmonics,
    /// For each radius, the paths that start there, with their weights in an integral over the cosine of the zenith angle.
    paths: Vec<Vec<(Path<N>, f64)>>,
    azimuth_cosines: Vec<f64>,
    control: Control<'a>,
}

impl<'a, const N: usize> Transport<'a, N> {
    fn new(
        (air, grid, basis): (&'a Air<N>, &'a FieldGrid, &'a Harmonics),
        rescattered_degree: usize,
        directions: &Directions,
        control: Control<'a>,
    ) -> Result<Self, Cancelled> {
        let marcher = Marcher::new(
            directions.panel_nodes,
            2.0,
            air.coefficients.max_extinction_per_m(),
        );
        let paths = parallel::try_map(grid.radii_m.len(), |row| {
            control.check()?;
            let radius_m = grid.radii_m[row];
            let degree = rescattered_degree;
            Ok(vectorized(
                #[inline(always)]
                || {
                    let rule = zenith_rule(air, radius_m, directions).into_iter();
                    let path = |mu| Path::new(air, Some(grid), &marcher, (radius_m, mu), degree);
                    rule.map(|(mu, w)| (path(mu), w)).collect()
                },
            ))
        })?;
        let azimuths = directions.azimuths;
        let azimuth_cosines = (0..azimuths)
            .map(|k| (PI * (k as f64 + 0.5) / azimuths as f64).cos())
            .collect();
        Ok(Self {
            air,
            grid,
            basis,
            rescattered: Harmonics::new(rescattered_degree),
            paths,
            azimuth_cosines,
            control,
        })
    }

    /// Light that has been scattered or reflected exactly once.
    fn first_order(&self) -> Result<Order<N>, Cancelled> {
        let air = self.air;
        self.gather(
            #[inline(always)]
            |path, bundle, work| {
                path.accumulate_sunlight(air, bundle, &mut work.single_scatter_without_phase);
                let mut p = [0.0; Harmonics::MAX_DEGREE + 1];
                let p = &mut p[..=self.basis.degree()];
                for (slot, light) in work.light.iter_mut().enumerate() {
                    legendre(bundle.nu[slot], p);
                    for (place, s) in air.scatterers.iter().enumerate() {
                        *light = light.mul_acc(
                            work.single_scatter_without_phase[place * bundle.len() + slot],
                            s.scattering * s.truncated_phase(p),
                        );
                    }
                }
                path.accumulate_ground(
                    air,
                    bundle,
                    |mu_sun| air.sun_on_ground(mu_sun),
                    &mut work.light,
                );
            },
        )
    }

    /// Light of `field`, scattered or reflected once more.
    fn next_order(&self, field: &RadianceField<N>) -> Result<Order<N>, Cancelled> {
        self.gather(
            #[inline(always)]
            |path, bundle, work| {
                path.accumulate_scattered(
                    field,
                    &self.rescattered,
                    bundle,
                    &mut work.scratch,
                    &mut work.light,
                );
                path.accumulate_ground(
                    self.air,
                    bundle,
                    |mu_sun| field.ground_irradiance(mu_sun),
                    &mut work.light,
                );
            },
        )
    }

    /// Rays with the same start and zenith angle: each azimuth for each sun cosine.
    #[inline(always)]
    fn bundle(&self, mu: f64) -> RayBundle {
        let sin = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
        let mut bundle = RayBundle::default();
        for &mu_sun in &self.grid.sun_cosines {
            let sin_sun = ((1.0 - mu_sun) * (1.0 + mu_sun)).max(0.0).sqrt();
            for &cos_azimuth in &self.azimuth_cosines {
                bundle.push(mu_sun, mu * mu_sun + sin * sin_sun * cos_azimuth);
            }
        }
        bundle
    }

    /// Integrates the light along the rays of each path with `accumulate` and projects it onto moments and irradiances on the
    /// ground.
    fn gather(
        &self,
        accumulate: impl Fn(&Path<N>, &RayBundle, &mut Work<N>) + Send + Sync,
    ) -> Result<Order<N>, Cancelled> {
        let rows = parallel::try_map(self.paths.len(), |row| {
            self.control.check()?;
            Ok(vectorized(
                #[inline(always)]
                || self.gather_row(&self.paths[row], &accumulate),
            ))
        })?;
        let ground = rows[0].1.clone();
        Ok(Order {
            count: self.basis.count(),
            moments: rows.into_iter().flat_map(|(moments, _)| moments).collect(),
            ground,
        })
    }

    /// Moments, `[sun][harmonic]`, and downward irradiances, `[sun]`, at one radius.
    #[inline(always)]
    fn gather_row(
        &self,
        paths: &[(Path<N>, f64)],
        accumulate: &impl Fn(&Path<N>, &RayBundle, &mut Work<N>),
    ) -> (Vec<Spectrum<N>>, Vec<Spectrum<N>>) {
        let (suns, azimuths, count) = (
            self.grid.sun_cosines.len(),
            self.azimuth_cosines.len(),
            self.basis.count(),
        );
        let mut moments = vec![Spectrum::ZERO; suns * count];
        let mut downward = vec![Spectrum::ZERO; suns];
        let mut work = Work {
            light: vec![Spectrum::ZERO; suns * azimuths],
            ..Default::default()
        };
        let mut y = [0.0f32; Harmonics::MAX_COUNT];
        for (path, solid_weight) in paths {
            let bundle = self.bundle(path.mu);
            work.light.fill(Spectrum::ZERO);
            // A direct call: one through the reference would not be inlined into the vectorised code.
            (*accumulate)(path, &bundle, &mut work);
            let w = solid_weight * 2.0 * PI / azimuths as f64;
            let sin = ((1.0 - path.mu) * (1.0 + path.mu)).max(0.0).sqrt();
            for (slot, light) in work.light.iter().enumerate() {
                // A truncated phase function can be slightly negative.
                let light = light.max_scalar(0.0);
                let (sun, azimuth) = (slot / azimuths, slot % azimuths);
                let toward_sun = (sin * self.azimuth_cosines[azimuth]) as f32;
                self.basis.evaluate(path.mu as f32, toward_sun, &mut y);
                for (moment, y) in moments[sun * count..(sun + 1) * count].iter_mut().zip(&y) {
                    *moment = moment.scale_acc(light, y * w as f32);
                }
                if path.mu > 0.0 {
                    downward[sun] = downward[sun].scale_acc(light, (w * path.mu) as f32);
                }
            }
        }
        (moments, downward)
    }
}

/// Reused buffers for the rays of one radius.
#[derive(Default)]
struct Work<const N: usize> {
    /// Light along each ray.
    light: Vec<Spectrum<N>>,
    single_scatter_without_phase: Vec<Spectrum<N>>,
    scratch: Scratch<N>,
}

/// Cosines of the zenith angle and quadrature weights: Gauss rules below the horizon, in a band just above it, where the
/// light changes fastest, and in the rest of the sky.
fn zenith_rule<const N: usize>(
    air: &Air<N>,
    radius_m: f64,
    directions: &Directions,
) -> Vec<(f64, f64)> {
    const BAND: f64 = 0.2;
    let sin = (air.shell().ground_radius_m / radius_m).min(1.0);
    let horizon = -((1.0 - sin) * (1.0 + sin)).sqrt();
    let [below, band, above] = directions.zenith_nodes.map(GaussRule::new);
    below
        .on(-1.0, horizon)
        .chain(band.on(horizon, horizon + BAND))
        .chain(above.on(horizon + BAND, 1.0))
        .collect()
}
