//! [`Layout`]: files of a picture, with their frames and formats.

use crate::error::RenderError;
use crate::pixels::{is_spectral_path, tagged_path};
use crate::shard::Shard;
use crate::sky_rows::Layer;
use airlight::Named;
use airlight::scene::{
    CameraSpec, Orientation, OutputSpec, Projection as ProjectionKind, SunDiscPlacement,
};
use airlight_image::output::RowBand;
use airlight_image::{Camera, CubeFace, Fisheye, Frame, PictureFormat, Projection, Size};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Frames of a picture, and names and encoding of its files.
#[derive(Clone, Debug)]
pub struct Layout {
    format: Option<PictureFormat>,
    /// Each frame, with the name of a cube's face.
    frames: Vec<(Option<&'static str>, Frame)>,
    is_spectral: bool,
    sun_disc: SunDiscPlacement,
}

/// One file to write: a picture, or a band of its rows.
#[derive(Clone, Debug)]
pub struct PictureFile {
    /// Path of the file.
    pub path: PathBuf,
    /// Path of the picture.
    picture: PathBuf,
    /// Projection and size of the picture.
    pub frame: Frame,
    /// Layer that it shows.
    pub layer: Layer,
    /// The shard whose rows the file holds; `None`: all.
    shard: Option<Shard>,
}

impl PictureFile {
    /// The file of a whole picture.
    pub fn whole(picture: PathBuf, frame: Frame, layer: Layer) -> Self {
        Self {
            path: picture.clone(),
            picture,
            frame,
            layer,
            shard: None,
        }
    }

    /// The file of a shard's rows.
    fn of_shard(self, shard: Shard) -> Self {
        Self {
            path: shard.path_of(&self.picture),
            shard: Some(shard),
            ..self
        }
    }

    /// Path of an EXR file beside it, such as its depth.
    pub fn map_path(&self, tag: &str) -> PathBuf {
        let map = tagged_path(&self.picture, tag).with_extension("exr");
        match &self.shard {
            Some(shard) => shard.path_of(&map),
            None => map,
        }
    }

    /// Rows of the picture that the file holds.
    pub fn rows(&self) -> Range<u32> {
        let height = self.frame.size().height();
        self.shard.map_or(0..height, |shard| shard.rows(height))
    }

    /// Width and height of what the file holds.
    pub fn size(&self) -> Size {
        let width = self.frame.size().width();
        Size::new(width, self.rows().len() as u32).expect("checked by Layout::files_of")
    }

    /// The larger picture of which the file holds a band.
    pub fn band(&self) -> Option<RowBand> {
        self.shard.map(|_| RowBand {
            first_row: self.rows().start,
            picture_rows: self.frame.size().height(),
        })
    }
}

impl Layout {
    /// Layout of a scene's camera and output. The default azimuth of a perspective camera is that of the sun.
    ///
    /// # Errors
    /// [`RenderError`] for settings that contradict each other, and for numbers out of range.
    pub fn new(
        camera: &CameraSpec,
        output: &OutputSpec,
        sun_azimuth_deg: f64,
    ) -> Result<Self, RenderError> {
        let file = output.file.as_deref().map(Path::new);
        let format = file.map(PictureFormat::from_path).transpose()?;
        let is_spectral = is_spectral(output);
        let name = || {
            output
                .file
                .clone()
                .map_or("no file".to_owned(), |file| format!("`{file}`"))
        };
        if is_spectral && !format.is_some_and(PictureFormat::holds_channels) {
            return Err(RenderError::value(
                "output.spectral",
                "an OpenEXR file to write to",
                name(),
                "a name that ends in .exr",
            ));
        }
        let sun_disc = output.sun_disc.unwrap_or_default();
        if sun_disc == SunDiscPlacement::Separate && file.is_none() {
            return Err(RenderError::value(
                "output.sun_disc",
                "a picture file, beside which the sun's disc is written",
                name(),
                "output.file, or in or out",
            ));
        }
        for (map, set) in [
            ("output.depth_map", output.depth_map),
            ("output.noise_map", output.noise_map),
            ("output.polarisation", output.polarisation),
        ] {
            if set == Some(true) && file.is_none() {
                return Err(RenderError::value(
                    map,
                    "a picture file, beside which the map is written",
                    name(),
                    "output.file",
                ));
            }
        }
        Ok(Self {
            format,
            frames: frames(camera, sun_azimuth_deg)?,
            is_spectral,
            sun_disc,
        })
    }

    /// Format of the files; `None` for a picture without a file.
    pub fn format(&self) -> Option<PictureFormat> {
        self.format
    }

    /// Whether there is a channel for each wavelength.
    pub fn is_spectral(&self) -> bool {
        self.is_spectral
    }

    /// Layer of the main file.
    pub fn main_layer(&self) -> Layer {
        match self.sun_disc {
            SunDiscPlacement::In => Layer::All,
            SunDiscPlacement::Out | SunDiscPlacement::Separate => Layer::Sky,
        }
    }

    /// Files of a picture called `path` in the order in which they are written; that with this name is last.
    pub fn files(&self, path: &Path) -> Vec<PictureFile> {
        let layers: &[(Option<&str>, Layer)] = match self.sun_disc {
            SunDiscPlacement::Separate => &[(Some("sun"), Layer::Disc), (None, Layer::Sky)],
            _ => &[(None, self.main_layer())],
        };
        let mut files = Vec::new();
        for (part, layer) in layers {
            for (face, frame) in &self.frames {
                let path = [*part, *face]
                    .into_iter()
                    .flatten()
                    .fold(path.to_owned(), |path, tag| tagged_path(&path, tag));
                files.push(PictureFile::whole(path, *frame, *layer));
            }
        }
        files
    }

    /// Files of a shard's rows of a picture called `path`, in the order of [`Layout::files`]: EXR files whose data window is the
    /// band, which [`exr::join`](airlight_image::output::exr::join) joins.
    ///
    /// # Errors
    /// [`RenderError`] for formats other than EXR, and for more shards than the picture has bands.
    pub fn files_of(&self, path: &Path, shard: Shard) -> Result<Vec<PictureFile>, RenderError> {
        if self.format != Some(PictureFormat::EXR) {
            return Err(RenderError::value(
                "output.file",
                "an OpenEXR file for a shard of one picture",
                format!("`{}`", path.display()),
                "a name that ends in .exr",
            ));
        }
        let files = self.files(path).into_iter();
        let parts = files.map(|file| file.of_shard(shard));
        parts
            .map(|file| match file.rows().is_empty() {
                false => Ok(file),
                true => Err(RenderError::setting(format!(
                    "shard: expected at most {} shards of a picture of {} rows, one for each {}, got {}",
                    file.frame.size().height().div_ceil(RowBand::MULTIPLE),
                    file.frame.size().height(),
                    RowBand::MULTIPLE,
                    shard.count()
                ))),
            })
            .collect()
    }

    /// The single frame of a picture.
    ///
    /// # Errors
    /// [`RenderError`] for a cube map, which has six.
    pub fn only_frame(&self) -> Result<Frame, RenderError> {
        match self.frames[..] {
            [(_, frame)] => Ok(frame),
            _ => Err(RenderError::value(
                "camera.projection",
                "one picture",
                "the six of a cube",
                "equirectangular, fisheye or perspective",
            )),
        }
    }

    /// Frame of a small overview, at most `width` pixels wide; for a cube map, of the whole sphere.
    ///
    /// # Errors
    /// As [`Frame::new`].
    pub fn overview(&self, width: u32) -> Result<Frame, RenderError> {
        let frame = &self.frames[0].1;
        let (projection, size) = match frame.projection() {
            Projection::CubeFace(_) | Projection::MirroredCubeFace(_) => (
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

    /// Name of the kind of projection.
    pub fn projection_name(&self) -> &'static str {
        self.frames[0].1.projection().name()
    }
}

/// Whether an output has a channel for each wavelength: it is set, or the name ends in `.spectral.exr`.
pub(crate) fn is_spectral(output: &OutputSpec) -> bool {
    output.spectral == Some(true)
        || output
            .file
            .as_deref()
            .is_some_and(|file| is_spectral_path(Path::new(file)))
}

fn frames(
    camera: &CameraSpec,
    sun_azimuth_deg: f64,
) -> Result<Vec<(Option<&'static str>, Frame)>, RenderError> {
    let kind = camera.projection.unwrap_or_default();
    let orientation = camera.orientation.unwrap_or_default();
    refuse_unused(camera, kind)?;
    let [width, height] = camera.size.unwrap_or(match kind {
        ProjectionKind::Equirectangular => [2048, 1024],
        ProjectionKind::Cube | ProjectionKind::Fisheye => [1024, 1024],
        ProjectionKind::Perspective => [1920, 1080],
    });
    let projection = match kind {
        ProjectionKind::Equirectangular => Projection::Equirectangular {
            center_azimuth_deg: camera
                .azimuth_deg
                .unwrap_or(orientation.center_azimuth_deg()),
        },
        ProjectionKind::Cube => {
            let projection = match orientation {
                Orientation::Three => Projection::MirroredCubeFace,
                _ => Projection::CubeFace,
            };
            let face = |&face: &CubeFace| {
                let frame = Frame::new(projection(face), width, height)?;
                Ok((Some(face.name()), frame))
            };
            return CubeFace::ALL.iter().map(face).collect();
        }
        ProjectionKind::Fisheye => Projection::AngularFisheye(Fisheye {
            azimuth_deg: camera.azimuth_deg.unwrap_or(180.0),
            elevation_deg: camera.elevation_deg.unwrap_or(90.0),
            field_of_view_deg: camera.fov_deg.unwrap_or(180.0),
        }),
        ProjectionKind::Perspective => Projection::Perspective(Camera {
            roll_deg: camera.roll_deg.unwrap_or(0.0),
            ..Camera::with_horizontal_fov(
                camera.azimuth_deg.unwrap_or(sun_azimuth_deg),
                camera.elevation_deg.unwrap_or(10.0),
                camera.fov_deg.unwrap_or(75.0),
                Size::new(width, height)?,
            )
        }),
    };
    Ok(vec![(None, Frame::new(projection, width, height)?)])
}

/// Refuses camera settings that the projection does not use.
fn refuse_unused(camera: &CameraSpec, kind: ProjectionKind) -> Result<(), RenderError> {
    use ProjectionKind::{Cube, Equirectangular, Fisheye, Perspective};
    let set: [(bool, &str, &[ProjectionKind]); 5] = [
        (
            camera.azimuth_deg.is_some(),
            "camera.azimuth_deg",
            &[Equirectangular, Fisheye, Perspective],
        ),
        (
            camera.elevation_deg.is_some(),
            "camera.elevation_deg",
            &[Fisheye, Perspective],
        ),
        (camera.roll_deg.is_some(), "camera.roll_deg", &[Perspective]),
        (
            camera.fov_deg.is_some(),
            "camera.fov_deg",
            &[Fisheye, Perspective],
        ),
        (
            camera.orientation.is_some(),
            "camera.orientation",
            &[Equirectangular, Cube],
        ),
    ];
    for (set, key, kinds) in set {
        if set && !kinds.contains(&kind) {
            let list: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
            return Err(RenderError::value(
                key,
                format!("the projection {}", list.join(" or ")),
                kind.name(),
                "leaving it out",
            ));
        }
    }
    match camera.orientation {
        Some(orientation)
            if kind == Cube
                && !matches!(orientation, Orientation::Airlight | Orientation::Three) =>
        {
            Err(RenderError::value(
                "camera.orientation",
                "airlight or three for a cube map",
                orientation.name(),
                "the projection equirectangular",
            ))
        }
        Some(orientation) if camera.azimuth_deg.is_some() => Err(RenderError::value(
            "camera.orientation",
            "either an orientation or azimuth_deg",
            format!("{orientation} and azimuth_deg"),
            "leaving one of them out",
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn output(file: &str) -> OutputSpec {
        OutputSpec {
            file: Some(file.to_owned()),
            ..Default::default()
        }
    }

    fn camera(kind: ProjectionKind) -> CameraSpec {
        CameraSpec {
            projection: Some(kind),
            ..Default::default()
        }
    }

    #[test]
    fn a_cube_with_a_separate_sun_is_twelve_files() {
        let output = OutputSpec {
            sun_disc: Some(SunDiscPlacement::Separate),
            ..output("a/dome.exr")
        };
        let layout = Layout::new(&camera(ProjectionKind::Cube), &output, 0.0).unwrap();
        let files = layout.files(Path::new("a/dome.exr"));
        let names: Vec<_> = files
            .iter()
            .map(|file| file.path.display().to_string())
            .collect();
        assert_eq!(files.len(), 12);
        assert_eq!(
            [&names[0], &names[11]],
            ["a/dome.sun.px.exr", "a/dome.nz.exr"]
        );
        assert_eq!([files[0].layer, files[11].layer], [Layer::Disc, Layer::Sky]);
        assert_eq!(
            layout.overview(64).unwrap().size(),
            Size::new(64, 32).unwrap()
        );
        assert!(layout.only_frame().is_err());
    }

    #[test]
    fn a_perspective_camera_looks_towards_the_sun() {
        let layout = Layout::new(
            &camera(ProjectionKind::Perspective),
            &output("a.png"),
            123.0,
        );
        match *layout.unwrap().only_frame().unwrap().projection() {
            Projection::Perspective(camera) => assert_eq!(camera.azimuth_deg, 123.0),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn panoramas_and_cubes_are_oriented_for_other_programs() {
        use ProjectionKind::{Cube, Equirectangular, Fisheye};
        let oriented = |kind, orientation| CameraSpec {
            orientation: Some(orientation),
            ..camera(kind)
        };
        let first = |camera: &CameraSpec| {
            let layout = Layout::new(camera, &output("a.exr"), 0.0).unwrap();
            *layout.files(Path::new("a.exr"))[0].frame.projection()
        };
        for &orientation in Orientation::ALL {
            let center_azimuth_deg = orientation.center_azimuth_deg();
            assert_eq!(
                first(&oriented(Equirectangular, orientation)),
                Projection::Equirectangular { center_azimuth_deg }
            );
        }
        assert_eq!(
            first(&oriented(Cube, Orientation::Three)),
            Projection::MirroredCubeFace(CubeFace::PositiveX)
        );
        assert_eq!(
            first(&camera(Cube)),
            Projection::CubeFace(CubeFace::PositiveX)
        );
        let turned = CameraSpec {
            azimuth_deg: Some(20.0),
            ..oriented(Equirectangular, Orientation::Godot)
        };
        for (camera, part) in [
            (oriented(Cube, Orientation::Unity), "airlight or three"),
            (
                oriented(Fisheye, Orientation::Three),
                "equirectangular or cube",
            ),
            (turned, "got godot and azimuth_deg"),
        ] {
            let error = Layout::new(&camera, &output("a.exr"), 0.0).unwrap_err();
            assert!(error.to_string().contains(part), "{error}");
        }
    }

    #[test]
    fn contradictory_settings_are_refused() {
        use ProjectionKind::{Equirectangular, Fisheye, Perspective};
        let size = |kind, width, height| CameraSpec {
            size: Some([width, height]),
            ..camera(kind)
        };
        let fov = |kind, deg| CameraSpec {
            fov_deg: Some(deg),
            ..camera(kind)
        };
        let roll = CameraSpec {
            roll_deg: Some(9.0),
            ..camera(Fisheye)
        };
        let exr = || output("a.exr");
        for (camera, output, part) in [
            (camera(Equirectangular), output("a.bmp"), ".exr"),
            (camera(Equirectangular), output("a"), "no ending"),
            (fov(Equirectangular, 90.0), exr(), "fisheye or perspective"),
            (
                roll,
                exr(),
                "camera.roll_deg: expected the projection perspective, got fisheye",
            ),
            (fov(Perspective, 180.0), exr(), "below 180"),
            (fov(Fisheye, 400.0), exr(), "360"),
            (size(ProjectionKind::Cube, 8, 4), exr(), "as wide as high"),
            (
                camera(Equirectangular),
                OutputSpec {
                    spectral: Some(true),
                    ..output("a.png")
                },
                "output.spectral: expected an OpenEXR file",
            ),
            (camera(Equirectangular), output("a.spectral.exr.png"), ""),
            (
                camera(Equirectangular),
                OutputSpec {
                    sun_disc: Some(SunDiscPlacement::Separate),
                    ..Default::default()
                },
                "output.file",
            ),
            (
                camera(Equirectangular),
                OutputSpec {
                    noise_map: Some(true),
                    ..Default::default()
                },
                "output.noise_map",
            ),
        ] {
            match Layout::new(&camera, &output, 0.0) {
                Ok(_) => assert!(part.is_empty(), "{part}"),
                Err(error) => assert!(
                    !part.is_empty() && error.to_string().contains(part),
                    "{part}: {error}"
                ),
            }
        }
    }
}
