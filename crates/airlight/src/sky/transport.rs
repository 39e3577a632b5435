//! Light scattered or reflected once more, integrated along straight rays in spherical geometry.
//!
//! Rays, transmittances and quadrature nodes depend only on the altitude and zenith angle: they are computed once for all sun
//! angles, azimuths and iterations.

use super::air::Air;
use super::field::{FieldGrid, RadianceField};
use super::harmonics::Harmonics;
use super::horizon::{self, ByDirection};
use super::light::Light;
use super::plane_parallel::{PlaneParallel, ResponseRow, Shape, WeightedDirection};
use super::polarised::{POLARISED, TensorHarmonics, scattering_plane};
use super::ray_bundle::{Path, RayBundle, Response, Scratch};
use super::settings::Directions;
use crate::control::{Cancelled, Control};
use crate::math::legendre::legendre;
use crate::math::parallel;
use crate::math::simd::vectorized;
use crate::spectrum::Spectrum;
use crate::transfer::march::Marcher;
use std::f64::consts::PI;

/// Rays from the nodes of a grid in a set of directions.
pub struct Transport<'a, const N: usize> {
    air: &'a Air<N>,
    grid: &'a FieldGrid,
    basis: &'a Harmonics,
    /// Harmonics up to the degree that is scattered again.
    rescattered: Harmonics,
    /// For each radius, the paths that start there, with their weights in an integral over the cosine of the zenith angle.
    paths: Vec<Vec<(Path<N>, f64)>>,
    azimuth_cosines: Vec<f64>,
    /// Whether scattering polarises the light.
    polarised: bool,
    control: Control<'a>,
}

impl<'a, const N: usize> Transport<'a, N> {
    /// Traces the paths; `rescattered_degree` is the degree of the moments that [`Transport::scattered`] uses. `polarised` light needs
    /// moments of degree 2.
    ///
    /// # Errors
    /// [`Cancelled`] soon after cancellation.
    pub fn new(
        (air, grid, basis): (&'a Air<N>, &'a FieldGrid, &'a Harmonics),
        (rescattered_degree, polarised): (usize, bool),
        directions: &Directions,
        control: Control<'a>,
    ) -> Result<Self, Cancelled> {
        let marcher = Marcher::new(
            &air.panel_radii_m,
            directions.panel_nodes,
            1.0,
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
            polarised,
            control,
        })
    }

    /// Light that has been scattered or reflected exactly once.
    ///
    /// # Errors
    /// [`Cancelled`] soon after cancellation.
    pub fn sunlight(&self) -> Result<(Light<N>, ByDirection<N>), Cancelled> {
        let air = self.air;
        self.gather(
            #[inline(always)]
            |path, bundle, work| {
                let once = &mut work.single_scatter_without_phase;
                match self.polarised {
                    true => path.accumulate_sunlight::<1, true>(air, bundle, once),
                    false => path.accumulate_sunlight::<1, false>(air, bundle, once),
                }
                let streams = 1 + usize::from(self.polarised);
                let mut p = [0.0; Harmonics::MAX_DEGREE + 1];
                let p = &mut p[..=self.basis.degree()];
                for (slot, light) in work.light.iter_mut().enumerate() {
                    legendre(bundle.nu[slot], p);
                    let mut parallel = Spectrum::ZERO;
                    for (place, s) in air.scatterers.iter().enumerate() {
                        let once =
                            &work.single_scatter_without_phase[streams * place * bundle.len()..];
                        *light = light.mul_acc(once[slot], s.scattering * s.truncated_phase(p));
                        if self.polarised
                            && let Some(f12) = s.f12(bundle.nu[slot])
                        {
                            let stream = usize::from(s.polarises_smoothly());
                            let linear = once[stream * bundle.len() + slot];
                            parallel = parallel.mul_acc(linear, s.whole_scattering * f12);
                        }
                    }
                    if self.polarised {
                        let azimuth = self.azimuth_cosines[slot % self.azimuth_cosines.len()];
                        let (mu, mu_sun) = (path.mu as f32, bundle.mu_sun[slot] as f32);
                        work.linear[slot] = scattering_plane(mu, mu_sun, azimuth as f32)
                            .map(|proportion| parallel * proportion);
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
    ///
    /// # Errors
    /// [`Cancelled`] soon after cancellation.
    pub fn scattered(
        &self,
        field: &RadianceField<N>,
    ) -> Result<(Light<N>, ByDirection<N>), Cancelled> {
        self.gather(
            #[inline(always)]
            |path, bundle, work| {
                path.accumulate_scattered(
                    field,
                    &self.rescattered,
                    bundle,
                    &mut work.scratch,
                    &mut work.light,
                    self.polarised.then_some(&mut work.linear),
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

    /// The operator of [`Transport::scattered`] for light that does not change horizontally.
    ///
    /// # Errors
    /// [`Cancelled`] soon after cancellation.
    pub fn plane_parallel(&self) -> Result<PlaneParallel<N>, Cancelled> {
        let rows = parallel::try_map(self.paths.len(), |row| {
            self.control.check()?;
            Ok(vectorized(
                #[inline(always)]
                || self.response_row(&self.paths[row]),
            ))
        })?;
        Ok(PlaneParallel::new(&self.shape(), &rows))
    }

    /// Moments of the light.
    fn shape(&self) -> Shape {
        Shape {
            radii: self.grid.radii_m.len(),
            degree: self.basis.degree(),
            rescattered: self.rescattered.degree(),
            polarised: self.polarised,
        }
    }

    /// Response of the light at one radius.
    #[inline(always)]
    fn response_row(&self, paths: &[(Path<N>, f64)]) -> ResponseRow<N> {
        let mut row = ResponseRow::new(self.shape());
        let polarised = self.count() - self.basis.count();
        let stride = self.rescattered.count() + polarised;
        let mut response = Response::new(self.grid.radii_m.len(), stride);
        let mut y = [0.0f32; Harmonics::MAX_COUNT];
        for (path, solid_weight) in paths.iter().filter(|(_, weight)| *weight > 0.0) {
            response.clear();
            path.accumulate_response(&self.rescattered, &mut y, &mut response);
            let ground = match path.transmittance_to_ground() {
                Some(transmittance) => {
                    transmittance * self.air.coefficients.reflected(Spectrum::ONE)
                }
                None => Spectrum::ZERO,
            };
            let sin = ((1.0 - path.mu) * (1.0 + path.mu)).max(0.0).sqrt();
            self.basis.evaluate(path.mu as f32, sin as f32, &mut y);
            let direction = WeightedDirection {
                mu: path.mu,
                weight: solid_weight * 2.0 * PI,
                harmonics: &y,
            };
            row.add(&direction, &response, ground);
        }
        row
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
    ) -> Result<(Light<N>, ByDirection<N>), Cancelled> {
        let rows = parallel::try_map(self.paths.len(), |row| {
            self.control.check()?;
            Ok(vectorized(
                #[inline(always)]
                || self.gather_row(&self.paths[row], &accumulate),
            ))
        })?;
        let ground = rows[0].1.clone();
        let mut light = Light {
            count: self.count(),
            moments: Vec::new(),
            ground,
        };
        let mut by_direction = ByDirection::new();
        for (moments, _, directions) in rows {
            light.moments.extend(moments);
            by_direction.push(directions);
        }
        Ok((light, by_direction))
    }

    /// Number of moments at each node.
    fn count(&self) -> usize {
        self.basis.count() + if self.polarised { POLARISED } else { 0 }
    }

    /// Functions of the directions with a zenith angle, for each azimuth.
    #[inline(always)]
    fn functions(&self, mu: f64) -> Vec<Functions> {
        let sin = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
        let amplitudes = TensorHarmonics::amplitudes(mu as f32);
        let of_azimuth = |&cosine: &f64| {
            let mut harmonics = [0.0; Harmonics::MAX_COUNT];
            let toward_sun = (sin * cosine) as f32;
            self.basis.evaluate(mu as f32, toward_sun, &mut harmonics);
            Functions {
                harmonics,
                tensor: amplitudes.at(cosine as f32),
                modes: horizon::modes(cosine as f32),
            }
        };
        self.azimuth_cosines.iter().map(of_azimuth).collect()
    }

    /// Moments, `[sun][moment]`, downward irradiances, `[sun]`, and the light by direction, `[sun][path][mode]`, at one radius.
    #[inline(always)]
    fn gather_row(
        &self,
        paths: &[(Path<N>, f64)],
        accumulate: &impl Fn(&Path<N>, &RayBundle, &mut Work<N>),
    ) -> (Vec<Spectrum<N>>, Vec<Spectrum<N>>, Vec<Spectrum<N>>) {
        let (suns, azimuths, count) = (
            self.grid.sun_cosines.len(),
            self.azimuth_cosines.len(),
            self.count(),
        );
        let harmonics = self.basis.count();
        let mut moments = vec![Spectrum::ZERO; suns * count];
        let mut downward = vec![Spectrum::ZERO; suns];
        let mut by_direction = vec![Spectrum::ZERO; suns * paths.len() * horizon::MODES];
        let mut work = Work {
            light: vec![Spectrum::ZERO; suns * azimuths],
            linear: vec![[Spectrum::ZERO; 2]; suns * azimuths],
            ..Default::default()
        };
        for (place, (path, solid_weight)) in paths.iter().enumerate() {
            let bundle = self.bundle(path.mu);
            work.light.fill(Spectrum::ZERO);
            work.linear.fill([Spectrum::ZERO; 2]);
            // A direct call: one through the reference would not be inlined into the vectorised code.
            (*accumulate)(path, &bundle, &mut work);
            let w = solid_weight * 2.0 * PI / azimuths as f64;
            let functions = self.functions(path.mu);
            for (slot, light) in work.light.iter().enumerate() {
                // A truncated phase function can be slightly negative.
                let light = light.max_scalar(0.0);
                let (sun, azimuth) = (slot / azimuths, slot % azimuths);
                let functions = &functions[azimuth];
                let modes = &mut by_direction[(sun * paths.len() + place) * horizon::MODES..];
                for (m, (mode, cosine)) in modes.iter_mut().zip(functions.modes).enumerate() {
                    let factor = if m == 0 { 1.0 } else { 2.0 } / azimuths as f32;
                    *mode = mode.scale_acc(light, cosine * factor);
                }
                if *solid_weight == 0.0 {
                    continue;
                }
                let (intensity, polarised) =
                    moments[sun * count..(sun + 1) * count].split_at_mut(harmonics);
                for (moment, y) in intensity.iter_mut().zip(&functions.harmonics) {
                    *moment = moment.scale_acc(light, y * w as f32);
                }
                if self.polarised {
                    let tensor = &functions.tensor;
                    tensor.add_moments(work.linear[slot], w as f32, polarised);
                }
                if path.mu > 0.0 {
                    downward[sun] = downward[sun].scale_acc(light, (w * path.mu) as f32);
                }
            }
        }
        (moments, downward, by_direction)
    }
}

/// Functions of a direction with which light is projected.
struct Functions {
    harmonics: [f32; Harmonics::MAX_COUNT],
    tensor: TensorHarmonics,
    /// Azimuthal modes.
    modes: [f32; horizon::MODES],
}

/// Reused buffers for the rays of one radius.
#[derive(Default)]
struct Work<const N: usize> {
    /// Light along each ray.
    light: Vec<Spectrum<N>>,
    /// Its Q and U.
    linear: Vec<[Spectrum<N>; 2]>,
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
    let horizon = horizon::horizon(radius_m, air.shell().ground_radius_m);
    horizon::zenith_rule(horizon, directions).concat()
}
