//! `airlight plot`: curves and maps as SVG or PNG.
//!
//! [`particles`]: phase functions and efficiencies; [`air`]: spectra and transmittance; [`fog`]: profiles, and the error of
//! the split sum.

mod air;
mod fog;
mod particles;

use crate::args::{PlotArgs, PlotWhat};
use crate::error::CliError;
use crate::report;
use airlight_plot::Raster;

/// Number of PNG pixels for each unit of the drawing.
const PNG_SCALE: f32 = 2.0;

/// Runs the command.
///
/// # Errors
/// [`CliError`] for invalid options, and if the file cannot be written.
pub fn run(args: &PlotArgs) -> Result<(), CliError> {
    let output = match &args.what {
        PlotWhat::Phase(args) => &args.output,
        PlotWhat::Efficiency(args) => &args.output,
        PlotWhat::Spectrum(args) => &args.output,
        PlotWhat::Transmittance(args) => &args.output,
        PlotWhat::FogProfile(args) => &args.output,
        PlotWhat::SplitSum(args) => &args.output,
    };
    let png = match output.extension().and_then(|ending| ending.to_str()) {
        Some("svg") => false,
        Some("png") => true,
        _ => {
            return Err(CliError::usage(format!(
                "--output: expected a name that ends in .svg or .png, got `{}`; try `{}`",
                output.display(),
                output.with_extension("svg").display()
            )));
        }
    };
    let svg = match &args.what {
        PlotWhat::Phase(args) => particles::phase(args)?,
        PlotWhat::Efficiency(args) => particles::efficiency(args)?,
        PlotWhat::Spectrum(args) => air::spectrum(args)?,
        PlotWhat::Transmittance(args) => air::transmittance(args)?,
        PlotWhat::FogProfile(args) => fog::profile(args)?,
        PlotWhat::SplitSum(args) => fog::split_sum(args)?,
    };
    match png {
        false => report::write(output, &svg),
        true => report::write(output, Raster::from_svg(&svg, PNG_SCALE)?.to_png()?),
    }
}
