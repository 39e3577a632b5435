//! Previews in a terminal: coloured text with two pixels in a character cell, one above the other.

use airlight::spectrum::rgb::{srgb_decode, srgb_encode};
use std::fmt::Write;

/// Colours of a terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TerminalColor {
    /// Any 24-bit colour.
    True,
    /// The 256-colour palette.
    Palette,
    /// No colours.
    None,
}

impl TerminalColor {
    /// Capabilities according to the environment variables `COLORTERM`, `TERM` and `NO_COLOR`.
    pub fn detect(colorterm: Option<&str>, term: Option<&str>, no_color: Option<&str>) -> Self {
        let colorterm = colorterm.unwrap_or("").to_ascii_lowercase();
        let term = term.unwrap_or("").to_ascii_lowercase();
        let names = |list: &[&str], text: &str| list.iter().any(|name| text.contains(name));
        if no_color.is_some_and(|value| !value.is_empty()) || term == "dumb" {
            Self::None
        } else if names(&["truecolor", "24bit"], &colorterm)
            || names(
                &[
                    "truecolor",
                    "direct",
                    "kitty",
                    "alacritty",
                    "ghostty",
                    "wezterm",
                ],
                &term,
            )
        {
            Self::True
        } else if term.contains("256") || !colorterm.is_empty() {
            Self::Palette
        } else {
            Self::None
        }
    }
}

/// A picture as lines of upper half blocks, at most `columns` wide, each ending with a reset and a line feed.
///
/// `rgb` is 8-bit sRGB, row after row, `width` pixels a row; an incomplete row is ignored. A picture wider than
/// `columns` is averaged in linear light; a smaller one is shown pixel for pixel. Empty for an empty picture and a terminal without
/// colours.
pub fn half_blocks(rgb: &[u8], width: usize, columns: usize, color: TerminalColor) -> String {
    let height = if width == 0 {
        0
    } else {
        rgb.len() / width.saturating_mul(3)
    };
    if height == 0 || columns == 0 || color == TerminalColor::None {
        return String::new();
    }
    let across = columns.min(width);
    let down = (height * across).div_ceil(width).max(1);
    let pixel = |x: usize, y: usize| {
        average(
            rgb,
            width,
            (x * width / across, ((x + 1) * width).div_ceil(across)),
            (y * height / down, ((y + 1) * height).div_ceil(down)),
        )
    };
    let mut text = String::with_capacity(across * down.div_ceil(2) * 40);
    for pair in 0..down.div_ceil(2) {
        let mut last = None;
        for x in 0..across {
            let top = pixel(x, pair * 2);
            let bottom = (pair * 2 + 1 < down).then(|| pixel(x, pair * 2 + 1));
            if last != Some((top, bottom)) {
                set_colour(&mut text, 38, top, color);
                match bottom {
                    Some(bottom) => set_colour(&mut text, 48, bottom, color),
                    None => text.push_str("\x1b[49m"),
                }
                last = Some((top, bottom));
            }
            text.push('\u{2580}');
        }
        text.push_str("\x1b[0m\n");
    }
    text
}

/// Mean of the pixels in a rectangle, in linear light.
fn average(rgb: &[u8], width: usize, x: (usize, usize), y: (usize, usize)) -> [u8; 3] {
    let mut sum = [0.0; 3];
    for row in y.0..y.1 {
        for column in x.0..x.1 {
            for (c, sum) in sum.iter_mut().enumerate() {
                *sum += srgb_decode(f64::from(rgb[(row * width + column) * 3 + c]) / 255.0);
            }
        }
    }
    let count = ((x.1 - x.0) * (y.1 - y.0)).max(1) as f64;
    sum.map(|v| (srgb_encode(v / count) * 255.0 + 0.5) as u8)
}

/// Appends the escape sequence that sets the foreground (38) or background (48).
fn set_colour(text: &mut String, ground: u8, [r, g, b]: [u8; 3], color: TerminalColor) {
    // Writing to a string cannot fail.
    let _ = match color {
        TerminalColor::True => write!(text, "\x1b[{ground};2;{r};{g};{b}m"),
        _ => write!(text, "\x1b[{ground};5;{}m", palette_index(r, g, b)),
    };
}

/// Index of the nearest colour of the palette: its 6 x 6 x 6 cube or its 24 greys.
fn palette_index(r: u8, g: u8, b: u8) -> u8 {
    const LEVELS: [u8; 6] = [0, 95, 135, 175, 215, 255];
    let nearest = |v: u8| (0..6).min_by_key(|&i| v.abs_diff(LEVELS[i])).unwrap_or(0);
    let (ri, gi, bi) = (nearest(r), nearest(g), nearest(b));
    let mean = (u32::from(r) + u32::from(g) + u32::from(b)) / 3;
    let grey_index = (mean.saturating_sub(3) / 10).min(23) as u8;
    let grey = 8 + grey_index * 10;
    let distance = |a: [u8; 3]| {
        [r, g, b]
            .iter()
            .zip(a)
            .map(|(&p, q)| u32::from(p.abs_diff(q)).pow(2))
            .sum::<u32>()
    };
    if distance([grey; 3]) < distance([LEVELS[ri], LEVELS[gi], LEVELS[bi]]) {
        232 + grey_index
    } else {
        16 + (36 * ri + 6 * gi + bi) as u8
    }
}
