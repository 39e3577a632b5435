//! Deflate (RFC 1951) and zlib (RFC 1950) streams in independently compressed pieces.

use crate::ImageError;
use flate2::{Compress, Compression, FlushCompress, Status};

/// A compressor for many pieces.
pub(super) struct Deflater {
    format: &'static str,
    compress: Compress,
}

/// End of a piece of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// At a byte boundary, with more to follow.
    Open,
    /// With the last block of the stream.
    Last,
}

impl Deflater {
    /// At `level` 0 (stored) to 9 (smallest); with a zlib header and checksum, or bare.
    pub(super) fn new(format: &'static str, level: u8, zlib: bool) -> Self {
        Self {
            format,
            compress: Compress::new(Compression::new(u32::from(level.min(9))), zlib),
        }
    }

    /// Compresses a piece independently of those before it.
    pub(super) fn piece(&mut self, input: &[u8], end: End) -> Result<Vec<u8>, ImageError> {
        self.compress.reset();
        let flush = match end {
            End::Open => FlushCompress::Sync,
            End::Last => FlushCompress::Finish,
        };
        let mut output = Vec::with_capacity(input.len() / 2 + 1024);
        loop {
            let read = self.compress.total_in() as usize;
            let status = self
                .compress
                .compress_vec(&input[read..], &mut output, flush)
                .map_err(|e| ImageError::Encode {
                    format: self.format,
                    reason: e.to_string(),
                })?;
            let all_read = self.compress.total_in() as usize == input.len();
            let room_left = output.len() < output.capacity();
            let done = match end {
                // A flush is complete once the compressor leaves room in the output.
                End::Open => all_read && room_left,
                End::Last => status == Status::StreamEnd,
            };
            if done {
                return Ok(output);
            }
            output.reserve(output.len() / 2 + 1024);
        }
    }
}

/// Adler-32 checksum of a stream, composed from those of its pieces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Adler32 {
    sum: u32,
    sum_of_sums: u32,
}

/// Largest prime below 2^16.
const MODULUS: u32 = 65_521;

impl Adler32 {
    /// Checksum of no bytes.
    pub(super) const EMPTY: Self = Self {
        sum: 1,
        sum_of_sums: 0,
    };

    pub(super) fn of(bytes: &[u8]) -> Self {
        const LANES: usize = 32;
        let Self {
            mut sum,
            mut sum_of_sums,
        } = Self::EMPTY;
        // No more bytes of 255 than can be added before 32 bits overflow.
        for part in bytes.chunks(5504) {
            let (lanes, rest) = part.as_chunks::<LANES>();
            for lanes in lanes {
                // Each byte counts once for itself and each one after it.
                let weights = (1..=LANES as u32).rev();
                let weighted: u32 = lanes
                    .iter()
                    .zip(weights)
                    .map(|(&b, w)| u32::from(b) * w)
                    .sum();
                sum_of_sums += LANES as u32 * sum + weighted;
                sum += lanes.iter().map(|&byte| u32::from(byte)).sum::<u32>();
            }
            for &byte in rest {
                sum += u32::from(byte);
                sum_of_sums += sum;
            }
            sum %= MODULUS;
            sum_of_sums %= MODULUS;
        }
        Self { sum, sum_of_sums }
    }

    /// Checksum of these bytes followed by `length` bytes with checksum `next`.
    pub(super) fn then(self, next: Self, length: usize) -> Self {
        let m = u64::from(MODULUS);
        let length = length as u64 % m;
        // Each later partial sum is larger by the sum so far, less the 1 that each piece starts from.
        let carried = u64::from(self.sum) + m - 1;
        Self {
            sum: ((carried + u64::from(next.sum)) % m) as u32,
            sum_of_sums: ((u64::from(self.sum_of_sums)
                + u64::from(next.sum_of_sums)
                + length * (carried % m))
                % m) as u32,
        }
    }

    pub(super) fn value(self) -> u32 {
        self.sum_of_sums << 16 | self.sum
    }
}
