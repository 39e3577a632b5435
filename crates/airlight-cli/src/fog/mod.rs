//! `airlight fog`: fog laid over pictures that exist.

mod batch;
mod forms;
mod layers;
mod light;
mod lights;
mod overlay;
mod paths;
mod picture;

use crate::args::OverlayArgs;
use crate::error::CliError;
use crate::interrupt;
use crate::report::{self, bytes};
use airlight::monte_carlo::MonteCarloSettings;
use light::{LightSource, SolvedSky};
use paths::Painter;
use picture::Subject;
use std::path::Path;

/// Runs the command.
///
/// # Errors
/// [`CliError`]: what was wrong with the options or the files.
pub fn run(args: &OverlayArgs) -> Result<(), CliError> {
    let args = &OverlayArgs {
        // Where it is not given it varies, and is set for each picture.
        visibility_m: args.given_visibility_m.unwrap_or_default(),
        ..args.clone()
    };
    picture::check(args)?;
    let random = args.random.settings(args.batch.seed)?;
    match (batch::is_asked_for(args)?, random) {
        (true, Some(_)) => Err(CliError::usage(
            "--solver monte-carlo takes one picture at a time: leave out --solver, or give COLOUR, --depth and --output each \
             the name of a file, without options for many pictures",
        )),
        (true, None) => batch::run(args),
        (false, random) => one(args, random),
    }
}

fn one(args: &OverlayArgs, random: Option<MonteCarloSettings>) -> Result<(), CliError> {
    let format = picture::format_of(args, &args.output)?;
    let depth = args.depth.as_ref().unwrap_or(&args.colour);
    for input in [&args.colour, depth] {
        if same_file(input, &args.output) {
            return Err(written_over(input));
        }
    }
    let subject = Subject::read(args, &args.colour, depth, format)?;
    let solved = SolvedSky::of(args)?;
    let fogged = subject.fogged(args, &LightSource::new(solved.as_ref(), args))?;
    let painter = match (random, &solved) {
        (Some(settings), Some(solved)) => Some(Painter::new(args, solved, &fogged, settings)?),
        _ => None,
    };
    let writing = interrupt::start_writing()?;
    let (written, noise) = match &painter {
        Some(painter) => painter.write(args, &subject, &fogged, format)?,
        None => (
            subject.write(&fogged, args, &args.output, format)?,
            String::new(),
        ),
    };
    drop(writing);
    if args.quiet {
        return Ok(());
    }
    let size = subject.picture.size;
    let [red, green, blue] = fogged.level.colour.0;
    report::print(&format!(
        "{}: {} x {}, {}\n  visibility    {} m ({} of contrast)\n  light         {red:.4} {green:.4} {blue:.4} ({})\n  \
         depth         {} pixels unknown, {} infinitely far\n{noise}",
        args.output.display(),
        size.width(),
        size.height(),
        bytes(written.bytes),
        report::short(args.visibility_m),
        args.contrast,
        fogged.level.how,
        subject.depth.holes,
        subject.depth.infinite,
    ))
}

/// Whether two paths lead to one file that is there.
fn same_file(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// The refusal of an output that is an input.
fn written_over(input: &Path) -> CliError {
    CliError::usage(format!(
        "`{}` would be written over: give --output another name",
        input.display()
    ))
}
