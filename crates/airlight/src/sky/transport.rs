//! Light scattered or reflected once more, integrated along straight rays in spherical geometry.
//!
//! Rays, transmittances and quadrature nodes depend only on the altitude and zenith angle: they are computed once for all sun
//! angles, azimuths and iterations.

use super::air::Air;
use super::between_azimuths::BetweenAzimuths;
use super::field::{FieldGrid, RadianceField};
use super::harmonics::Harmonics;
use super::horizon::{self, ByDirection, MODES};
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
use std::ops::Range;

/// Rays from the nodes of a grid in a set of directions.
pub struct Transport<'a, const N: usize> {
    air: &'a Air<N>,
    grid: &'a FieldGrid,
    basis: &'a Harmonics,
    /// Harmonics up to the degree that is scattered again.
    rescattered: Harmonics,
    /// For each radius, the paths that start there, with their weights in an integral over the cosine of the zenith angle.
    paths: Vec<Vec<(Path<N>, f64)>>,
    marcher: Marcher<'a>,
    azimuth_cosines: Vec<f64>,
    /// Half as many, and the interpolation between them.
    few_azimuth_cosines: Vec<f64>,
    between_few_azimuths: BetweenAzimuths,
    /// Cosines of the multiples of each azimuth: at least [`MODES`], where there are as many azimuths.
    azimuth_modes: Vec<Vec<f32>>,
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
        let (many, few) = (directions.azimuths, directions.azimuths.div_ceil(2));
        let modes = MODES.max(basis.degree() + 1).min(many);
        let multiples = |azimuth: f64| {
            let cosine = |m: usize| (m as f64 * azimuth).cos() as f32;
            (0..modes).map(cosine).collect()
        };
        Ok(Self {
            air,
            grid,
            basis,
            rescattered: Harmonics::new(rescattered_degree),
            paths,
            marcher,
            azimuth_cosines: azimuths(many).map(f64::cos).collect(),
            few_azimuth_cosines: azimuths(few).map(f64::cos).collect(),
            between_few_azimuths: BetweenAzimuths::middles(few, many),
            azimuth_modes: azimuths(many).map(multiples).collect(),
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
            &(0..self.grid.sun_cosines.len()),
            #[inline(always)]
            |path, bundle, work| {
                let streams = 1 + usize::from(self.polarised);
                match self.polarised {
                    true => self.sunlight_without_phase::<true>(path, bundle, work),
                    false => self.sunlight_without_phase::<false>(path, bundle, work),
                }
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

    /// Sunlight scattered into each ray of a path per unit scattering coefficient and without phase functions. Where the whole path
    /// lies in sunlight, the light changes slowly with the azimuth and is interpolated between half as many rays.
    #[inline(always)]
    fn sunlight_without_phase<const LINEAR: bool>(
        &self,
        path: &Path<N>,
        bundle: &RayBundle,
        work: &mut Work<N>,
    ) {
        let (suns, azimuths) = (self.grid.sun_cosines.len(), self.azimuth_cosines.len());
        let few = self.few_azimuth_cosines.len();
        let is_lit: Vec<bool> = (0..suns)
            .map(|sun| path.has_sun_above_horizon(bundle, sun * azimuths..(sun + 1) * azimuths))
            .collect();
        let of_suns = |lit: bool| {
            let suns = self.grid.sun_cosines.iter().zip(&is_lit);
            suns.filter(move |(_, is_lit)| **is_lit == lit)
                .map(|(mu_sun, _)| *mu_sun)
        };
        let lit = bundle_of(path.mu, of_suns(true), &self.few_azimuth_cosines);
        let other = bundle_of(path.mu, of_suns(false), &self.azimuth_cosines);
        let [lit_light, other_light] = &mut work.parts;
        path.accumulate_sunlight::<1, LINEAR>(self.air, &self.marcher, &lit, lit_light);
        path.accumulate_sunlight::<1, LINEAR>(self.air, &self.marcher, &other, other_light);
        let streams = self.air.scatterers.len() * (1 + usize::from(LINEAR));
        let out = &mut work.single_scatter_without_phase;
        out.clear();
        for stream in 0..streams {
            let mut lit_light = lit_light[stream * lit.len()..].chunks_exact(few);
            let mut other_light = other_light[stream * other.len()..].chunks_exact(azimuths);
            for &is_lit in &is_lit {
                if is_lit {
                    let light = lit_light.next().expect("a sun in light");
                    out.extend(self.between_few_azimuths.of(light));
                } else {
                    out.extend_from_slice(other_light.next().expect("another sun"));
                }
            }
        }
    }

    /// Light of `field`, scattered or reflected once more, under some of its suns; none under others.
    ///
    /// # Errors
    /// [`Cancelled`] soon after cancellation.
    pub fn scattered(
        &self,
        field: &RadianceField<N>,
        suns: &Range<usize>,
    ) -> Result<(Light<N>, ByDirection<N>), Cancelled> {
        self.gather(
            suns,
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

    /// Integrates the light along the rays of each path under some of the suns with `accumulate` and projects it onto moments and
    /// irradiances on the ground.
    fn gather(
        &self,
        suns: &Range<usize>,
        accumulate: impl Fn(&Path<N>, &RayBundle, &mut Work<N>) + Send + Sync,
    ) -> Result<(Light<N>, ByDirection<N>), Cancelled> {
        let rows = parallel::try_map(self.paths.len(), |row| {
            self.control.check()?;
            Ok(vectorized(
                #[inline(always)]
                || self.gather_row(&self.paths[row], suns, &accumulate),
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

    /// Moments, `[sun][moment]`, downward irradiances, `[sun]`, and the light by direction, `[sun][path][mode]`, at one radius; 0 but for
    /// some of the suns.
    #[inline(always)]
    fn gather_row(
        &self,
        paths: &[(Path<N>, f64)],
        some_suns: &Range<usize>,
        accumulate: &impl Fn(&Path<N>, &RayBundle, &mut Work<N>),
    ) -> (Vec<Spectrum<N>>, Vec<Spectrum<N>>, Vec<Spectrum<N>>) {
        let (suns, azimuths, count) = (
            self.grid.sun_cosines.len(),
            self.azimuth_cosines.len(),
            self.count(),
        );
        let (harmonics, modes) = (self.basis.count(), self.azimuth_modes[0].len());
        let mut moments = vec![Spectrum::ZERO; suns * count];
        let mut downward = vec![Spectrum::ZERO; suns];
        let mut by_direction = vec![Spectrum::ZERO; suns * paths.len() * MODES];
        let mut work = Work {
            light: vec![Spectrum::ZERO; some_suns.len() * azimuths],
            linear: vec![[Spectrum::ZERO; 2]; some_suns.len() * azimuths],
            ..Default::default()
        };
        let mut y = [0.0; Harmonics::MAX_COUNT];
        for (place, (path, solid_weight)) in paths.iter().enumerate() {
            let sun_cosines = self.grid.sun_cosines[some_suns.clone()].iter().copied();
            let bundle = bundle_of(path.mu, sun_cosines, &self.azimuth_cosines);
            work.light.fill(Spectrum::ZERO);
            work.linear.fill([Spectrum::ZERO; 2]);
            // A direct call: one through the reference would not be inlined into the vectorised code.
            (*accumulate)(path, &bundle, &mut work);
            let sin = ((1.0 - path.mu) * (1.0 + path.mu)).max(0.0).sqrt();
            self.basis.evaluate(path.mu as f32, sin as f32, &mut y);
            let amplitudes = TensorHarmonics::amplitudes(path.mu as f32);
            let tensor = |&cosine: &f64| amplitudes.at(cosine as f32);
            let tensor: Vec<_> = self.azimuth_cosines.iter().map(tensor).collect();
            let w = solid_weight * 2.0 * PI;
            for (slot, sun) in some_suns.clone().enumerate() {
                let light = &work.light[slot * azimuths..][..azimuths];
                // Means over the azimuth of the light times the cosines of its multiples.
                let mut mean = [Spectrum::ZERO; Harmonics::MAX_DEGREE + 1];
                for (light, cosines) in light.iter().zip(&self.azimuth_modes) {
                    // A truncated phase function can be slightly negative.
                    let light = light.max_scalar(0.0) * (1.0 / azimuths as f32);
                    for (mean, cosine) in mean.iter_mut().zip(cosines) {
                        *mean = mean.scale_acc(light, *cosine);
                    }
                }
                let directed = &mut by_direction[(sun * paths.len() + place) * MODES..][..MODES];
                for (m, (directed, mean)) in directed.iter_mut().zip(&mean).enumerate() {
                    *directed = *mean * if m == 0 { 1.0 } else { 2.0 };
                }
                if *solid_weight == 0.0 {
                    continue;
                }
                let (intensity, polarised) =
                    moments[sun * count..(sun + 1) * count].split_at_mut(harmonics);
                for (m, mean) in mean[..modes].iter().enumerate() {
                    for l in m..=self.basis.degree() {
                        let k = Harmonics::index(l, m);
                        intensity[k] = intensity[k].scale_acc(*mean, y[k] * w as f32);
                    }
                }
                if self.polarised {
                    let weight = (w / azimuths as f64) as f32;
                    let linear = &work.linear[slot * azimuths..][..azimuths];
                    for (linear, tensor) in linear.iter().zip(&tensor) {
                        tensor.add_moments(*linear, weight, polarised);
                    }
                }
                if path.mu > 0.0 {
                    downward[sun] = downward[sun].scale_acc(mean[0], (w * path.mu) as f32);
                }
            }
        }
        (moments, downward, by_direction)
    }
}

/// Rays with the same start and zenith angle: each azimuth for each sun cosine.
#[inline(always)]
fn bundle_of(
    mu: f64,
    sun_cosines: impl Iterator<Item = f64>,
    azimuth_cosines: &[f64],
) -> RayBundle {
    let sin = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
    let mut bundle = RayBundle::default();
    for mu_sun in sun_cosines {
        let sin_sun = ((1.0 - mu_sun) * (1.0 + mu_sun)).max(0.0).sqrt();
        for &cos_azimuth in azimuth_cosines {
            bundle.push(mu_sun, mu * mu_sun + sin * sin_sun * cos_azimuth);
        }
    }
    bundle
}

/// Azimuths from that of the sun to the opposite one, in the middle of equal intervals.
fn azimuths(count: usize) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |k| PI * (k as f64 + 0.5) / count as f64)
}

/// Reused buffers for the rays of one radius.
#[derive(Default)]
struct Work<const N: usize> {
    /// Light along each ray.
    light: Vec<Spectrum<N>>,
    /// Its Q and U.
    linear: Vec<[Spectrum<N>; 2]>,
    single_scatter_without_phase: Vec<Spectrum<N>>,
    /// The same for the suns that light a whole path, and for the others.
    parts: [Vec<Spectrum<N>>; 2],
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
