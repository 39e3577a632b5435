//! View of a prepared sky from one position under one sun.

use super::block::{BlockLight, SampleLight, TableRow};
use super::light_source::LightSource;
use super::peaked::Part;
use super::ray_bundle::RayBundle;
use super::settings::SkyError;
use super::solver::Sky;
use crate::axes;
use crate::control::Control;
use crate::sun::SunDisc;
use crate::transfer::ray::Ray;
use glam::DVec3;
use std::ops::Range;
use std::sync::Arc;

/// A prepared sky seen from one altitude under one position of the sun, or of the moon in its place: what the methods say of the sun
/// is then that of the moon.
#[derive(Clone, Debug)]
pub struct View {
    sky: Sky,
    position: DVec3,
    source: LightSource,
    /// The disc of the source.
    disc: SunDisc,
    /// Irradiance of the source outside the air, by wavelength, W m^-2 nm^-1.
    irradiance: Arc<[f32]>,
}

/// Light along a view ray, without the direct light of the sun's disc. Each list has one entry per wavelength of the sky's
/// grid; radiances are in W m^-2 sr^-1 nm^-1.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LineOfSight {
    /// Transmittance to the end of the ray: the given distance, the ground or space.
    pub transmittance: Vec<f32>,
    /// Singly scattered sunlight.
    pub single: Vec<f32>,
    /// Light scattered or reflected more than once, last in the air along the ray.
    pub multiple: Vec<f32>,
    /// Attenuated ground radiance; zero unless the ray ends on the ground.
    pub ground: Vec<f32>,
    /// True if the ray ends on the ground.
    pub meets_ground: bool,
}

impl LineOfSight {
    /// Path radiance: `single + multiple`.
    pub fn path_radiance(&self) -> Vec<f32> {
        self.single
            .iter()
            .zip(&self.multiple)
            .map(|(s, m)| s + m)
            .collect()
    }

    /// Total radiance: path radiance and ground.
    pub fn radiance(&self) -> Vec<f32> {
        self.path_radiance()
            .iter()
            .zip(&self.ground)
            .map(|(p, g)| p + g)
            .collect()
    }
}

impl Sky {
    /// View from `altitude_m` (m; raised to the ground if below it) under a source of light: a [`SunState`](crate::sun::SunState), a
    /// direction (world axes: [`crate::axes`]), in which the sun is at the planet's mean distance, or a
    /// [`MoonState`](crate::night::MoonState).
    ///
    /// A view that the sky is not prepared for ([`Sky::covers`]) solves for all suns and altitudes when it is the first of its kind,
    /// which takes a second or two, and is as right as the others.
    ///
    /// # Panics
    /// Where the sky is not prepared for the view and that solution does not converge, as may happen in optically thick air. See
    /// [`Sky::try_view`].
    pub fn view(&self, altitude_m: f64, source: impl Into<LightSource>) -> View {
        self.try_view(altitude_m, source)
            .unwrap_or_else(|error| panic!("a view that the sky is not prepared for: {error}"))
    }

    /// As [`Sky::view`], without a panic.
    ///
    /// # Errors
    /// [`SkyError::NotConverged`].
    pub fn try_view(
        &self,
        altitude_m: f64,
        source: impl Into<LightSource>,
    ) -> Result<View, SkyError> {
        self.view_with(altitude_m, source, Control::default())
    }

    /// As [`Sky::try_view`], with progress and cancellation of the solution for all suns, if the view needs it.
    ///
    /// # Errors
    /// [`SkyError::NotConverged`]; [`SkyError::Cancelled`].
    pub fn view_with(
        &self,
        altitude_m: f64,
        source: impl Into<LightSource>,
        control: Control<'_>,
    ) -> Result<View, SkyError> {
        View::new(self, altitude_m, source.into(), control)
    }
}

impl View {
    fn new(
        sky: &Sky,
        altitude_m: f64,
        source: LightSource,
        control: Control<'_>,
    ) -> Result<Self, SkyError> {
        let source = source.normalised();
        let sky = sky.covering(altitude_m, axes::elevation_deg(source.direction()), control)?;
        let radius_m = (sky.shell().planet_radius_m + altitude_m).max(sky.shell().ground_radius_m);
        let nodes = sky.grid().wavelengths_nm().iter();
        let irradiance = nodes
            .zip(sky.grid().solar_irradiance())
            .map(|(&nm, e)| (e * source.irradiance_ratio(nm)) as f32);
        Ok(Self {
            irradiance: irradiance.collect(),
            position: DVec3::Y * radius_m,
            disc: source.disc(&sky.atmosphere().sun),
            sky: sky.clone(),
            source,
        })
    }

    /// This view from another altitude (m; raised to the ground if below it), vertically above or below.
    ///
    /// # Errors
    /// As [`Sky::try_view`].
    pub fn at_altitude(&self, altitude_m: f64) -> Result<Self, SkyError> {
        Self::new(&self.sky, altitude_m, self.source, Control::default())
    }

    /// The sky.
    pub fn sky(&self) -> &Sky {
        &self.sky
    }

    /// What lights the view.
    pub fn source(&self) -> &LightSource {
        &self.source
    }

    /// Unit vector towards the sun.
    pub fn sun(&self) -> DVec3 {
        self.source.direction()
    }

    /// The sun's disc as seen from this distance.
    pub fn disc(&self) -> &SunDisc {
        &self.disc
    }

    /// Distance of the eye from the planet's centre, m.
    pub fn radius_m(&self) -> f64 {
        self.position.y
    }

    /// Solar irradiance at the top of the atmosphere on a surface that faces the sun, W m^-2 nm^-1.
    pub fn solar_irradiance(&self) -> Vec<f32> {
        self.irradiance.to_vec()
    }

    pub(super) fn ray(&self, direction: DVec3) -> Ray {
        Ray::new(self.position, direction, self.sun())
    }

    /// Light along the unit vector `direction`, over at most `limit_m` metres; `None` for the whole ray to the ground or to
    /// space.
    pub fn along(&self, direction: DVec3, limit_m: Option<f64>) -> LineOfSight {
        let ray = self.ray(direction.normalize());
        let blocks: Vec<BlockLight> = self
            .sky
            .blocks()
            .iter()
            .map(|b| b.trace(&ray, limit_m.unwrap_or(f64::INFINITY)))
            .collect();
        let solar = self.solar_irradiance();
        let join = |part: fn(&BlockLight) -> &Vec<f32>| -> Vec<f32> {
            blocks
                .iter()
                .flat_map(|b| part(b).iter().copied())
                .collect()
        };
        let lit = |part: fn(&BlockLight) -> &Vec<f32>| -> Vec<f32> {
            join(part).iter().zip(&solar).map(|(l, e)| l * e).collect()
        };
        LineOfSight {
            transmittance: join(|b| &b.transmittance),
            single: lit(|b| &b.single),
            multiple: lit(|b| &b.multiple),
            ground: lit(|b| &b.ground),
            meets_ground: blocks.iter().any(|b| b.meets_ground),
        }
    }

    /// Light from the eye to each of the increasing distances `samples_m` along unit vectors of one elevation, `[direction][sample]`:
    /// optical depths, one per wavelength, and path radiance per unit solar irradiance, first the smooth light and then each part
    /// without its share. The last sample is the light of the whole ray, with its ground. Wavelengths whose indices are not in `used` may be
    /// left at 0.
    pub(crate) fn samples_along_rays(
        &self,
        directions: &[DVec3],
        samples_m: &[f64],
        parts: &[Part],
        used: &Range<usize>,
    ) -> Vec<Vec<SampleLight>> {
        let rays: Vec<Ray> = directions.iter().map(|&d| self.ray(d)).collect();
        let Some(first) = rays.first() else {
            return Vec::new();
        };
        let mut row = TableRow {
            start: (first.radius_m, first.mu),
            bundle: RayBundle::default(),
        };
        for ray in &rays {
            row.bundle.push(ray.mu_sun, ray.nu);
        }
        let nothing = SampleLight {
            depth: Vec::new(),
            path: vec![Vec::new(); 1 + parts.len()],
        };
        let mut all = vec![vec![nothing; samples_m.len() + 1]; rays.len()];
        let mut first = 0;
        for block in self.sky.blocks() {
            let lanes = first..first + block.lanes();
            first = lanes.end;
            if lanes.start >= used.end || lanes.end <= used.start {
                for sample in all.iter_mut().flatten() {
                    sample.depth.resize(lanes.end, 0.0);
                    for part in &mut sample.path {
                        part.resize(lanes.end, 0.0);
                    }
                }
                continue;
            }
            let more = block.samples_along_rays(&row, samples_m, parts);
            for (sample, more) in all.iter_mut().flatten().zip(more.into_iter().flatten()) {
                sample.depth.extend(more.depth);
                for (part, more) in sample.path.iter_mut().zip(more.path) {
                    part.extend(more);
                }
            }
        }
        all
    }

    /// Radii of the ground and of the top of the atmosphere, m.
    pub fn bounds_m(&self) -> (f64, f64) {
        let shell = self.sky.shell();
        (shell.ground_radius_m, shell.top_radius_m)
    }

    /// Elevation of the horizon, rad: 0 on the ground, and below it from above.
    pub fn horizon_elevation_rad(&self) -> f64 {
        -(self.sky.shell().ground_radius_m / self.radius_m())
            .min(1.0)
            .acos()
    }

    /// Transmittance from the eye to space along `direction`; 0 if the ray hits the planet.
    pub fn transmittance_to_space(&self, direction: DVec3) -> Vec<f32> {
        let ray = self.ray(direction.normalize());
        self.sky
            .blocks()
            .iter()
            .flat_map(|b| b.transmittance_to_space(ray.radius_m, ray.mu))
            .collect()
    }

    /// Irradiance of the sun's disc on a surface that faces it, W m^-2 nm^-1: integrated over strips of the disc with their
    /// transmittances, down to the horizon.
    pub fn sun_irradiance(&self) -> Vec<f32> {
        let radius = self.disc.angular_radius_rad;
        let sun = self.sun();
        let across = sun.cross(DVec3::Y);
        let up = if across.length() > 1e-9 {
            across.normalize().cross(sun).normalize()
        } else {
            DVec3::X
        };
        // Height at which the horizon cuts the disc, relative to its centre.
        let cut =
            (self.horizon_elevation_rad() - sun.y.clamp(-1.0, 1.0).asin()).clamp(-radius, radius);
        let mut sum = vec![0.0f64; self.sky.grid().len()];
        for (height, light) in self.disc_strips(cut) {
            let direction = (sun + up * height.tan()).normalize();
            let transmittance = self.transmittance_to_space(direction);
            for ((sum, light), t) in sum.iter_mut().zip(&light).zip(&transmittance) {
                *sum += light * f64::from(*t);
            }
        }
        let mut total = vec![0.0f64; sum.len()];
        for (_, light) in self.disc_strips(-radius) {
            total.iter_mut().zip(&light).for_each(|(t, l)| *t += l);
        }
        self.solar_irradiance()
            .iter()
            .zip(sum.iter().zip(&total))
            .map(|(e, (s, t))| (f64::from(*e) * s / t) as f32)
            .collect()
    }

    /// Horizontal strips of the disc from `lowest` (rad, relative to its centre) to its upper limb: the height of each and its
    /// unattenuated light at each wavelength, on a common scale.
    fn disc_strips(&self, lowest: f64) -> Vec<(f64, Vec<f64>)> {
        const STRIPS: u32 = 24;
        const POINTS: u32 = 8;
        let radius = self.disc.angular_radius_rad;
        let step = (radius - lowest) / f64::from(STRIPS);
        (0..STRIPS)
            .map(|strip| {
                let height = lowest + (f64::from(strip) + 0.5) * step;
                let half_length = (radius * radius - height * height).max(0.0).sqrt();
                let light = |&nm: &f64| {
                    let mean = (0..POINTS).map(|k| {
                        let along = (f64::from(k) + 0.5) / f64::from(POINTS) * half_length;
                        self.disc.radiance_per_irradiance(along.hypot(height), nm)
                    });
                    mean.sum::<f64>() * half_length * step
                };
                (
                    height,
                    self.sky.grid().wavelengths_nm().iter().map(light).collect(),
                )
            })
            .collect()
    }

    /// Radiance of the sun's disc along `direction`, attenuated by the air, W m^-2 sr^-1 nm^-1; zero outside the disc, on the night side of
    /// the moon and where the planet hides it.
    pub fn sun_disc_radiance(&self, direction: DVec3) -> Vec<f32> {
        let direction = direction.normalize();
        let angle = direction.angle_between(self.sun());
        if angle >= self.disc.angular_radius_rad {
            return vec![0.0; self.sky.grid().len()];
        }
        let transmittance = self.transmittance_to_space(direction);
        let relative = self.source.relative_radiance(direction);
        let disc = |nm: f64| (relative * self.disc.radiance_per_irradiance(angle, nm)) as f32;
        self.irradiance
            .iter()
            .zip(&transmittance)
            .zip(self.sky.grid().wavelengths_nm())
            .map(|((e, t), &nm)| e * t * disc(nm))
            .collect()
    }
}
