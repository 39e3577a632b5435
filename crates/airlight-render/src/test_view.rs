//! A view for tests: uniform sky, ground and sun.

use airlight::axes;
use airlight::monte_carlo::{Estimate, PolarisedEstimate};
use airlight::scene::{Channels, RadianceSampler, RadianceView};
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use airlight::sun::{LimbDarkening, SunDisc};
use airlight::{Cancelled, Control};
use glam::DVec3;
use std::f64::consts::PI;
use std::sync::Arc;

/// Uniform sky over uniform ground without air, and a sun without limb darkening; linear sRGB.
#[derive(Clone, Debug)]
pub struct TestView {
    sun: DVec3,
    disc: SunDisc,
}

impl TestView {
    /// Radiance of the sky.
    pub const SKY: f32 = 1000.0;
    /// Radiance of the ground.
    pub const GROUND: f32 = 200.0;
    /// Radiance of the sun's disc.
    pub const SUN: f32 = 1e9;
    /// Path radiance of a metre of air in front of objects.
    pub const AIR_PER_M: f32 = 0.5;

    /// A view with the sun in a direction.
    pub fn with_sun(sun: DVec3) -> Self {
        Self {
            sun,
            disc: SunDisc {
                limb_darkening: LimbDarkening::Uniform,
                ..SunDisc::default()
            },
        }
    }

    /// The same with the limb darkening of the sun, and the same irradiance by the whole disc.
    pub fn with_limb_darkening(mut self) -> Self {
        self.disc = SunDisc::default();
        self
    }

    /// Radiance of the disc at an angle from its centre.
    fn disc_radiance(&self, angle_rad: f64) -> f64 {
        let area = PI * self.disc.angular_radius_rad.sin().powi(2);
        f64::from(Self::SUN) * area * self.disc.radiance_per_irradiance(angle_rad, 550.0)
    }

    /// Radiance times solid angle of the part of the disc above the horizon.
    pub fn disc_irradiance_above_horizon(&self) -> f64 {
        let radius = self.disc.angular_radius_rad;
        let elevation = axes::elevation_rad(self.sun);
        // Rings, each with the visible part of its circle.
        const RINGS: u32 = 20_000;
        let ring = |k: u32| {
            let angle = radius * (f64::from(k) + 0.5) / f64::from(RINGS);
            let half = (-elevation.tan() / angle.tan()).clamp(-1.0, 1.0).acos();
            2.0 * half * angle.sin() * self.disc_radiance(angle)
        };
        (0..RINGS).map(ring).sum::<f64>() * radius / f64::from(RINGS)
    }

    fn each(directions: &[DVec3], out: &mut [f32], value: impl Fn(DVec3) -> f32) {
        for (&direction, out) in directions.iter().zip(out.chunks_exact_mut(3)) {
            out.fill(match direction == DVec3::ZERO {
                true => 0.0,
                false => value(direction),
            });
        }
    }
}

impl RadianceView for TestView {
    fn channels(&self) -> Channels {
        Channels::Rgb(RgbSpace::Srgb)
    }

    fn grid(&self) -> Option<&WavelengthGrid> {
        None
    }

    fn sun(&self) -> DVec3 {
        self.sun
    }

    fn disc(&self) -> &SunDisc {
        &self.disc
    }

    fn averages_horizon(&self) -> bool {
        true
    }

    fn radiance(&self, directions: &[DVec3], out: &mut [f32]) {
        Self::each(directions, out, |d| match d.y < 0.0 {
            true => Self::GROUND,
            false => Self::SKY,
        });
    }

    fn sun_disc(&self, directions: &[DVec3], out: &mut [f32]) {
        Self::each(directions, out, |d| match d.y >= 0.0 {
            true => self.disc_radiance(d.angle_between(self.sun)) as f32,
            false => 0.0,
        });
    }

    fn irradiance(&self, normals: &[DVec3], out: &mut [f32]) {
        Self::each(normals, out, |n| {
            let up = 0.5 + 0.5 * n.y as f32;
            PI as f32 * (up * Self::SKY + (1.0 - up) * Self::GROUND)
        });
    }

    fn horizontal_irradiance(&self, out: &mut [f32]) {
        self.irradiance(&[DVec3::Y], out);
    }

    fn sun_irradiance(&self, out: &mut [f32]) {
        out.fill(self.disc_irradiance_above_horizon() as f32);
    }

    fn sunlight(&self, _height_m: f64, out: &mut [f32]) {
        self.sun_irradiance(out);
    }

    fn path(
        &self,
        _direction: DVec3,
        distance_m: f64,
        transmittance: &mut [f32],
        path_radiance: &mut [f32],
    ) {
        transmittance.fill(1.0);
        path_radiance.fill(Self::AIR_PER_M * distance_m as f32);
    }
}

/// Sampler whose bundles alternate between radiance 0 and 2, half of which is horizontally polarised.
#[derive(Clone, Copy, Debug)]
pub struct TestSampler;

impl RadianceSampler for TestSampler {
    fn paths(&self) -> u64 {
        512
    }

    fn add_bundle(&self, _direction: DVec3, bundle: u64, sum: &mut [f64]) {
        sum.iter_mut()
            .for_each(|sum| *sum += (2 * (bundle % 2)) as f64);
    }

    fn add_polarised_bundle(
        &self,
        direction: DVec3,
        bundle: u64,
        sum: &mut [f64],
        stokes: &mut [f64; 3],
    ) {
        self.add_bundle(direction, bundle, sum);
        stokes[0] += 2.0;
        stokes[1] -= 1.0;
    }

    fn estimate_with(
        &self,
        _direction: DVec3,
        _limit_m: Option<f64>,
        _control: Control<'_>,
    ) -> Result<Estimate, Cancelled> {
        unreachable!("pictures add bundles")
    }

    fn polarised_estimate_with(
        &self,
        _direction: DVec3,
        _limit_m: Option<f64>,
        _control: Control<'_>,
    ) -> Result<PolarisedEstimate, Cancelled> {
        unreachable!("pictures add bundles")
    }

    fn preview(&self) -> Arc<dyn RadianceView> {
        Arc::new(TestView::with_sun(DVec3::Y))
    }
}
