//! How bright PNG, JPEG and preview are.

use super::prepared_frame::PreparedFrame;
use super::renderer::Renderer;
use super::rows::Layer;
use crate::args::{PictureArgs, ToneArg};
use crate::error::CliError;
use airlight_image::tone::{Exposure, FilmicSettings, Metering, ToneCurve, ToneMapper};

/// Columns of the small picture that is metered.
const METERED_WIDTH: u32 = 96;
/// What ground counts against sky: a dark foreground is not to wash out the sky above it.
const GROUND_SHARE: f64 = 0.2;
/// Stops by which a picture that is all sky is brighter than middle grey; one that is all ground (from space) by none.
const SKY_STOPS: f64 = 1.0;
/// Luminance of a daylight sky, cd/m^2, and by how many stops a picture gets darker for each stop below it: dusk is to
/// look like dusk.
const DAYLIGHT_CD_M2: f64 = 2000.0;
const DARKER_PER_STOP: f64 = 0.1;

/// What `--exposure` says: `None` for auto.
///
/// # Errors
/// [`CliError::Usage`] where it is neither auto nor an exposure value in range.
pub fn fixed(args: &PictureArgs) -> Result<Option<Exposure>, CliError> {
    if args.exposure.eq_ignore_ascii_case("auto") {
        return Ok(None);
    }
    let ev100 = crate::parse::number(&args.exposure).map_err(|_| {
        CliError::usage(format!(
            "--exposure must be auto or an exposure value at ISO 100 such as 14.5, got `{}`",
            args.exposure
        ))
    })?;
    Ok(Some(
        Exposure::from_ev100(ev100)?.brighter_by(args.brighten)?,
    ))
}

/// The exposure of a shot.
///
/// # Errors
/// As [`fixed`].
pub fn of(renderer: &Renderer<'_>, prepared: &PreparedFrame) -> Result<Exposure, CliError> {
    let args = &renderer.args.picture;
    if let Some(exposure) = fixed(args)? {
        return Ok(exposure);
    }
    let frame = renderer.layout.overview(METERED_WIDTH)?;
    let rows = renderer.rows(prepared, &frame, (Layer::Sky, 1.0), None);
    let pixels = super::renderer::stored(rows.as_ref(), &frame);
    let mut samples = Vec::with_capacity(pixels.len());
    let (mut lit_sky, mut lit) = (0.0f64, 0.0f64);
    for (index, rgb) in (0..).zip(&pixels) {
        let (i, j) = (index % frame.size().width(), index / frame.size().width());
        let luminance = renderer.channels.space.luminance(rgb.map(f64::from));
        let below = frame
            .pixel_direction(i, j)
            .is_some_and(|direction| prepared.is_below_horizon(direction));
        let share = if below { GROUND_SHARE } else { 1.0 };
        let weight = share * frame.pixel_solid_angle(i, j);
        samples.push((luminance as f32, weight as f32));
        if luminance > 0.0 {
            lit += weight;
            lit_sky += if below { 0.0 } else { weight };
        }
    }
    let metering = Metering::default();
    // Where nothing is lit any exposure shows black.
    let typical = metering
        .typical_luminance(&samples)
        .unwrap_or(DAYLIGHT_CD_M2);
    let dusk_stops = DARKER_PER_STOP * (typical / DAYLIGHT_CD_M2).log2().min(0.0);
    let sky_stops = SKY_STOPS * lit_sky / lit.max(f64::MIN_POSITIVE);
    Ok(Exposure::factor_of(metering.key / typical)?
        .brighter_by(args.brighten + sky_stops + dusk_stops)?)
}

/// What makes display light of linear light.
///
/// # Errors
/// As [`of`].
pub fn tone(renderer: &Renderer<'_>, prepared: &PreparedFrame) -> Result<ToneMapper, CliError> {
    let curve = curve(&renderer.args.picture);
    Ok(ToneMapper::new(
        of(renderer, prepared)?.factor() as f32,
        curve,
    )?)
}

/// The tone curve of the options.
pub fn curve(args: &PictureArgs) -> ToneCurve {
    match args.tone {
        ToneArg::Filmic => ToneCurve::Filmic(FilmicSettings::default()),
        ToneArg::Clip => ToneCurve::Clip,
    }
}
