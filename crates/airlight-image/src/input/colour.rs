//! Decoding of display colours to linear sRGB, by what a file says about them: code points (cICP), an ICC profile, or
//! primaries and gamma.

use super::picture::{SRGB_8, SRGB_16, decoding_table};
use crate::output::Chromaticities;
use airlight::spectrum::rgb::srgb_decode;
use glam::{DMat3, Mat3, Vec3};
use moxcms::{
    CicpColorPrimaries, CicpProfile, ColorProfile, DataColorSpace, Layout, MatrixCoefficients,
    ProfileText, ToneReprCurve, TransferCharacteristics, TransformF32Executor, TransformOptions,
};
use rayon::prelude::*;
use std::{borrow::Cow, sync::Arc};

/// Luminance of a display's reference white in high dynamic range, cd/m^2 (ITU-R BT.2408): light of 1.
const REFERENCE_WHITE_CD_M2: f64 = 203.0;
/// Luminance of the largest signal of the perceptual quantizer, cd/m^2 (SMPTE ST 2084).
const PQ_PEAK_CD_M2: f64 = 10_000.0;
/// Luminance of the largest signal of hybrid log-gamma on the display for which its system gamma is 1.2 (ITU-R BT.2100).
const HLG_PEAK_CD_M2: f64 = 1000.0;
const HLG_GAMMA: f64 = 1.2;
/// Luminance of red, green and blue in hybrid log-gamma (ITU-R BT.2100, table 5).
const HLG_LUMINANCE: Vec3 = Vec3::new(0.2627, 0.6780, 0.0593);
/// Largest difference from sRGB, in linear light and in the matrix, of a profile that is taken for sRGB itself.
const SAME: f64 = 2e-3;
/// Pixels converted together.
const BLOCK: usize = 1 << 12;

/// How display colours are decoded to linear sRGB, in two steps: [`Self::table`], then [`Self::finish`].
pub(super) struct ColourDecoding {
    /// Name of the colour space; `None` for sRGB.
    name: Option<String>,
    steps: Steps,
}

enum Steps {
    Srgb,
    /// A curve for all components, then a matrix to linear sRGB.
    Curve(Curve, Option<DMat3>),
    /// A curve for each component, then a matrix.
    Curves([Curve; 3], DMat3),
    /// Hybrid log-gamma: light in the scene, whose luminance determines the display's; then a matrix.
    Hlg(DMat3),
    /// A profile with tables.
    Lookup(Arc<TransformF32Executor>),
}

/// Light of an encoded component in `[0, 1]`.
enum Curve {
    Srgb,
    Power(f64),
    Cicp(TransferCharacteristics, f64),
    Icc(Box<dyn moxcms::ToneCurveEvaluator + Send + Sync>),
    /// A signal from 16/255 to 235/255.
    NarrowRange(Box<Self>),
}

impl Curve {
    fn at(&self, signal: f64) -> f64 {
        match self {
            Self::Srgb => srgb_decode(signal),
            Self::Power(exponent) => signal.powf(*exponent),
            Self::Cicp(curve, peak) => peak * curve.linearize(signal),
            Self::Icc(curve) => f64::from(curve.evaluate_value(signal as f32)),
            Self::NarrowRange(curve) => curve.at(((signal * 255.0 - 16.0) / 219.0).clamp(0.0, 1.0)),
        }
    }

    fn is_like(&self, other: &Self) -> bool {
        (0..=64).all(|i| {
            let signal = f64::from(i) / 64.0;
            (self.at(signal) - other.at(signal)).abs() < SAME
        })
    }
}

impl ColourDecoding {
    pub(super) fn srgb() -> Self {
        Self {
            name: None,
            steps: Steps::Srgb,
        }
    }

    /// By an ICC profile.
    ///
    /// # Errors
    /// Why the profile cannot be used for a picture of `components` colour components.
    pub(super) fn from_icc(profile: &[u8], components: usize) -> Result<Self, String> {
        let profile = ColorProfile::new_from_slice(profile).map_err(|error| error.to_string())?;
        let name = profile.description.as_ref().and_then(name_of);
        let named = |steps| Self {
            name: Some(
                name.clone()
                    .unwrap_or("a profile without a name".to_owned()),
            ),
            steps,
        };
        let curve = |curve: &Option<ToneReprCurve>| {
            let curve = curve.as_ref().ok_or("it has no tone curve")?;
            let curve = curve.make_linear_evaluator();
            curve.map(Curve::Icc).map_err(|error| error.to_string())
        };
        match (profile.color_space, components) {
            (DataColorSpace::Gray, 1) => {
                let curve = curve(&profile.gray_trc)?;
                Ok(named(Steps::Curve(curve, None)).or_srgb())
            }
            (DataColorSpace::Rgb, _) => {
                // Curves of high dynamic range do not fit into a profile, which approximates them for a display.
                use TransferCharacteristics::{Hlg, Smpte2084};
                if let Some(cicp) = profile.cicp
                    && matches!(cicp.transfer_characteristics, Hlg | Smpte2084)
                    && let Some(decoding) = Self::from_code_points(
                        cicp.color_primaries,
                        cicp.transfer_characteristics,
                        true,
                    )
                {
                    return Ok(decoding);
                }
                if profile.lut_a_to_b_perceptual.is_some()
                    || profile.lut_a_to_b_colorimetric.is_some()
                {
                    if name.as_ref().is_some_and(|name| name.contains("sRGB")) {
                        return Ok(Self::srgb());
                    }
                    let mut linear = ColorProfile::new_srgb();
                    let straight = || Some(ToneReprCurve::Lut(Vec::new()));
                    (linear.red_trc, linear.green_trc) = (straight(), straight());
                    (linear.blue_trc, linear.cicp) = (straight(), None);
                    let transform = profile.create_transform_f32(
                        Layout::Rgb,
                        &linear,
                        Layout::Rgb,
                        TransformOptions::default(),
                    );
                    return transform
                        .map(|transform| named(Steps::Lookup(transform)))
                        .map_err(|error| error.to_string());
                }
                let curves = [
                    curve(&profile.red_trc)?,
                    curve(&profile.green_trc)?,
                    curve(&profile.blue_trc)?,
                ];
                let matrix = to_srgb(&profile);
                if !matrix.is_finite() || matrix.determinant().abs() < 1e-6 {
                    return Err("its primaries are on one line".to_owned());
                }
                Ok(named(Steps::Curves(curves, matrix)).or_srgb())
            }
            (space, _) => Err(format!("it is for another colour space, {space:?}")),
        }
    }

    /// By code points of ITU-T H.273; `None` for reserved, unspecified and unsupported ones.
    pub(super) fn from_cicp(primaries: u8, transfer: u8, full_range: bool) -> Option<Self> {
        Self::from_code_points(
            primaries.try_into().ok()?,
            transfer.try_into().ok()?,
            full_range,
        )
    }

    fn from_code_points(
        primaries: CicpColorPrimaries,
        transfer: TransferCharacteristics,
        full_range: bool,
    ) -> Option<Self> {
        use TransferCharacteristics as Transfer;
        let primaries_name = primaries_name(primaries)?;
        let (transfer_name, peak) = match transfer {
            Transfer::Reserved | Transfer::Unspecified => return None,
            Transfer::Smpte2084 => (" PQ", PQ_PEAK_CD_M2 / REFERENCE_WHITE_CD_M2),
            Transfer::Hlg => (" HLG", 1.0),
            Transfer::Linear => (", linear", 1.0),
            _ => ("", 1.0),
        };
        // The profile is used for its primaries.
        let profile = ColorProfile::new_from_cicp(CicpProfile {
            color_primaries: primaries,
            transfer_characteristics: Transfer::Srgb,
            matrix_coefficients: MatrixCoefficients::Identity,
            full_range: true,
        });
        let matrix = to_srgb(&profile);
        let steps = if transfer == Transfer::Hlg {
            Steps::Hlg(matrix)
        } else {
            let curve = match transfer {
                Transfer::Srgb => Curve::Srgb,
                other => Curve::Cicp(other, peak),
            };
            let curve = match full_range {
                true => curve,
                false => Curve::NarrowRange(Box::new(curve)),
            };
            Steps::Curve(curve, Some(matrix))
        };
        let decoding = Self {
            name: Some(format!("{primaries_name}{transfer_name}")),
            steps,
        };
        Some(decoding.or_srgb())
    }

    /// By primaries and white, and the exponent of a power law; sRGB where one is missing. `None` for impossible primaries.
    pub(super) fn from_primaries(
        primaries: Option<Chromaticities>,
        exponent: Option<f64>,
    ) -> Option<Self> {
        let matrix = match primaries {
            Some(primaries) => Some(primaries.to_linear_srgb()?),
            None => None,
        };
        let is_foreign = matrix.is_some_and(|matrix| !is_identity(&matrix));
        // A gamma of 2.2 is how files without other primaries approximate the sRGB curve.
        let is_about_srgb = |exponent: f64| !is_foreign && (exponent / 2.2 - 1.0).abs() < 0.05;
        let curve = match exponent {
            Some(exponent) if !is_about_srgb(exponent) => Curve::Power(exponent),
            _ => Curve::Srgb,
        };
        let name = match (is_foreign, exponent) {
            (true, _) => "other primaries (cHRM)".to_owned(),
            (false, Some(exponent)) => format!("gamma {}", (exponent * 100.0).round() / 100.0),
            (false, None) => String::new(),
        };
        let decoding = Self {
            name: Some(name),
            steps: Steps::Curve(curve, matrix),
        };
        Some(decoding.or_srgb())
    }

    /// Adobe RGB (1998): the colour space of photographs whose EXIF data say R03.
    pub(super) fn adobe_rgb() -> Self {
        Self {
            name: Some("Adobe RGB (1998)".to_owned()),
            steps: Steps::Curve(
                Curve::Power(563.0 / 256.0),
                Some(to_srgb(&ColorProfile::new_adobe_rgb())),
            ),
        }
    }

    /// Simplifies equal curves, and recognises sRGB under another name.
    fn or_srgb(self) -> Self {
        let Self { name, steps } = self;
        let steps = match steps {
            Steps::Curves([red, green, blue], matrix)
                if red.is_like(&green) && green.is_like(&blue) =>
            {
                Steps::Curve(green, Some(matrix))
            }
            other => other,
        };
        match steps {
            Steps::Curve(curve, matrix)
                if curve.is_like(&Curve::Srgb) && matrix.is_none_or(|m| is_identity(&m)) =>
            {
                Self::srgb()
            }
            Steps::Curve(curve, matrix) => Self {
                name,
                steps: Steps::Curve(curve, matrix.filter(|m| !is_identity(m))),
            },
            steps => Self { name, steps },
        }
    }

    /// Name of the colour space where it is not sRGB.
    pub(super) fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// Matrix from linear light of the colour space to linear sRGB (`None`: it is that of sRGB); `None` for a space of encoded light.
    pub(super) fn of_linear_light(&self) -> Option<Option<Mat3>> {
        match &self.steps {
            Steps::Curve(curve, matrix) if curve.is_like(&Curve::Power(1.0)) => {
                Some(matrix.as_ref().map(narrowed))
            }
            _ => None,
        }
    }

    /// Value for each of `levels` encoded values, 256 or 65536, that [`Self::finish`] expects.
    pub(super) fn table(&self, levels: u32) -> Cow<'static, [f32]> {
        match &self.steps {
            Steps::Srgb | Steps::Curve(Curve::Srgb, _) if levels == 256 => {
                Cow::Borrowed(SRGB_8.as_slice())
            }
            Steps::Srgb | Steps::Curve(Curve::Srgb, _) => Cow::Borrowed(SRGB_16.as_slice()),
            Steps::Curve(curve, _) => decoding_table(levels, |signal| curve.at(signal)).into(),
            Steps::Hlg(_) => decoding_table(levels, |signal| {
                // The library's curve includes the display's gamma.
                let light = TransferCharacteristics::Hlg.linearize(signal);
                light.powf(1.0 / HLG_GAMMA)
            })
            .into(),
            Steps::Curves(..) | Steps::Lookup(_) => decoding_table(levels, |signal| signal).into(),
        }
    }

    /// Converts red, green and blue from the values of the table to linear sRGB.
    ///
    /// # Errors
    /// Why the profile's transform failed.
    pub(super) fn finish(&self, rgb: &mut [f32]) -> Result<(), String> {
        let each = |rgb: &mut [f32], convert: &(dyn Fn(Vec3) -> Vec3 + Sync)| {
            rgb.par_chunks_mut(3 * BLOCK).for_each(|block| {
                for pixel in block.as_chunks_mut::<3>().0 {
                    *pixel = convert(Vec3::from(*pixel)).into();
                }
            });
        };
        match &self.steps {
            Steps::Srgb | Steps::Curve(_, None) => {}
            Steps::Curve(_, Some(matrix)) => {
                let matrix = narrowed(matrix);
                each(rgb, &|light| matrix * light);
            }
            Steps::Curves(curves, matrix) => {
                let matrix = narrowed(matrix);
                let tables = curves
                    .each_ref()
                    .map(|curve| decoding_table(65_536, |signal| curve.at(signal)));
                each(rgb, &|signal| {
                    let signal = signal.to_array();
                    let light = std::array::from_fn(|c| {
                        let level = (signal[c] * 65_535.0 + 0.5) as usize;
                        tables[c].get(level).copied().unwrap_or(0.0)
                    });
                    matrix * Vec3::from_array(light)
                });
            }
            Steps::Hlg(matrix) => {
                let matrix = narrowed(matrix);
                let peak = (HLG_PEAK_CD_M2 / REFERENCE_WHITE_CD_M2) as f32;
                each(rgb, &|scene| {
                    let factor = HLG_LUMINANCE
                        .dot(scene)
                        .max(0.0)
                        .powf(HLG_GAMMA as f32 - 1.0);
                    matrix * (scene * (peak * factor))
                });
            }
            Steps::Lookup(transform) => {
                return rgb.par_chunks_mut(3 * BLOCK).try_for_each(|block| {
                    let from = block.to_vec();
                    transform
                        .transform(&from, block)
                        .map_err(|error| error.to_string())
                });
            }
        }
        Ok(())
    }
}

/// Matrix from linear RGB of a profile's primaries, which are adapted to D50, to linear sRGB.
fn to_srgb(profile: &ColorProfile) -> DMat3 {
    let rows = |profile: &ColorProfile| DMat3::from_cols_array_2d(&profile.colorant_matrix().v);
    (rows(&ColorProfile::new_srgb()).transpose().inverse()) * rows(profile).transpose()
}

fn narrowed(matrix: &DMat3) -> Mat3 {
    matrix.as_mat3()
}

fn is_identity(matrix: &DMat3) -> bool {
    matrix.abs_diff_eq(DMat3::IDENTITY, SAME)
}

/// Name of a profile in English, or in its first language.
fn name_of(text: &ProfileText) -> Option<String> {
    let name = match text {
        ProfileText::PlainString(text) => text,
        ProfileText::Localizable(texts) => {
            let english = texts.iter().find(|text| text.language == "en");
            &english.or(texts.first())?.value
        }
        ProfileText::Description(text) if text.ascii_string.is_empty() => &text.unicode_string,
        ProfileText::Description(text) => &text.ascii_string,
    };
    let printable = name.chars().filter(|c| !c.is_control()).take(60);
    let name: String = printable.collect();
    let name = name.trim();
    (!name.is_empty()).then(|| name.to_owned())
}

fn primaries_name(primaries: CicpColorPrimaries) -> Option<&'static str> {
    use CicpColorPrimaries as Primaries;
    Some(match primaries {
        Primaries::Reserved | Primaries::Unspecified => return None,
        Primaries::Bt709 => "BT.709",
        Primaries::Bt470M => "BT.470 M",
        Primaries::Bt470Bg => "BT.470 BG",
        Primaries::Bt601 => "BT.601",
        Primaries::Smpte240 => "SMPTE 240M",
        Primaries::GenericFilm => "generic film",
        Primaries::Bt2020 => "BT.2020",
        Primaries::Xyz => "CIE XYZ",
        Primaries::Smpte431 => "DCI-P3",
        Primaries::Smpte432 => "Display P3",
        Primaries::Ebu3213 => "EBU 3213",
    })
}
