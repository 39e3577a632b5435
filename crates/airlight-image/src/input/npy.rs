//! NPY decoder (NumPy arrays): integers and floats of any width and byte order, in C or Fortran order.

use super::{
    depth::RawDepth,
    picture::SampleBits,
    source::{DecodeError, Source, checked_size, reserve, sample_count, zeros},
};
use half::f16;
use std::io::Read;

/// Longest header, bytes.
const MAX_HEADER: u32 = 1 << 20;

/// Bytes read at a time.
const BLOCK: usize = 1 << 16;

pub(super) fn read(mut source: Source<'_>) -> Result<RawDepth, DecodeError> {
    let length = source.length;
    let reader = &mut source.reader;
    let mut start = [0; 8];
    reader.read_exact(&mut start)?;
    let (header_length, before) = match start[6] {
        1 => {
            let mut two = [0; 2];
            reader.read_exact(&mut two)?;
            (u32::from(u16::from_le_bytes(two)), 10)
        }
        2 | 3 => {
            let mut four = [0; 4];
            reader.read_exact(&mut four)?;
            (u32::from_le_bytes(four), 12)
        }
        other => {
            return Err(DecodeError::Invalid(format!(
                "expected NPY version 1, 2 or 3, got {other}"
            )));
        }
    };
    if header_length > MAX_HEADER {
        return Err(DecodeError::invalid(
            "expected an NPY header of at most 1 MiB, got a longer one",
        ));
    }
    let mut header = vec![0; header_length as usize];
    reader.read_exact(&mut header)?;
    let header = String::from_utf8_lossy(&header);
    let element = Element::parse(&header)?;
    let (height, width) = shape(&header)?;
    let size = checked_size(width, height)?;
    let fortran_order = match value(&header, "fortran_order").map(|v| v.starts_with("True")) {
        Some(fortran_order) => fortran_order,
        None => {
            return Err(DecodeError::invalid(
                "expected `fortran_order` in the NPY header, got none",
            ));
        }
    };
    let needed = sample_count(size, element.bytes) as u64;
    let available = length.saturating_sub(before + u64::from(header_length));
    if available < needed {
        return Err(DecodeError::Truncated(format!(
            "expected {needed} bytes of samples, got {available}"
        )));
    }
    let mut values = reserve(sample_count(size, 1))?;
    let mut buffer = vec![0; BLOCK];
    let mut left = needed;
    while left > 0 {
        let block = &mut buffer[..left.min(BLOCK as u64) as usize];
        reader.read_exact(block)?;
        element.append(block, &mut values);
        left -= block.len() as u64;
    }
    if fortran_order {
        values = transposed(&values, size.width() as usize, size.height() as usize)?;
    }
    Ok(RawDepth {
        size,
        values,
        bits: element.bits(),
    })
}

fn transposed(columns: &[f32], width: usize, height: usize) -> Result<Vec<f32>, DecodeError> {
    let mut rows = zeros(columns.len())?;
    for (x, column) in columns.chunks_exact(height).enumerate() {
        for (to, from) in rows[x..].iter_mut().step_by(width).zip(column) {
            *to = *from;
        }
    }
    Ok(rows)
}

/// Text after `'name':` in the header.
fn value<'a>(header: &'a str, name: &str) -> Option<&'a str> {
    let quoted = |quote: char| {
        let key = format!("{quote}{name}{quote}");
        header.split_once(&key).map(|(_, after)| after)
    };
    let after = quoted('\'').or_else(|| quoted('"'))?;
    Some(after.trim_start().strip_prefix(':')?.trim_start())
}

/// Rows and columns.
fn shape(header: &str) -> Result<(u64, u64), DecodeError> {
    let missing = || DecodeError::invalid("expected a shape in the NPY header, got none");
    let list = value(header, "shape").ok_or_else(missing)?;
    let list = list.strip_prefix('(').ok_or_else(missing)?;
    let (list, _) = list.split_once(')').ok_or_else(missing)?;
    let numbers: Vec<u64> = list
        .split(',')
        .map(str::trim)
        .filter(|number| !number.is_empty())
        .map(|number| number.trim_end_matches('L').parse().map_err(|_| missing()))
        .collect::<Result<_, _>>()?;
    match numbers[..] {
        [height, width] | [height, width, 1] | [1, height, width] => Ok((height, width)),
        _ => Err(DecodeError::Invalid(format!(
            "expected the NPY shape (height, width), optionally with a 1 before or after, got ({list})"
        ))),
    }
}

/// Element type of an array.
#[derive(Clone, Copy)]
struct Element {
    little: bool,
    kind: u8,
    bytes: usize,
}

impl Element {
    fn parse(header: &str) -> Result<Self, DecodeError> {
        let described = value(header, "descr").unwrap_or_default();
        let quote = described.chars().next().unwrap_or('\'');
        let name = described.split(quote).nth(1).unwrap_or_default();
        let refused = || {
            let shown: String = described.chars().take(40).collect();
            DecodeError::Invalid(format!(
                "expected NPY numbers of type f2, f4, f8, u1, u2, u4, u8, i1, i2, i4 or i8, got {shown}"
            ))
        };
        let (&[order, kind, bytes], true) = (name.as_bytes(), matches!(quote, '\'' | '"')) else {
            return Err(refused());
        };
        let little = match order {
            b'<' => true,
            b'>' => false,
            b'|' | b'=' => cfg!(target_endian = "little"),
            _ => return Err(refused()),
        };
        let bytes = match (kind, bytes) {
            (b'f', b'2' | b'4' | b'8') | (b'u' | b'i', b'1' | b'2' | b'4' | b'8') => {
                usize::from(bytes - b'0')
            }
            _ => return Err(refused()),
        };
        Ok(Self {
            little,
            kind,
            bytes,
        })
    }

    fn bits(self) -> SampleBits {
        match (self.kind, self.bytes) {
            (b'f', 2) => SampleBits::Half,
            (b'f', _) => SampleBits::Float,
            (_, 1) => SampleBits::U8,
            (_, 2) => SampleBits::U16,
            _ => SampleBits::U32,
        }
    }

    fn append(self, bytes: &[u8], out: &mut Vec<f32>) {
        match (self.kind, self.bytes) {
            (b'f', 2) => self.each(bytes, out, |b| f16::from_le_bytes(b).to_f32()),
            (b'f', 4) => self.each(bytes, out, f32::from_le_bytes),
            (b'f', _) => self.each(bytes, out, |b| f64::from_le_bytes(b) as f32),
            (b'u', 1) => self.each(bytes, out, |[b]| f32::from(b)),
            (b'u', 2) => self.each(bytes, out, |b| f32::from(u16::from_le_bytes(b))),
            (b'u', 4) => self.each(bytes, out, |b| u32::from_le_bytes(b) as f32),
            (b'u', _) => self.each(bytes, out, |b| u64::from_le_bytes(b) as f32),
            (_, 1) => self.each(bytes, out, |b| f32::from(i8::from_le_bytes(b))),
            (_, 2) => self.each(bytes, out, |b| f32::from(i16::from_le_bytes(b))),
            (_, 4) => self.each(bytes, out, |b| i32::from_le_bytes(b) as f32),
            _ => self.each(bytes, out, |b| i64::from_le_bytes(b) as f32),
        }
    }

    fn each<const N: usize>(self, bytes: &[u8], out: &mut Vec<f32>, of: impl Fn([u8; N]) -> f32) {
        let (numbers, _) = bytes.as_chunks::<N>();
        if self.little {
            out.extend(numbers.iter().map(|&number| of(number)));
        } else {
            out.extend(numbers.iter().map(|&(mut number)| {
                number.reverse();
                of(number)
            }));
        }
    }
}
