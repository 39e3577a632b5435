//! What published models tell. Those that know colours only have no wavelengths, and their spectra are empty lists; what a model
//! does not tell is none.

use super::values::{Answer, FORMAT, Observer, SkyLight, SunLight, ViewLight};
use super::views::AskedView;
use crate::args::{ProbeArgs, SolverArg, VariantArg};
use crate::error::CliError;
use crate::models::Lit;
use crate::progress::Busy;
use crate::scene::{Scene, Sun};
use crate::sky::{SOFTWARE, space_name, space_of};
use airlight::axes;
use airlight::spectrum::RgbSpace;
use rayon::prelude::*;

/// Refuses lines that end before the air does where a model does not know what is scattered there.
///
/// # Errors
/// [`CliError::Usage`]: what would be right.
pub fn check(args: &ProbeArgs, views: &[AskedView]) -> Result<(), CliError> {
    let solver = args.air.solver;
    let ends = views.iter().any(|view| view.distance_m.is_some());
    match ends && !solver.has_distances() {
        false => Ok(()),
        true => Err(CliError::usage(format!(
            "--solver {} tells the light of the sky, not of the air before a thing: leave out --distance-m, and distance_m in \
             --views, or give one of {}",
            solver.name(),
            SolverArg::names(SolverArg::has_distances)
        ))),
    }
}

/// The whole answer.
///
/// # Errors
/// [`CliError::Usage`] for what the model refuses.
pub fn answer(args: &ProbeArgs, scene: &Scene, views: &[AskedView]) -> Result<Answer, CliError> {
    let _busy = Busy::with("computing");
    let sun = scene.sun.at(None)?;
    let lit = crate::models::lit(&args.air, &args.model, scene, &sun)?;
    let solver = args.air.solver;
    let variant = args.model.variant_of(solver);
    let space = space_of(args.color_space);
    Ok(Answer {
        format: FORMAT,
        program: SOFTWARE,
        // The article has air of its own.
        atmosphere: (solver != SolverArg::SingleScattering).then(|| scene.atmosphere.name.clone()),
        scattering: match (solver, variant) {
            (SolverArg::Hillaire2020, _) => Some(scene.scattering_name()),
            (SolverArg::SingleScattering, Some(VariantArg::Multiple)) => Some("all"),
            (SolverArg::SingleScattering, _) => Some("single"),
            _ => None,
        },
        solver: solver.name(),
        is_of_model: true,
        variant: variant.as_ref().map(crate::parse::name),
        color_space: space_name(space),
        wavelengths_nm: lit.model.wavelengths_nm().to_vec(),
        observer: Observer::of(scene),
        sun: sun_light(&lit, &sun),
        sky: SkyLight {
            irradiance_horizontal_w_m2_nm: lanes(&lit.sky_horizontal.spectrum),
            illuminance_horizontal_lx: lit.sky_horizontal.xyz[1],
        },
        views: views
            .par_iter()
            .map(|asked| view_light(&lit, asked, space))
            .collect(),
    })
}

fn sun_light(lit: &Lit, sun: &Sun) -> SunLight {
    let light = lit.illuminances();
    let sine = lit.sin_sun();
    let outside = lit.model.grid().map(|grid| lanes(grid.solar_irradiance()));
    let normal = &lit.sun_normal.spectrum;
    let horizontal: Vec<f64> = normal.iter().map(|e| e * sine).collect();
    SunLight {
        azimuth_deg: sun.azimuth_deg,
        elevation_deg: sun.elevation_deg,
        geometric_elevation_deg: sun.geometric_elevation_deg,
        distance_ratio: sun.distance_ratio,
        angular_radius_deg: lit.model.disc_edge_rad().to_degrees(),
        irradiance_outside_w_m2_nm: outside.unwrap_or_default(),
        irradiance_normal_w_m2_nm: lanes(normal),
        irradiance_horizontal_w_m2_nm: lanes(&horizontal),
        illuminance_normal_lx: light.sun_normal_lx,
        illuminance_horizontal_lx: light.sun_horizontal_lx,
    }
}

fn view_light(lit: &Lit, asked: &AskedView, space: RgbSpace) -> ViewLight {
    let direction = axes::direction(asked.azimuth_deg, asked.elevation_deg);
    let line = lit.model.line(direction, asked.distance_m);
    let (radiance, xyz) = match (&line, lit.model.grid()) {
        (Some(line), Some(grid)) => (line.radiance(), grid.to_xyz(&line.radiance())),
        _ => {
            let light = lit.along(direction);
            (lanes(&light.spectrum), light.xyz)
        }
    };
    let meets_ground = match &line {
        Some(line) => line.meets_ground,
        None => direction.y < 0.0,
    };
    let (single, multiple, ground, transmittance) = match line {
        Some(line) => (
            Some(line.single),
            Some(line.multiple),
            Some(line.ground),
            Some(line.transmittance),
        ),
        None => (None, None, None, None),
    };
    ViewLight {
        azimuth_deg: asked.azimuth_deg,
        elevation_deg: asked.elevation_deg,
        distance_m: asked.distance_m,
        meets_ground,
        sun_angle_deg: direction.angle_between(lit.model.sun()).to_degrees(),
        radiance_w_m2_sr_nm: radiance,
        radiance_single_w_m2_sr_nm: single,
        radiance_multiple_w_m2_sr_nm: multiple,
        radiance_ground_w_m2_sr_nm: ground,
        transmittance,
        xyz_cd_m2: xyz,
        rgb_cd_m2: space.from_xyz(xyz),
        luminance_cd_m2: xyz[1],
        monte_carlo: None,
    }
}

fn lanes(values: &[f64]) -> Vec<f32> {
    values.iter().map(|&v| v as f32).collect()
}
