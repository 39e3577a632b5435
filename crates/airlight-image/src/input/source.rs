//! Files being read: their format, errors of decoders, limits of size and memory.

use crate::{Control, ImageError, Size};
use std::{
    fs::File,
    io::{self, BufReader, Cursor, Read, Seek, SeekFrom},
    panic::{self, AssertUnwindSafe},
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

/// A file format, recognised by its first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FileKind {
    Exr,
    Hdr,
    Png,
    Jpeg,
    Npy,
    Pfm,
    Npz,
    Tiff,
}

impl FileKind {
    fn from_magic(start: &[u8]) -> Option<Self> {
        const MAGIC: [(&[u8], FileKind); 12] = [
            (&[0x76, 0x2f, 0x31, 0x01], FileKind::Exr),
            (b"#?", FileKind::Hdr),
            (b"\x89PNG\r\n\x1a\n", FileKind::Png),
            (&[0xff, 0xd8, 0xff], FileKind::Jpeg),
            (b"\x93NUMPY", FileKind::Npy),
            (b"Pf", FileKind::Pfm),
            (b"PF", FileKind::Pfm),
            (b"PK\x03\x04", FileKind::Npz),
            (b"II*\0", FileKind::Tiff),
            (b"MM\0*", FileKind::Tiff),
            (b"II+\0", FileKind::Tiff),
            (b"MM\0+", FileKind::Tiff),
        ];
        MAGIC
            .iter()
            .find(|(magic, _)| start.starts_with(magic))
            .map(|&(_, kind)| kind)
    }
}

/// A file being read.
pub(super) struct Source<'a> {
    pub(super) kind: FileKind,
    /// At the first byte.
    pub(super) reader: BufReader<TrackedFile<'a>>,
    /// Size of the file in bytes.
    pub(super) length: u64,
    ended: Arc<AtomicBool>,
}

/// A file that records whether a read reached its end, and cannot be read once the caller has cancelled: so decoders of all formats
/// end.
pub(super) struct TrackedFile<'a> {
    bytes: Bytes,
    ended: Arc<AtomicBool>,
    control: Control<'a>,
}

/// Bytes of a file.
enum Bytes {
    File(File),
    /// Of a pipe, which cannot be read twice.
    Memory(Cursor<Vec<u8>>),
}

impl<'a> Source<'a> {
    /// How the caller cancels reading.
    pub(super) fn control(&self) -> Control<'a> {
        self.reader.get_ref().control
    }

    /// The file with other contents, in memory.
    pub(super) fn with_bytes(self, bytes: Vec<u8>) -> Self {
        let length = bytes.len() as u64;
        let tracked = TrackedFile {
            bytes: Bytes::Memory(Cursor::new(bytes)),
            ended: self.ended.clone(),
            control: self.control(),
        };
        Self {
            reader: BufReader::new(tracked),
            length,
            ..self
        }
    }

    /// The file once more, if it cannot be opened again, such as a pipe.
    pub(super) fn again(&self) -> Option<Self> {
        let Bytes::Memory(memory) = &self.reader.get_ref().bytes else {
            return None;
        };
        let ended = Arc::new(AtomicBool::new(false));
        let tracked = TrackedFile {
            bytes: Bytes::Memory(Cursor::new(memory.get_ref().clone())),
            ended: ended.clone(),
            control: self.control(),
        };
        Some(Self {
            kind: self.kind,
            reader: BufReader::new(tracked),
            length: self.length,
            ended,
        })
    }

    /// The whole contents, for decoders that work in memory. That the end was reached is then no sign of missing bytes.
    pub(super) fn read_to_end(&mut self) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        self.reader.read_to_end(&mut bytes)?;
        self.ended.store(false, Ordering::Relaxed);
        Ok(bytes)
    }
}

impl Read for TrackedFile<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.control.check().map_err(io::Error::other)?;
        let read = match &mut self.bytes {
            Bytes::File(file) => file.read(buffer)?,
            Bytes::Memory(memory) => memory.read(buffer)?,
        };
        if read == 0 && !buffer.is_empty() {
            self.ended.store(true, Ordering::Relaxed);
        }
        Ok(read)
    }
}

impl Seek for TrackedFile<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match &mut self.bytes {
            Bytes::File(file) => file.seek(to),
            Bytes::Memory(memory) => memory.seek(to),
        }
    }
}

/// Why the contents of a file cannot be decoded; [`decode_file`] adds the name of the file.
#[derive(Debug)]
pub(super) enum DecodeError {
    Io(io::Error),
    /// The contents are corrupt or of the wrong kind.
    Invalid(String),
    /// The file ends too early.
    Truncated(String),
    /// A channel is missing or ambiguous.
    NoChannel {
        wanted: String,
        available: String,
    },
}

impl DecodeError {
    pub(super) fn invalid(reason: impl Into<String>) -> Self {
        Self::Invalid(reason.into())
    }

    /// With the name of the file; `ended` where the decoder read past its end.
    fn in_file(self, path: &Path, ended: bool) -> ImageError {
        let path = path.to_owned();
        match self {
            Self::Io(error) if error.kind() == io::ErrorKind::UnexpectedEof => {
                ImageError::EndsEarly {
                    path,
                    reason: "bytes are missing".to_owned(),
                }
            }
            Self::Io(source) => ImageError::File {
                action: "read",
                path,
                source,
            },
            Self::Invalid(reason) if ended => ImageError::EndsEarly { path, reason },
            Self::Invalid(reason) => ImageError::Read { path, reason },
            Self::Truncated(reason) => ImageError::EndsEarly { path, reason },
            Self::NoChannel { wanted, available } => ImageError::NoChannel {
                path,
                wanted,
                available,
            },
        }
    }
}

impl From<io::Error> for DecodeError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// Opens a file and decodes it. `formats` lists the formats that `decode` distinguishes.
pub(super) fn decode_file<'a, T>(
    path: &Path,
    formats: &str,
    control: Control<'a>,
    decode: impl FnOnce(Source<'a>) -> Result<T, DecodeError>,
) -> Result<T, ImageError> {
    control.check()?;
    let source = open(path, formats, control).map_err(|error| error.in_file(path, false))?;
    decode_source(source, path, decode)
}

/// Decodes a file whose contents are in memory; `path` is its name in errors.
pub(super) fn decode_bytes<T>(
    bytes: Vec<u8>,
    path: &Path,
    formats: &str,
    decode: impl FnOnce(Source<'static>) -> Result<T, DecodeError>,
) -> Result<T, ImageError> {
    let length = bytes.len() as u64;
    let bytes = Bytes::Memory(Cursor::new(bytes));
    let source = source_of(bytes, length, formats, Control::default());
    decode_source(
        source.map_err(|error| error.in_file(path, false))?,
        path,
        decode,
    )
}

/// Decodes an open file.
pub(super) fn decode_source<'a, T>(
    source: Source<'a>,
    path: &Path,
    decode: impl FnOnce(Source<'a>) -> Result<T, DecodeError>,
) -> Result<T, ImageError> {
    let (ended, control) = (source.ended.clone(), source.control());
    // Some of the decoding libraries panic on corrupt files.
    let decoded = panic::catch_unwind(AssertUnwindSafe(|| decode(source)))
        .unwrap_or_else(|_| Err(DecodeError::invalid("corrupt data: the decoder failed")));
    // Whatever a decoder makes of a file that it may no longer read.
    control.check()?;
    decoded.map_err(|error| error.in_file(path, ended.load(Ordering::Relaxed)))
}

fn open<'a>(path: &Path, formats: &str, control: Control<'a>) -> Result<Source<'a>, DecodeError> {
    let mut file = File::open(path)?;
    let about = file.metadata()?;
    let (bytes, length) = if about.is_file() || about.is_dir() {
        (Bytes::File(file), about.len())
    } else {
        let mut memory = Vec::new();
        file.read_to_end(&mut memory)?;
        let length = memory.len() as u64;
        (Bytes::Memory(Cursor::new(memory)), length)
    };
    source_of(bytes, length, formats, control)
}

/// The source of bytes that are at their beginning.
fn source_of<'a>(
    mut bytes: Bytes,
    length: u64,
    formats: &str,
    control: Control<'a>,
) -> Result<Source<'a>, DecodeError> {
    let mut start = Vec::with_capacity(16);
    match &mut bytes {
        Bytes::File(file) => file.take(16).read_to_end(&mut start)?,
        Bytes::Memory(memory) => memory.take(16).read_to_end(&mut start)?,
    };
    if start.is_empty() {
        return Err(DecodeError::Truncated("it is empty (0 bytes)".to_owned()));
    }
    let kind = FileKind::from_magic(&start).ok_or_else(|| {
        DecodeError::Invalid(format!(
            "expected one of the formats {formats}, got another"
        ))
    })?;
    let ended = Arc::new(AtomicBool::new(false));
    let mut tracked = TrackedFile {
        bytes,
        ended: ended.clone(),
        control,
    };
    tracked.rewind()?;
    Ok(Source {
        kind,
        length,
        reader: BufReader::with_capacity(1 << 17, tracked),
        ended,
    })
}

/// Largest number of pixels of a picture.
const MAX_PIXELS: u64 = 1 << 30;

/// Checks the size of a picture.
pub(super) fn checked_size(width: u64, height: u64) -> Result<Size, DecodeError> {
    let refused = || {
        DecodeError::Invalid(format!(
            "expected 1 to {} pixels a side and at most {MAX_PIXELS} in total, got {width} x {height} pixels",
            Size::MAX
        ))
    };
    let side = |n: u64| u32::try_from(n).map_err(|_| refused());
    let size = Size::new(side(width)?, side(height)?).map_err(|_| refused())?;
    if width.saturating_mul(height) > MAX_PIXELS {
        return Err(refused());
    }
    Ok(size)
}

/// Number of samples of a picture with `channels` samples a pixel.
pub(super) fn sample_count(size: Size, channels: usize) -> usize {
    size.width() as usize * size.height() as usize * channels
}

/// An empty vector with capacity for `count` samples.
pub(super) fn reserve(count: usize) -> Result<Vec<f32>, DecodeError> {
    let mut samples = Vec::new();
    samples.try_reserve_exact(count).map_err(|_| {
        let mebibytes = (count as u64 * 4) >> 20;
        DecodeError::Invalid(format!("not enough memory for {mebibytes} MiB of samples"))
    })?;
    Ok(samples)
}

/// A vector of zeros, whose pages are not allocated before they are written.
pub(super) fn zeros(count: usize) -> Result<Vec<f32>, DecodeError> {
    drop(reserve(count)?);
    Ok(vec![0.0; count])
}
