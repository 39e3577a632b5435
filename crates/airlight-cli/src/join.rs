//! `airlight join`: a picture of the bands of its rows.

use crate::args::JoinArgs;
use crate::error::CliError;
use crate::interrupt::{self, STOP};
use crate::report::{self, bytes};
use airlight_image::output::exr;
use airlight_image::{Control, PictureFormat};

/// Runs the command.
///
/// # Errors
/// [`CliError`] if the output is no EXR file, a band cannot be read, or the bands are not those of one picture.
pub fn run(args: &JoinArgs) -> Result<(), CliError> {
    let output = &args.output;
    if PictureFormat::from_path(output)? != PictureFormat::EXR {
        return Err(CliError::usage(format!(
            "--output: expected an OpenEXR file, got `{}`; try a name that ends in .exr",
            output.display()
        )));
    }
    let writing = interrupt::start_writing()?;
    let written = exr::join(&args.bands, output, Control::cancelled_by(&STOP))?;
    drop(writing);
    if args.quiet {
        return Ok(());
    }
    report::print(&format!(
        "{}: {} bands joined, {}\n",
        output.display(),
        args.bands.len(),
        bytes(written.bytes)
    ))
}
