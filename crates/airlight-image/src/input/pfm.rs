//! PFM files: 32-bit floats, rows from the bottom.

use super::{
    fault::{Fault, checked_size, samples, zeros},
    metres::Raw,
    picture::SampleBits,
    source::Source,
};
use std::io::{BufRead, Read};

/// The longest word of a header in bytes.
const LONGEST_WORD: usize = 64;

pub(super) fn read(mut source: Source) -> Result<Raw, Fault> {
    let reader = &mut source.reader;
    match word(reader)?.as_str() {
        "Pf" => {}
        "PF" => {
            return Err(Fault::bad(
                "as PFM it holds colours: a depth map begins with `Pf`",
            ));
        }
        other => {
            return Err(Fault::Bad(format!(
                "as PFM it must begin with `Pf`: it begins with `{other}`"
            )));
        }
    }
    let side = |word: String| {
        word.parse::<u64>()
            .map_err(|_| Fault::Bad(format!("as PFM it has `{word}` where its size should be")))
    };
    let (width, height) = (side(word(reader)?)?, side(word(reader)?)?);
    let size = checked_size(width, height)?;
    let order = word(reader)?;
    // The size of this number is meant as a factor, but data sets write anything: only the sign counts.
    let little = match order.parse::<f64>() {
        Ok(n) if n < 0.0 => true,
        Ok(n) if n > 0.0 => false,
        _ => {
            return Err(Fault::Bad(format!(
                "as PFM it must give a byte order below or above 0: it says `{order}`"
            )));
        }
    };
    let mut values = zeros(samples(size, 1))?;
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
    Ok(Raw {
        size,
        values,
        bits: SampleBits::Float,
    })
}

/// The next word, and the one white space after it.
fn word(reader: &mut impl BufRead) -> Result<String, Fault> {
    let mut word = String::new();
    loop {
        let mut one = [0];
        reader.read_exact(&mut one)?;
        match one[0] {
            b' ' | b'\t' | b'\n' | b'\r' if word.is_empty() => {}
            b' ' | b'\t' | b'\n' | b'\r' => return Ok(word),
            letter @ b'!'..=b'~' if word.len() < LONGEST_WORD => word.push(char::from(letter)),
            _ => return Err(Fault::bad("as PFM it has a header that is not text")),
        }
    }
}
