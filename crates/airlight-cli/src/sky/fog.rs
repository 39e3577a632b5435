//! Fog before the sky of a picture.

use crate::args::{SkyFogArgs, droplets_in_words};
use crate::error::CliError;
use crate::report::short;
use airlight::atmosphere::Constituent;
use airlight::fog::DensityProfile;
use airlight::fog::visibility::{Contrast, extinction_per_m};
use airlight::scene::{FogLayer, FoggySky, LaneChannels};
use airlight::sky::{SkyTable, TableChannels, View};
use airlight::spectrum::{Spectrum, WavelengthGrid};
use glam::DVec3;
use std::sync::Arc;

/// Wavelengths in a piece of a spectrum.
pub const PIECE: usize = 16;
/// Height over which fog thins where nothing is said, m.
const SCALE_HEIGHT_M: f64 = 50.0;

/// A sky with fog in it, in the channels of a picture.
pub enum Fog {
    /// Red, green and blue.
    Rgb(Box<FoggySky<3>>),
    /// All wavelengths, one piece after the other.
    Spectral(Vec<FoggySky<PIECE>>),
}

impl Fog {
    /// As the options say, under the sky of a view; `None` without fog.
    ///
    /// # Errors
    /// [`CliError::Usage`] for a fog that is none.
    pub fn new(
        args: &SkyFogArgs,
        view: &View,
        channels: TableChannels,
    ) -> Result<Option<Self>, CliError> {
        match args.fog_visibility_m {
            None => Ok(None),
            Some(_) => Self::or_clear(args, view, channels).map(Some),
        }
    }

    /// The same, with air alone where the options ask for no fog.
    ///
    /// # Errors
    /// As [`Fog::new`].
    pub fn or_clear(
        args: &SkyFogArgs,
        view: &View,
        channels: TableChannels,
    ) -> Result<Self, CliError> {
        let ground = FoggySky::<3>::round_ground(view);
        let scattering = args.fog_scattering.scattering();
        Ok(match channels {
            TableChannels::Rgb(space) => {
                let layers = layers(args, WavelengthGrid::standard().wavelengths_nm())?;
                let channels = LaneChannels::Rgb(space);
                let sky = FoggySky::new(view, channels, &layers, ground, scattering)?;
                Self::Rgb(Box::new(sky))
            }
            TableChannels::Spectral => {
                let layers = layers(args, view.sky().grid().wavelengths_nm())?;
                Self::Spectral(FoggySky::spectral(view, &layers, ground, scattering)?)
            }
        })
    }

    /// The sky without the fog.
    pub fn clear(&self) -> Arc<SkyTable> {
        match self {
            Self::Rgb(sky) => sky.clear().clone(),
            Self::Spectral(pieces) => pieces[0].clear().clone(),
        }
    }

    /// From radiance without fog, one value a channel, to that through the fog.
    #[inline]
    pub fn cover(&self, direction: DVec3, values: &mut [f32]) {
        match self {
            Self::Rgb(sky) => cover(sky, direction, values),
            Self::Spectral(pieces) => {
                for (sky, values) in pieces.iter().zip(values.chunks_mut(PIECE)) {
                    cover(sky, direction, values);
                }
            }
        }
    }

    /// Transmittance of the fog, which is the same for all light.
    pub fn transmittance(&self, direction: DVec3) -> f32 {
        match self {
            Self::Rgb(sky) => sky.fog_transmittance(direction)[0],
            Self::Spectral(pieces) => pieces[0].fog_transmittance(direction)[0],
        }
    }

    /// Illuminance of a level surface at the eye by the foggy sky, without the sun's disc, where `luminance` makes cd/m^2
    /// of channels: to a few percent where the fog's glow about the sun is narrow.
    pub fn horizontal_lx(&self, luminance: impl Fn(&[f32]) -> f64) -> f64 {
        const RINGS: u32 = 60;
        const SPOKES: u32 = 120;
        let table = self.clear();
        let mut values = vec![0.0; table.channels()];
        let mut sum = 0.0;
        for ring in 0..RINGS {
            // Rings of equal weight: even in the squared sine of the elevation.
            let sine = ((f64::from(ring) + 0.5) / f64::from(RINGS)).sqrt();
            for spoke in 0..SPOKES {
                let azimuth_deg = 360.0 * (f64::from(spoke) + 0.5) / f64::from(SPOKES);
                let direction = airlight::axes::direction(azimuth_deg, sine.asin().to_degrees());
                table.sample(direction, &mut values);
                self.cover(direction, &mut values);
                sum += luminance(&values);
            }
        }
        std::f64::consts::PI * sum / f64::from(RINGS * SPOKES)
    }
}

#[inline]
fn cover<const N: usize>(sky: &FoggySky<N>, direction: DVec3, values: &mut [f32]) {
    let last = values.len() - 1;
    let seen = sky.before(direction, Spectrum::from_fn(|lane| values[lane.min(last)]));
    values
        .iter_mut()
        .zip(seen.0)
        .for_each(|(value, seen)| *value = seen);
}

/// The fog of the options, known at wavelengths (nm, rising); no layer without fog.
fn layers(args: &SkyFogArgs, wavelengths_nm: &[f64]) -> Result<Vec<Constituent>, CliError> {
    let layers = in_air(args).into_iter();
    let layer = |fog: FogLayer| Ok(fog.layer(wavelengths_nm)?);
    layers.map(layer).collect()
}

/// The fog of the options before its optics are computed; `None` without fog.
fn in_air(args: &SkyFogArgs) -> Option<FogLayer> {
    let visibility_m = args.fog_visibility_m?;
    Some(FogLayer {
        profile: profile(args),
        droplets: args.fog_droplets.0,
        extinction_per_m: extinction_per_m(visibility_m, Contrast::FivePercent),
    })
}

fn profile(args: &SkyFogArgs) -> DensityProfile {
    match args.fog_top_m {
        Some(top_height_m) => DensityProfile::slab(top_height_m),
        None => DensityProfile::Clamped {
            base_height_m: args.fog_base_m.unwrap_or(0.0),
            scale_height_m: args.fog_scale_height_m.unwrap_or(SCALE_HEIGHT_M),
        },
    }
}

/// The fog of the options as a constituent of the air over a ground at an altitude (m), known at wavelengths (nm, rising);
/// `None` without fog.
///
/// # Errors
/// [`CliError::Usage`] for a fog that is none.
pub fn constituent(
    args: &SkyFogArgs,
    ground_m: f64,
    wavelengths_nm: &[f64],
) -> Result<Option<Constituent>, CliError> {
    let fog = in_air(args);
    Ok(fog
        .map(|fog| fog.constituent(ground_m, wavelengths_nm))
        .transpose()?)
}

/// The fog of the options in words.
pub fn in_words(args: &SkyFogArgs) -> Option<String> {
    let visibility_m = args.fog_visibility_m?;
    let height = match (args.fog_top_m, args.fog_base_m.unwrap_or(0.0)) {
        (Some(top_m), _) => format!("up to {} m", short(top_m)),
        (None, base_m) => {
            let scale_m = args.fog_scale_height_m.unwrap_or(SCALE_HEIGHT_M);
            let from = match base_m > 0.0 {
                true => format!(" from {} m on", short(base_m)),
                false => String::new(),
            };
            format!("scale height {} m{from}", short(scale_m))
        }
    };
    let kind = args.fog_droplets.0;
    let scattering = args.fog_scattering.in_words();
    Some(format!(
        "visibility {} m, {height}, droplets {} ({}){}",
        short(visibility_m),
        kind.name(),
        droplets_in_words(kind),
        scattering.map_or(String::new(), |words| format!("; {words}"))
    ))
}
