//! TIFF decoder for depth maps: one sample to a pixel, integers or floats of any width.

use super::{
    depth::RawDepth,
    picture::SampleBits,
    source::{DecodeError, Source, checked_size, sample_count},
};
use ::tiff::{
    ColorType, TiffError,
    decoder::{Decoder, DecodingResult, Limits},
};

/// Largest size of the decoded samples, bytes.
const MAX_BYTES: usize = 1 << 33;

pub(super) fn read(source: Source) -> Result<RawDepth, DecodeError> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MAX_BYTES;
    let mut decoder = Decoder::new(source.reader)
        .map_err(failed)?
        .with_limits(limits);
    let (width, height) = decoder.dimensions().map_err(failed)?;
    let size = checked_size(width.into(), height.into())?;
    match decoder.colortype().map_err(failed)? {
        ColorType::Gray(_) => {}
        other => {
            return Err(DecodeError::Invalid(format!(
                "expected a TIFF depth map with one sample to a pixel, got {other:?}"
            )));
        }
    }
    let image = decoder.read_image().map_err(failed)?;
    let (values, bits): (Vec<f32>, SampleBits) = match image {
        DecodingResult::U8(v) => (v.into_iter().map(f32::from).collect(), SampleBits::U8),
        DecodingResult::I8(v) => (v.into_iter().map(f32::from).collect(), SampleBits::U8),
        DecodingResult::U16(v) => (v.into_iter().map(f32::from).collect(), SampleBits::U16),
        DecodingResult::I16(v) => (v.into_iter().map(f32::from).collect(), SampleBits::U16),
        DecodingResult::U32(v) => (v.into_iter().map(|v| v as f32).collect(), SampleBits::U32),
        DecodingResult::I32(v) => (v.into_iter().map(|v| v as f32).collect(), SampleBits::U32),
        DecodingResult::U64(v) => (v.into_iter().map(|v| v as f32).collect(), SampleBits::U32),
        DecodingResult::I64(v) => (v.into_iter().map(|v| v as f32).collect(), SampleBits::U32),
        DecodingResult::F16(v) => (
            v.into_iter().map(|v| v.to_f32()).collect(),
            SampleBits::Half,
        ),
        DecodingResult::F32(v) => (v, SampleBits::Float),
        DecodingResult::F64(v) => (v.into_iter().map(|v| v as f32).collect(), SampleBits::Float),
    };
    if values.len() != sample_count(size, 1) {
        return Err(DecodeError::invalid(
            "expected a TIFF depth map of 8 bits or more, got fewer",
        ));
    }
    Ok(RawDepth { size, values, bits })
}

fn failed(error: TiffError) -> DecodeError {
    match error {
        TiffError::IoError(error) => DecodeError::Io(error),
        TiffError::LimitsExceeded => {
            DecodeError::invalid("its samples take more than 8 GiB of memory")
        }
        TiffError::UnsupportedError(what) => {
            DecodeError::Invalid(format!("unsupported TIFF file: {what}"))
        }
        other => DecodeError::Invalid(format!("corrupt TIFF data: {other}")),
    }
}
