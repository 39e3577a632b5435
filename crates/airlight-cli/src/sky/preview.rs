//! Preview of a picture on the terminal, as coloured half blocks.

use crate::error::CliError;
use airlight::spectrum::{RgbSpace, rgb};
use airlight_image::terminal::{TerminalColor, half_blocks};
use airlight_render::{PreparedFrame, Renderer};
use std::io::IsTerminal;

/// A terminal with colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Terminal {
    color: TerminalColor,
    columns: u16,
    lines: u16,
}

/// The terminal for a preview, if one is requested, or if there is no other output and the terminal has colours.
///
/// # Errors
/// [`CliError::Usage`] if there would be no output.
pub fn wanted(requested: bool, has_output: bool) -> Result<Option<Terminal>, CliError> {
    if !requested && has_output {
        return Ok(None);
    }
    let variable = |name| std::env::var(name).ok();
    let (colorterm, term, none) = (
        variable("COLORTERM"),
        variable("TERM"),
        variable("NO_COLOR"),
    );
    let color = TerminalColor::detect(colorterm.as_deref(), term.as_deref(), none.as_deref());
    if color == TerminalColor::None || !requested && !std::io::stdout().is_terminal() {
        return Err(CliError::usage(match requested {
            true => {
                "--preview: expected a terminal with colours, got one without according to COLORTERM and TERM; try --output"
            }
            false => {
                "expected an output, got none; try --output FILE (.exr, .hdr, .png, .jpg), or --preview for the terminal"
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

/// Text that shows a frame.
///
/// # Errors
/// [`CliError::Usage`] for an exposure out of range.
pub fn text(
    renderer: &Renderer,
    frame: &PreparedFrame,
    terminal: Terminal,
) -> Result<String, CliError> {
    let mut columns = u32::from(terminal.columns).clamp(8, 256);
    let mut small = renderer.layout().overview(columns)?;
    // Two rows of pixels on each line, with space for the report.
    let most = 2 * u32::from(terminal.lines.saturating_sub(8)).max(8);
    if small.size().height() > most {
        columns = (columns * most / small.size().height()).max(8);
        small = renderer.layout().overview(columns)?;
    }
    let tone = frame.tone()?;
    let to_srgb = rgb::multiply(
        &RgbSpace::Srgb.from_xyz_matrix(),
        &frame.channels().space().to_xyz_matrix(),
    );
    let width = small.size().width() as usize;
    let pixels = frame.pixels(&small, renderer.layout().main_layer());
    let mut bytes = Vec::new();
    for (y, row) in (0..).zip(pixels.chunks_exact(width)) {
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
