//! [`GlowView`]: airglow, zodiacal light, starlight and the glow of cities as seen through the air.

use super::Channels;
use super::city_glow::CityGlow;
use super::fog_in_sky::FogInSky;
use super::irradiance_map::{IrradianceMap, horizontal_irradiance_of};
use super::model::StarField;
use crate::axes;
use crate::control::{Cancelled, Control};
use crate::debug::debug_fields;
use crate::math::parallel;
use crate::math::quadrature::GaussRule;
use crate::math::slices::accumulate;
use crate::night::{
    CelestialFrame, GlowComponent, NightGlow, black_body, bright_stars, luminance_of_magnitude,
};
use crate::sky::{Sky, SkyError, View};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::{Arc, OnceLock};

/// Numbers of tabulated elevations above and below the horizon, odd.
const ABOVE: usize = 49;
const BELOW: usize = 13;
/// Number of rings of the sky whose scattered light is added up, and of azimuths at which each is evaluated.
const RINGS: usize = 12;
const AZIMUTHS: usize = 8;
/// Smallest distance of a tabulated elevation from the horizon, rad.
const OFF_HORIZON_RAD: f64 = 1e-6;
/// Number of components of the light outside the air.
const COMPONENTS: usize = GlowComponent::ALL.len();

/// Spectra of the components at the wavelengths of a sky.
type Spectra = [Vec<f64>; COMPONENTS];

/// Elevations that are tabulated for an eye whose horizon is at `horizon_rad`: denser towards the horizon on both sides of it,
/// first those above.
fn elevations(horizon_rad: f64) -> Vec<f64> {
    let square = |i: usize, count: usize| (i as f64 / (count - 1) as f64).powi(2);
    let above = (0..ABOVE).map(|i| {
        let up = square(i, ABOVE) * (FRAC_PI_2 - horizon_rad);
        horizon_rad + up.max(OFF_HORIZON_RAD)
    });
    let below = (0..BELOW).map(|i| {
        let down = square(i, BELOW) * (FRAC_PI_2 + horizon_rad);
        horizon_rad - down.max(OFF_HORIZON_RAD)
    });
    above.chain(below).collect()
}

/// Sines of the elevations of the rings of the sky, and their shares of the solid angle of a hemisphere.
fn ring_sines() -> impl Iterator<Item = (f64, f64)> {
    GaussRule::new(RINGS)
        .on(0.0, 1.0)
        .collect::<Vec<_>>()
        .into_iter()
}

/// Light of rings of the sky that the air scatters and the ground reflects, for one eye.
#[derive(Debug)]
pub(super) struct RingScattering {
    altitude_m: f64,
    /// For every second tabulated elevation, each ring and each wavelength: radiance under a ring with the radiance of the solar
    /// irradiance over 1 sr.
    scattered: Vec<Vec<Vec<f32>>>,
}

impl RingScattering {
    /// The light for an eye at an altitude, m, in a sky that is solved for sources above the horizon.
    ///
    /// # Errors
    /// [`SkyError::NotConverged`]; [`SkyError::Cancelled`].
    pub fn new(sky: &Sky, altitude_m: f64, control: Control<'_>) -> Result<Self, SkyError> {
        let eye = sky.view_with(altitude_m, DVec3::Y, control)?;
        let above_and_below = elevations(horizon_rad(&eye));
        let (above, below) = above_and_below.split_at(ABOVE);
        let elevations: Vec<f64> = above
            .iter()
            .step_by(2)
            .chain(below.iter().step_by(2))
            .copied()
            .collect();
        let rings = ring_sines().map(|(sine, share)| {
            let source = axes::direction(0.0, sine.asin().to_degrees());
            let view = sky.view_with(altitude_m, source, control)?;
            Ok((view, 2.0 * PI * share))
        });
        let rings: Vec<(View, f64)> = rings.collect::<Result<_, SkyError>>()?;
        let solar = eye.solar_irradiance();
        let scattered = parallel::try_map(elevations.len(), |i| {
            control.check()?;
            let under = |(view, solid_angle): &(View, f64)| {
                let mut mean = vec![0.0; solar.len()];
                for k in 0..AZIMUTHS {
                    let azimuth_deg = 180.0 * (k as f64 + 0.5) / AZIMUTHS as f64;
                    let direction = axes::direction(azimuth_deg, elevations[i].to_degrees());
                    let light = view.along(direction, None).radiance();
                    for (mean, light) in mean.iter_mut().zip(light) {
                        *mean += light * (solid_angle / AZIMUTHS as f64) as f32;
                    }
                }
                mean
            };
            Ok::<_, Cancelled>(rings.iter().map(under).collect())
        })?;
        Ok(Self {
            altitude_m,
            scattered,
        })
    }

    /// Altitude of the eye, m.
    pub fn altitude_m(&self) -> f64 {
        self.altitude_m
    }
}

/// Elevation of the horizon of a view, rad.
fn horizon_rad(view: &View) -> f64 {
    -(view.bounds_m().0 / view.radius_m()).min(1.0).acos()
}

/// Diffuse light of the night for one eye.
///
/// Light that arrives straight is dimmed by the air along each ray. Light that the air scatters or the ground reflects is the
/// solution of the sky's solver for distant sources, added up over the whole sky: 12 rings, each as bright as the sky on
/// average over its azimuths. The scattered part therefore has the same brightness in all azimuths; at the zenith of clear air it
/// is a tenth of the light at 550 nm. Under an even sky over white ground, air without absorption changes radiance by at most 1 %
/// (test `air_without_absorption_is_invisible_under_an_even_sky`), instead of not at all.
pub(super) struct GlowView {
    view: View,
    channels: Channels,
    count: usize,
    glow: NightGlow,
    sea_level_m: f64,
    horizon_rad: f64,
    /// `[elevation][component][channel]`: one unit of a component, dimmed by the air.
    direct: Vec<f32>,
    /// `[elevation][channel]`: light that the air and the ground scatter.
    scattered: Vec<f32>,
    /// Fog in front of the light. What it scatters is part of the fog itself.
    fog: Option<Arc<FogInSky>>,
    irradiance: OnceLock<IrradianceMap>,
}

debug_fields! { GlowView { channels, horizon_rad } }

impl GlowView {
    /// Tabulates the light for the eye of `rings`.
    ///
    /// # Errors
    /// As [`CityGlow::radiance`].
    pub fn new(
        sky: &Sky,
        rings: &RingScattering,
        glow: NightGlow,
        (city, sky_quality_mag): (Option<&CityGlow>, Option<f64>),
        channels: Channels,
    ) -> Result<Self, SkyError> {
        let view = sky.view(rings.altitude_m(), DVec3::Y);
        let horizon_rad = horizon_rad(&view);
        let count = match channels {
            Channels::Rgb(_) => 3,
            Channels::Spectral => sky.grid().len(),
        };
        let mut this = Self {
            sea_level_m: sky.atmosphere().planet.radius_m,
            view,
            channels,
            count,
            glow,
            horizon_rad,
            direct: Vec::new(),
            scattered: Vec::new(),
            fog: None,
            irradiance: OnceLock::new(),
        };
        let elevations = elevations(horizon_rad);
        let spectra = GlowComponent::ALL.map(|component| glow.spectrum(component, sky.grid()));
        this.direct = this.tabulate_direct(&elevations, &spectra);
        this.scattered = this.tabulate_scattered(rings, &spectra);
        if let (Some(city), Some(magnitude)) = (city, sky_quality_mag) {
            this.add_city(city, magnitude, &elevations)?;
        }
        Ok(this)
    }

    /// The same light behind fog.
    pub fn behind(self, fog: Arc<FogInSky>) -> Self {
        Self {
            fog: Some(fog),
            irradiance: OnceLock::new(),
            ..self
        }
    }

    /// Mean radiance of the sky in each channel: its irradiance of a horizontal surface divided by pi.
    pub fn mean_radiance(&self) -> Vec<f32> {
        let mut irradiance = vec![0.0; self.count];
        self.horizontal_irradiance(&mut irradiance);
        irradiance.iter().map(|e| e / PI as f32).collect()
    }

    /// Transmittance of the fog to the ground or to space.
    fn through_fog(&self, direction: DVec3) -> f32 {
        self.fog
            .as_ref()
            .map_or(1.0, |fog| fog.transmittance(direction))
    }

    /// Index of the tabulated elevation below (above the horizon) or above (below it) a direction's, and the fraction from
    /// there to the next.
    fn place(&self, elevation_rad: f64) -> (usize, f32) {
        let (first, count, part) = match elevation_rad >= self.horizon_rad {
            true => (
                0,
                ABOVE,
                (elevation_rad - self.horizon_rad) / (FRAC_PI_2 - self.horizon_rad),
            ),
            false => (
                ABOVE,
                BELOW,
                (self.horizon_rad - elevation_rad) / (FRAC_PI_2 + self.horizon_rad),
            ),
        };
        let at = part.clamp(0.0, 1.0).sqrt() * (count - 1) as f64;
        let cell = (at as usize).min(count - 2);
        (first + cell, (at - cell as f64) as f32)
    }

    /// Converts spectral radiance at the wavelengths of the sky to channels.
    fn to_channels(&self, spectrum: &[f64]) -> Vec<f32> {
        let spectrum: Vec<f32> = spectrum.iter().map(|&v| v as f32).collect();
        match self.channels {
            Channels::Spectral => spectrum,
            Channels::Rgb(space) => {
                let xyz = self.view.sky().grid().to_xyz(&spectrum);
                space.from_xyz(xyz).map(|v| v as f32).to_vec()
            }
        }
    }

    /// One unit of each component with these spectra, dimmed by the air at each elevation.
    fn tabulate_direct(&self, elevations: &[f64], spectra: &Spectra) -> Vec<f32> {
        let rows = parallel::map(elevations.len(), |i| {
            let direction = axes::direction(0.0, elevations[i].to_degrees());
            let transmittance = self.view.transmittance_to_space(direction);
            let mut row = Vec::with_capacity(COMPONENTS * self.count);
            for (component, spectrum) in GlowComponent::ALL.iter().zip(spectra) {
                let dimmed = spectrum.iter().zip(&transmittance);
                let dimmed: Vec<f64> = match component {
                    GlowComponent::AirglowBefore => spectrum.clone(),
                    _ => dimmed.map(|(v, t)| v * f64::from(*t)).collect(),
                };
                row.extend(self.to_channels(&dimmed));
            }
            row
        });
        rows.concat()
    }

    /// Light of rings of the sky, scattered into each tabulated elevation.
    fn tabulate_scattered(&self, rings: &RingScattering, spectra: &Spectra) -> Vec<f32> {
        let grid = self.view.sky().grid();
        // Radiance of each ring at each wavelength relative to the solar irradiance, as seen from the ground, where the air
        // that scatters is.
        let relative: Vec<Vec<f64>> = ring_sines()
            .map(|(sine, _)| {
                let mut mean = [0.0; COMPONENTS];
                for k in 0..AZIMUTHS {
                    let azimuth_deg = 360.0 * k as f64 / AZIMUTHS as f64;
                    let direction = axes::direction(azimuth_deg, sine.asin().to_degrees());
                    let sea = self.sea_level_m;
                    let amounts = self.glow.amounts(direction, sea, sea, false);
                    for (mean, amount) in mean.iter_mut().zip(amounts) {
                        *mean += amount / AZIMUTHS as f64;
                    }
                }
                let at = |(k, solar): (usize, &f64)| {
                    let radiance: f64 = spectra.iter().zip(mean).map(|(s, m)| s[k] * m).sum();
                    if *solar > 0.0 { radiance / solar } else { 0.0 }
                };
                grid.solar_irradiance().iter().enumerate().map(at).collect()
            })
            .collect();
        let coarse: Vec<Vec<f32>> = rings
            .scattered
            .iter()
            .map(|by_ring| {
                let mut sum = vec![0.0; grid.len()];
                for (light, relative) in by_ring.iter().zip(&relative) {
                    for ((sum, light), relative) in sum.iter_mut().zip(light).zip(relative) {
                        *sum += f64::from(*light) * relative;
                    }
                }
                self.to_channels(&sum)
            })
            .collect();
        let mut table = Vec::with_capacity((ABOVE + BELOW) * self.count);
        for (side, count) in [
            (&coarse[..ABOVE / 2 + 1], ABOVE),
            (&coarse[ABOVE / 2 + 1..], BELOW),
        ] {
            for i in 0..count {
                // Every second elevation lies between two of the coarse table.
                let (low, high) = (&side[i / 2], &side[i.div_ceil(2)]);
                table.extend(low.iter().zip(high).map(|(low, high)| 0.5 * (low + high)));
            }
        }
        table
    }

    /// Adds the glow of cities, so that the zenith has a magnitude per square arcsecond; nothing if it is as bright without.
    fn add_city(
        &mut self,
        city: &CityGlow,
        magnitude: f64,
        elevations: &[f64],
    ) -> Result<(), SkyError> {
        let mut zenith = vec![0.0; self.count];
        self.radiance(DVec3::Y, &mut zenith);
        let natural = self.luminance(&zenith);
        let needed = luminance_of_magnitude(magnitude) - natural;
        if needed <= 0.0 {
            return Ok(());
        }
        let altitude_m = self.view.radius_m() - self.sea_level_m;
        let above: Vec<DVec3> = elevations[..ABOVE]
            .iter()
            .map(|rad| axes::direction(0.0, rad.to_degrees()))
            .collect();
        let glow: Vec<Vec<f64>> = city
            .radiance(altitude_m, &above)?
            .into_iter()
            .map(|spectrum| spectrum.iter().map(|v| v * needed).collect())
            .collect();
        for (i, spectrum) in glow.iter().enumerate() {
            let more = self.to_channels(spectrum);
            accumulate(&more, &mut self.scattered[i * self.count..][..self.count]);
        }
        let ground = self.to_channels(&self.ground_under(&glow, elevations));
        for values in self.scattered[ABOVE * self.count..].chunks_exact_mut(self.count) {
            accumulate(&ground, values);
        }
        Ok(())
    }

    /// Radiance of the ground at each wavelength under a glow of the same radiance in all azimuths, given at the tabulated
    /// elevations above the horizon.
    fn ground_under(&self, glow: &[Vec<f64>], elevations: &[f64]) -> Vec<f64> {
        let sky = self.view.sky();
        let albedo = &sky.atmosphere().planet.ground_albedo;
        // Irradiance is the integral of 2 pi L over half the square of the sine of the elevation.
        let squares: Vec<f64> = elevations
            .iter()
            .map(|rad| rad.sin().max(0.0).powi(2))
            .collect();
        let nm = sky.grid().wavelengths_nm().iter().enumerate();
        nm.map(|(k, &nm)| {
            let panels = (1..ABOVE)
                .map(|i| 0.5 * (glow[i][k] + glow[i - 1][k]) * (squares[i] - squares[i - 1]));
            albedo.at(nm) * panels.sum::<f64>()
        })
        .collect()
    }

    fn luminance(&self, values: &[f32]) -> f64 {
        match (self.channels, values) {
            (Channels::Rgb(space), &[r, g, b]) => space.luminance([r, g, b].map(f64::from)),
            _ => self.view.sky().grid().to_xyz(values)[1],
        }
    }

    /// Adds the light along a unit vector to the values of a direction.
    pub fn add_radiance(&self, direction: DVec3, values: &mut [f32]) {
        let through = self.through_fog(direction);
        let elevation_rad = axes::elevation_rad(direction);
        let (cell, t) = self.place(elevation_rad);
        let meets_ground = elevation_rad < self.horizon_rad;
        let amounts = self.glow.amounts(
            direction,
            self.view.radius_m(),
            self.sea_level_m,
            meets_ground,
        );
        let count = self.count;
        for (channel, value) in values.iter_mut().enumerate() {
            let scattered = |cell: usize| self.scattered[cell * count + channel];
            let mut sum = scattered(cell) * (1.0 - t) + scattered(cell + 1) * t;
            for (component, amount) in amounts.iter().enumerate() {
                if *amount > 0.0 {
                    let direct = |cell: usize| {
                        self.direct[(cell * COMPONENTS + component) * count + channel]
                    };
                    sum += *amount as f32 * (direct(cell) * (1.0 - t) + direct(cell + 1) * t);
                }
            }
            *value += through * sum;
        }
    }

    /// [`Self::add_radiance`] for many directions, of which a zero vector is none.
    pub fn add_to(&self, directions: impl Iterator<Item = DVec3>, out: &mut [f32]) {
        let values = out.chunks_exact_mut(self.count);
        for (direction, values) in directions.zip(values) {
            if direction != DVec3::ZERO {
                self.add_radiance(direction, values);
            }
        }
    }

    fn radiance(&self, direction: DVec3, values: &mut [f32]) {
        values.fill(0.0);
        self.add_radiance(direction, values);
    }

    /// Adds the light of the air between the eye and a point: the share of the light that the air scatters along the whole ray
    /// which its opacity up to the point has in that of the whole ray. `transmittance` is that of the air up to the point, `whole`
    /// that of the whole ray.
    pub fn add_path_radiance(
        &self,
        direction: DVec3,
        transmittance: &[f32],
        whole: &[f32],
        path_radiance: &mut [f32],
    ) {
        let (cell, t) = self.place(axes::elevation_rad(direction).max(self.horizon_rad));
        for (channel, value) in path_radiance.iter_mut().enumerate() {
            let scattered = |cell: usize| self.scattered[cell * self.count + channel];
            let all = scattered(cell) * (1.0 - t) + scattered(cell + 1) * t;
            let opaque = (1.0 - transmittance[channel]).clamp(0.0, 1.0);
            let share = (opaque / (1.0 - whole[channel]).max(1e-6)).min(1.0);
            *value += share * all;
        }
    }

    /// Irradiance of surfaces with a unit normal, added to `out`.
    pub fn add_irradiance(&self, normal: DVec3, out: &mut [f32]) {
        let map = self.irradiance.get_or_init(|| {
            parallel::apart(|| {
                IrradianceMap::new(DVec3::Y, self.count, |directions, out| {
                    let values = out.chunks_exact_mut(self.count);
                    for (&direction, values) in directions.iter().zip(values) {
                        self.radiance(direction, values);
                    }
                })
            })
        });
        let mut values = vec![0.0; self.count];
        map.irradiance(normal, &mut values);
        accumulate(&values, out);
    }

    /// Irradiance of an upward-facing horizontal surface.
    pub fn horizontal_irradiance(&self, out: &mut [f32]) {
        const DIRECTIONS: (usize, usize) = (32, 48);
        horizontal_irradiance_of(DIRECTIONS, out, |direction, values| {
            self.radiance(direction, values);
        });
    }

    /// The bright stars above the horizon, dimmed by air and fog.
    pub fn stars(&self, frame: &CelestialFrame) -> StarField {
        let grid = self.view.sky().grid();
        let lowest = self.horizon_rad;
        let seen: Vec<_> = bright_stars()
            .iter()
            .map(|star| (star, frame.to_world(star.equatorial)))
            .filter(|(_, direction)| axes::elevation_rad(*direction) > lowest)
            .collect();
        let light = parallel::map(seen.len(), |i| {
            let (star, direction) = seen[i];
            let scale = star.illuminance_lx() * f64::from(self.through_fog(direction));
            let transmittance = self.view.transmittance_to_space(direction);
            let arriving: Vec<f64> = black_body(grid, star.temperature_k)
                .iter()
                .zip(&transmittance)
                .map(|(v, t)| v * f64::from(*t) * scale)
                .collect();
            self.to_channels(&arriving)
        });
        StarField {
            directions: seen.into_iter().map(|(_, direction)| direction).collect(),
            irradiance: light.concat(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::sky::SunCoverage;

    /// Under an even sky over white ground, air that does not absorb is invisible: what it takes from a ray it scatters into it.
    #[test]
    fn air_without_absorption_is_invisible_under_an_even_sky() {
        let mut scene = Scene::default();
        scene.sun.elevation_deg = Some(-30.0);
        scene.air.aod_550 = Some(0.0);
        scene.air.ozone_du = Some(0.0);
        scene.air.ground_albedo = Some(1.0);
        scene.solver.wavelengths = Some("450,550,650".to_owned());
        let scene = scene.resolve().unwrap();
        let settings = scene.solver.sky_settings(SunCoverage::AboveHorizon);
        let sky = Sky::prepare(&scene.atmosphere, &scene.grid, &settings).unwrap();
        let rings = RingScattering::new(&sky, 2.0, Control::default()).unwrap();
        let eye = sky.view(2.0, DVec3::Y);
        let solar = eye.solar_irradiance();
        let elevations = elevations(horizon_rad(&eye));
        let coarse = (0..ABOVE)
            .step_by(2)
            .chain((ABOVE..ABOVE + BELOW).step_by(2));
        let mut worst = 0.0f32;
        for (by_ring, i) in rings.scattered.iter().zip(coarse) {
            let direction = axes::direction(0.0, elevations[i].to_degrees());
            let transmittance = eye.transmittance_to_space(direction);
            for (lane, solar) in solar.iter().enumerate() {
                let scattered: f32 = by_ring.iter().map(|light| light[lane] / solar).sum();
                let whole = transmittance[lane] + scattered;
                let degrees = elevations[i].to_degrees();
                assert!((whole - 1.0).abs() < 0.01, "{degrees}, {lane}: {whole}");
                worst = worst.max((whole - 1.0).abs());
                if i == ABOVE - 1 && lane == 1 {
                    assert!((scattered - 0.092).abs() < 0.002, "{scattered}");
                }
            }
        }
        println!("worst: {worst}");
    }
}
