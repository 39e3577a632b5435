//! Plots of light and transmittance of the air by wavelength.

use crate::args::{SceneArgs, SpectrumPlotArgs, TransmittancePlotArgs};
use crate::error::CliError;
use crate::interrupt::STOP;
use crate::progress::RowsBar;
use airlight::scene::Scene;
use airlight::sky::Scattering;
use airlight_image::Control;
use airlight_plot::{Axis, Colormap, Curve, HeatMap, heat_map, line_chart};
use airlight_render::probe::{Probe, ProbeAnswer, ProbeRay};

fn wavelength() -> Axis {
    Axis::linear("wavelength, nm")
}

/// The scene of the options, by default at fine wavelengths.
fn read(args: &SceneArgs) -> Result<Scene, CliError> {
    args.read(|scene| {
        scene
            .solver
            .wavelengths
            .get_or_insert_with(|| "fine".to_owned());
    })
}

/// Computes the light along directions; refuses a solver without spectra.
fn probe(scene: &Scene, rays: Vec<ProbeRay>) -> Result<ProbeAnswer, CliError> {
    let bar = RowsBar::by_stages();
    let control = Control::cancelled_by(&STOP).reporting_to(&bar);
    let answer = Probe::new(scene, rays)?.answer(control)?;
    drop(bar);
    match answer.wavelengths_nm.is_empty() {
        true => Err(CliError::usage(format!(
            "--solver: expected one with spectra, got {}; try orders",
            answer.solver
        ))),
        false => Ok(answer),
    }
}

fn ray(azimuth_deg: f64, elevation_deg: f64) -> ProbeRay {
    ProbeRay {
        azimuth_deg,
        elevation_deg,
        distance_m: None,
    }
}

/// Spectral radiance of the sky in directions, or without directions the irradiances by sun and sky.
///
/// # Errors
/// [`CliError`] for options that contradict each other.
pub fn spectrum(args: &SpectrumPlotArgs) -> Result<String, CliError> {
    let rays = args
        .view
        .iter()
        .map(|at| ray(at.azimuth_deg, at.elevation_deg));
    let answer = probe(&read(&args.scene)?, rays.collect())?;
    let curve = |name: String, values: &[f32]| Curve {
        name,
        points: points(&answer, values),
    };
    if args.view.is_empty() {
        let (sun, sky) = (&answer.sun, &answer.sky);
        let all = [
            curve(
                "sun outside the air".to_owned(),
                &sun.irradiance_outside_w_m2_nm,
            ),
            curve(
                "sun, on a surface that faces it".to_owned(),
                &sun.irradiance_normal_w_m2_nm,
            ),
            curve(
                "sky, on a horizontal surface".to_owned(),
                &sky.irradiance_horizontal_w_m2_nm,
            ),
        ];
        let y = Axis::linear("irradiance, W m\u{207b}\u{b2} nm\u{207b}\u{b9}");
        return Ok(line_chart(&wavelength(), &y, &all)?);
    }
    let all: Vec<Curve> = answer
        .views
        .iter()
        .map(|view| {
            let name = format!(
                "azimuth {}, elevation {} degrees",
                view.azimuth_deg, view.elevation_deg
            );
            curve(name, &view.radiance_w_m2_sr_nm)
        })
        .collect();
    let y = Axis::linear("radiance, W m\u{207b}\u{b2} sr\u{207b}\u{b9} nm\u{207b}\u{b9}");
    Ok(line_chart(&wavelength(), &y, &all)?)
}

/// Transmittance of the air from the eye to space, for zenith angles or as a map.
///
/// # Errors
/// [`CliError`] for options that contradict each other.
pub fn transmittance(args: &TransmittancePlotArgs) -> Result<String, CliError> {
    let mut scene = read(&args.scene)?;
    // The transmittance does not depend on the sun.
    if scene.sun.latitude_deg.is_none() {
        scene.sun.elevation_deg.get_or_insert(45.0);
    }
    scene.solver.scattering = Some(Scattering::Single);
    const STEP_DEG: f64 = 1.5;
    let zenith_deg = match args.map {
        true => (0..=60).map(|i| f64::from(i) * STEP_DEG).collect(),
        false => args.zenith_deg.clone(),
    };
    let rays = zenith_deg.iter().map(|deg| ray(0.0, 90.0 - deg)).collect();
    let answer = probe(&scene, rays)?;
    let transmittances = answer.views.iter().map(|view| {
        let values = view.transmittance.as_deref();
        points(&answer, values.unwrap_or_default())
    });
    if args.map {
        let data = HeatMap {
            values: transmittances
                .map(|points| points.into_iter().map(|p| p.1).collect())
                .collect(),
            x: answer.wavelengths_nm.clone(),
            y: zenith_deg,
        };
        let zenith = Axis::linear("zenith angle, degrees");
        return Ok(heat_map(
            (&wavelength(), &zenith),
            &data,
            ("transmittance", &Colormap::sequential(1.0)),
            &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9],
        )?);
    }
    let all: Vec<Curve> = zenith_deg
        .iter()
        .zip(transmittances)
        .map(|(deg, points)| Curve {
            name: format!("zenith angle {deg} degrees"),
            points,
        })
        .collect();
    let y = Axis::linear("transmittance to space").with_range(0.0, 1.0);
    Ok(line_chart(&wavelength(), &y, &all)?)
}

fn points(answer: &ProbeAnswer, values: &[f32]) -> Vec<(f64, f64)> {
    let wavelengths = answer.wavelengths_nm.iter().copied();
    wavelengths
        .zip(values.iter().map(|&v| f64::from(v)))
        .collect()
}
