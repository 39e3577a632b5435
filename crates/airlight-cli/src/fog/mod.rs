//! `airlight fog`: fog laid over a picture that exists.

mod lamps;
mod layers;
mod light;
mod veil;

use crate::args::{DepthKindArg, HolesArg, OverlayArgs};
use crate::error::CliError;
use crate::interrupt;
use crate::report::{self, bytes};
use airlight_render::Control;
use airlight_render::frame::{Intrinsics, PixelCentres};
use airlight_render::input::{
    DepthMeaning, DepthOptions, LightReference, Picture, SampleBits, Unknown, read_depth,
    read_picture,
};
use airlight_render::output::{PictureFormat, PictureOptions, Written, exr, png, write_picture};
use airlight_render::overlay::{Channels, Overlay};
use airlight_render::tone::ToneMapper;

/// Runs the command.
///
/// # Errors
/// [`CliError`]: what was wrong with the options or the files.
pub fn run(args: &OverlayArgs) -> Result<(), CliError> {
    let format = PictureFormat::from_path(&args.output)?;
    if args.layers && format != PictureFormat::Exr {
        return Err(CliError::usage(
            "--layers needs an OpenEXR file to go to: give --output a name that ends in .exr",
        ));
    }
    let depth_file = args.depth.as_ref().unwrap_or(&args.colour);
    for input in [&args.colour, depth_file] {
        if same_file(input, &args.output) {
            return Err(CliError::usage(format!(
                "`{}` would be written over: give --output another name",
                input.display()
            )));
        }
    }
    let sun_is_down = args.sun_elevation.is_some_and(|elevation| elevation <= 0.0);
    if sun_is_down && !args.light.sky_light {
        return Err(CliError::usage(
            "the sun must stand above the horizon to shine on fog: give --sun-elevation above 0, or leave it out for \
             fog in even light; --sky-light knows twilight",
        ));
    }
    let options = depth_options(args)?;
    let mut picture = read_picture(&args.colour, None)?;
    if matches!(format, PictureFormat::Jpeg | PictureFormat::Hdr) {
        // These formats hold no opacity.
        picture.alpha = None;
    }
    if (format == PictureFormat::Exr || format == PictureFormat::Hdr)
        != (picture.reference == LightReference::Scene)
    {
        return Err(CliError::usage(format!(
            "`{}` holds {}, and so must the output: give --output a name that ends in {}",
            args.colour.display(),
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
    let depth = read_depth(depth_file, &options)?;
    depth.check_against(&picture)?;
    let camera = camera(args, &picture)?;
    let solved = light::SolvedSky::of(args)?;
    let source = light::LightSource::new(solved.as_ref());
    let (veil, level) = veil::veil(args, &source, &picture, &depth, &camera)?;
    let channels = match args.layers {
        true => Channels::Layers,
        false => Channels::Picture,
    };
    let overlay = Overlay::new(
        &picture,
        &depth,
        &camera,
        args.eye_height_m,
        &veil,
        channels,
    )?;
    let writing = interrupt::start_writing()?;
    let written = write(args, format, &picture, &overlay)?;
    drop(writing);
    if args.quiet {
        return Ok(());
    }
    report::print(&format!(
        "{}: {} x {}, {}\n  visibility    {} m ({} of contrast)\n  light         {:.4} {:.4} {:.4} ({})\n  \
         depth         {} pixels unknown, {} infinitely far\n",
        args.output.display(),
        picture.size.width(),
        picture.size.height(),
        bytes(written.bytes),
        report::short(args.visibility_m),
        args.contrast,
        level.colour[0],
        level.colour[1],
        level.colour[2],
        level.how,
        depth.holes,
        depth.infinite,
    ))
}

/// Whether two paths lead to one file that is there.
fn same_file(a: &std::path::Path, b: &std::path::Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
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

fn camera(args: &OverlayArgs, picture: &Picture) -> Result<Intrinsics, CliError> {
    let size = picture.size;
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

fn write(
    args: &OverlayArgs,
    format: PictureFormat,
    picture: &Picture,
    overlay: &Overlay<'_>,
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
    let (path, size) = (&args.output, picture.size);
    Ok(match format {
        PictureFormat::Exr => {
            let (names, metadata) = (overlay.channel_names(), &options.metadata);
            exr::write(path, size, &names, overlay, &options.exr, metadata, control)?
        }
        _ => {
            let tone = ToneMapper::as_displayed();
            write_picture(path, size, overlay, &tone, &options, control)?
        }
    })
}
