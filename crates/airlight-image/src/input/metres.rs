//! From the numbers of a depth file to metres.

use super::{
    depth::{DepthMeaning, DepthOptions},
    picture::SampleBits,
};
use crate::{ImageError, Size};
use rayon::prelude::*;
use std::path::Path;

/// At or beyond this nothing was met, metres: renderers write 1e10 and more where a ray leaves the scene.
const NOTHING_MET_M: f64 = 1e9;

/// The same in units of the file, whatever its scale.
const NOTHING_MET: f32 = 9.9e9;

/// The pixels worked on together.
const PIECE: usize = 1 << 14;

/// A map in the numbers of its file.
pub(super) struct Raw {
    pub(super) size: Size,
    pub(super) values: Vec<f32>,
    pub(super) bits: SampleBits,
}

/// Pixels of each kind.
#[derive(Clone, Copy, Default)]
pub(super) struct Counts {
    pub(super) holes: u64,
    pub(super) infinite: u64,
    negative: u64,
    /// Place and value of the first negative pixel.
    first: Option<(usize, f32)>,
}

impl Counts {
    fn and(self, later: Self) -> Self {
        Self {
            holes: self.holes + later.holes,
            infinite: self.infinite + later.infinite,
            negative: self.negative + later.negative,
            first: self.first.or(later.first),
        }
    }
}

/// What one number says.
enum Said {
    Metres(f64),
    Hole,
    Negative,
}

/// Turns the numbers into metres in place, holes into not-a-number, and counts.
pub(super) fn convert(
    path: &Path,
    raw: &mut Raw,
    options: &DepthOptions,
) -> Result<Counts, ImageError> {
    let far = options.far_from_m.unwrap_or(NOTHING_MET_M);
    let far = far.min(NOTHING_MET_M);
    let counts = raw
        .values
        .par_chunks_mut(PIECE)
        .enumerate()
        .map(|(piece, values)| {
            let mut counts = Counts::default();
            for (i, value) in values.iter_mut().enumerate() {
                let metres = match said(*value, options) {
                    Said::Metres(metres) if metres >= far => {
                        counts.infinite += 1;
                        f32::INFINITY
                    }
                    Said::Metres(metres) => metres as f32,
                    Said::Negative if !options.negative_is_unknown => {
                        counts.negative += 1;
                        counts.first = counts.first.or(Some((piece * PIECE + i, *value)));
                        0.0
                    }
                    Said::Hole | Said::Negative => {
                        counts.holes += 1;
                        f32::NAN
                    }
                };
                *value = metres;
            }
            counts
        })
        .reduce(Counts::default, Counts::and);
    let width = raw.size.width() as usize;
    if let Some((at, value)) = counts.first {
        return Err(ImageError::NegativeDepth {
            path: path.to_owned(),
            count: counts.negative,
            x: (at % width) as u32,
            y: (at / width) as u32,
            value,
        });
    }
    if counts.holes == raw.values.len() as u64 {
        return Err(ImageError::Read {
            path: path.to_owned(),
            reason: format!(
                "nothing is known in it: all its {} pixels are holes ({})",
                counts.holes,
                holes_of(&options.meaning)
            ),
        });
    }
    Ok(counts)
}

fn holes_of(meaning: &DepthMeaning) -> &'static str {
    match meaning {
        DepthMeaning::ZDepth | DepthMeaning::RayDistance => "0 or not a number",
        DepthMeaning::Disparity { .. } => "0, infinite or not a number",
        DepthMeaning::Inverse => "infinite or not a number",
    }
}

#[inline(always)]
fn said(value: f32, options: &DepthOptions) -> Said {
    let scaled = f64::from(value) * options.scale;
    match options.meaning {
        _ if value.is_nan() => Said::Hole,
        DepthMeaning::ZDepth | DepthMeaning::RayDistance => match value {
            0.0 => Said::Hole,
            v if v < 0.0 => Said::Negative,
            v if v >= NOTHING_MET => Said::Metres(f64::INFINITY),
            _ => Said::Metres(scaled),
        },
        DepthMeaning::Disparity {
            focal_length_px,
            baseline_m,
            offset_px,
        } => {
            let disparity = scaled + offset_px;
            if value == 0.0 || value.is_infinite() {
                Said::Hole
            } else if disparity <= 0.0 {
                Said::Metres(f64::INFINITY)
            } else {
                Said::Metres(focal_length_px * baseline_m / disparity)
            }
        }
        DepthMeaning::Inverse => match value {
            f32::INFINITY => Said::Hole,
            v if v < 0.0 => Said::Negative,
            // 1 / 0 is infinite.
            _ => Said::Metres(1.0 / scaled.abs()),
        },
    }
}
