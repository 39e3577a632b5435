//! Plots of fog profiles, and of the error of the split sum.

use crate::args::{FogProfilePlotArgs, SplitSumPlotArgs};
use crate::error::CliError;
use airlight::fog::DensityProfile;
use airlight::fog::split_sum_error;
use airlight::fog::visibility::{Contrast, extinction_per_m};
use airlight_plot::{Axis, Colormap, Curve, HeatMap, heat_map, line_chart};

/// Extinction by height of a slab, an exponential profile and a clamped exponential profile.
///
/// # Errors
/// [`CliError::Usage`] for heights out of range.
pub fn profile(args: &FogProfilePlotArgs) -> Result<String, CliError> {
    const STEPS: u32 = 400;
    let extinction = extinction_per_m(args.visibility_m, Contrast::FivePercent);
    let scale_height_m = args.scale_height_m;
    let profiles = [
        (
            format!("slab, top at {} m", args.top_m),
            DensityProfile::slab(args.top_m),
        ),
        (
            format!("exponential, scale height {scale_height_m} m"),
            DensityProfile::Exponential {
                reference_height_m: 0.0,
                scale_height_m,
            },
        ),
        (
            format!(
                "exponential above {} m, scale height {scale_height_m} m",
                args.base_height_m
            ),
            DensityProfile::Clamped {
                base_height_m: args.base_height_m,
                scale_height_m,
            },
        ),
    ];
    let to_m = args
        .to_m
        .unwrap_or(1.5 * args.top_m.max(args.base_height_m + 2.0 * scale_height_m));
    let mut all = Vec::new();
    for (name, profile) in profiles {
        profile
            .validate()
            .map_err(|error| CliError::usage(error.to_string()))?;
        let height = |i: u32| to_m * f64::from(i) / f64::from(STEPS);
        all.push(Curve {
            name,
            points: (0..=STEPS)
                .map(|i| (height(i), 1e3 * extinction * profile.at(height(i))))
                .collect(),
        });
    }
    let x = Axis::linear("height above the ground, m");
    let y = Axis::linear("extinction coefficient, km\u{207b}\u{b9}");
    Ok(line_chart(&x, &y, &all)?)
}

/// Error of the split sum by optical depth and by the decay rate of the source.
///
/// # Errors
/// [`CliError`] if the map cannot be drawn.
pub fn split_sum(_: &SplitSumPlotArgs) -> Result<String, CliError> {
    const COLUMNS: u32 = 72;
    const ROWS: u32 = 48;
    // Optical depths from 0.01 to 10, decay rates from -1 to 1.
    let depth: Vec<f64> = (0..=COLUMNS)
        .map(|i| 10f64.powf(-2.0 + 3.0 * f64::from(i) / f64::from(COLUMNS)))
        .collect();
    let fall: Vec<f64> = (0..=ROWS)
        .map(|j| -1.0 + 2.0 * f64::from(j) / f64::from(ROWS))
        .collect();
    let data = HeatMap {
        values: fall
            .iter()
            .map(|&k| {
                depth
                    .iter()
                    .map(|&tau| 100.0 * split_sum_error(tau, k))
                    .collect()
            })
            .collect(),
        x: depth,
        y: fall,
    };
    let x = Axis::logarithmic("optical depth of the ray");
    let y =
        Axis::linear("k: the source decays as exp(\u{2212}k t) with optical depth t from the eye");
    Ok(heat_map(
        (&x, &y),
        &data,
        ("error of the split sum, %", &Colormap::diverging(50.0)),
        &[-20.0, -10.0, -1.0, 1.0, 10.0, 20.0],
    )?)
}
