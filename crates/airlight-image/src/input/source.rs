//! A file opened for reading, and what kind of file its first bytes say it is.

use super::fault::Fault;
use crate::ImageError;
use std::{
    fs::File,
    io::{self, BufReader, Read, Seek, SeekFrom},
    panic::{self, AssertUnwindSafe},
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

/// What the first bytes of a file say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Exr,
    Hdr,
    Png,
    Jpeg,
    Npy,
    Pfm,
}

impl Kind {
    fn of(start: &[u8]) -> Option<Self> {
        const MAGIC: [(&[u8], Kind); 6] = [
            (&[0x76, 0x2f, 0x31, 0x01], Kind::Exr),
            (b"#?", Kind::Hdr),
            (b"\x89PNG\r\n\x1a\n", Kind::Png),
            (&[0xff, 0xd8, 0xff], Kind::Jpeg),
            (b"\x93NUMPY", Kind::Npy),
            // Followed by white space.
            (b"Pf", Kind::Pfm),
        ];
        MAGIC
            .iter()
            .find(|(magic, _)| start.starts_with(magic))
            .map(|&(_, kind)| kind)
            .or(start.starts_with(b"PF").then_some(Self::Pfm))
    }
}

/// A file being read.
pub(super) struct Source {
    pub(super) kind: Kind,
    /// From its first byte.
    pub(super) reader: BufReader<Watched>,
    /// Bytes in the file.
    pub(super) length: u64,
    ended: Arc<AtomicBool>,
}

/// A file that remembers whether more was asked of it than it holds.
pub(super) struct Watched {
    file: File,
    ended: Arc<AtomicBool>,
}

impl Read for Watched {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read(buffer)?;
        if read == 0 && !buffer.is_empty() {
            self.ended.store(true, Ordering::Relaxed);
        }
        Ok(read)
    }
}

impl Seek for Watched {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

/// Opens a file, has `decode` read it, and puts the file's name to what it complains of. `known` lists the formats that
/// `decode` can tell apart.
pub(super) fn with_source<T>(
    path: &Path,
    known: &str,
    decode: impl FnOnce(Source) -> Result<T, Fault>,
) -> Result<T, ImageError> {
    let source = open(path, known).map_err(|fault| fault.at(path, false))?;
    let ended = source.ended.clone();
    // Some decoders that this room builds on panic on corrupt files.
    panic::catch_unwind(AssertUnwindSafe(|| decode(source)))
        .unwrap_or_else(|_| Err(Fault::bad("it is corrupt: its decoder gave up")))
        .map_err(|fault| fault.at(path, ended.load(Ordering::Relaxed)))
}

fn open(path: &Path, known: &str) -> Result<Source, Fault> {
    let mut file = File::open(path)?;
    let length = file.metadata()?.len();
    let mut start = Vec::with_capacity(16);
    (&mut file).take(16).read_to_end(&mut start)?;
    if start.is_empty() {
        return Err(Fault::Early("it is empty (0 bytes)".to_owned()));
    }
    let kind = Kind::of(&start)
        .ok_or_else(|| Fault::Bad(format!("it is none of the formats that are read ({known})")))?;
    file.rewind()?;
    let ended = Arc::new(AtomicBool::new(false));
    Ok(Source {
        kind,
        length,
        reader: BufReader::with_capacity(
            1 << 17,
            Watched {
                file,
                ended: ended.clone(),
            },
        ),
        ended,
    })
}
