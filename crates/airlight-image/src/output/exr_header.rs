//! What the header of an EXR file says.

use super::{
    Metadata,
    options::{ExrCompression, ExrOptions, ExrSample},
};
use crate::{ImageError, Size};
use ::exr::{
    compression::Compression,
    math::Vec2,
    meta::{
        BlockDescription,
        attribute::{
            AttributeValue, ChannelDescription, Chromaticities, EnvironmentMap, LineOrder,
            SampleType, Text,
        },
        header::{Header, LayerAttributes},
    },
};
use std::collections::HashSet;

/// Bytes of a block of 16 or 32 scan lines above which single lines are compressed, to bound memory.
const LARGEST_BLOCK: usize = 16 << 20;

/// The header, and for each channel of the file (they are sorted by name) its place in the source's pixels.
pub(super) fn build(
    size: Size,
    channels: &[&str],
    options: &ExrOptions,
    metadata: &Metadata,
) -> Result<(Header, Vec<usize>), ImageError> {
    let mut order: Vec<usize> = (0..channels.len()).collect();
    order.sort_by_key(|&c| channels[c].as_bytes());
    let sample = match options.sample {
        ExrSample::Half => SampleType::F16,
        ExrSample::Float => SampleType::F32,
    };
    let list = order
        .iter()
        .map(|&c| ChannelDescription::named(text(channels[c]), sample))
        .collect();
    let bytes_per_line = size.width() as usize * channels.len() * sample.bytes_per_sample();
    let compression = match options.compression {
        ExrCompression::None => Compression::Uncompressed,
        ExrCompression::Rle => Compression::RLE,
        ExrCompression::ZipLine => Compression::ZIP1,
        ExrCompression::Zip if bytes_per_line * 16 > LARGEST_BLOCK => Compression::ZIP1,
        ExrCompression::Zip => Compression::ZIP16,
        ExrCompression::Piz if bytes_per_line * 32 > LARGEST_BLOCK => Compression::ZIP1,
        ExrCompression::Piz => Compression::PIZ,
    };
    let dimensions = Vec2(size.width() as usize, size.height() as usize);
    let mut header = Header::new(text("main"), dimensions, list)
        .with_encoding(
            compression,
            BlockDescription::ScanLines,
            LineOrder::Increasing,
        )
        .with_attributes(attributes(metadata));
    let point = |p: [f32; 2]| Vec2(p[0], p[1]);
    header.shared_attributes.chromaticities = metadata.chromaticities.map(|c| Chromaticities {
        red: point(c.red),
        green: point(c.green),
        blue: point(c.blue),
        white: point(c.white),
    });
    let taken: HashSet<Vec<u8>> = header
        .all_named_attributes()
        .map(|(name, _)| name.to_vec())
        .collect();
    for (name, value) in &metadata.texts {
        let name = attribute_name(name, &taken);
        header
            .own_attributes
            .other
            .insert(text(&name), AttributeValue::Text(text(value)));
    }
    Ok((header, order))
}

fn attributes(metadata: &Metadata) -> LayerAttributes {
    let words = |words: &Option<String>| words.as_deref().map(text);
    LayerAttributes {
        owner: words(&metadata.owner),
        comments: words(&metadata.comments),
        capture_date: words(&metadata.capture_date),
        software_name: words(&metadata.software),
        // OpenEXR: UTC = local time + offset.
        utc_offset: metadata.utc_offset_s.map(|s| -s),
        latitude: metadata.latitude_deg,
        longitude: metadata.longitude_deg,
        altitude: metadata.altitude_m,
        white_luminance: metadata.white_luminance_cd_m2,
        environment_map: metadata
            .is_latitude_longitude
            .then_some(EnvironmentMap::LatitudeLongitude),
        ..LayerAttributes::default()
    }
}

/// A text in UTF-8, as OpenEXR stores names and texts; without null bytes, which end names.
pub(super) fn text(words: &str) -> Text {
    Text::from_bytes_unchecked(words.bytes().filter(|&b| b != 0).collect())
}

/// A name that no standard attribute bears, 1 to 255 bytes long.
fn attribute_name(name: &str, taken: &HashSet<Vec<u8>>) -> String {
    let mut end = name.len().min(240);
    while !name.is_char_boundary(end) {
        end -= 1;
    }
    let name = &name[..end];
    let reserved = ::exr::meta::header::standard_names::ALL.contains(&name.as_bytes());
    if name.is_empty() || reserved || taken.contains(name.as_bytes()) {
        format!("airlight:{name}")
    } else {
        name.to_owned()
    }
}
