//! `airlight grid`: a contact sheet of skies described by a TOML file.

use crate::args::GridArgs;
use crate::error::CliError;
use crate::interrupt::STOP;
use crate::progress::PicturesBar;
use crate::report;
use airlight_image::Control;
use airlight_plot::ContactSheet;
use airlight_render::contact_sheet::ContactSheetSpec;
use airlight_render::{Renderer, Solutions};

/// Runs the command.
///
/// # Errors
/// [`CliError`] for an invalid file, and failures.
pub fn run(args: &GridArgs) -> Result<(), CliError> {
    report::check_png(&args.output)?;
    let spec = ContactSheetSpec::load(&args.file)?;
    let wrong = |number: usize, error: CliError| match error {
        CliError::Usage(sentence) => CliError::Usage(format!(
            "{}: cell {number}: {sentence}",
            args.file.display()
        )),
        other => other,
    };
    let renderers = (1..)
        .zip(&spec.cells)
        .map(|(number, (label, scene))| {
            let renderer = Renderer::new(scene).map_err(|error| wrong(number, error.into()))?;
            Ok((label, renderer))
        })
        .collect::<Result<Vec<_>, CliError>>()?;
    let bar = PicturesBar::new(renderers.len() as u64);
    let mut panels = Vec::with_capacity(renderers.len());
    let mut solutions = Solutions::default();
    for (number, (label, renderer)) in (1..).zip(renderers) {
        let image = renderer
            .render_sharing(&mut solutions, Control::cancelled_by(&STOP))
            .map_err(|error| wrong(number, error.into()))?;
        panels.push(report::panel(label, &image, &image.tone));
        bar.one_more();
    }
    drop(bar);
    let sheet = ContactSheet {
        heading: spec.title,
        columns: spec.columns,
        panels,
        notes: Vec::new(),
    };
    report::write_contact_sheet(&args.output, &sheet)
}
