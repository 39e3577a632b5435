//! Plots of phase functions and scattering efficiencies.

use crate::args::{EfficiencyPlotArgs, Index, PhasePlotArgs};
use crate::error::CliError;
use crate::progress::Busy;
use airlight::atmosphere::{Constituent, DensityProfile};
use airlight::fog::droplets::DropletKind;
use airlight::optics::RefractiveIndex;
use airlight::optics::mie::{Complex64, MieError, Particles, SizeDistribution, Sphere};
use airlight_plot::{Axis, Curve, line_chart, polar_plot};
use std::f64::consts::{PI, TAU};

/// Effective variance of the sizes over which the oscillations of single spheres are smoothed.
const VARIANCE: f64 = 0.1;

/// Phase functions, or angular patterns of single spheres.
///
/// # Errors
/// [`CliError`] if no particles are given or they are invalid.
pub fn phase(args: &PhasePlotArgs) -> Result<String, CliError> {
    if args.droplets.is_empty() && args.size_parameter.is_empty() {
        return Err(CliError::usage(
            "expected particles, got none; try --droplets KIND,... or --size-parameter X,...",
        ));
    }
    let busy = Busy::with("summing over spheres");
    let mut curves = Vec::new();
    for &droplets in &args.droplets {
        for &nm in &args.wavelength_nm {
            curves.push(of_drops(droplets, nm)?);
        }
    }
    for &x in &args.size_parameter {
        curves.push(of_sphere(x, args.index, args.polar)?);
    }
    drop(busy);
    if args.polar {
        return Ok(polar_plot(&curves)?);
    }
    let degrees = |points: &mut Vec<(f64, f64)>| {
        points.truncate(points.len() / 2 + 1);
        points.iter_mut().for_each(|p| p.0 = p.0.to_degrees());
    };
    curves
        .iter_mut()
        .for_each(|curve| degrees(&mut curve.points));
    let x = Axis::linear("scattering angle, degrees");
    let y = Axis::logarithmic("phase function, 1/sr");
    Ok(line_chart(&x, &y, &curves)?)
}

/// Angles over the full circle (rad), in steps that resolve features of a width.
fn angles(width: f64) -> Vec<f64> {
    let half = ((PI / width).ceil() as usize).clamp(360, 7200);
    (0..=2 * half)
        .map(|i| PI * i as f64 / half as f64)
        .collect()
}

fn of_drops(kind: DropletKind, nm: f64) -> Result<Curve, CliError> {
    let layer = Constituent::fog(1.0, kind, DensityProfile::Uniform, &[nm])?;
    let point = |angle: f64| (angle, layer.phase.evaluate(angle.cos(), nm));
    Ok(Curve {
        name: format!("{kind}, {nm} nm"),
        points: angles(PI / 1800.0).into_iter().map(point).collect(),
    })
}

/// Phase function of a sphere, or its scattered intensity `(|S_1|^2 + |S_2|^2) / 2`: the differential cross-section times the
/// squared wave number.
fn of_sphere(x: f64, index: Index, pattern: bool) -> Result<Curve, CliError> {
    let sphere = Sphere::new(x, Complex64::new(index.real, index.imaginary))?;
    let value = |angle: f64| match pattern {
        true => {
            let [s1, s2] = sphere.amplitudes(angle.cos());
            0.5 * (s1.norm_sqr() + s2.norm_sqr())
        }
        false => sphere.phase(angle.cos()),
    };
    let angles = angles(0.3 / x);
    Ok(Curve {
        name: match pattern {
            true => format!("size parameter {x}, by (|S1|^2 + |S2|^2) / 2"),
            false => format!("size parameter {x}"),
        },
        points: angles
            .into_iter()
            .map(|angle| (angle, value(angle)))
            .collect(),
    })
}

/// Efficiencies of single spheres, and the mean over sizes.
///
/// # Errors
/// [`CliError`] for invalid particles.
pub fn efficiency(args: &EfficiencyPlotArgs) -> Result<String, CliError> {
    const STEPS: usize = 2500;
    const SMOOTH_STEPS: usize = 120;
    let _busy = Busy::with("summing over spheres");
    let index = Complex64::new(args.index.real, args.index.imaginary);
    let to = args.to;
    let places = |steps: usize| (1..=steps).map(move |i| to * i as f64 / steps as f64);
    let single = |x: f64| Ok((x, Sphere::new(x, index)?.efficiencies().scattering));
    let of_many = |x: f64| {
        // Wavelengths of 2 pi micrometres: radii are size parameters.
        let sizes = SizeDistribution::gamma(x, VARIANCE);
        let particles = Particles::new(RefractiveIndex::constant(index), sizes)?;
        let bulk = particles.bulk(1e3 * TAU)?;
        Ok((x, bulk.scattering_um2 / (PI * sizes.mean_power(2.0))))
    };
    let single: Result<Vec<_>, MieError> = places(STEPS).map(single).collect();
    let of_many: Result<Vec<_>, MieError> = places(SMOOTH_STEPS).map(of_many).collect();
    let curves = [
        Curve {
            name: "single size".to_owned(),
            points: single?,
        },
        Curve {
            name: format!("gamma distribution, effective variance {VARIANCE}, by effective radius"),
            points: of_many?,
        },
    ];
    let x = Axis::linear("size parameter 2 pi r / wavelength");
    let y = Axis::linear("scattering efficiency");
    Ok(line_chart(&x, &y, &curves)?)
}
