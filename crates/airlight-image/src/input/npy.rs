//! NumPy's NPY files: whole numbers and floats of any width and byte order, by rows or by columns.

use super::{
    fault::{Fault, checked_size, room, samples, zeros},
    metres::Raw,
    picture::SampleBits,
    source::Source,
};
use half::f16;
use std::io::Read;

/// The longest header in bytes.
const LONGEST_HEADER: u32 = 1 << 20;

/// Bytes read at a time.
const PIECE: usize = 1 << 16;

pub(super) fn read(mut source: Source) -> Result<Raw, Fault> {
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
            return Err(Fault::Bad(format!(
                "as NPY it must be of version 1, 2 or 3: it is {other}"
            )));
        }
    };
    if header_length > LONGEST_HEADER {
        return Err(Fault::bad("as NPY it has a header of more than 1 MiB"));
    }
    let mut header = vec![0; header_length as usize];
    reader.read_exact(&mut header)?;
    let header = String::from_utf8_lossy(&header);
    let element = Element::parse(&header)?;
    let (height, width) = shape(&header)?;
    let size = checked_size(width, height)?;
    let by_columns = match value(&header, "fortran_order").map(|v| v.starts_with("True")) {
        Some(by_columns) => by_columns,
        None => return Err(Fault::bad("as NPY it does not say its fortran_order")),
    };
    let needed = samples(size, element.bytes) as u64;
    let there = length.saturating_sub(before + u64::from(header_length));
    // Devices and pipes have no length.
    if length > 0 && there < needed {
        return Err(Fault::Early(format!(
            "{needed} bytes of samples are announced, {there} are there"
        )));
    }
    let mut values = room(samples(size, 1))?;
    let mut buffer = vec![0; PIECE];
    let mut left = needed;
    while left > 0 {
        let piece = &mut buffer[..left.min(PIECE as u64) as usize];
        reader.read_exact(piece)?;
        element.append(piece, &mut values);
        left -= piece.len() as u64;
    }
    if by_columns {
        values = transposed(&values, size.width() as usize, size.height() as usize)?;
    }
    Ok(Raw {
        size,
        values,
        bits: element.bits(),
    })
}

fn transposed(columns: &[f32], width: usize, height: usize) -> Result<Vec<f32>, Fault> {
    let mut rows = zeros(columns.len())?;
    for (x, column) in columns.chunks_exact(height).enumerate() {
        for (to, from) in rows[x..].iter_mut().step_by(width).zip(column) {
            *to = *from;
        }
    }
    Ok(rows)
}

/// What stands after `'name':` in the header.
fn value<'a>(header: &'a str, name: &str) -> Option<&'a str> {
    let quoted = |quote: char| {
        let key = format!("{quote}{name}{quote}");
        header.split_once(&key).map(|(_, after)| after)
    };
    let after = quoted('\'').or_else(|| quoted('"'))?;
    Some(after.trim_start().strip_prefix(':')?.trim_start())
}

/// Rows and columns.
fn shape(header: &str) -> Result<(u64, u64), Fault> {
    let missing = || Fault::bad("as NPY it does not say its shape");
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
        _ => Err(Fault::Bad(format!(
            "as NPY it must have the shape (height, width), with or without a 1 before or after: it is ({list})"
        ))),
    }
}

/// The kind of its numbers.
#[derive(Clone, Copy)]
struct Element {
    little: bool,
    kind: u8,
    bytes: usize,
}

impl Element {
    fn parse(header: &str) -> Result<Self, Fault> {
        let described = value(header, "descr").unwrap_or_default();
        let quote = described.chars().next().unwrap_or('\'');
        let name = described.split(quote).nth(1).unwrap_or_default();
        let refused = || {
            let shown: String = described.chars().take(40).collect();
            Fault::Bad(format!(
                "as NPY it must hold numbers of type f2, f4, f8, u1, u2, u4, u8, i1, i2, i4 or i8: it says {shown}"
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
