//! Options of `airlight sky`.

use super::{CameraArgs, DisplayArgs, EncodingArgs, SceneArgs};
use crate::error::CliError;
use crate::parse::{self, put};
use airlight::scene::{ObjectsSpec, Scene, SequenceSpec};
use airlight_render::Shard;
use clap::Args;
use std::path::PathBuf;

/// Options of `airlight sky`.
#[derive(Clone, Debug, Args)]
#[command(allow_negative_numbers = true, after_help = EXAMPLES)]
pub struct SkyArgs {
    /// File to write; its extension selects the format: .exr, .hdr, .png, .jpg, or .spectral.exr
    #[arg(short, long, value_name = "FILE", help_heading = "Files")]
    pub output: Option<String>,
    /// Show the picture in the terminal (default without --output)
    #[arg(long, help_heading = "Files")]
    pub preview: bool,
    /// Write the complete scene of --scene and the options to a TOML file
    #[arg(long, value_name = "FILE.toml", help_heading = "Files")]
    pub save_scene: Option<PathBuf>,
    /// Print nothing on standard output
    #[arg(short, long, help_heading = "Files")]
    pub quiet: bool,
    /// With --solver monte-carlo: write the standard error of each pixel's colour to NAME.noise.exr
    #[arg(long, help_heading = "Files")]
    pub noise_map: bool,
    /// Write degree and angle of polarisation to NAME.polarisation.exr
    #[arg(long, help_heading = "Files")]
    pub polarisation: bool,
    #[command(flatten)]
    pub scene: SceneArgs,
    #[command(flatten)]
    pub sequence: SequenceArgs,
    #[command(flatten)]
    pub machines: MachinesArgs,
    #[command(flatten)]
    pub camera: CameraArgs,
    #[command(flatten)]
    pub display: DisplayArgs,
    #[command(flatten)]
    pub encoding: EncodingArgs,
    #[command(flatten)]
    pub objects: ObjectArgs,
}

/// A sequence of pictures.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Sequences")]
pub struct SequenceArgs {
    /// Draw a sequence from --when until this time, or for a duration: +6h
    #[arg(long, value_name = "TIME|+SPAN")]
    pub until: Option<String>,
    /// Interval between pictures: 10m, 1h30m, 45s
    #[arg(long, value_name = "SPAN", value_parser = parse::span)]
    pub every: Option<String>,
    /// Meter the exposure of every picture by itself; otherwise all have that of the brightest of the first, the middle and the
    /// last
    #[arg(long)]
    pub meter_each: bool,
    /// Manifest, with a line of JSON for each picture [default: manifest.jsonl beside the pictures; with --shard 3/16
    /// manifest-3-of-16.jsonl]
    #[arg(long, value_name = "FILE")]
    pub manifest: Option<PathBuf>,
    /// Replace existing pictures of a sequence; otherwise they are kept, and must have been made with the same options
    #[arg(long)]
    pub overwrite: bool,
}

/// Pictures drawn by several machines.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Many machines")]
pub struct MachinesArgs {
    /// Draw only a part, for one of several machines: 3/16 is the third of 16 parts of a sequence. Of a single picture, it is a band
    /// of rows, written to NAME-3-of-16.exr; airlight join makes the picture of all bands
    #[arg(long, value_name = "K/N")]
    pub shard: Option<Shard>,
    /// Draw nothing and write a job template of Open Job Description for render farms, whose tasks draw the shards
    #[arg(long, value_name = "FILE.json")]
    #[arg(conflicts_with_all = ["preview", "shard", "manifest", "overwrite"])]
    pub openjd: Option<PathBuf>,
    /// Number of tasks of the job [default: 16, or fewer for small jobs]
    #[arg(long, value_name = "N", requires = "openjd")]
    pub tasks: Option<u32>,
}

/// Objects in front of the sky.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Objects")]
pub struct ObjectArgs {
    /// TOML file of objects; their origin is the point of the ground below the eye
    #[arg(long, value_name = "FILE.toml")]
    pub objects: Option<String>,
    /// Write the depth of objects to NAME.depth.exr: metres along the camera's axis (perspective) or along the ray, infinite
    /// for sky
    #[arg(long)]
    pub depth_map: bool,
    /// Disable shadows of objects on each other, as in the pictures of Klassen 1987
    #[arg(long)]
    pub no_shadows: bool,
}

impl SkyArgs {
    /// The scene of the options.
    ///
    /// # Errors
    /// [`CliError`] if a file cannot be read or is invalid.
    pub fn read(&self) -> Result<Scene, CliError> {
        self.scene.read(|scene| {
            self.camera.fill(&mut scene.camera);
            let output = &mut scene.output;
            put(&mut output.file, &self.output);
            self.display.fill(output);
            self.encoding.fill(output);
            put(&mut output.noise_map, &self.noise_map.then_some(true));
            put(&mut output.polarisation, &self.polarisation.then_some(true));
            put(
                &mut output.depth_map,
                &self.objects.depth_map.then_some(true),
            );
            self.objects.fill(&mut scene.objects);
            self.sequence.fill(&mut scene.sequence);
        })
    }
}

impl ObjectArgs {
    /// Overrides values of a scene.
    pub fn fill(&self, objects: &mut Option<ObjectsSpec>) {
        if let Some(file) = &self.objects {
            *objects = Some(ObjectsSpec {
                file: Some(file.clone()),
                object: Vec::new(),
                shadows: objects.as_ref().and_then(|objects| objects.shadows),
            });
        }
        if self.no_shadows {
            objects.get_or_insert_default().shadows = Some(false);
        }
    }
}

impl SequenceArgs {
    /// An option that a single picture would ignore.
    pub fn of_sequences(&self) -> Option<&'static str> {
        self.manifest.is_some().then_some("--manifest")
    }

    fn fill(&self, sequence: &mut Option<SequenceSpec>) {
        if self.until.is_some() || self.every.is_some() {
            let sequence = sequence.get_or_insert_default();
            put(&mut sequence.until, &self.until);
            put(&mut sequence.every, &self.every);
        }
        if self.meter_each {
            sequence.get_or_insert_default().meter_each = Some(true);
        }
    }
}

const EXAMPLES: &str = "\
Examples:
  The sky over Paris on the whole sphere, linear light in cd/m^2:
    airlight sky --at 48.8584,2.2945 --when 2026-06-21T21:15:00+02:00 -o sky.exr
  A photograph of a low sun through haze:
    airlight sky --sun-elevation 3 --aod-550 0.3 --projection perspective --size 1920x1080 -o dusk.png
  A scene file, written from options and drawn at another time:
    airlight sky --at 64.1,-21.9 --when 2026-06-21T00:00:00Z --projection fisheye -o a.png --save-scene iceland.toml
    airlight sky --scene iceland.toml --when 2026-12-21T12:00:00Z -o b.png
  An environment map for rendering, with the sun in a separate file (dome.sun.exr):
    airlight sky --sun-elevation 40 --sun-disc separate --size 4096x2048 -o dome.exr
  A day with a picture every ten minutes (day.0001.png, ...); a second run draws missing pictures:
    airlight sky --at 64.1,-21.9 --when 2026-06-21T00:00:00Z --until +24h --every 10m \\
      --projection fisheye -o day.png
  A panorama in four bands on four machines, and joined; the same as a job for a render farm:
    airlight sky --sun-elevation 20 --size 32768x16384 -o big.exr --shard 1/4
    airlight join big-1-of-4.exr big-2-of-4.exr big-3-of-4.exr big-4-of-4.exr -o big.exr
    airlight sky --sun-elevation 20 --size 32768x16384 -o big.exr --openjd job.json
  Ground fog at sunrise, seen from a hill 60 m high:
    airlight sky --sun-elevation 2 --visibility-m 150 --top-m 40 --altitude-m 60 --projection perspective -o fog.png
  A sky by Monte Carlo, with a noise map:
    airlight sky --sun-elevation 3 --solver monte-carlo --paths 1024 --size 512x256 --noise-map -o truth.exr
  A sky with maps of polarisation: degree, and angle from the vertical, anticlockwise as seen by the eye:
    airlight sky --sun-elevation 10 --polarisation --projection fisheye --size 256x256 -o blue.exr
  The Earth from a height of 400 km; the sky of Mars:
    airlight sky --sun-elevation 20 --altitude-m 400e3 --projection perspective --camera-elevation -15 -o iss.png
    airlight sky --atmosphere mars --sun-elevation 5 --projection perspective -o mars.png";
