//! The outer form of a scan-line EXR file: header, table of offsets, blocks in order.
//!
//! Attributes are written in the order of their names, so that the same picture always makes the same bytes.

use crate::ImageError;
use ::exr::error::Error as ExrError;
use ::exr::meta::{MetaData, attribute, header::Header};
use std::io::{self, Seek, SeekFrom, Write};

/// Name of the format.
pub(super) const FORMAT: &str = "OpenEXR";

/// Magic number of OpenEXR files.
const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// File format version 2, single part, scan lines.
const VERSION: u32 = 2;

/// Flag of files in which a name is longer than 31 bytes.
const LONG_NAMES: u32 = 1 << 10;

/// A file being written, block after block from the top.
pub(super) struct ScanLineStream<'a, W> {
    out: &'a mut W,
    table_at: u64,
    next_at: u64,
    offsets: Vec<u64>,
}

impl<'a, W: Write + Seek> ScanLineStream<'a, W> {
    /// Writes the header and leaves room for the table.
    pub(super) fn start(out: &'a mut W, header: &Header) -> Result<Self, ImageError> {
        MetaData::validate(std::slice::from_ref(header), true).map_err(failed)?;
        let bytes = header_bytes(header)?;
        let start = out.stream_position().map_err(stream)?;
        out.write_all(&bytes).map_err(stream)?;
        let table_at = start + bytes.len() as u64;
        let table = vec![0; header.chunk_count * 8];
        out.write_all(&table).map_err(stream)?;
        Ok(Self {
            out,
            table_at,
            next_at: table_at + table.len() as u64,
            offsets: Vec::with_capacity(header.chunk_count),
        })
    }

    /// Writes the packed samples of the block that begins with row `y`.
    pub(super) fn block(&mut self, y: u32, packed: &[u8]) -> Result<(), ImageError> {
        let length = i32::try_from(packed.len()).map_err(|_| ImageError::Encode {
            format: FORMAT,
            reason: "a block of scan lines exceeds 2 GiB".to_owned(),
        })?;
        self.offsets.push(self.next_at);
        self.next_at += 8 + packed.len() as u64;
        let mut write = |bytes: &[u8]| self.out.write_all(bytes).map_err(stream);
        write(&(y as i32).to_le_bytes())?;
        write(&length.to_le_bytes())?;
        write(packed)
    }

    /// Fills in the table.
    pub(super) fn finish(self) -> Result<(), ImageError> {
        let table: Vec<u8> = self.offsets.iter().flat_map(|o| o.to_le_bytes()).collect();
        self.out
            .seek(SeekFrom::Start(self.table_at))
            .map_err(stream)?;
        self.out.write_all(&table).map_err(stream)?;
        self.out
            .seek(SeekFrom::Start(self.next_at))
            .map_err(stream)?;
        self.out.flush().map_err(stream)
    }
}

fn header_bytes(header: &Header) -> Result<Vec<u8>, ImageError> {
    let mut attributes: Vec<_> = header.all_named_attributes().collect();
    attributes.sort_by_key(|(name, _)| *name);
    let channel_names = header.channels.list.iter().map(|c| c.name.as_slice().len());
    let attribute_names = attributes.iter().map(|(name, _)| name.len());
    let long_names = channel_names
        .chain(attribute_names)
        .any(|length| length > 31);
    let version = if long_names {
        VERSION | LONG_NAMES
    } else {
        VERSION
    };
    let mut bytes = Vec::from(MAGIC);
    bytes.extend_from_slice(&version.to_le_bytes());
    for (name, value) in &attributes {
        attribute::write(name, value, &mut bytes).map_err(failed)?;
    }
    bytes.push(0);
    Ok(bytes)
}

fn stream(source: io::Error) -> ImageError {
    ImageError::Stream {
        format: FORMAT,
        source,
    }
}

/// The error of the EXR library as an error of this crate.
pub(super) fn failed(error: ExrError) -> ImageError {
    match error {
        ExrError::Io(source) => ImageError::Stream {
            format: FORMAT,
            source,
        },
        other => ImageError::Encode {
            format: FORMAT,
            reason: other.to_string(),
        },
    }
}
