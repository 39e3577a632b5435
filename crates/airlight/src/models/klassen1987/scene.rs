//! Naturally lit fog, and objects in it, under the sun and sky of Klassen 1987 (sections 9 to 12, eqs. 34 to 47).
//!
//! [`Slab1987`] is the paper's slab of fog; here it is lit by the sun and seen in front of the sky of this model. As in
//! section 12, the irradiance at the top of the fog, `I_t`, is that of the sun at the ground without the fog (eq. 22). Then
//! only the fog itself, some tens of metres high, is assumed to lie on flat ground: the error is below 1 % down to a sun at
//! 1 degree (test `error_of_flat_ground_is_below_a_percent`), whereas the paper states 15 degrees for eqs. 37 and 44.
//!
//! Choices that the paper leaves open:
//! - The ambient term `A` of eqs. 36 to 47 has no value. Here it is the reflected light of sky, fog and ground of the model
//!   itself ([`crate::scene::IrradianceMap`]).
//! - With the sun at the horizon the fog has one colour, that of direct sunlight (section 11.2), without a stated radiance.
//!   Here, for suns below [`SUNSET_DEG`], it is the irradiance of sun and sky on a horizontal surface, emitted uniformly in
//!   all directions.
//! - Without fog there are haze and air in front of objects (eq. 45), and objects are lit by `I_t`.

use super::Klassen1987;
use super::lanes::{Lanes, WAVELENGTHS, to_xyz, wavelengths_nm};
use super::settings::{HazePhase, Klassen1987Error};
use super::simpson::Simpson;
use crate::atmosphere::{Constituent, DensityProfile, RaySegment};
use crate::axes;
use crate::control::Control;
use crate::fog::LayerLanes;
use crate::models::PublishedModel;
use crate::models::klassen1987::fog::{Slab1987, SunDepth};
use crate::optics::{Depolarization, PhaseFunction};
use crate::scene::IrradianceMap;
use crate::spectrum::{Spectrum, WavelengthGrid};
use crate::sun::SunDisc;
use crate::transfer::PathOptics;
use glam::DVec3;
use std::f32::consts::PI;
use std::sync::Arc;

/// Elevation of the sun below which the fog has one colour, degrees: there the error of flat ground exceeds 1 % for 50 m of
/// fog.
pub const SUNSET_DEG: f64 = 1.0;
/// Length that stands for an infinite ray, m: opaque in any fog.
const FARTHEST_M: f64 = 1e9;

/// Sun, sky, fog and ground of Klassen 1987 for an eye at a height.
#[derive(Clone, Debug)]
pub struct Klassen1987Scene {
    model: Arc<Klassen1987>,
    eye_height_m: f64,
    depth: SunDepth,
    /// The fog with its sunlight; without fog, haze and air at the ground.
    slab: Slab1987<WAVELENGTHS>,
    foggy: bool,
    /// Radiance of the horizontal ground, W m^-2 sr^-1 nm^-1.
    ground: Lanes,
    /// Radiance of the fog with the sun at the horizon; `None` for higher suns.
    evening: Option<Lanes>,
}

/// Fog of Klassen 1987.
#[derive(Clone, Debug, PartialEq)]
pub struct Fog1987 {
    /// Height of its top, `R_H - R_E`, m.
    pub top_m: f64,
    /// Droplets, whose coefficients and phase function are evaluated at the model's wavelengths
    /// ([`Klassen1987::wavelengths`]).
    pub droplets: Constituent,
}

impl Klassen1987Scene {
    /// Scene for an eye at a height above the ground (m, not negative), with or without fog; `depth` selects the path of
    /// sunlight through the fog.
    ///
    /// # Errors
    /// [`Klassen1987Error`] if a number is outside its domain.
    pub fn new(
        model: Arc<Klassen1987>,
        eye_height_m: f64,
        fog: Option<Fog1987>,
        depth: SunDepth,
    ) -> Result<Self, Klassen1987Error> {
        let number = |what, right, got: f64, fits: bool| match fits {
            true => Ok(()),
            false => Err(Klassen1987Error::Number { what, right, got }),
        };
        let fits = (0.0..=1e6).contains(&eye_height_m);
        number("the eye's height (m)", "from 0 to 1e6", eye_height_m, fits)?;
        if let Some(fog) = &fog {
            let fits = (1e-3..=1e5).contains(&fog.top_m);
            number("the fog's top (m)", "from 0.001 to 1e5", fog.top_m, fits)?;
            LayerLanes::new(&fog.droplets, &Klassen1987::wavelengths()).validate()?;
        }
        let foggy = fog.is_some();
        let slab = slab(&model, fog)?;
        let planet_albedo = &model.settings.clear_air.planet.ground_albedo;
        let albedo = Klassen1987::wavelengths().map(|nm| planet_albedo.at(nm) as f32);
        let albedo = Spectrum(albedo);
        let mut scene = Self {
            eye_height_m,
            depth: match foggy {
                true => depth,
                // No air lies above, so the light is the same along the whole ray.
                false => SunDepth::Printed,
            },
            slab,
            foggy,
            ground: Lanes::ZERO,
            evening: None,
            model,
        };
        let level = |irradiance: Lanes| irradiance * scene.model.sin_sun as f32;
        if foggy && axes::elevation_deg(scene.model.sun) < SUNSET_DEG {
            let sky = scene.horizontal_irradiance(|d| scene.sky_alone(d));
            scene.evening = Some((level(scene.slab.irradiance_at_top()) + sky) / PI);
        }
        // The ground is lit from above; its own light is 0 in this computation.
        let on_ground = Self {
            eye_height_m: 0.0,
            ..scene.clone()
        };
        let even = scene.horizontal_irradiance(|d| on_ground.around(d));
        scene.ground = (level(scene.sunlight(0.0)) + even) * albedo / PI;
        Ok(scene)
    }

    /// Irradiance of a horizontal surface by a radiance.
    fn horizontal_irradiance(&self, radiance: impl Fn(DVec3) -> Lanes + Sync) -> Lanes {
        let map = IrradianceMap::new(self.model.sun, WAVELENGTHS, |directions, out| {
            for (direction, out) in directions.iter().zip(out.chunks_exact_mut(WAVELENGTHS)) {
                out.copy_from_slice(&radiance(*direction).0);
            }
        });
        let mut lanes = Lanes::ZERO;
        map.irradiance(DVec3::Y, &mut lanes.0);
        lanes
    }

    /// The same scene for an eye at another height, m.
    pub fn at_height_m(&self, eye_height_m: f64) -> Self {
        Self {
            eye_height_m,
            ..self.clone()
        }
    }

    /// Radiance of the sun's disc, attenuated by the fog.
    fn disc_along(&self, direction: DVec3) -> Lanes {
        let disc = self.model.disc_along(direction);
        match self.foggy {
            true => self.fog_on(direction, FARTHEST_M).transmittance * disc,
            false => disc,
        }
    }

    /// The sky without fog, W m^-2 sr^-1 nm^-1; black below the horizon.
    fn sky_alone(&self, direction: DVec3) -> Lanes {
        match direction.y < 0.0 {
            true => Lanes::ZERO,
            false => self.behind(direction, &mut Simpson::new(0.0)),
        }
    }

    /// Radiance behind the fog: sky or ground.
    fn behind(&self, direction: DVec3, simpson: &mut Simpson) -> Lanes {
        if direction.y < 0.0 {
            return self.ground;
        }
        let (sin_elevation, cos_sun) = self.model.angles(direction);
        self.model.radiance_along(sin_elevation, cos_sun, simpson)
    }

    fn seen(&self, direction: DVec3, simpson: &mut Simpson) -> Lanes {
        let behind = self.behind(direction, simpson);
        if direction.y < 0.0 {
            let ground_m = (self.eye_height_m / -direction.y).min(FARTHEST_M);
            return self.before(direction, ground_m).apply(behind);
        }
        match self.foggy {
            true => self.fog_on(direction, FARTHEST_M).apply(behind),
            false => behind,
        }
    }

    /// Path optics of the fog on a ray from the eye.
    fn fog_on(&self, direction: DVec3, length_m: f64) -> PathOptics<WAVELENGTHS> {
        let line = RaySegment::flat(self.eye_height_m, direction.y, length_m);
        let (enters, leaves) = line.below(self.slab.fog_top_m);
        if enters >= leaves {
            return PathOptics::CLEAR;
        }
        let length_m = leaves - enters;
        match self.evening {
            Some(colour) => self.slab.in_fog_at_sunset(length_m, colour),
            None => self.slab.in_fog(
                line.height_at(enters).min(self.slab.fog_top_m),
                direction.y,
                length_m,
                direction.dot(self.model.sun),
                self.depth,
            ),
        }
    }
}

/// The fog with the irradiance `I_t` at its top; without fog, haze and air at the ground with the irradiance there.
fn slab(
    model: &Klassen1987,
    fog: Option<Fog1987>,
) -> Result<Slab1987<WAVELENGTHS>, Klassen1987Error> {
    let top_m = fog.as_ref().map_or(0.0, |fog| fog.top_m);
    Ok(Slab1987 {
        fog_top_m: top_m,
        // The sun's irradiance is already that at the top.
        air_top_m: top_m,
        fog: match fog {
            Some(fog) => LayerLanes::new(&fog.droplets, &Klassen1987::wavelengths()),
            None => model.haze_at_ground()?,
        },
        air: LayerLanes {
            density: DensityProfile::Uniform,
            extinction_per_m: model.air_per_m,
            scattering_per_m: model.air_per_m,
            phase: PhaseFunction::Rayleigh(Depolarization::None),
            wavelengths_nm: Klassen1987::wavelengths(),
        },
        sun_irradiance: model.attenuated_sun(model.sin_sun),
        sin_sun: model.sin_sun.max(1e-6),
    })
}

impl Klassen1987 {
    /// The model's wavelengths, nm.
    pub fn wavelengths() -> [f64; WAVELENGTHS] {
        let mut nm = wavelengths_nm();
        std::array::from_fn(|_| nm.next().unwrap_or(f64::NAN))
    }

    /// Haze with its density at the ground.
    fn haze_at_ground(&self) -> Result<LayerLanes<WAVELENGTHS>, Klassen1987Error> {
        let (_, albedo, phase) = self.settings.haze.optics(Control::default())?;
        let albedo = Self::wavelengths().map(|nm| albedo.at(nm).clamp(0.0, 1.0) as f32);
        Ok(LayerLanes {
            density: DensityProfile::Uniform,
            extinction_per_m: self.haze.extinction_per_m,
            scattering_per_m: self.haze.extinction_per_m * Spectrum(albedo),
            wavelengths_nm: Self::wavelengths(),
            phase: match self.settings.phase {
                HazePhase::Particles => phase,
                HazePhase::HenyeyGreenstein { g } | HazePhase::Printed { g } => {
                    PhaseFunction::HenyeyGreenstein { g }
                }
            },
        })
    }
}

impl Klassen1987Scene {
    /// Irradiance of the sun's disc at a height (m), on a surface that faces it: eqs. 34, 36 and 38 under `I_t`.
    pub fn sunlight(&self, height_m: f64) -> Lanes {
        match (self.foggy, self.evening) {
            (false, _) => self.slab.irradiance_at_top(),
            (true, None) => self.slab.irradiance_at(height_m),
            // Section 11.2: all direct sunlight is scattered.
            (true, Some(_)) if height_m < self.slab.fog_top_m => Lanes::ZERO,
            (true, Some(_)) => self.slab.irradiance_at_top(),
        }
    }

    /// Air above the fog, and fog, in front of a point at a distance (eqs. 39 to 46); without fog, haze and air.
    pub fn before(&self, direction: DVec3, distance_m: f64) -> PathOptics<WAVELENGTHS> {
        let cos_sun = direction.dot(self.model.sun);
        let (eye_m, sin_elevation) = (self.eye_height_m, direction.y);
        match self.foggy {
            false => self
                .slab
                .in_fog(eye_m, sin_elevation, distance_m, cos_sun, self.depth),
            true if self.evening.is_none() => {
                self.slab
                    .along(eye_m, sin_elevation, distance_m, cos_sun, self.depth)
            }
            true => self.fog_on(direction, distance_m),
        }
    }

    /// Radiance that arrives from a direction, without the sun's disc.
    pub fn around(&self, direction: DVec3) -> Lanes {
        self.seen(direction, &mut Simpson::new(0.0))
    }
}

impl PublishedModel for Klassen1987Scene {
    fn sun(&self) -> DVec3 {
        self.model.sun
    }

    fn disc(&self) -> &SunDisc {
        self.model.disc()
    }

    fn has_ground(&self) -> bool {
        true
    }

    fn sky_xyz(&self, direction: DVec3) -> [f64; 3] {
        to_xyz(&self.model.grid, &self.around(direction))
    }

    fn disc_xyz(&self, direction: DVec3) -> [f64; 3] {
        to_xyz(&self.model.grid, &self.disc_along(direction))
    }

    /// Without fog within one step of a picture with the model's bits per channel; with fog as [`Self::sky_xyz`], except that
    /// integrals with nearly equal first estimates are reused.
    fn walk(&self) -> Box<dyn FnMut(DVec3) -> [f64; 3] + '_> {
        if self.foggy {
            let mut simpson = Simpson::new(1e-3);
            return Box::new(move |direction| {
                to_xyz(&self.model.grid, &self.seen(direction, &mut simpson))
            });
        }
        let mut sky = self.model.walk();
        Box::new(move |direction| match direction.y < 0.0 {
            true => self.sky_xyz(direction),
            false => sky(direction),
        })
    }

    fn grid(&self) -> Option<&WavelengthGrid> {
        Some(&self.model.grid)
    }

    fn sky_spectrum(&self, direction: DVec3) -> Vec<f64> {
        super::f64s(&self.around(direction))
    }

    fn disc_spectrum(&self, direction: DVec3) -> Vec<f64> {
        super::f64s(&self.disc_along(direction))
    }

    fn path(&self, direction: DVec3, distance_m: f64) -> Option<(Vec<f32>, Vec<f64>)> {
        let optics = self.before(direction, distance_m);
        Some((
            optics.transmittance.0.to_vec(),
            super::f64s(&optics.path_radiance),
        ))
    }

    fn sunlight(&self, height_m: f64) -> Option<Vec<f64>> {
        Some(super::f64s(&Klassen1987Scene::sunlight(self, height_m)))
    }
}

#[cfg(test)]
mod tests;
