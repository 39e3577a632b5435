//! The picture on the terminal, as coloured half blocks.

use super::exposure;
use super::prepared_frame::PreparedFrame;
use super::renderer::{Renderer, stored};
use crate::args::SkyArgs;
use crate::error::CliError;
use airlight::spectrum::{RgbSpace, rgb};
use airlight_image::terminal::{TerminalColor, half_blocks};
use std::io::IsTerminal;

/// A terminal that shows colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Terminal {
    color: TerminalColor,
    columns: u16,
    lines: u16,
}

/// Whether to show a preview: where it is asked for, or where nothing else would show and the terminal can.
///
/// # Errors
/// [`CliError::Usage`] where there would be no output at all.
pub fn wanted(args: &SkyArgs) -> Result<Option<Terminal>, CliError> {
    if !args.preview && args.output.is_some() {
        return Ok(None);
    }
    let variable = |name| std::env::var(name).ok();
    let (colorterm, term, none) = (
        variable("COLORTERM"),
        variable("TERM"),
        variable("NO_COLOR"),
    );
    let color = TerminalColor::detect(colorterm.as_deref(), term.as_deref(), none.as_deref());
    if color == TerminalColor::None || !args.preview && !std::io::stdout().is_terminal() {
        return Err(CliError::usage(match args.preview {
            true => {
                "--preview needs a terminal that shows colours (COLORTERM and TERM say it does not)"
            }
            false => {
                "say what to write: --output FILE (.exr, .hdr, .png, .jpg), or --preview for the terminal"
            }
        }));
    }
    let (lines, columns) = console::Term::stdout().size();
    Ok(Some(Terminal {
        color,
        columns,
        lines,
    }))
}

/// The text that shows a shot.
///
/// # Errors
/// As [`exposure::tone`].
pub fn text(
    renderer: &Renderer<'_>,
    prepared: &PreparedFrame,
    terminal: Terminal,
) -> Result<String, CliError> {
    let mut columns = u32::from(terminal.columns).clamp(8, 256);
    let mut frame = renderer.layout.overview(columns)?;
    // Two pixels a line, and room for the report.
    let most = 2 * u32::from(terminal.lines.saturating_sub(8)).max(8);
    if frame.size().height() > most {
        columns = (columns * most / frame.size().height()).max(8);
        frame = renderer.layout.overview(columns)?;
    }
    let tone = exposure::tone(renderer, prepared)?;
    let to_srgb = rgb::multiply(
        &RgbSpace::Srgb.from_xyz_matrix(),
        &renderer.channels.space.to_xyz_matrix(),
    );
    let rows = renderer.rows(prepared, &frame, (renderer.layout.main_layer(), 1.0), None);
    let width = frame.size().width() as usize;
    let mut bytes = Vec::new();
    for (y, row) in (0..).zip(stored(rows.as_ref(), &frame).chunks_exact(width)) {
        let linear: Vec<f32> = row
            .iter()
            .flat_map(|p| rgb::apply(&to_srgb, p.map(f64::from)).map(|v| v as f32))
            .collect();
        let mut out = vec![0; linear.len()];
        tone.row_to_u8(y, &linear, &mut out);
        bytes.extend(out);
    }
    Ok(half_blocks(&bytes, width, width, terminal.color))
}
