//! Functions that the tests of picture files share.

pub mod files;
mod folder;

pub use folder::Folder;

use airlight::spectrum::RgbSpace;
use airlight_image::{
    Frame, Size,
    output::Metadata,
    rows::{RowFn, RowSource},
    tone::{ToneCurve, ToneMapper},
};

/// A smooth sky with a bright sun, `channels` samples a pixel.
pub fn sky(size: Size, channels: usize) -> impl RowSource {
    RowFn::new(channels, move |y, out: &mut [f32]| {
        for (x, pixel) in out.chunks_mut(channels).enumerate() {
            for (c, value) in pixel.iter_mut().enumerate() {
                *value = sample(size, x as u32, y, c);
            }
        }
    })
}

pub fn sample(size: Size, x: u32, y: u32, c: usize) -> f32 {
    let (u, v) = (
        x as f32 / size.width() as f32,
        y as f32 / size.height() as f32,
    );
    let sun = if (u - 0.3).hypot(v - 0.4) < 0.03 {
        900.0
    } else {
        0.0
    };
    (0.02 + 0.3 * v * v + 0.1 * u) * (1.0 + 0.5 * c as f32) + sun
}

pub fn size(width: u32, height: u32) -> Size {
    Size::new(width, height).unwrap()
}

pub fn tone() -> ToneMapper {
    ToneMapper::new(1.0, ToneCurve::default()).unwrap()
}

pub fn full_metadata() -> Metadata {
    Metadata {
        software: Some("airlight test".into()),
        owner: Some("Zażółć".into()),
        comments: Some("two\nlines".into()),
        capture_date: Some("2024:06:21 14:00:00".into()),
        utc_offset_s: Some(7200.0),
        latitude_deg: Some(52.5),
        longitude_deg: Some(13.4),
        altitude_m: Some(34.0),
        white_luminance_cd_m2: Some(1.0),
        chromaticities: Some(RgbSpace::Srgb.into()),
        pixel_aspect: None,
        band: None,
        carried: None,
        texts: vec![
            ("units".into(), "cd/m^2".into()),
            ("place".into(), "Łódź".into()),
            // Names that the format reserves, and an empty one.
            ("channels".into(), "not really".into()),
            ("software".into(), "twice".into()),
            (String::new(), "nameless".into()),
            ("x".repeat(400), "long\0".into()),
        ],
    }
    .with_frame(&Frame::equirectangular(16).unwrap())
}
