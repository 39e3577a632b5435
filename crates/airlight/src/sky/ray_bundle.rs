//! Bundles of rays that share their starting radius and zenith angle, and the light along them.
//!
//! In a spherically symmetric atmosphere such rays cross the same radii at the same distances: quadrature nodes,
//! transmittances to the eye and radial interpolation are computed once, in a [`Path`], for the whole [`RayBundle`]. What
//! depends on the sun remains for each ray and is stored in arrays over the rays, so that the compiler vectorises it.

use super::air::Air;
use super::field::{FieldGrid, RadianceField, scattering_moment};
use super::harmonics::Harmonics;
use crate::math::interpolation::Place;
use crate::spectrum::Spectrum;
use crate::transfer::march::Marcher;
use crate::transfer::ray::{Ray, in_shadow};
use crate::transfer::shell::PerConstituent;
use std::ops::ControlFlow;

/// What the rays of a bundle have in common: quadrature nodes, transmittances and densities along the path.
pub struct Path<const N: usize> {
    /// Radius of the start, m.
    pub radius_m: f64,
    /// Cosine of the zenith angle at the start.
    pub mu: f64,
    nodes: Vec<PathNode<N>>,
    /// Distance to the ground and transmittance to it, if the rays end there.
    ground: Option<(f64, Spectrum<N>)>,
}

/// A quadrature node of a [`Path`].
struct PathNode<const N: usize> {
    t: f64,
    radius_m: f64,
    mu: f32,
    densities: PerConstituent,
    place: Place,
    /// Transmittance from the start times the length of the node's interval, m.
    weight: Spectrum<N>,
    /// `weight` times the l-th phase moment of the scattering coefficients.
    source_weights: Vec<Spectrum<N>>,
}

/// The rays of one path: the position of the sun at the start for each.
#[derive(Clone, Debug, Default)]
pub struct RayBundle {
    /// Cosine of the sun's zenith angle at the start.
    pub mu_sun: Vec<f64>,
    /// Cosine of the angle between the ray and the sun.
    pub nu: Vec<f64>,
}

impl RayBundle {
    /// Number of rays.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.nu.len()
    }

    /// Adds a ray.
    #[inline(always)]
    pub fn push(&mut self, mu_sun: f64, nu: f64) {
        self.mu_sun.push(mu_sun);
        self.nu.push(nu);
    }

    /// Ray by index, for the start (radius in m, cosine of the zenith angle).
    #[inline(always)]
    pub fn ray(&self, (radius_m, mu): (f64, f64), slot: usize) -> Ray {
        Ray {
            radius_m,
            mu,
            mu_sun: self.mu_sun[slot],
            nu: self.nu[slot],
        }
    }
}

/// Reused buffers over the rays of a bundle.
#[derive(Default)]
pub struct Scratch<const N: usize> {
    mu_sun: Vec<f32>,
    toward_sun: Vec<f32>,
    below: Vec<u32>,
    fraction: Vec<f32>,
    azimuthal: [Vec<f32>; 3],
    /// Basis functions, `[harmonic][ray]`.
    y: Vec<f32>,
    /// The field at a node's radius, `[sun][harmonic]`.
    row: Vec<Spectrum<N>>,
}

impl<const N: usize> Path<N> {
    /// Traces a path from `radius_m` along `mu` through the whole atmosphere.
    #[inline(always)]
    pub fn new(
        air: &Air<N>,
        grid: Option<&FieldGrid>,
        marcher: &Marcher,
        (radius_m, mu): (f64, f64),
        degree: usize,
    ) -> Self {
        let mut path = Self {
            radius_m,
            mu,
            nodes: Vec::new(),
            ground: None,
        };
        // With the sun at the zenith no shadow edge crosses the ray, so the panels serve all sun angles.
        let ray = Ray {
            radius_m,
            mu,
            mu_sun: 1.0,
            nu: mu,
        };
        let Some(segment) = air.shell().segment(&ray, f64::INFINITY) else {
            return path;
        };
        let columns = marcher.march(
            air.shell(),
            &ray,
            (segment.start_m, segment.end_m),
            &mut Vec::new(),
            #[inline(always)]
            |nodes| {
                let mut brightest = 0.0f32;
                for node in nodes {
                    let transmittance = air.coefficients.transmittance(&node.columns_m);
                    brightest = brightest.max(transmittance.max_element());
                    let weight = transmittance * node.dt as f32;
                    let radius_m = node.here.radius_m;
                    path.nodes.push(PathNode {
                        t: node.t,
                        radius_m,
                        mu: node.here.mu as f32,
                        densities: node.densities,
                        place: grid.map_or(
                            Place {
                                below: 0,
                                fraction: 0.0,
                            },
                            |g| g.place_of_radius(radius_m),
                        ),
                        weight,
                        source_weights: (0..=degree)
                            .map(|l| weight * scattering_moment(air, &node.densities, l))
                            .collect(),
                    });
                }
                if brightest < 1e-7 {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
        );
        if segment.meets_ground {
            path.ground = Some((segment.end_m, air.coefficients.transmittance(&columns)));
        }
        path
    }

    /// True if the sun is above the planet's limb at all nodes of all rays.
    #[inline(always)]
    pub fn is_lit(&self, air: &Air<N>, bundle: &RayBundle) -> bool {
        let ground_radius_m = air.shell().ground_radius_m;
        self.nodes.iter().all(|node| {
            (0..bundle.len()).all(|slot| {
                let mu_sun = (self.radius_m * bundle.mu_sun[slot] + node.t * bundle.nu[slot])
                    / node.radius_m;
                !in_shadow(node.radius_m, mu_sun, ground_radius_m)
            })
        })
    }

    /// Singly scattered sunlight along each ray, per unit scattering coefficient and without phase functions, into `out`:
    /// `[scatterer][ray]`.
    #[inline(always)]
    pub fn accumulate_sunlight(
        &self,
        air: &Air<N>,
        bundle: &RayBundle,
        out: &mut Vec<Spectrum<N>>,
    ) {
        let shell = air.shell();
        out.clear();
        out.resize(air.scatterers.len() * bundle.len(), Spectrum::ZERO);
        for node in &self.nodes {
            let columns = air.columns.at(node.radius_m);
            for slot in 0..bundle.len() {
                let mu_sun = (self.radius_m * bundle.mu_sun[slot] + node.t * bundle.nu[slot])
                    / node.radius_m;
                let depth = if mu_sun >= 0.0 {
                    air.coefficients
                        .extinction_f32(&columns.to_space_m(mu_sun as f32))
                } else if in_shadow(node.radius_m, mu_sun, shell.ground_radius_m) {
                    continue;
                } else {
                    air.coefficients
                        .extinction(&air.columns.to_space_m(node.radius_m, mu_sun))
                };
                let arriving = node.weight * (Spectrum::ZERO - depth).exp();
                for (place, s) in air.scatterers.iter().enumerate() {
                    let sum = &mut out[place * bundle.len() + slot];
                    *sum = sum.scale_acc(arriving, node.densities[s.constituent] as f32);
                }
            }
        }
    }

    /// Adds the light of `field` scattered into each ray; `basis` is that of the field, or its low degrees.
    #[inline(always)]
    pub fn accumulate_scattered(
        &self,
        field: &RadianceField<N>,
        basis: &Harmonics,
        bundle: &RayBundle,
        scratch: &mut Scratch<N>,
        out: &mut [Spectrum<N>],
    ) {
        let (rays, count) = (bundle.len(), basis.count());
        scratch.resize(rays, count);
        for node in &self.nodes {
            field.at_radius(node.place, count, &mut scratch.row);
            scratch.locate(&field.grid, self, node, bundle);
            basis.evaluate_bundle(
                node.mu,
                &scratch.toward_sun,
                &mut scratch.azimuthal,
                &mut scratch.y,
            );
            for (slot, out) in out.iter_mut().enumerate() {
                let below = scratch.below[slot] as usize * count;
                let (a, b) = scratch.row[below..below + 2 * count].split_at(count);
                let (wa, wb) = (1.0 - scratch.fraction[slot], scratch.fraction[slot]);
                let mut sum = node.source_weights[0] * scratch.y[slot];
                for (l, weight) in node.source_weights.iter().enumerate().skip(1) {
                    let mut degree = Spectrum::ZERO;
                    for k in basis.span(l) {
                        let y = scratch.y[k * rays + slot];
                        degree = degree.scale_acc(a[k], wa * y).scale_acc(b[k], wb * y);
                    }
                    sum = sum.mul_acc(*weight, degree);
                }
                let intensity = (a[0] * wa + b[0] * wb).exp();
                *out = out.mul_acc(sum.max_scalar(0.0), intensity);
            }
        }
    }

    /// Adds the attenuated ground radiance to each ray, for the irradiance on the ground `irradiance(sun cosine)`.
    #[inline(always)]
    pub fn accumulate_ground(
        &self,
        air: &Air<N>,
        bundle: &RayBundle,
        irradiance: impl Fn(f64) -> Spectrum<N>,
        out: &mut [Spectrum<N>],
    ) {
        let Some((t, transmittance)) = self.ground else {
            return;
        };
        for (slot, out) in out.iter_mut().enumerate() {
            let mu_sun = bundle
                .ray((self.radius_m, self.mu), slot)
                .advanced(t)
                .mu_sun;
            *out = out.mul_acc(
                transmittance,
                air.coefficients.reflected(irradiance(mu_sun)),
            );
        }
    }
}

impl<const N: usize> Scratch<N> {
    #[inline(always)]
    fn resize(&mut self, rays: usize, harmonics: usize) {
        for list in [&mut self.mu_sun, &mut self.toward_sun, &mut self.fraction] {
            list.resize(rays, 0.0);
        }
        for list in &mut self.azimuthal {
            list.resize(rays, 0.0);
        }
        self.below.resize(rays, 0);
        self.y.resize(rays * harmonics, 0.0);
    }

    /// Computes for each ray the position of the sun relative to `node` and its interval in the sun cosines of the grid.
    #[inline(always)]
    fn locate(&mut self, grid: &FieldGrid, path: &Path<N>, node: &PathNode<N>, bundle: &RayBundle) {
        let rays = bundle.len();
        let (mu_suns, towards) = (&mut self.mu_sun[..rays], &mut self.toward_sun[..rays]);
        let (nus, starts) = (&bundle.nu[..rays], &bundle.mu_sun[..rays]);
        let inverse = 1.0 / node.radius_m;
        let sin = (1.0 - node.mu * node.mu).max(0.0).sqrt();
        for slot in 0..rays {
            let mu_sun = ((path.radius_m * starts[slot] + node.t * nus[slot]) * inverse) as f32;
            let sin_sun = (1.0 - mu_sun * mu_sun).max(1e-9).sqrt();
            let toward = (nus[slot] as f32 - node.mu * mu_sun) / sin_sun;
            mu_suns[slot] = mu_sun;
            towards[slot] = toward.max(-sin).min(sin);
        }
        let nodes = &grid.sun_cosines;
        let (below, fraction) = (&mut self.below[..rays], &mut self.fraction[..rays]);
        below.fill(0);
        for &cosine in &nodes[1..nodes.len() - 1] {
            let cosine = cosine as f32;
            for slot in 0..rays {
                below[slot] += u32::from(mu_suns[slot] >= cosine);
            }
        }
        for slot in 0..rays {
            let (a, b) = (
                nodes[below[slot] as usize] as f32,
                nodes[below[slot] as usize + 1] as f32,
            );
            fraction[slot] = ((mu_suns[slot] - a) / (b - a)).clamp(0.0, 1.0);
        }
    }
}
