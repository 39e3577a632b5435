//! What the shaders of Hillaire 2020 are given: the air, and what a frame is drawn for.

use airlight::atmosphere::{Atmosphere, Constituent, ConstituentKind, DensityProfile};
use airlight::glam::{DVec3, Vec3};
use airlight::optics::PhaseFunction;
use airlight::spectrum::{RgbSpace, WavelengthGrid};
use airlight_gpu::{Camera, Projection};

/// Wavelengths whose light is taken as red, green and blue, nm.
const RGB_NM: [f64; 3] = [680.0, 550.0, 440.0];
/// The shaders' unit of length, m.
const KM: f64 = 1e3;

/// Error of [`HillairePasses`](super::HillairePasses).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HillairePassesError {
    /// The shaders have no such air.
    #[error(
        "expected molecules and aerosol that thin exponentially from the ground on, the aerosol with a Cornette-Shanks phase function, and \
         a tent of ozone, got {0}; try Preset::Hillaire"
    )]
    Air(String),
    /// The eye is not in the air.
    #[error(
        "expected an eye above the ground and below the top of the air at {top_m} m, got {height_m} m"
    )]
    Eye {
        /// Height of the eye above the ground, m.
        height_m: f64,
        /// Height of the top of the air, m.
        top_m: f64,
    },
    /// The direction to the sun has no length.
    #[error("expected a direction to the sun, got {0}")]
    Sun(DVec3),
    /// The volume of aerial perspective is that of a perspective view.
    #[error("expected a perspective camera")]
    Projection,
}

/// The air of the shaders, and its sunlight.
#[derive(Debug)]
pub struct Air {
    ground_radius_m: f64,
    top_m: f64,
    /// Red, green and blue of sunlight outside the air, lx.
    sunlight: [f64; 3],
    sun_radius_rad: f64,
    /// The numbers of the shaders' struct `Air`.
    pub numbers: Vec<f32>,
}

impl Air {
    /// The air of an atmosphere with the three constituents of the paper.
    pub fn new(atmosphere: &Atmosphere) -> Result<Self, HillairePassesError> {
        let part = |kind: &ConstituentKind| {
            let missing = || HillairePassesError::Air(format!("no constituent {kind:?}"));
            atmosphere.constituent(kind).ok_or_else(missing)
        };
        let molecules = part(&ConstituentKind::Molecules)?;
        let aerosol = part(&ConstituentKind::Aerosol)?;
        let ozone = part(&ConstituentKind::Ozone)?;
        if let Some(other) = atmosphere.constituents.get(3) {
            let other = format!("a constituent {:?} as well", other.kind);
            return Err(HillairePassesError::Air(other));
        }
        let planet = &atmosphere.planet;
        let per_km = |of: &dyn Fn(f64) -> f64| RGB_NM.map(|nm| KM * of(nm));
        let scattering = |part: &Constituent| per_km(&|nm| part.scattering_per_m.at(nm));
        let extinction = |part: &Constituent| per_km(&|nm| part.extinction_per_m(nm));
        let [bottom, peak, top] = tent_m(ozone)?.map(|height_m| height_m / KM);
        let mut numbers = Vec::new();
        let mut add = |rgb: [f64; 3], more: f64| {
            numbers.extend(rgb.into_iter().chain([more]).map(|v| v as f32));
        };
        add(scattering(molecules), KM / scale_height_m(molecules)?);
        add(scattering(aerosol), KM / scale_height_m(aerosol)?);
        add(extinction(aerosol), asymmetry(aerosol)?);
        add(extinction(ozone), bottom);
        add(RGB_NM.map(|nm| planet.ground_albedo.at(nm)), peak);
        let ground_radius_m = planet.radius_m + planet.ground_altitude_m;
        let top_m = planet.top_altitude_m - planet.ground_altitude_m;
        add([top, ground_radius_m / KM, top_m / KM], 0.0);
        // All of the light of the sun, which the three wavelengths share as real-time programs have it.
        let grid = WavelengthGrid::standard().with_solar(&atmosphere.solar_irradiance);
        let solar: Vec<f32> = grid.solar_irradiance().iter().map(|&e| e as f32).collect();
        Ok(Self {
            ground_radius_m,
            top_m,
            sunlight: RgbSpace::Srgb.from_xyz(grid.to_xyz(&solar)),
            sun_radius_rad: atmosphere.sun.angular_radius_rad,
            numbers,
        })
    }

    /// The numbers of the shaders' struct `View`.
    pub fn view_numbers(
        &self,
        height_m: f64,
        sun: DVec3,
        camera: &Camera,
    ) -> Result<Vec<f32>, HillairePassesError> {
        let top_m = self.top_m;
        if !(height_m >= 0.0 && height_m < top_m) {
            return Err(HillairePassesError::Eye { height_m, top_m });
        }
        let sun = sun.try_normalize().ok_or(HillairePassesError::Sun(sun))?;
        let Projection::Perspective {
            world_from_clip,
            far_depth,
        } = camera.projection()
        else {
            return Err(HillairePassesError::Projection);
        };
        let horizon = -(2.0 * self.ground_radius_m * height_m + height_m * height_m)
            .sqrt()
            .atan2(self.ground_radius_m);
        let cos_radius = self.sun_radius_rad.cos();
        let solid_angle = std::f64::consts::TAU * (1.0 - cos_radius);
        let sunlight = Vec3::from(self.sunlight.map(|v| v as f32)) * camera.exposure();
        let mut numbers = world_from_clip.to_cols_array().to_vec();
        numbers.extend(sun.as_vec3().extend((height_m / KM) as f32).to_array());
        numbers.extend(sunlight.extend(horizon as f32).to_array());
        numbers.extend([
            far_depth,
            cos_radius as f32,
            (1.0 / solid_angle) as f32,
            0.0,
        ]);
        Ok(numbers)
    }
}

fn scale_height_m(part: &Constituent) -> Result<f64, HillairePassesError> {
    match part.density {
        DensityProfile::Exponential {
            reference_height_m: 0.0,
            scale_height_m,
        } => Ok(scale_height_m),
        _ => Err(refused(part)),
    }
}

fn asymmetry(part: &Constituent) -> Result<f64, HillairePassesError> {
    match part.phase {
        PhaseFunction::CornetteShanks { g } => Ok(g),
        _ => Err(refused(part)),
    }
}

/// Heights of the corners of a tent.
fn tent_m(part: &Constituent) -> Result<[f64; 3], HillairePassesError> {
    match part.density {
        DensityProfile::Tent {
            bottom_m,
            peak_m,
            top_m,
        } => Ok([bottom_m, peak_m, top_m]),
        _ => Err(refused(part)),
    }
}

fn refused(part: &Constituent) -> HillairePassesError {
    HillairePassesError::Air(format!(
        "{:?} with the density {:?} and the phase function {:?}",
        part.kind, part.density, part.phase
    ))
}
