//! Pictures side by side, each with a title and, where its colours mean values, a scale.

use crate::ramp::Ramp;
use crate::raster::Picture;
use std::error::Error;
use std::fmt::Write;

/// A picture on a board.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What stands above it.
    pub title: String,
    /// The picture.
    pub picture: Picture,
    /// What its colours mean, and the name and unit of the values.
    pub scale: Option<(Ramp, String)>,
}

/// Pictures side by side.
#[derive(Clone, Debug)]
pub struct ContactSheet {
    /// What stands above all.
    pub heading: String,
    /// Panels in a row.
    pub columns: usize,
    /// The pictures, row by row.
    pub panels: Vec<Panel>,
    /// Lines under all.
    pub notes: Vec<String>,
}

const MARGIN: u32 = 16;
const HEADING: u32 = 28;
const TITLE: u32 = 26;
const SCALE: u32 = 40;
const LINE: u32 = 20;
/// Sizes of letters, pixels.
const HEADING_SIZE: u32 = 20;
const NOTE_SIZE: u32 = 14;
/// Width of a letter over its size, with some to spare.
const WIDE: f64 = 0.58;

/// Where things are put.
struct Layout {
    columns: u32,
    cell: (u32, u32),
    size: (u32, u32),
    top: u32,
    scales: bool,
    /// Lines of the heading and of the notes, none wider than the board.
    heading: Vec<String>,
    notes: Vec<String>,
}

impl ContactSheet {
    fn layout(&self) -> Layout {
        let columns = self.columns.clamp(1, self.panels.len().max(1)) as u32;
        let rows = (self.panels.len() as u32).div_ceil(columns);
        let most = |length: fn(&Picture) -> u32| {
            let lengths = self.panels.iter().map(|panel| length(&panel.picture));
            lengths.max().unwrap_or(1)
        };
        let scales = self.panels.iter().any(|panel| panel.scale.is_some());
        let below = if scales { SCALE } else { 0 };
        let cell = (
            most(|p| p.width) + MARGIN,
            TITLE + most(|p| p.height) + below + MARGIN / 2,
        );
        let width = MARGIN + columns * cell.0;
        let heading = wrapped(&self.heading, width - 2 * MARGIN, HEADING_SIZE);
        let notes = self.notes.iter();
        let notes: Vec<String> = notes
            .flat_map(|note| wrapped(note, width - 2 * MARGIN, NOTE_SIZE))
            .collect();
        let top = MARGIN + HEADING * heading.len() as u32 + if heading.is_empty() { 0 } else { 6 };
        Layout {
            columns,
            cell,
            size: (
                width,
                top + rows * cell.1 + LINE * notes.len() as u32 + MARGIN,
            ),
            top,
            scales,
            heading,
            notes,
        }
    }

    /// Draws the board.
    ///
    /// # Errors
    /// Where it is larger than memory.
    pub fn draw(&self) -> Result<Picture, Box<dyn Error>> {
        let layout = self.layout();
        let corner = |index: usize| {
            let (column, row) = (index as u32 % layout.columns, index as u32 / layout.columns);
            (
                MARGIN + column * layout.cell.0,
                layout.top + row * layout.cell.1,
            )
        };
        let mut drawn = Picture::of_svg(&self.lettering(&layout, corner), 1.0)?;
        for (index, panel) in self.panels.iter().enumerate() {
            let (left, top) = corner(index);
            drawn.put(&panel.picture, (left, top + TITLE));
        }
        Ok(drawn)
    }

    /// All but the pictures, as SVG.
    fn lettering(&self, layout: &Layout, corner: impl Fn(usize) -> (u32, u32)) -> String {
        let (width, height) = layout.size;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" font-family=\"sans-serif\">"
        );
        let mut text = |x: u32, y: u32, size: u32, text: &str, anchor: &str| {
            // Writing to a string cannot fail.
            let _ = write!(
                svg,
                "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\">{}</text>",
                escaped(text)
            );
        };
        for (row, line) in (0..).zip(&layout.heading) {
            text(
                MARGIN,
                MARGIN + 18 + HEADING * row,
                HEADING_SIZE,
                line,
                "start",
            );
        }
        for (index, panel) in self.panels.iter().enumerate() {
            let (left, top) = corner(index);
            text(left, top + TITLE - 8, 15, &panel.title, "start");
            if let Some((ramp, name)) = &panel.scale {
                let below = top + TITLE + panel.picture.height + SCALE - 4;
                let (right, middle) = (left + panel.picture.width, left + panel.picture.width / 2);
                let number = |value: f64| crate::Axis::even("").label(value);
                text(left, below, 13, &number(ramp.ends.0), "start");
                text(middle, below, 13, name, "middle");
                text(right, below, 13, &number(ramp.ends.1), "end");
            }
        }
        let notes = height - MARGIN - LINE * layout.notes.len() as u32;
        for (row, note) in (1..).zip(&layout.notes) {
            text(MARGIN, notes + LINE * row, NOTE_SIZE, note, "start");
        }
        if layout.scales {
            for (index, panel) in self.panels.iter().enumerate() {
                let (left, top) = corner(index);
                if let Some((ramp, _)) = &panel.scale {
                    bar(
                        &mut svg,
                        ramp,
                        (left, top + TITLE + panel.picture.height + 6),
                        panel.picture.width,
                    );
                }
            }
        }
        svg.push_str("</svg>");
        svg
    }
}

/// A text in lines of at most so many pixels, broken between words; no line where there is no text.
fn wrapped(text: &str, width: u32, size: u32) -> Vec<String> {
    let most = (f64::from(width) / (WIDE * f64::from(size))) as usize;
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= most => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// A strip of a ramp's colours.
fn bar(svg: &mut String, ramp: &Ramp, (left, top): (u32, u32), width: u32) {
    const STEPS: u32 = 128;
    for step in 0..STEPS {
        let at = |step: u32| f64::from(width) * f64::from(step) / f64::from(STEPS);
        let part = (f64::from(step) + 0.5) / f64::from(STEPS);
        let [r, g, b] = ramp.colour(ramp.ends.0 + (ramp.ends.1 - ramp.ends.0) * part);
        let _ = write!(
            svg,
            "<rect x=\"{}\" y=\"{top}\" width=\"{}\" height=\"12\" fill=\"rgb({r},{g},{b})\" shape-rendering=\"crispEdges\"/>",
            f64::from(left) + at(step),
            at(step + 1) - at(step)
        );
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(value: u8) -> Panel {
        Panel {
            title: "a < b".to_owned(),
            picture: Picture {
                width: 200,
                height: 100,
                rgb: vec![value; 3 * 200 * 100],
            },
            scale: Some((Ramp::both_ways(5.0), "%".to_owned())),
        }
    }

    #[test]
    fn long_lines_are_broken_between_words() {
        assert_eq!(wrapped("", 100, 14), Vec::<String>::new());
        let text = "one two three four five six seven eight nine ten";
        let lines = wrapped(text, 120, 14);
        assert!(
            lines.len() > 2 && lines.iter().all(|line| line.len() <= 14),
            "{lines:?}"
        );
        assert_eq!(lines.join(" "), text);
        assert_eq!(wrapped("unbreakable", 20, 14), ["unbreakable"]);
    }

    #[test]
    fn pictures_are_whole_and_do_not_overlap() {
        let board = ContactSheet {
            heading: "All".to_owned(),
            columns: 2,
            panels: (10..13).map(panel).collect(),
            notes: vec!["a note".to_owned()],
        };
        let drawn = board.draw().unwrap();
        for value in 10..13 {
            let count = drawn
                .rgb
                .chunks_exact(3)
                .filter(|pixel| *pixel == [value; 3])
                .count();
            assert!(count >= 200 * 100, "{value}: {count}");
        }
        assert!(drawn.width > 400 && drawn.height > 200);
    }
}
