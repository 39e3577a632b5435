//! PFM decoder: 32-bit floats, rows from the bottom.

use super::{
    depth::RawDepth,
    picture::SampleBits,
    source::{DecodeError, Source, checked_size, sample_count, zeros},
};
use std::io::{BufRead, Read};

/// Longest word of a header, bytes.
const MAX_WORD: usize = 64;

pub(super) fn read(mut source: Source<'_>) -> Result<RawDepth, DecodeError> {
    let length = source.length;
    let reader = &mut source.reader;
    let mut header = 0;
    let mut word = || word(reader, &mut header);
    match word()?.as_str() {
        "Pf" => {}
        "PF" => {
            return Err(DecodeError::invalid(
                "expected a PFM depth map (`Pf`), got colours (`PF`)",
            ));
        }
        other => {
            return Err(DecodeError::Invalid(format!(
                "expected `Pf` at the start of the PFM file, got `{other}`"
            )));
        }
    }
    let side = |word: String| {
        word.parse::<u64>()
            .map_err(|_| DecodeError::Invalid(format!("expected the PFM size, got `{word}`")))
    };
    let (width, height) = (side(word()?)?, side(word()?)?);
    let size = checked_size(width, height)?;
    let order = word()?;
    // The number is specified as a scale factor, but data sets write arbitrary values: only its sign is used.
    let little = match order.parse::<f64>() {
        Ok(n) if n < 0.0 => true,
        Ok(n) if n > 0.0 => false,
        _ => {
            return Err(DecodeError::Invalid(format!(
                "expected a PFM byte order below or above 0, got `{order}`"
            )));
        }
    };
    let mut values = zeros(sample_count(size, 1))?;
    // Where lines end in two characters, the second one is left.
    if length == header + 1 + 4 * values.len() as u64 {
        reader.read_exact(&mut [0])?;
    }
    let width = size.width() as usize;
    let mut bytes = vec![0; width * 4];
    for row in values.chunks_exact_mut(width).rev() {
        reader.read_exact(&mut bytes)?;
        for (value, &four) in row.iter_mut().zip(bytes.as_chunks::<4>().0) {
            *value = if little {
                f32::from_le_bytes(four)
            } else {
                f32::from_be_bytes(four)
            };
        }
    }
    Ok(RawDepth {
        size,
        values,
        bits: SampleBits::Float,
    })
}

/// Reads the next word and one white space after it; adds their bytes to `count`.
fn word(reader: &mut impl BufRead, count: &mut u64) -> Result<String, DecodeError> {
    let mut word = String::new();
    loop {
        let mut one = [0];
        reader.read_exact(&mut one)?;
        *count += 1;
        match one[0] {
            b' ' | b'\t' | b'\n' | b'\r' if word.is_empty() => {}
            b' ' | b'\t' | b'\n' | b'\r' => return Ok(word),
            letter @ b'!'..=b'~' if word.len() < MAX_WORD => word.push(char::from(letter)),
            _ => {
                return Err(DecodeError::invalid(
                    "expected a text header in the PFM file, got other bytes",
                ));
            }
        }
    }
}
