//! Pictures in memory: from SVG, composed, to PNG.

use crate::PlotError;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};
use std::sync::Arc;

/// Font of every text.
const FONT: &[u8] = include_bytes!("../font/DejaVuSans-subset.ttf");
const FAMILY: &str = "DejaVu Sans";

/// An opaque picture in memory, 8-bit sRGB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Raster {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Red, green and blue of each pixel, row after row from the top.
    pub rgb: Vec<u8>,
}

impl Raster {
    /// Renders an SVG document on white, with `scale` pixels for each of its pixels.
    ///
    /// # Errors
    /// [`PlotError::Svg`] where the text is not SVG, [`PlotError::Size`] where the picture is empty or does not fit in memory.
    pub fn from_svg(svg: &str, scale: f32) -> Result<Self, PlotError> {
        let mut fonts = fontdb::Database::new();
        fonts.load_font_data(FONT.to_vec());
        fonts.set_sans_serif_family(FAMILY);
        let options = Options {
            font_family: FAMILY.to_owned(),
            fontdb: Arc::new(fonts),
            ..Options::default()
        };
        let tree =
            Tree::from_str(svg, &options).map_err(|error| PlotError::Svg(error.to_string()))?;
        let size = tree.size();
        let pixels = |length: f32| (length * scale).ceil() as u32;
        let (width, height) = (pixels(size.width()), pixels(size.height()));
        let mut pixmap = Pixmap::new(width, height).ok_or(PlotError::Size { width, height })?;
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

    /// The bytes of a PNG file.
    ///
    /// # Errors
    /// [`PlotError::Png`] where the encoder refuses the size.
    pub fn to_png(&self) -> Result<Vec<u8>, PlotError> {
        self.encode()
            .map_err(|error| PlotError::Png(error.to_string()))
    }

    fn encode(&self) -> Result<Vec<u8>, png::EncodingError> {
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

    /// Copies another picture onto this one, its top left corner at `(left, top)`; what lies outside is cut off.
    pub fn paste(&mut self, other: &Raster, (left, top): (u32, u32)) {
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
    fn texts_are_drawn_with_the_embedded_font() {
        let svg = |text: &str| {
            format!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="30"><text x="4" y="22" font-size="20" font-family="system-ui,sans-serif">{text}</text></svg>"#
            )
        };
        let dark = |text: &str| {
            let picture = Raster::from_svg(&svg(text), 2.0).unwrap();
            assert_eq!((picture.width, picture.height), (120, 60));
            picture.rgb.iter().filter(|&&byte| byte < 100).count()
        };
        assert_eq!(dark(""), 0);
        // Characters in labels of axes.
        for sign in ["A", "\u{2212}", "\u{207b}\u{b9}", "λ", "%"] {
            assert!(dark(sign) > 20, "{sign}");
        }
    }

    #[test]
    fn a_pasted_picture_is_cut_at_the_edge() {
        let blank = |width, height, value| Raster {
            width,
            height,
            rgb: vec![value; 3 * (width * height) as usize],
        };
        let mut large = blank(4, 3, 0);
        large.paste(&blank(2, 2, 9), (3, 1));
        let lit: Vec<usize> = (0..12).filter(|i| large.rgb[3 * i] == 9).collect();
        assert_eq!(lit, [7, 11]);
    }

    #[test]
    fn png_keeps_every_byte() {
        let picture = Raster {
            width: 2,
            height: 1,
            rgb: vec![1, 2, 3, 250, 251, 252],
        };
        let bytes = picture.to_png().unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
            .read_info()
            .unwrap();
        let mut back = vec![0; 6];
        reader.next_frame(&mut back).unwrap();
        assert_eq!(back, picture.rgb);
    }
}
