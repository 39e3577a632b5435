//! Display of linear light in PNG, JPEG and previews, by the settings of a scene's output.

use crate::summary::short;
use airlight::scene::{OutputSpec, ToneKind};
use airlight_image::ImageError;
use airlight_image::tone::{
    AgxSettings, CameraSettings, Exposure, ToneCurve, ToneMapper, WhiteBalance,
};

/// The tone mapper of an output with an exposure, for linear sRGB in cd/m^2.
///
/// # Errors
/// [`ImageError::Setting`] for a setting out of range.
pub(crate) fn tone_mapper(
    output: &OutputSpec,
    exposure: Exposure,
) -> Result<ToneMapper, ImageError> {
    let balance = output.white_balance_k.map(WhiteBalance::new).transpose()?;
    let mapper = ToneMapper::new(exposure.factor() as f32, tone_curve(output))?;
    Ok(mapper
        .with_white_balance(balance)
        .with_scotopic(output.scotopic.unwrap_or(false)))
}

/// The tone curve of an output, whose settings may be out of range.
pub fn tone_curve(output: &OutputSpec) -> ToneCurve {
    let camera = CameraSettings::default();
    match output.tone.unwrap_or_default() {
        ToneKind::AgxBase => ToneCurve::Agx(AgxSettings::default()),
        ToneKind::Clip => ToneCurve::Clip,
        _ => ToneCurve::Camera(CameraSettings {
            contrast: output.tone_contrast.unwrap_or(camera.contrast),
            saturation: output.saturation.unwrap_or(camera.saturation),
        }),
    }
}

/// Exposure and tone curve of a picture, for its metadata.
pub(crate) fn description(output: &OutputSpec, exposure: Exposure) -> (String, String) {
    let (ev100, tone) = (short(exposure.ev100()), output.tone.unwrap_or_default());
    let text = format!("EV {ev100} at ISO 100, tone curve {tone}");
    ("exposure".to_owned(), text)
}
