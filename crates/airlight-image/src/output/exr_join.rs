//! [`join`]: one EXR file of bands of its rows, whose compressed blocks are copied.

use super::exr::{FORMAT, ScanLineStream};
use super::format::{Written, into_file};
use crate::{Control, ImageError};
use ::exr::{
    block::{self, chunk::CompressedBlock},
    error::Error as ExrError,
    math::Vec2,
    meta::{
        BlockDescription,
        attribute::{IntegerBounds, LineOrder},
        header::Header,
    },
};
use std::{
    fs::File,
    io::BufReader,
    ops::Range,
    path::{Path, PathBuf},
};

/// Joins EXR files, each of which has a band of the rows of one picture as its data window, to the file of the picture, whose rows
/// have the bits of the bands. The bands may be given in any order. Attributes are those of the first row's band.
///
/// Memory is that of one compressed block of rows.
///
/// # Errors
/// [`ImageError`] for a file that cannot be read, bands of different pictures, rows that are missing or in two bands, and bands that
/// begin within a compressed block of rows: those of a multiple of [`RowBand::MULTIPLE`](super::RowBand::MULTIPLE) rows do not. The
/// target is then unchanged.
pub fn join(bands: &[PathBuf], target: &Path, control: Control<'_>) -> Result<Written, ImageError> {
    let opened = bands.iter().map(|path| Band::open(path));
    let mut bands = opened.collect::<Result<Vec<_>, _>>()?;
    bands.sort_by_key(|band| band.rows.start);
    let header = header_of_all(&bands)?;
    into_file(target, control, |out| {
        let mut stream = ScanLineStream::start(out, &header)?;
        for band in &bands {
            band.copy(&mut stream, control)?;
            control.report(u64::from(band.rows.end), header.layer_size.1 as u64);
        }
        stream.finish()?;
        Ok(Written::default())
    })
}

/// A file with a band of rows.
struct Band {
    path: PathBuf,
    header: Header,
    /// Its rows in the display window.
    rows: Range<u32>,
}

impl Band {
    fn open(path: &Path) -> Result<Self, ImageError> {
        let reader = block::read(BufReader::new(open(path)?), false).map_err(at(path))?;
        let [header] = reader.headers() else {
            return Err(refusal(path, "it has several parts, expected one"));
        };
        if header.blocks != BlockDescription::ScanLines
            || header.line_order != LineOrder::Increasing
            || header.deep
        {
            return Err(refusal(path, "expected scan lines from top to bottom"));
        }
        let window = header.shared_attributes.display_window;
        let corner = header.own_attributes.layer_position - window.position;
        let (width, height) = (header.layer_size.0, header.layer_size.1);
        let bottom = i64::from(corner.1) + height as i64;
        if corner.0 != 0 || width != window.size.0 || corner.1 < 0 || bottom > window.size.1 as i64
        {
            return Err(refusal(
                path,
                "expected whole rows of its display window as its data window",
            ));
        }
        Ok(Self {
            path: path.to_owned(),
            rows: corner.1 as u32..bottom as u32,
            header: header.clone(),
        })
    }

    /// Copies the compressed blocks.
    fn copy(
        &self,
        stream: &mut ScanLineStream<'_>,
        control: Control<'_>,
    ) -> Result<(), ImageError> {
        let file = BufReader::with_capacity(1 << 20, open(&self.path)?);
        let reader = block::read(file, false).map_err(at(&self.path))?;
        let top = i64::from(self.header.own_attributes.layer_position.1);
        let lines = self.header.compression.scan_lines_per_block() as u32;
        let mut next = 0;
        for chunk in reader.all_chunks(false).map_err(at(&self.path))? {
            control.check()?;
            let CompressedBlock::ScanLine(found) = chunk.map_err(at(&self.path))?.compressed_block
            else {
                return Err(refusal(&self.path, "expected blocks of scan lines"));
            };
            if i64::from(found.y_coordinate) != top + i64::from(next) {
                return Err(refusal(&self.path, "its blocks of rows are not in order"));
            }
            stream.block(self.rows.start + next, &found.compressed_pixels_le)?;
            next += lines;
        }
        Ok(())
    }

    /// The header without what differs between the bands of a picture.
    fn common(&self) -> Header {
        let header = Header::new(
            Default::default(),
            self.header.shared_attributes.display_window.size,
            self.header.channels.list.clone(),
        );
        let mut header = header.with_encoding(
            self.header.compression,
            self.header.blocks,
            self.header.line_order,
        );
        header.shared_attributes = self.header.shared_attributes.clone();
        header
    }
}

/// The header of the picture, once all its rows are there.
fn header_of_all(bands: &[Band]) -> Result<Header, ImageError> {
    let Some(first) = bands.first() else {
        return Err(ImageError::Setting {
            what: "the number of bands",
            got: "0".to_owned(),
            right: "1 or more",
        });
    };
    let lines = first.header.compression.scan_lines_per_block() as u32;
    let mut next = 0;
    for band in bands {
        if band.common() != first.common() {
            let reason = format!(
                "its channels, size or encoding are not those of `{}`, so it is a band of another picture",
                first.path.display()
            );
            return Err(refusal(&band.path, reason));
        }
        let start = band.rows.start;
        if start != next {
            let reason = match start > next {
                true => format!("rows {next} to {} of the picture are in no band", start - 1),
                false => format!("rows {start} to {} are also in another band", next - 1),
            };
            return Err(refusal(&band.path, reason));
        }
        if start % lines != 0 {
            let reason = format!("expected a first row that is a multiple of {lines}, got {start}");
            return Err(refusal(&band.path, reason));
        }
        next = band.rows.end;
    }
    let IntegerBounds { position, size } = first.header.shared_attributes.display_window;
    let (last, height) = (&bands[bands.len() - 1], size.1 as u32);
    if next != height {
        let reason = format!(
            "rows {next} to {} of the picture are in no band",
            height - 1
        );
        return Err(refusal(&last.path, reason));
    }
    let mut header = first.common();
    header.own_attributes = first.header.own_attributes.clone();
    header.own_attributes.layer_position = Vec2(position.0, position.1);
    Ok(header)
}

fn open(path: &Path) -> Result<File, ImageError> {
    File::open(path).map_err(|source| ImageError::File {
        action: "read",
        path: path.to_owned(),
        source,
    })
}

fn refusal(path: &Path, reason: impl Into<String>) -> ImageError {
    ImageError::Read {
        path: path.to_owned(),
        reason: reason.into(),
    }
}

/// Errors of a file.
fn at(path: &Path) -> impl Fn(ExrError) -> ImageError + '_ {
    move |error| refusal(path, format!("{FORMAT}: {error}"))
}
