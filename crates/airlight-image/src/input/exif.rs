//! EXIF data of photographs: the orientation of the camera, and the colour space of files without a profile.

use super::Orientation;

/// What a reader needs of EXIF data.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Exif {
    pub(super) orientation: Orientation,
    /// The interoperability index names Adobe RGB ("R03", DCF 2.0).
    pub(super) is_adobe_rgb: bool,
}

const ORIENTATION: u16 = 0x0112;
const EXIF_DIRECTORY: u16 = 0x8769;
const INTEROPERABILITY_DIRECTORY: u16 = 0xa005;
const INTEROPERABILITY_INDEX: u16 = 1;

impl Exif {
    /// Reads a TIFF structure, optionally after `Exif\0\0`. Entries that are missing or corrupt have their defaults.
    pub(super) fn parse(bytes: &[u8]) -> Self {
        let tiff = bytes.strip_prefix(b"Exif\0\0").unwrap_or(bytes);
        Tiff::new(tiff).map_or_else(Self::default, |tiff| tiff.exif().unwrap_or_default())
    }
}

/// A TIFF structure in either byte order.
struct Tiff<'a> {
    bytes: &'a [u8],
    little: bool,
}

impl<'a> Tiff<'a> {
    fn new(bytes: &'a [u8]) -> Option<Self> {
        let little = match bytes.get(..4)? {
            b"II*\0" => true,
            b"MM\0*" => false,
            _ => return None,
        };
        Some(Self { bytes, little })
    }

    fn exif(&self) -> Option<Exif> {
        let first = self.u32(4)?;
        let orientation = self.entry(first, ORIENTATION).and_then(|at| self.u16(at));
        let index = self
            .entry(first, EXIF_DIRECTORY)
            .and_then(|at| self.entry(self.u32(at)?, INTEROPERABILITY_DIRECTORY))
            .and_then(|at| self.entry(self.u32(at)?, INTEROPERABILITY_INDEX));
        let adobe = index.and_then(|at| self.bytes.get(at..at + 3)) == Some(b"R03");
        Some(Exif {
            orientation: orientation
                .and_then(Orientation::from_exif)
                .unwrap_or_default(),
            is_adobe_rgb: adobe,
        })
    }

    /// Position of the value of an entry of the directory at `start`.
    fn entry(&self, start: u32, tag: u16) -> Option<usize> {
        let start = start as usize;
        let count = usize::from(self.u16(start)?);
        (0..count)
            .map(|i| start + 2 + 12 * i)
            .take_while(|&at| at + 12 <= self.bytes.len())
            .find(|&at| self.u16(at) == Some(tag))
            .map(|at| at + 8)
    }

    fn u16(&self, at: usize) -> Option<u16> {
        let two = self.bytes.get(at..)?.first_chunk()?;
        Some(match self.little {
            true => u16::from_le_bytes(*two),
            false => u16::from_be_bytes(*two),
        })
    }

    fn u32(&self, at: usize) -> Option<u32> {
        let four = self.bytes.get(at..)?.first_chunk()?;
        Some(match self.little {
            true => u32::from_le_bytes(*four),
            false => u32::from_be_bytes(*four),
        })
    }
}
