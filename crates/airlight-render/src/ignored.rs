//! Options of the output that the format of its file would ignore are refused.

use crate::error::RenderError;
use airlight::scene::{Gamut, OutputSpec};
use airlight::spectrum::RgbSpace;
use airlight_image::PictureFormat;
use std::path::Path;

/// Kinds of files that an option acts on.
#[derive(Clone, Copy)]
enum ActsOn {
    /// Linear light: EXR and HDR.
    Linear,
    /// Tone-mapped pictures: PNG, JPEG and previews.
    Display,
    /// One format; EXR also for the noise map beside a picture of another format.
    Format(PictureFormat),
}

impl ActsOn {
    fn includes(self, format: PictureFormat, output: &OutputSpec, is_previewed: bool) -> bool {
        let has_noise_map = output.noise_map == Some(true);
        match self {
            Self::Linear => format.is_linear() || has_noise_map,
            Self::Display => !format.is_linear() || is_previewed,
            Self::Format(only) if only == PictureFormat::EXR && has_noise_map => true,
            Self::Format(only) => format == only,
        }
    }

    /// Endings of file names that the option acts on.
    fn endings(self) -> String {
        let formats = PictureFormat::ALL.into_iter().filter(|format| match self {
            Self::Linear => format.is_linear(),
            Self::Display => !format.is_linear(),
            Self::Format(only) => *format == only,
        });
        let endings: Vec<String> = formats
            .map(|format| format!(".{}", format.endings()[0]))
            .collect();
        endings.join(" or ")
    }
}

/// Options of an output: key, whether it is set, and the files that it acts on.
fn options(output: &OutputSpec) -> [(&'static str, bool, ActsOn); 15] {
    use ActsOn::{Display, Format, Linear};
    let is_other_space = output
        .color_space
        .is_some_and(|space| space != RgbSpace::Srgb);
    [
        ("color_space", is_other_space, Linear),
        ("scale", output.scale.is_some(), Linear),
        ("gamut", output.gamut == Some(Gamut::Desaturate), Linear),
        ("exposure", output.exposure.is_some(), Display),
        ("brighten", output.brighten.is_some(), Display),
        ("tone", output.tone.is_some(), Display),
        ("tone_contrast", output.tone_contrast.is_some(), Display),
        ("saturation", output.saturation.is_some(), Display),
        ("white_balance_k", output.white_balance_k.is_some(), Display),
        ("scotopic", output.scotopic == Some(true), Display),
        (
            "spectral",
            output.spectral == Some(true),
            Format(PictureFormat::EXR),
        ),
        (
            "precision",
            output.precision.is_some(),
            Format(PictureFormat::EXR),
        ),
        (
            "compression",
            output.compression.is_some(),
            Format(PictureFormat::EXR),
        ),
        ("bits", output.bits.is_some(), Format(PictureFormat::PNG)),
        (
            "quality",
            output.quality.is_some(),
            Format(PictureFormat::JPEG),
        ),
    ]
}

/// Refuses the first option that is set and that a file of a format would ignore. `is_previewed`: the picture is also shown tone
/// mapped, so that options of display formats have an effect.
///
/// # Errors
/// [`RenderError`] with the key, and the endings of files on which it acts.
pub(crate) fn refuse_ignored(
    output: &OutputSpec,
    file: &Path,
    format: PictureFormat,
    is_previewed: bool,
) -> Result<(), RenderError> {
    let ignored = |(_, is_set, acts_on): &(&str, bool, ActsOn)| {
        *is_set && !acts_on.includes(format, output, is_previewed)
    };
    match options(output).into_iter().find(ignored) {
        None => Ok(()),
        Some((key, _, acts_on)) => Err(RenderError::value(
            format!("output.{key}"),
            format!(
                "a file whose name ends in {}, which this acts on",
                acts_on.endings()
            ),
            format!("`{}`", file.display()),
            "leaving it out",
        )),
    }
}

/// Refuses the first option that is set and that acts on the display of linear light, for a picture of display colours.
///
/// # Errors
/// [`RenderError`] with the key and the picture.
pub(crate) fn refuse_display_options(
    output: &OutputSpec,
    picture: &Path,
) -> Result<(), RenderError> {
    let acts =
        |(_, is_set, acts_on): &(&str, bool, ActsOn)| *is_set && matches!(acts_on, ActsOn::Display);
    match options(output).into_iter().find(acts) {
        None => Ok(()),
        Some((key, ..)) => Err(RenderError::value(
            format!("output.{key}"),
            "a picture of linear light (EXR, HDR, TIFF of floats), which this acts on",
            format!("`{}`", picture.display()),
            "leaving it out",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight::scene::{Exposure, ExrCompression, SamplePrecision, ToneKind};

    #[test]
    fn every_option_is_refused_where_it_is_ignored() {
        type Set = fn(&mut OutputSpec);
        let set: [(&str, Set, &[&str]); 14] = [
            (
                "white_balance_k",
                |o| o.white_balance_k = Some(5000.0),
                &["png", "jpg"],
            ),
            ("scotopic", |o| o.scotopic = Some(true), &["png", "jpg"]),
            (
                "color_space",
                |o| o.color_space = Some(RgbSpace::AcesCg),
                &["exr", "hdr"],
            ),
            ("scale", |o| o.scale = Some(2.0), &["exr", "hdr"]),
            (
                "gamut",
                |o| o.gamut = Some(Gamut::Desaturate),
                &["exr", "hdr"],
            ),
            (
                "exposure",
                |o| o.exposure = Some(Exposure::AUTO),
                &["png", "jpg"],
            ),
            ("brighten", |o| o.brighten = Some(0.0), &["png", "jpg"]),
            ("tone", |o| o.tone = Some(ToneKind::Clip), &["png", "jpg"]),
            ("saturation", |o| o.saturation = Some(1.0), &["png", "jpg"]),
            ("spectral", |o| o.spectral = Some(true), &["exr"]),
            (
                "precision",
                |o| o.precision = Some(SamplePrecision::Half),
                &["exr"],
            ),
            (
                "compression",
                |o| o.compression = Some(ExrCompression::Zip),
                &["exr"],
            ),
            ("bits", |o| o.bits = Some(16), &["png"]),
            ("quality", |o| o.quality = Some(90), &["jpg"]),
        ];
        for (key, set, acts_on) in set {
            for ending in ["exr", "hdr", "png", "jpg"] {
                let mut output = OutputSpec::default();
                set(&mut output);
                let file = format!("a.{ending}");
                let format = PictureFormat::from_path(file.as_ref()).unwrap();
                match refuse_ignored(&output, file.as_ref(), format, false) {
                    Ok(()) => assert!(acts_on.contains(&ending), "{key} with {ending}"),
                    Err(error) => {
                        let said = error.to_string();
                        assert!(!acts_on.contains(&ending), "{said}");
                        assert!(
                            said.starts_with(&format!("output.{key}: expected")),
                            "{said}"
                        );
                        assert!(said.contains(&format!(".{}", acts_on[0])), "{said}");
                    }
                }
                let shown = refuse_ignored(&output, file.as_ref(), format, true).is_ok();
                assert_eq!(
                    shown,
                    acts_on.contains(&ending) || acts_on == ["png", "jpg"]
                );
            }
        }
    }

    #[test]
    fn options_of_the_noise_map_are_accepted_beside_a_png() {
        let output = OutputSpec {
            noise_map: Some(true),
            scale: Some(1e-3),
            precision: Some(SamplePrecision::Half),
            ..Default::default()
        };
        assert!(refuse_ignored(&output, "a.png".as_ref(), PictureFormat::PNG, false).is_ok());
    }
}
