//! Light and transmittance of the air by wavelength.

use super::Chart;
use crate::args::{AirArgs, PlaceArgs, ScatteringArg, SpectrumPlotArgs, TransmittancePlotArgs};
use crate::error::CliError;
use crate::scene::Scene;
use airlight::axes;
use airlight::sky::TableChannels;
use airlight_plot::{Axis, Colormap, Curve, HeatMap, heat_map, line_chart};
use glam::DVec3;

fn wavelength() -> Axis {
    Axis::linear("wavelength, nm")
}

/// Spectral radiance of the sky in directions, or without any the irradiances of sun and sky.
///
/// # Errors
/// [`CliError`] for options that do not fit together.
pub fn spectrum(args: &SpectrumPlotArgs) -> Result<Chart, CliError> {
    let scene = Scene::new(&args.place, &args.air)?;
    args.air.refuse_other_solvers("airlight plot")?;
    let sun = scene.sun.at(None)?;
    let (sky, _) = scene.prepare(scene.near(&sun))?;
    let view = scene.view(&sky, &sun);
    let curve = |name: String, values: Vec<f32>| Curve {
        name,
        points: points(&scene, values),
    };
    if args.view.is_empty() {
        let sky_light = view.table(TableChannels::Spectral).irradiance(DVec3::Y);
        let all = [
            curve("sun outside the air".to_owned(), view.solar_irradiance()),
            curve(
                "sun, on a surface that faces it".to_owned(),
                view.sun_irradiance(),
            ),
            curve("sky, on the horizontal".to_owned(), sky_light),
        ];
        let y = Axis::linear("irradiance, W m\u{207b}\u{b2} nm\u{207b}\u{b9}");
        return Ok(line_chart(&wavelength(), &y, &all));
    }
    let all: Vec<Curve> = args
        .view
        .iter()
        .map(|at| {
            let direction = axes::direction(at.azimuth_deg, at.elevation_deg);
            let name = format!(
                "azimuth {}, elevation {} degrees",
                at.azimuth_deg, at.elevation_deg
            );
            curve(name, view.along(direction, None).radiance())
        })
        .collect();
    let y = Axis::linear("radiance, W m\u{207b}\u{b2} sr\u{207b}\u{b9} nm\u{207b}\u{b9}");
    Ok(line_chart(&wavelength(), &y, &all))
}

/// Transmittance of the air from the eye to space, for zenith angles or as a map over them.
///
/// # Errors
/// [`CliError`] for options that do not fit together.
pub fn transmittance(args: &TransmittancePlotArgs) -> Result<Chart, CliError> {
    // Whatever sun: it is the air alone that counts.
    let place = PlaceArgs {
        sun_elevation: args
            .place
            .sun_elevation
            .or(args.place.at.is_none().then_some(45.0)),
        ..args.place.clone()
    };
    let air = AirArgs {
        scattering: ScatteringArg::Single,
        ..args.air.clone()
    };
    let scene = Scene::new(&place, &air)?;
    args.air.refuse_other_solvers("airlight plot")?;
    let sun = scene.sun.at(None)?;
    let (sky, _) = scene.prepare(scene.near(&sun))?;
    let view = scene.view(&sky, &sun);
    let at = |zenith_deg: f64| {
        points(
            &scene,
            view.transmittance_to_space(axes::direction(0.0, 90.0 - zenith_deg)),
        )
    };
    if args.map {
        const STEP_DEG: f64 = 1.5;
        let zenith_deg: Vec<f64> = (0..=60).map(|i| f64::from(i) * STEP_DEG).collect();
        let values = zenith_deg
            .iter()
            .map(|&deg| at(deg).into_iter().map(|p| p.1).collect());
        let data = HeatMap {
            values: values.collect(),
            x: scene.grid.wavelengths_nm().to_vec(),
            y: zenith_deg,
        };
        let zenith = Axis::linear("zenith angle, degrees");
        return Ok(heat_map(
            (&wavelength(), &zenith),
            &data,
            ("transmittance", &Colormap::sequential(1.0)),
            &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9],
        ));
    }
    let all: Vec<Curve> = args
        .zenith_deg
        .iter()
        .map(|&deg| Curve {
            name: format!("zenith angle {deg} degrees"),
            points: at(deg),
        })
        .collect();
    let y = Axis::linear("transmittance to space").with_range(0.0, 1.0);
    Ok(line_chart(&wavelength(), &y, &all))
}

fn points(scene: &Scene, values: Vec<f32>) -> Vec<(f64, f64)> {
    let wavelengths = scene.grid.wavelengths_nm().iter().copied();
    wavelengths.zip(values.into_iter().map(f64::from)).collect()
}
