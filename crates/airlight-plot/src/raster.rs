//! From SVG to pixels.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};
use std::error::Error;
use std::sync::Arc;

/// The letters of every chart.
const FONT: &[u8] = include_bytes!("../font/DejaVuSans-subset.ttf");
const FAMILY: &str = "DejaVu Sans";

/// An opaque picture: red, green, blue, row after row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Three bytes a pixel, sRGB.
    pub rgb: Vec<u8>,
}

impl Picture {
    /// Draws an SVG on white, so many pixels for each of its own.
    ///
    /// # Errors
    /// Where the text is no SVG, or larger than memory.
    pub fn of_svg(svg: &str, scale: f32) -> Result<Self, Box<dyn Error>> {
        let mut fonts = fontdb::Database::new();
        fonts.load_font_data(FONT.to_vec());
        fonts.set_sans_serif_family(FAMILY);
        let options = Options {
            font_family: FAMILY.to_owned(),
            fontdb: Arc::new(fonts),
            ..Options::default()
        };
        let tree = Tree::from_str(svg, &options)?;
        let size = tree.size();
        let pixels = |length: f32| (length * scale).ceil() as u32;
        let (width, height) = (pixels(size.width()), pixels(size.height()));
        let mut pixmap = Pixmap::new(width, height)
            .ok_or_else(|| format!("a picture of {width} x {height} pixels is too large"))?;
        pixmap.fill(resvg::tiny_skia::Color::WHITE);
        let transform = Transform::from_scale(scale, scale);
        resvg::render(&tree, transform, &mut pixmap.as_mut());
        let rgb = pixmap
            .data()
            .chunks_exact(4)
            .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
            .collect();
        Ok(Self { width, height, rgb })
    }

    /// As a PNG file.
    ///
    /// # Errors
    /// Where the size is none that PNG has.
    pub fn png(&self) -> Result<Vec<u8>, Box<dyn Error>> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.rgb)?;
        writer.finish()?;
        Ok(bytes)
    }

    /// Puts another picture onto this one, its top left corner at `(left, top)`; what sticks out is cut off.
    pub fn put(&mut self, other: &Picture, (left, top): (u32, u32)) {
        let columns = other.width.min(self.width.saturating_sub(left)) as usize;
        let rows = other.height.min(self.height.saturating_sub(top));
        for row in 0..rows {
            let from = 3 * (row as usize * other.width as usize);
            let to = 3 * ((top + row) as usize * self.width as usize + left as usize);
            self.rgb[to..to + 3 * columns].copy_from_slice(&other.rgb[from..from + 3 * columns]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_drawn_with_the_font_at_hand() {
        let svg = |text: &str| {
            format!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="30"><text x="4" y="22" font-size="20" font-family="system-ui,sans-serif">{text}</text></svg>"#
            )
        };
        let dark = |text: &str| {
            let picture = Picture::of_svg(&svg(text), 2.0).unwrap();
            assert_eq!((picture.width, picture.height), (120, 60));
            picture.rgb.iter().filter(|&&byte| byte < 100).count()
        };
        assert_eq!(dark(""), 0);
        // Signs that labels of axes need.
        for sign in ["A", "\u{2212}", "\u{207b}\u{b9}", "λ", "%"] {
            assert!(dark(sign) > 20, "{sign}");
        }
    }

    #[test]
    fn a_picture_is_put_where_it_belongs_and_cut() {
        let blank = |width, height, value| Picture {
            width,
            height,
            rgb: vec![value; 3 * (width * height) as usize],
        };
        let mut large = blank(4, 3, 0);
        large.put(&blank(2, 2, 9), (3, 1));
        let lit: Vec<usize> = (0..12).filter(|i| large.rgb[3 * i] == 9).collect();
        assert_eq!(lit, [7, 11]);
    }

    #[test]
    fn png_keeps_every_byte() {
        let picture = Picture {
            width: 2,
            height: 1,
            rgb: vec![1, 2, 3, 250, 251, 252],
        };
        let bytes = picture.png().unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .unwrap();
        let mut back = vec![0; 6];
        reader.next_frame(&mut back).unwrap();
        assert_eq!(back, picture.rgb);
    }
}
