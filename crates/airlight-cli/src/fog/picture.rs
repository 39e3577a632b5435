//! One picture: read, fogged, written.

use super::light::{self, Level, LightSource, Shown};
use super::{forms, overlay};
use crate::args::{DepthKindArg, HolesArg, OverlayArgs};
use crate::error::CliError;
use crate::interrupt;
use airlight_image::Control;
use airlight_image::frame::{Intrinsics, PixelCentres};
use airlight_image::input::{
    DepthMap, DepthMeaning, DepthOptions, LightReference, Picture, SampleBits, Unknown, read_depth,
    read_picture,
};
use airlight_image::output::{PictureFormat, PictureOptions, Written, exr, png, write_picture};
use airlight_image::tone::ToneMapper;
use airlight_render::overlay::{Channels, FogOverlay, FogSource, Overlay};
use std::path::Path;

/// A picture and its depth in memory.
pub struct Subject {
    pub picture: Picture,
    pub depth: DepthMap,
    /// The ambient light that it shows or that is given.
    ambient: Level,
}

/// The fog of some options over a picture.
pub struct Fogged {
    pub camera: Intrinsics,
    overlay: FogOverlay,
    /// The light that the fog is in.
    pub level: Level,
}

/// Refuses options that no picture could go with, before any is read.
///
/// # Errors
/// [`CliError::Usage`].
pub fn check(args: &OverlayArgs) -> Result<(), CliError> {
    let sun_is_down = args.sun_elevation.is_some_and(|elevation| elevation <= 0.0);
    if sun_is_down && !args.light.sky_light {
        return Err(CliError::usage(
            "the sun must stand above the horizon to shine on fog: give --sun-elevation above 0, or leave it out for \
             fog in even light; --sky-light knows twilight",
        ));
    }
    let random = args.random.settings(args.batch.seed)?.is_some();
    if random && !args.light.sky_light {
        return Err(CliError::usage(
            "--solver monte-carlo follows sunlight through fog and air: give --sky-light as well",
        ));
    }
    if args.batch.seed.is_some() && !random && args.batch.vary.is_empty() {
        return Err(CliError::usage(
            "--seed is for what is drawn at random: give --vary or --solver monte-carlo as well",
        ));
    }
    forms::check(args, random)?;
    depth_options(args).map(drop)
}

/// The format of an output, which must hold what is asked for.
///
/// # Errors
/// [`CliError::Usage`] where it does not.
pub fn format_of(args: &OverlayArgs, output: &Path) -> Result<PictureFormat, CliError> {
    let format = PictureFormat::from_path(output)?;
    if args.layers && !format.holds_channels() {
        return Err(CliError::usage(
            "--layers needs an OpenEXR file to go to: give --output a name that ends in .exr",
        ));
    }
    Ok(format)
}

impl Subject {
    /// Reads a picture and its depth, to be written in a format.
    ///
    /// # Errors
    /// [`CliError`] where one cannot be read, or they do not go together.
    pub fn read(
        args: &OverlayArgs,
        colour: &Path,
        depth: &Path,
        format: PictureFormat,
    ) -> Result<Self, CliError> {
        let mut picture = read_picture(colour, None)?;
        if !format.holds_alpha() {
            picture.alpha = None;
        }
        if format.is_linear() != (picture.reference == LightReference::Scene) {
            return Err(CliError::usage(format!(
                "`{}` holds {}, and so must the output: give --output a name that ends in {}",
                colour.display(),
                match picture.reference {
                    LightReference::Scene => "linear light",
                    LightReference::Display => "values for a display",
                },
                match picture.reference {
                    LightReference::Scene => ".exr or .hdr",
                    LightReference::Display => ".png or .jpg",
                }
            )));
        }
        let depth = read_depth(depth, &depth_options(args)?)?;
        depth.check_against(&picture)?;
        let ambient = light::ambient(args, &picture, &depth)?;
        Ok(Self {
            picture,
            depth,
            ambient,
        })
    }

    /// Where the pixels look.
    ///
    /// # Errors
    /// [`CliError::Usage`] where the options make no camera.
    fn camera(&self, args: &OverlayArgs) -> Result<Intrinsics, CliError> {
        let size = self.picture.size;
        let camera = match args.focal_px {
            Some(focal) => {
                let middle = |n: u32| 0.5 * f64::from(n) - 0.5;
                let principal = args
                    .principal_point
                    .unwrap_or((middle(size.width()), middle(size.height())));
                Intrinsics::new(size, (focal, focal), principal, PixelCentres::Whole)?
            }
            None => Intrinsics::from_horizontal_fov(size, args.fov.unwrap_or(60.0))?,
        };
        Ok(camera.looking(args.camera_azimuth, args.camera_elevation, args.camera_roll)?)
    }

    /// The fog of the options over it.
    ///
    /// # Errors
    /// [`CliError::Usage`] where the options make no camera or no fog.
    pub fn fogged<'a>(
        &self,
        args: &OverlayArgs,
        source: &LightSource<'a>,
    ) -> Result<Fogged, CliError> {
        let camera = self.camera(args)?;
        let ambient = Level {
            colour: self.ambient.colour * args.ambient_scale as f32,
            ..self.ambient
        };
        let shown = Shown {
            picture: &self.picture,
            depth: &self.depth,
            camera: &camera,
            ambient,
        };
        let (overlay, level) = overlay::overlay(args, source, &shown)?;
        Ok(Fogged {
            camera,
            overlay,
            level,
        })
    }

    /// Writes it with fog over it. While it does, [`interrupt::start_writing`] must be in force.
    ///
    /// # Errors
    /// [`CliError`]; nothing is left at `output`, or what was there before.
    pub fn write(
        &self,
        fogged: &Fogged,
        args: &OverlayArgs,
        output: &Path,
        format: PictureFormat,
    ) -> Result<Written, CliError> {
        let overlay = self.overlay(fogged, args)?;
        self.write_overlay(&overlay, args, output, format)
    }

    /// Picture, depth and fog put together.
    ///
    /// # Errors
    /// [`CliError`] where they do not go together.
    pub fn overlay<'o>(
        &'o self,
        fogged: &'o Fogged,
        args: &OverlayArgs,
    ) -> Result<Overlay<'o>, CliError> {
        let channels = match args.layers {
            true => Channels::Layers,
            false => Channels::Picture,
        };
        Ok(Overlay::new(
            &self.picture,
            &self.depth,
            &fogged.camera,
            args.eye_height_m,
            &fogged.overlay,
            channels,
        )?)
    }

    /// As [`Subject::write`], of what is put together already.
    ///
    /// # Errors
    /// As there.
    pub fn write_overlay(
        &self,
        overlay: &Overlay<'_>,
        args: &OverlayArgs,
        output: &Path,
        format: PictureFormat,
    ) -> Result<Written, CliError> {
        write(args, format, &self.picture, overlay, output)
    }
}

impl Fogged {
    /// The fog; nothing for a look.
    pub fn body(&self) -> Option<&FogSource> {
        match &self.overlay {
            FogOverlay::Fog(body, _) => Some(body),
            _ => None,
        }
    }
}

fn depth_options(args: &OverlayArgs) -> Result<DepthOptions, CliError> {
    let meaning = match args.depth_kind {
        DepthKindArg::Z => DepthMeaning::ZDepth,
        DepthKindArg::Ray => DepthMeaning::RayDistance,
        DepthKindArg::Inverse => DepthMeaning::Inverse,
        DepthKindArg::Disparity => match (args.focal_px, args.baseline_m) {
            (Some(focal_length_px), Some(baseline_m)) => DepthMeaning::Disparity {
                focal_length_px,
                baseline_m,
                offset_px: args.disparity_offset_px,
            },
            _ => {
                return Err(CliError::usage(
                    "--depth-kind disparity needs --focal-px and --baseline-m",
                ));
            }
        },
    };
    Ok(DepthOptions {
        meaning,
        scale: args.depth_scale,
        channel: args.depth_channel.clone(),
        unknown: match args.holes {
            HolesArg::Fill => Unknown::Fill,
            HolesArg::Far => Unknown::Far,
            HolesArg::Clear => Unknown::Clear,
        },
        far_from_m: args.far_m,
        negative_is_unknown: false,
    })
}

fn write(
    args: &OverlayArgs,
    format: PictureFormat,
    picture: &Picture,
    overlay: &Overlay<'_>,
    path: &Path,
) -> Result<Written, CliError> {
    let control = Control::cancelled_by(&interrupt::STOP);
    let options = PictureOptions {
        exr: exr::ExrOptions {
            sample: match (picture.bits, args.layers) {
                (SampleBits::Half, false) => exr::ExrSample::Half,
                _ => exr::ExrSample::Float,
            },
            ..Default::default()
        },
        png: png::PngOptions {
            depth: match picture.bits {
                SampleBits::U8 => png::PngDepth::Eight,
                _ => png::PngDepth::Sixteen,
            },
            ..Default::default()
        },
        ..Default::default()
    };
    let size = picture.size;
    Ok(match format.holds_channels() {
        true => {
            let (names, metadata) = (overlay.channel_names(), &options.metadata);
            exr::write(path, size, &names, overlay, &options.exr, metadata, control)?
        }
        false => {
            let tone = ToneMapper::as_displayed();
            write_picture(path, size, overlay, &tone, &options, control)?
        }
    })
}
