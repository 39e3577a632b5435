//! NPZ files: ZIP archives of NumPy arrays, stored or deflated.

use super::source::{DecodeError, Source};
use flate2::{Decompress, FlushDecompress, Status};

/// An array in an archive.
struct Entry {
    name: String,
    method: u16,
    packed: usize,
    unpacked: usize,
    /// Position of the local header.
    at: usize,
}

/// Names of depth arrays among several, the likeliest first.
const DEPTH_NAMES: [&str; 6] = ["depth", "depths", "depth_map", "z", "distance", "disparity"];

/// Largest archive with 32-bit sizes.
const UNKNOWN: u32 = u32::MAX;

/// The array with a name, or the depth, as an NPY file in memory.
pub(super) fn open<'a>(
    mut source: Source<'a>,
    wanted: Option<&str>,
) -> Result<Source<'a>, DecodeError> {
    let bytes = source.read_to_end()?;
    let entries = directory(&bytes)?;
    let arrays: Vec<&Entry> = entries
        .iter()
        .filter(|entry| entry.name.ends_with(".npy"))
        .collect();
    let short = |entry: &&Entry| entry.name.trim_end_matches(".npy").to_owned();
    let found = match wanted {
        Some(wanted) => arrays.iter().find(|entry| short(entry) == wanted),
        None if arrays.len() == 1 => arrays.first(),
        None => DEPTH_NAMES
            .iter()
            .find_map(|known| arrays.iter().find(|e| short(e).eq_ignore_ascii_case(known))),
    };
    let Some(entry) = found else {
        return Err(DecodeError::NoChannel {
            wanted: match wanted {
                Some(wanted) => format!("array `{wanted}`"),
                None => "array that is clearly depth; try depth-channel with a name".to_owned(),
            },
            available: arrays.iter().map(short).collect::<Vec<_>>().join(", "),
        });
    };
    let array = unpack(&bytes, entry)?;
    Ok(source.with_bytes(array))
}

fn corrupt() -> DecodeError {
    DecodeError::invalid("corrupt NPZ data: the archive's directory is damaged")
}

fn u16_at(bytes: &[u8], at: usize) -> Result<u16, DecodeError> {
    let two = bytes.get(at..).and_then(<[u8]>::first_chunk);
    two.map(|two| u16::from_le_bytes(*two)).ok_or_else(corrupt)
}

fn u32_at(bytes: &[u8], at: usize) -> Result<u32, DecodeError> {
    let four = bytes.get(at..).and_then(<[u8]>::first_chunk);
    four.map(|four| u32::from_le_bytes(*four))
        .ok_or_else(corrupt)
}

fn u64_at(bytes: &[u8], at: usize) -> Result<u64, DecodeError> {
    let eight = bytes.get(at..).and_then(<[u8]>::first_chunk);
    eight
        .map(|eight| u64::from_le_bytes(*eight))
        .ok_or_else(corrupt)
}

/// The central directory (ZIP application note, 4.3.12), which the end record (4.3.16) locates.
fn directory(bytes: &[u8]) -> Result<Vec<Entry>, DecodeError> {
    let end = bytes
        .windows(4)
        .rposition(|four| four == b"PK\x05\x06")
        .filter(|end| end + 22 <= bytes.len())
        .ok_or_else(|| DecodeError::Truncated("the archive's directory is missing".to_owned()))?;
    let count = u16_at(bytes, end + 10)?;
    let mut at = u32_at(bytes, end + 16)? as usize;
    let mut entries = Vec::new();
    for _ in 0..count {
        if bytes.get(at..at + 4) != Some(b"PK\x01\x02".as_slice()) {
            return Err(corrupt());
        }
        let (name_length, extra_length) = (u16_at(bytes, at + 28)?, u16_at(bytes, at + 30)?);
        let name_end = at + 46 + usize::from(name_length);
        let name = bytes.get(at + 46..name_end).ok_or_else(corrupt)?;
        let extra_end = name_end + usize::from(extra_length);
        let mut wide = wide_sizes(bytes, name_end, extra_end)?.into_iter();
        let mut size = |short: u32| match short {
            UNKNOWN => wide.next().ok_or_else(corrupt),
            short => Ok(u64::from(short)),
        };
        // In the order of the extra field.
        let unpacked = size(u32_at(bytes, at + 24)?)?;
        let packed = size(u32_at(bytes, at + 20)?)?;
        let start = size(u32_at(bytes, at + 42)?)?;
        let whole = |n: u64| usize::try_from(n).map_err(|_| corrupt());
        entries.push(Entry {
            name: String::from_utf8_lossy(name).into_owned(),
            method: u16_at(bytes, at + 10)?,
            packed: whole(packed)?,
            unpacked: whole(unpacked)?,
            at: whole(start)?,
        });
        at = extra_end + usize::from(u16_at(bytes, at + 32)?);
    }
    Ok(entries)
}

/// The 64-bit numbers of an entry's extra fields (ZIP application note, 4.5.3).
fn wide_sizes(bytes: &[u8], mut at: usize, end: usize) -> Result<Vec<u64>, DecodeError> {
    while at + 4 <= end {
        let length = usize::from(u16_at(bytes, at + 2)?);
        if u16_at(bytes, at)? == 1 {
            let numbers = (at + 4..(at + 4 + length).min(end)).step_by(8);
            return numbers
                .take(length / 8)
                .map(|at| u64_at(bytes, at))
                .collect();
        }
        at += 4 + length;
    }
    Ok(Vec::new())
}

fn unpack(bytes: &[u8], entry: &Entry) -> Result<Vec<u8>, DecodeError> {
    let lengths = (u16_at(bytes, entry.at + 26)?, u16_at(bytes, entry.at + 28)?);
    let start = entry.at + 30 + usize::from(lengths.0) + usize::from(lengths.1);
    let end = start.checked_add(entry.packed).ok_or_else(corrupt)?;
    let packed = bytes.get(start..end).ok_or_else(corrupt)?;
    match entry.method {
        0 => Ok(packed.to_vec()),
        8 => {
            let mut out = Vec::new();
            out.try_reserve_exact(entry.unpacked)
                .map_err(|_| DecodeError::invalid("not enough memory for the array"))?;
            let mut inflate = Decompress::new(false);
            let status = inflate.decompress_vec(packed, &mut out, FlushDecompress::Finish);
            match status {
                Ok(Status::StreamEnd) if out.len() == entry.unpacked => Ok(out),
                _ => Err(DecodeError::invalid(
                    "corrupt NPZ data: an array cannot be unpacked",
                )),
            }
        }
        other => Err(DecodeError::Invalid(format!(
            "expected arrays that are stored or deflated, got compression method {other}"
        ))),
    }
}
