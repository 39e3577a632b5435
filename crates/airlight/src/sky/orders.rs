//! Successive orders of scattering in spherical geometry.
//!
//! The n-th order of light is what order n - 1 becomes when it is scattered, or reflected by the ground, once more.
//! Each order is carried from place to place along straight rays from the nodes of the grid in a fixed set of
//! directions, and gathered there into angular moments, from which the next order's source follows with every
//! constituent's own phase function. Rays, transmittances and quadrature nodes depend only on the height of the start
//! and its zenith angle: they are worked out once and serve every sun angle, azimuth and order.

use super::air::Air;
use super::field::{FieldGrid, Place, RadianceField, scattering_moment};
use super::harmonics::{Harmonics, legendre};
use super::march::Marcher;
use super::quadrature::GaussRule;
use super::ray::{Ray, in_shadow};
use super::shell::PerConstituent;
use super::vector::vectorized;
use crate::spectrum::Spectrum;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::ops::ControlFlow;

/// How finely the orders are solved.
#[derive(Clone, Debug, PartialEq)]
pub struct OrderSettings {
    /// Degree up to which the light's angular moments are kept in full.
    pub full_degree: usize,
    /// Degree up to which they are kept as far as they are symmetric about the sun's direction.
    pub zonal_degree: usize,
    /// Degree (at most `full_degree`) of the moments that are scattered again while the orders are solved; the light
    /// that is finally looked at keeps all.
    pub rescattered_degree: usize,
    /// Rays that carry light scattered once: it holds the aerosol's forward peak and wants the most directions.
    pub first: Directions,
    /// Rays that carry every later order: smoother, so fewer of them.
    pub later: Directions,
    /// Orders are added until the next is below this part of the sum.
    pub tolerance: f32,
    /// Orders never exceed this number.
    pub max_orders: usize,
}

/// A set of directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Directions {
    /// Number of zenith angles: below the horizon, just above it, and higher up.
    pub zenith_nodes: [usize; 3],
    /// Number of azimuths between the sun's and the opposite one.
    pub azimuths: usize,
    /// Quadrature nodes in a panel of a ray.
    pub panel_nodes: usize,
}

/// Solves for the moments of all light scattered or reflected at least once, per unit solar irradiance.
pub fn solve<const N: usize>(
    air: &Air<N>,
    grid: FieldGrid,
    settings: &OrderSettings,
) -> RadianceField<N> {
    let basis = Harmonics::new(settings.full_degree, settings.zonal_degree);
    let mut sum = Transport::new(air, &grid, &basis, 0, &settings.first).first_order();
    let transport = Transport::new(
        air,
        &grid,
        &basis,
        settings.rescattered_degree,
        &settings.later,
    );
    let mut order = sum.clone();
    for _ in 2..=settings.max_orders {
        let next = transport.next_order(&order.field(&grid, &basis));
        let growth = sum.add(&next);
        let ratio = next.ratio_to(&order);
        order = next;
        if growth < settings.tolerance {
            sum.add_geometric_tail(&order, &ratio);
            break;
        }
    }
    sum.field(&grid, &basis)
}

/// One order of light, or a sum of orders: moments `[radius][sun][harmonic]` and ground irradiances `[sun]`.
#[derive(Clone)]
struct Order<const N: usize> {
    /// Moments of each point.
    count: usize,
    moments: Vec<Spectrum<N>>,
    ground: Vec<Spectrum<N>>,
}

impl<const N: usize> Order<N> {
    /// The moments of each point.
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

    /// Adds another order; returns the largest part that it adds to the intensity anywhere.
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

    /// Ratio of this order's intensity to the previous one's, at every point.
    fn ratio_to(&self, previous: &Self) -> Vec<Spectrum<N>> {
        self.points()
            .zip(previous.points())
            .map(|(a, b)| a[0] / b[0].max_scalar(1e-34))
            .collect()
    }

    /// Adds the orders after `last` as a geometric series: late orders keep their shape and shrink by a constant
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
        // The ground's nodes are the first row of points.
        for ((a, b), &r) in self.ground.iter_mut().zip(&last.ground).zip(ratio) {
            *a = a.mul_acc(factor(r), *b);
        }
    }
}

/// A quadrature node on the way of a [`Path`].
struct PathNode<const N: usize> {
    t: f64,
    radius_m: f64,
    mu: f32,
    densities: PerConstituent,
    place: Place,
    /// Transmittance from the start times the length that the node stands for, m.
    weight: Spectrum<N>,
    /// `weight` times the scattering coefficients' l-th phase moments.
    source_weights: Vec<Spectrum<N>>,
}

/// The rays that leave one height under one zenith angle.
struct Path<const N: usize> {
    mu: f64,
    /// Weight of this zenith angle in an integral over the cosine.
    solid_weight: f64,
    nodes: Vec<PathNode<N>>,
    /// Distance to the ground and transmittance up to it, where the ray ends there.
    ground: Option<(f64, Spectrum<N>)>,
}

struct Transport<'a, const N: usize> {
    air: &'a Air<N>,
    grid: &'a FieldGrid,
    basis: &'a Harmonics,
    /// The low degrees of the basis: what is scattered again.
    rescattered: Harmonics,
    /// For each height, the rays that leave it.
    paths: Vec<Vec<Path<N>>>,
    azimuth_cosines: Vec<f64>,
}

impl<'a, const N: usize> Transport<'a, N> {
    fn new(
        air: &'a Air<N>,
        grid: &'a FieldGrid,
        basis: &'a Harmonics,
        rescattered_degree: usize,
        directions: &Directions,
    ) -> Self {
        let marcher = Marcher::new(directions.panel_nodes, 2.0, air.max_extinction_per_m());
        let paths = grid
            .radii_m
            .par_iter()
            .map(|&radius_m| {
                vectorized(
                    #[inline(always)]
                    || {
                        zenith_rule(air, radius_m, directions)
                            .into_iter()
                            .map(|(mu, w)| {
                                trace_path(air, grid, &marcher, radius_m, mu, w, rescattered_degree)
                            })
                            .collect()
                    },
                )
            })
            .collect();
        let azimuths = directions.azimuths;
        let azimuth_cosines = (0..azimuths)
            .map(|k| (PI * (k as f64 + 0.5) / azimuths as f64).cos())
            .collect();
        Self {
            air,
            grid,
            basis,
            rescattered: Harmonics::new(rescattered_degree, rescattered_degree),
            paths,
            azimuth_cosines,
        }
    }

    /// Light that has been scattered, or reflected by the ground, exactly once.
    fn first_order(&self) -> Order<N> {
        self.gather(
            #[inline(always)]
            |radius_m, path, light| self.carry_sunlight(radius_m, path, light),
        )
    }

    #[inline(always)]
    fn carry_sunlight(&self, radius_m: f64, path: &Path<N>, light: &mut [Spectrum<N>]) {
        let (air, shell) = (self.air, &self.air.shell);
        let mut p = vec![0.0; self.basis.degree() + 1];
        let mut phases = vec![Spectrum::ZERO; air.scatterers.len()];
        for (light, ray) in light.iter_mut().zip(self.rays(radius_m, path.mu)) {
            legendre(ray.nu, &mut p);
            for (phase, s) in phases.iter_mut().zip(&air.scatterers) {
                *phase = s.scattering * s.truncated_phase(&p);
            }
            let mut sum = Spectrum::ZERO;
            for node in &path.nodes {
                let mu_sun = (ray.radius_m * ray.mu_sun + node.t * ray.nu) / node.radius_m;
                if in_shadow(node.radius_m, mu_sun, shell.ground_radius_m) {
                    continue;
                }
                let sun = air.transmittance(&shell.columns_to_space_m(node.radius_m, mu_sun));
                let mut scattering = Spectrum::ZERO;
                for (phase, s) in phases.iter().zip(&air.scatterers) {
                    scattering = scattering.scale_acc(*phase, node.densities[s.constituent] as f32);
                }
                sum = sum.mul_acc(node.weight * sun, scattering);
            }
            if let Some((t, transmittance)) = path.ground {
                let mu_sun = ray.advanced(t).mu_sun;
                if mu_sun > 0.0 {
                    let columns = shell.columns_to_space_m(shell.ground_radius_m, mu_sun);
                    let irradiance = air.transmittance(&columns) * mu_sun as f32;
                    sum = sum.mul_acc(transmittance, air.reflected(irradiance));
                }
            }
            *light = sum;
        }
    }

    /// What becomes of the light `field` when it is scattered or reflected once more.
    fn next_order(&self, field: &RadianceField<N>) -> Order<N> {
        self.gather(
            #[inline(always)]
            |radius_m, path, light| self.carry_scattered(field, radius_m, path, light),
        )
    }

    #[inline(always)]
    fn carry_scattered(
        &self,
        field: &RadianceField<N>,
        radius_m: f64,
        path: &Path<N>,
        light: &mut [Spectrum<N>],
    ) {
        let basis = &self.rescattered;
        let mut row = Vec::new();
        let mut y = [0.0f32; Harmonics::MAX_COUNT];
        light.fill(Spectrum::ZERO);
        for node in &path.nodes {
            field.at_radius(node.place, basis.count(), &mut row);
            for (light, ray) in light.iter_mut().zip(self.rays(radius_m, path.mu)) {
                let mu_sun = (ray.radius_m * ray.mu_sun + node.t * ray.nu) / node.radius_m;
                let here = Ray {
                    radius_m: node.radius_m,
                    mu: f64::from(node.mu),
                    mu_sun,
                    nu: ray.nu,
                };
                basis.evaluate_local(node.mu, here.toward_sun() as f32, &mut y);
                let at = self.grid.place_of_sun(mu_sun);
                let (a, b) =
                    row[at.below * basis.count()..][..2 * basis.count()].split_at(basis.count());
                let (wa, wb) = (1.0 - at.fraction, at.fraction);
                let mut sum = node.source_weights[0] * y[0];
                for (l, weight) in node.source_weights.iter().enumerate().skip(1) {
                    let mut degree = Spectrum::ZERO;
                    for k in basis.span(l) {
                        degree = degree.scale_acc(a[k], wa * y[k]).scale_acc(b[k], wb * y[k]);
                    }
                    sum = sum.mul_acc(*weight, degree);
                }
                let intensity = (a[0] * wa + b[0] * wb).exp();
                *light = light.mul_acc(sum, intensity);
            }
        }
        if let Some((t, transmittance)) = path.ground {
            for (light, ray) in light.iter_mut().zip(self.rays(radius_m, path.mu)) {
                let irradiance = field.ground_irradiance(ray.advanced(t).mu_sun);
                *light = light.mul_acc(transmittance, self.air.reflected(irradiance));
            }
        }
    }

    /// The rays that leave a height under a zenith angle: every azimuth for every sun cosine.
    #[inline(always)]
    fn rays(&self, radius_m: f64, mu: f64) -> impl Iterator<Item = Ray> {
        let sin = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
        self.grid.sun_cosines.iter().flat_map(move |&mu_sun| {
            let sin_sun = ((1.0 - mu_sun) * (1.0 + mu_sun)).max(0.0).sqrt();
            self.azimuth_cosines.iter().map(move |&cos_azimuth| {
                let nu = mu * mu_sun + sin * sin_sun * cos_azimuth;
                Ray {
                    radius_m,
                    mu,
                    mu_sun,
                    nu,
                }
            })
        })
    }

    /// Lets `carry(start radius, path, light)` find the light that arrives along each path, for every sun cosine and
    /// azimuth, and gathers it into moments and ground irradiances.
    fn gather(&self, carry: impl Fn(f64, &Path<N>, &mut [Spectrum<N>]) + Sync) -> Order<N> {
        let count = self.basis.count();
        let suns = self.grid.sun_cosines.len();
        let rows: Vec<(Vec<Spectrum<N>>, Vec<Spectrum<N>>)> = self
            .paths
            .par_iter()
            .zip(&self.grid.radii_m)
            .map(|(paths, &radius_m)| {
                vectorized(
                    #[inline(always)]
                    || {
                        let mut moments = vec![Spectrum::ZERO; suns * count];
                        let mut downward = vec![Spectrum::ZERO; suns];
                        let mut light = vec![Spectrum::ZERO; suns * self.azimuth_cosines.len()];
                        let mut y = [0.0f32; Harmonics::MAX_COUNT];
                        for path in paths {
                            carry(radius_m, path, &mut light);
                            let azimuths = self.azimuth_cosines.len();
                            let w = path.solid_weight * 2.0 * PI / azimuths as f64;
                            let sin = ((1.0 - path.mu) * (1.0 + path.mu)).max(0.0).sqrt();
                            for (slot, ray) in self.rays(radius_m, path.mu).enumerate() {
                                let (sun, azimuth) = (slot / azimuths, slot % azimuths);
                                let toward_sun = (sin * self.azimuth_cosines[azimuth]) as f32;
                                self.basis.evaluate(
                                    path.mu as f32,
                                    toward_sun,
                                    ray.nu as f32,
                                    &mut y,
                                );
                                for k in 0..count {
                                    let moment = &mut moments[sun * count + k];
                                    *moment = moment.scale_acc(light[slot], y[k] * w as f32);
                                }
                                if path.mu > 0.0 {
                                    downward[sun] =
                                        downward[sun].scale_acc(light[slot], (w * path.mu) as f32);
                                }
                            }
                        }
                        (moments, downward)
                    },
                )
            })
            .collect();
        let ground = rows[0].1.clone();
        Order {
            count: self.basis.count(),
            moments: rows.into_iter().flat_map(|(moments, _)| moments).collect(),
            ground,
        }
    }
}

/// Cosines of the zenith angle and their weights: Gauss rules below the horizon, in the band just above it where the
/// light changes fastest, and in the rest of the sky.
fn zenith_rule<const N: usize>(
    air: &Air<N>,
    radius_m: f64,
    directions: &Directions,
) -> Vec<(f64, f64)> {
    const BAND: f64 = 0.2;
    let sin = (air.shell.ground_radius_m / radius_m).min(1.0);
    let horizon = -((1.0 - sin) * (1.0 + sin)).sqrt();
    let [below, band, above] = directions.zenith_nodes.map(GaussRule::new);
    below
        .on(-1.0, horizon)
        .chain(band.on(horizon, horizon + BAND))
        .chain(above.on(horizon + BAND, 1.0))
        .collect()
}

#[inline(always)]
fn trace_path<const N: usize>(
    air: &Air<N>,
    grid: &FieldGrid,
    marcher: &Marcher,
    radius_m: f64,
    mu: f64,
    solid_weight: f64,
    l_max: usize,
) -> Path<N> {
    let mut path = Path {
        mu,
        solid_weight,
        nodes: Vec::new(),
        ground: None,
    };
    // The sun in the zenith casts no shadow across the ray: the panels serve all sun angles.
    let ray = Ray {
        radius_m,
        mu,
        mu_sun: 1.0,
        nu: mu,
    };
    let Some(stretch) = air.shell.stretch(&ray, f64::INFINITY) else {
        return path;
    };
    let columns = marcher.walk(
        &air.shell,
        &ray,
        (stretch.start_m, stretch.end_m),
        &mut Vec::new(),
        #[inline(always)]
        |nodes| {
            let mut brightest = 0.0f32;
            for node in nodes {
                let transmittance = air.transmittance(&node.columns_m);
                brightest = brightest.max(transmittance.max_element());
                let weight = transmittance * node.dt as f32;
                path.nodes.push(PathNode {
                    t: node.t,
                    radius_m: node.here.radius_m,
                    mu: node.here.mu as f32,
                    densities: node.densities,
                    place: grid.place_of_radius(node.here.radius_m),
                    weight,
                    source_weights: (0..=l_max)
                        .map(|l| weight * scattering_moment(air, &node.densities, l))
                        .collect(),
                });
            }
            if brightest < 1e-6 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        },
    );
    if stretch.meets_ground {
        path.ground = Some((stretch.end_m, air.transmittance(&columns)));
    }
    path
}
