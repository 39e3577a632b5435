//! Which files a picture consists of, and where each looks.

use super::rows::Layer;
use crate::args::{PictureArgs, ProjectionArg, SkyArgs, SunDiscArg};
use crate::error::CliError;
use crate::parse::PixelSize;
use crate::scene::Sun;
use airlight_image::{Camera, CubeFace, Fisheye, Frame, PictureFormat, Projection, Size};
use airlight_render::pixels::{is_spectral_path, tagged_path};
use std::path::{Path, PathBuf};

/// Where files go and what each shows.
pub struct Layout {
    /// As asked for; for a sequence the pattern of its names.
    pub output: Option<PathBuf>,
    /// What its ending says.
    pub format: Option<PictureFormat>,
    /// Each frame, with the name of a cube's face.
    frames: Vec<(Option<&'static str>, Frame)>,
    spectral: bool,
    disc: SunDiscArg,
}

/// One file to write.
#[derive(Debug)]
pub struct PictureFile {
    /// Where.
    pub path: PathBuf,
    /// Where its pixels look.
    pub frame: Frame,
    /// What it shows.
    pub layer: Layer,
}

impl Layout {
    /// As the options say; the camera looks towards `sun` where they say nothing.
    ///
    /// # Errors
    /// [`CliError::Usage`] where options do not fit together or numbers are out of range.
    pub fn new(args: &SkyArgs, sun: &Sun) -> Result<Self, CliError> {
        let picture = &args.picture;
        let format = args
            .output
            .as_deref()
            .map(PictureFormat::from_path)
            .transpose()?;
        let spectral = picture.spectral || args.output.as_deref().is_some_and(is_spectral_path);
        if spectral && format != Some(PictureFormat::EXR) {
            return Err(CliError::usage(
                "--spectral is for OpenEXR files: give --output a name that ends in .exr",
            ));
        }
        let linear = format.is_none_or(PictureFormat::is_linear);
        if !linear && picture.color_space != crate::args::ColorSpaceArg::Srgb {
            return Err(CliError::usage(
                "--color-space is for .exr and .hdr: .png and .jpg are always sRGB, leave it out",
            ));
        }
        if picture.sun_disc == SunDiscArg::Separate && args.output.is_none() {
            return Err(CliError::usage(
                "--sun-disc separate writes a second file: say with --output where to",
            ));
        }
        Ok(Self {
            output: args.output.clone(),
            format,
            frames: frames(picture, sun)?,
            spectral,
            disc: picture.sun_disc,
        })
    }

    /// Whether there is a channel a wavelength.
    pub fn is_spectral(&self) -> bool {
        self.spectral
    }

    /// What a picture without second file shows.
    pub fn main_layer(&self) -> Layer {
        match self.disc {
            SunDiscArg::In => Layer::All,
            SunDiscArg::Out | SunDiscArg::Separate => Layer::Sky,
        }
    }

    /// The files of a picture called `path`, in the order to write them: that of this name last.
    pub fn files(&self, path: &Path) -> Vec<PictureFile> {
        let layers: &[(Option<&str>, Layer)] = match self.disc {
            SunDiscArg::Separate => &[(Some("sun"), Layer::Disc), (None, Layer::Sky)],
            _ => &[(None, self.main_layer())],
        };
        let mut files = Vec::new();
        for (part, layer) in layers {
            for (face, frame) in &self.frames {
                let path = [*part, *face]
                    .into_iter()
                    .flatten()
                    .fold(path.to_owned(), |path, tag| tagged_path(&path, tag));
                files.push(PictureFile {
                    path,
                    frame: *frame,
                    layer: *layer,
                });
            }
        }
        files
    }

    /// The frame of a picture that has one.
    pub fn only_frame(&self) -> Frame {
        self.frames[0].1
    }

    /// The picture in small, at most so many pixels wide; for a cube, the whole sphere.
    ///
    /// # Errors
    /// As [`Frame::new`].
    pub fn overview(&self, width: u32) -> Result<Frame, CliError> {
        let frame = &self.frames[0].1;
        let (projection, size) = match frame.projection() {
            Projection::CubeFace(_) => (
                Projection::Equirectangular {
                    center_azimuth_deg: 0.0,
                },
                (2, 1),
            ),
            other => (*other, (frame.size().width(), frame.size().height())),
        };
        let across = match projection {
            Projection::Equirectangular { .. } => width,
            _ => width.min(size.0),
        };
        let down = (f64::from(across) * f64::from(size.1) / f64::from(size.0))
            .round()
            .clamp(1.0, 4096.0);
        Ok(Frame::new(projection, across.max(1), down as u32)?)
    }
}

fn frames(args: &PictureArgs, sun: &Sun) -> Result<Vec<(Option<&'static str>, Frame)>, CliError> {
    refuse_what_does_not_apply(args)?;
    let default = match args.projection {
        ProjectionArg::Equirectangular => (2048, 1024),
        ProjectionArg::Cube | ProjectionArg::Fisheye => (1024, 1024),
        ProjectionArg::Perspective => (1920, 1080),
    };
    let PixelSize { width, height } = args.size.unwrap_or(PixelSize {
        width: default.0,
        height: default.1,
    });
    let projection = match args.projection {
        ProjectionArg::Equirectangular => Projection::Equirectangular {
            center_azimuth_deg: args.camera_azimuth.unwrap_or(0.0),
        },
        ProjectionArg::Cube => {
            let face = |face: CubeFace| {
                Ok((
                    Some(face.name()),
                    Frame::new(Projection::CubeFace(face), width, height)?,
                ))
            };
            return CubeFace::ALL.into_iter().map(face).collect();
        }
        ProjectionArg::Fisheye => Projection::AngularFisheye(Fisheye {
            azimuth_deg: args.camera_azimuth.unwrap_or(180.0),
            elevation_deg: args.camera_elevation.unwrap_or(90.0),
            field_of_view_deg: args.fov.unwrap_or(180.0),
        }),
        ProjectionArg::Perspective => {
            let azimuth_deg = args.camera_azimuth.unwrap_or(sun.azimuth_deg);
            let elevation_deg = args.camera_elevation.unwrap_or(10.0);
            let fov = args.fov.unwrap_or(75.0);
            let camera = Camera::with_horizontal_fov(
                azimuth_deg,
                elevation_deg,
                fov,
                Size::new(width, height)?,
            );
            Projection::Perspective(Camera {
                roll_deg: args.camera_roll.unwrap_or(0.0),
                ..camera
            })
        }
    };
    Ok(vec![(None, Frame::new(projection, width, height)?)])
}

fn refuse_what_does_not_apply(args: &PictureArgs) -> Result<(), CliError> {
    use ProjectionArg::{Cube, Equirectangular, Fisheye, Perspective};
    let given = [
        (
            args.camera_azimuth.is_some(),
            "--camera-azimuth",
            &[Equirectangular, Fisheye, Perspective][..],
        ),
        (
            args.camera_elevation.is_some(),
            "--camera-elevation",
            &[Fisheye, Perspective],
        ),
        (args.camera_roll.is_some(), "--camera-roll", &[Perspective]),
        (args.fov.is_some(), "--fov", &[Fisheye, Perspective]),
    ];
    for (given, option, projections) in given {
        if given && !projections.contains(&args.projection) {
            let names = |p: &ProjectionArg| match p {
                Equirectangular => "equirectangular",
                Cube => "cube",
                Fisheye => "fisheye",
                Perspective => "perspective",
            };
            let list: Vec<&str> = projections.iter().map(names).collect();
            return Err(CliError::usage(format!(
                "{option} is for --projection {}",
                list.join(" or ")
            )));
        }
    }
    Ok(())
}
