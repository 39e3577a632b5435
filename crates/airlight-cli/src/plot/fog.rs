//! How dense fog is by height, and where the split sum holds.

use crate::args::{FogProfilePlotArgs, SplitSumPlotArgs};
use crate::error::CliError;
use airlight::fog::DensityProfile;
use airlight::fog::split_sum_error;
use airlight::fog::visibility::{Contrast, extinction_per_m};
use airlight_plot::{Axis, Colormap, Curve, HeatMap, heat_map, line_chart};

/// Extinction by height of an even slab, an exponential fog and one that is even up to a base.
///
/// # Errors
/// [`CliError::Usage`] for heights that make no profile.
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

/// The error of the split sum over optical depth and the fall of the source along it.
///
/// # Errors
/// [`CliError`] where the map cannot be drawn.
pub fn split_sum(_: &SplitSumPlotArgs) -> Result<String, CliError> {
    const COLUMNS: u32 = 72;
    const ROWS: u32 = 48;
    // From a hundredth to ten; falls from -1 to 1.
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
    let x = Axis::logarithmic("optical depth of the line");
    let y =
        Axis::linear("k: the source falls as exp(\u{2212}k t) with optical depth t from the eye");
    Ok(heat_map(
        (&x, &y),
        &data,
        ("error of the split sum, %", &Colormap::diverging(50.0)),
        &[-20.0, -10.0, -1.0, 1.0, 10.0, 20.0],
    )?)
}
