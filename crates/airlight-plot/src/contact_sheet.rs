//! Contact sheets: pictures side by side, each with a title and, where its colours mean values, a colour scale.

use crate::axis::number;
use crate::{Colormap, PlotError, Raster};
use std::fmt::Write;

/// A picture on a contact sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Line above the picture.
    pub title: String,
    /// The picture.
    pub picture: Raster,
    /// Colour map of the picture, and the quantity and unit of its values: drawn as a scale below the picture.
    pub scale: Option<(Colormap, String)>,
}

/// Pictures in rows and columns.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSheet {
    /// Text above all pictures.
    pub heading: String,
    /// Panels in a row.
    pub columns: usize,
    /// The pictures, row by row.
    pub panels: Vec<Panel>,
    /// Lines below all pictures.
    pub notes: Vec<String>,
}

/// Sizes in pixels.
const MARGIN: u32 = 16;
const HEADING_HEIGHT: u32 = 28;
const TITLE_HEIGHT: u32 = 26;
const SCALE_HEIGHT: u32 = 40;
const NOTE_HEIGHT: u32 = 20;
const HEADING_FONT: u32 = 20;
const TITLE_FONT: u32 = 15;
const SCALE_FONT: u32 = 13;
const NOTE_FONT: u32 = 14;
/// Distance from a picture to its scale, and the height of the scale's bar.
const BAR_GAP: u32 = 6;
const BAR_HEIGHT: u32 = 12;
/// Upper estimate of the width of a character over the font size.
const CHARACTER_WIDTH: f64 = 0.58;

/// Positions of the parts of a sheet.
struct Layout {
    columns: u32,
    /// Width and height of a panel with its title, scale and margin.
    cell: (u32, u32),
    size: (u32, u32),
    /// First row of the panels.
    top: u32,
    /// Lines of the heading and of the notes, wrapped to the width of the sheet.
    heading: Vec<String>,
    notes: Vec<String>,
}

impl Layout {
    fn new(sheet: &ContactSheet) -> Self {
        let columns = sheet.columns.clamp(1, sheet.panels.len().max(1)) as u32;
        let rows = (sheet.panels.len() as u32).div_ceil(columns);
        let largest = |length: fn(&Raster) -> u32| {
            let lengths = sheet.panels.iter().map(|panel| length(&panel.picture));
            lengths.max().unwrap_or(1)
        };
        let has_scales = sheet.panels.iter().any(|panel| panel.scale.is_some());
        let scale_height = if has_scales { SCALE_HEIGHT } else { 0 };
        let cell = (
            largest(|p| p.width) + MARGIN,
            TITLE_HEIGHT + largest(|p| p.height) + scale_height + MARGIN / 2,
        );
        let width = MARGIN + columns * cell.0;
        let text_width = width - 2 * MARGIN;
        let heading = wrap(&sheet.heading, text_width, HEADING_FONT);
        let notes = sheet.notes.iter();
        let notes: Vec<String> = notes
            .flat_map(|note| wrap(note, text_width, NOTE_FONT))
            .collect();
        let below_heading = if heading.is_empty() { 0 } else { 6 };
        let top = MARGIN + HEADING_HEIGHT * heading.len() as u32 + below_heading;
        Self {
            columns,
            cell,
            size: (
                width,
                top + rows * cell.1 + NOTE_HEIGHT * notes.len() as u32 + MARGIN,
            ),
            top,
            heading,
            notes,
        }
    }

    /// Left edge and top of a panel with its title.
    fn corner(&self, index: usize) -> (u32, u32) {
        let (column, row) = (index as u32 % self.columns, index as u32 / self.columns);
        (MARGIN + column * self.cell.0, self.top + row * self.cell.1)
    }

    /// Left edge and top of a picture.
    fn picture_corner(&self, index: usize) -> (u32, u32) {
        let (left, top) = self.corner(index);
        (left, top + TITLE_HEIGHT)
    }
}

impl ContactSheet {
    /// Draws the sheet.
    ///
    /// # Errors
    /// [`PlotError::Size`] where it does not fit in memory.
    pub fn draw(&self) -> Result<Raster, PlotError> {
        let layout = Layout::new(self);
        let mut sheet = Raster::from_svg(&self.texts_and_scales(&layout), 1.0)?;
        for (index, panel) in self.panels.iter().enumerate() {
            sheet.paste(&panel.picture, layout.picture_corner(index));
        }
        Ok(sheet)
    }

    /// Everything but the pictures, as SVG.
    fn texts_and_scales(&self, layout: &Layout) -> String {
        let (width, height) = layout.size;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" font-family=\"sans-serif\">"
        );
        let mut text = |x: u32, y: u32, size: u32, text: &str, anchor: &str| {
            // Writing to a string cannot fail.
            let _ = write!(
                svg,
                "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\">{}</text>",
                escape(text)
            );
        };
        for (row, line) in (0..).zip(&layout.heading) {
            let baseline = MARGIN + 18 + HEADING_HEIGHT * row;
            text(MARGIN, baseline, HEADING_FONT, line, "start");
        }
        for (index, panel) in self.panels.iter().enumerate() {
            let (left, top) = layout.picture_corner(index);
            text(left, top - 8, TITLE_FONT, &panel.title, "start");
            if let Some((colormap, quantity)) = &panel.scale {
                let baseline = top + panel.picture.height + SCALE_HEIGHT - 4;
                let (right, middle) = (left + panel.picture.width, left + panel.picture.width / 2);
                let (low, high) = colormap.range;
                text(left, baseline, SCALE_FONT, &number(low), "start");
                text(middle, baseline, SCALE_FONT, quantity, "middle");
                text(right, baseline, SCALE_FONT, &number(high), "end");
            }
        }
        let notes = height - MARGIN - NOTE_HEIGHT * layout.notes.len() as u32;
        for (row, note) in (1..).zip(&layout.notes) {
            text(MARGIN, notes + NOTE_HEIGHT * row, NOTE_FONT, note, "start");
        }
        for (index, panel) in self.panels.iter().enumerate() {
            let (left, top) = layout.picture_corner(index);
            if let Some((colormap, _)) = &panel.scale {
                let corner = (left, top + panel.picture.height + BAR_GAP);
                draw_bar(&mut svg, colormap, corner, panel.picture.width);
            }
        }
        svg.push_str("</svg>");
        svg
    }
}

/// Wraps a text between words to lines of at most `width` pixels; no lines for an empty text.
fn wrap(text: &str, width: u32, font_size: u32) -> Vec<String> {
    let longest = (f64::from(width) / (CHARACTER_WIDTH * f64::from(font_size))) as usize;
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= longest => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Appends the bar of a colour scale.
fn draw_bar(svg: &mut String, colormap: &Colormap, (left, top): (u32, u32), width: u32) {
    const STEPS: u32 = 128;
    let (low, high) = colormap.range;
    for step in 0..STEPS {
        let at = |step: u32| f64::from(width) * f64::from(step) / f64::from(STEPS);
        let part = (f64::from(step) + 0.5) / f64::from(STEPS);
        let [r, g, b] = colormap.colour(low + (high - low) * part);
        let _ = write!(
            svg,
            "<rect x=\"{}\" y=\"{top}\" width=\"{}\" height=\"{BAR_HEIGHT}\" fill=\"rgb({r},{g},{b})\" shape-rendering=\"crispEdges\"/>",
            f64::from(left) + at(step),
            at(step + 1) - at(step)
        );
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: (u32, u32) = (256, 100);

    /// Pictures of one colour each, over a scale from blue to red.
    fn sheet() -> ContactSheet {
        let panel = |value: u8| Panel {
            title: "a < b".to_owned(),
            picture: Raster {
                width: SIZE.0,
                height: SIZE.1,
                rgb: vec![value; 3 * (SIZE.0 * SIZE.1) as usize],
            },
            scale: Some((Colormap::diverging(5.0), "%".to_owned())),
        };
        ContactSheet {
            heading: "All".to_owned(),
            columns: 2,
            panels: (10..13).map(panel).collect(),
            notes: vec!["a note".to_owned()],
        }
    }

    fn pixel(sheet: &Raster, x: u32, y: u32) -> [u8; 3] {
        let at = 3 * (y * sheet.width + x) as usize;
        [sheet.rgb[at], sheet.rgb[at + 1], sheet.rgb[at + 2]]
    }

    /// Dark pixels of a rectangle: those of a text on white.
    fn ink(sheet: &Raster, x: std::ops::Range<u32>, y: std::ops::Range<u32>) -> usize {
        let pixels = y.flat_map(|y| x.clone().map(move |x| (x, y)));
        pixels
            .filter(|&(x, y)| pixel(sheet, x, y).iter().all(|&c| c < 100))
            .count()
    }

    #[test]
    fn long_lines_are_wrapped_between_words() {
        assert_eq!(wrap("", 100, 14), Vec::<String>::new());
        let text = "one two three four five six seven eight nine ten";
        let lines = wrap(text, 120, 14);
        assert!(
            lines.len() > 2 && lines.iter().all(|line| line.len() <= 14),
            "{lines:?}"
        );
        assert_eq!(lines.join(" "), text);
        assert_eq!(wrap("unbreakable", 20, 14), ["unbreakable"]);
    }

    #[test]
    fn pictures_are_whole_and_on_white() {
        let sheet = sheet();
        let layout = Layout::new(&sheet);
        let drawn = sheet.draw().unwrap();
        assert_eq!((drawn.width, drawn.height), layout.size);
        for (index, value) in (10..13).enumerate() {
            let (left, top) = layout.picture_corner(index);
            for (x, y) in [(0, 0), (SIZE.0 - 1, 0), (0, SIZE.1 - 1), (SIZE.0 - 1, 50)] {
                assert_eq!(pixel(&drawn, left + x, top + y), [value; 3], "{index}");
            }
            for (x, y) in [
                (left - 1, top),
                (left + SIZE.0, top),
                (left, top - 1),
                (left, top + SIZE.1),
            ] {
                assert_eq!(pixel(&drawn, x, y), [255; 3], "{index} at {x} {y}");
            }
            let count = drawn
                .rgb
                .chunks_exact(3)
                .filter(|pixel| *pixel == [value; 3])
                .count();
            assert!(count >= (SIZE.0 * SIZE.1) as usize, "{value}: {count}");
        }
        // The fourth cell is empty.
        let (left, top) = layout.picture_corner(3);
        assert_eq!(pixel(&drawn, left + 20, top + 20), [255; 3]);
    }

    #[test]
    fn scales_show_the_colours_of_their_values() {
        let sheet = sheet();
        let layout = Layout::new(&sheet);
        let drawn = sheet.draw().unwrap();
        let colormap = Colormap::diverging(5.0);
        for index in 0..3 {
            let (left, top) = layout.picture_corner(index);
            let bar = top + SIZE.1 + BAR_GAP;
            // Two pixels a step of the bar.
            for x in [0, 63, 128, 200, 255] {
                let value = -5.0 + 10.0 * (f64::from(x / 2) + 0.5) / 128.0;
                for y in [0, BAR_HEIGHT - 1] {
                    let got = pixel(&drawn, left + x, bar + y);
                    assert_eq!(got, colormap.colour(value), "{index} at {x}");
                }
            }
            assert_eq!(pixel(&drawn, left, bar - 1), [255; 3]);
        }
    }

    #[test]
    fn texts_stand_in_their_places_and_nowhere_else() {
        let sheet = sheet();
        let layout = Layout::new(&sheet);
        let mut drawn = sheet.draw().unwrap();
        let right = drawn.width;
        let notes = drawn.height - MARGIN - NOTE_HEIGHT;
        let mut texts = vec![
            ink(&drawn, MARGIN..right, MARGIN..layout.top),
            ink(&drawn, MARGIN..right, notes..drawn.height),
        ];
        for index in 0..3 {
            let (left, top) = layout.picture_corner(index);
            let width = left..left + SIZE.0;
            texts.push(ink(&drawn, width.clone(), top - TITLE_HEIGHT..top));
            let labels = top + SIZE.1 + BAR_GAP + BAR_HEIGHT..top + SIZE.1 + SCALE_HEIGHT;
            // Low end, quantity, high end.
            for x in [0, SIZE.0 / 2 - 10, SIZE.0 - 20] {
                let ink = ink(&drawn, left + x..left + x + 20, labels.clone());
                assert!(ink > 3, "{index} at {x}: {ink}");
            }
            texts.push(ink(&drawn, width, labels));
        }
        assert!(texts.iter().all(|&ink| ink > 10), "{texts:?}");
        // All other ink is that of pictures and bars.
        for index in 0..3 {
            let white = |height: u32| Raster {
                width: SIZE.0,
                height,
                rgb: vec![255; 3 * (SIZE.0 * height) as usize],
            };
            let (left, top) = layout.picture_corner(index);
            drawn.paste(&white(SIZE.1 + BAR_GAP + BAR_HEIGHT), (left, top));
        }
        let all = ink(&drawn, 0..drawn.width, 0..drawn.height);
        assert_eq!(all, texts.iter().sum::<usize>());
    }
}
