//! Options of the command line.

use std::path::PathBuf;

/// How the program is called.
pub const USAGE: &str = "Times of airlight-gpu and of Hillaire 2020 on one graphics device.

Usage: gpu_speed [OPTIONS]

Options:
  --sizes WxH,..     Sizes of the frames [1280x720,1920x1080,3840x2160]
  --frames N         Rounds of which medians are taken, 1 to 10000 [20]
  --no-fog           Leave out fog and lights, which take long on the processor
  --json             Print JSON
  --pictures FOLDER  Write the frames of both, of the first size, as PNG
  -h, --help         Print this help";

/// What is measured.
#[derive(Debug, PartialEq)]
pub struct Options {
    /// Width and height of frames.
    pub sizes: Vec<[u32; 2]>,
    /// Rounds.
    pub frames: usize,
    /// Whether fog and lights are timed, too.
    pub fog: bool,
    /// Whether JSON is printed.
    pub json: bool,
    /// Folder for pictures.
    pub pictures: Option<PathBuf>,
}

impl Options {
    /// Options from arguments; `None` for the help.
    pub fn parse(mut arguments: impl Iterator<Item = String>) -> Result<Option<Self>, String> {
        let mut options = Self {
            sizes: vec![[1280, 720], [1920, 1080], [3840, 2160]],
            frames: 20,
            fog: true,
            json: false,
            pictures: None,
        };
        while let Some(argument) = arguments.next() {
            let mut value = || {
                arguments
                    .next()
                    .ok_or(format!("expected a value after {argument}"))
            };
            match argument.as_str() {
                "-h" | "--help" => return Ok(None),
                "--no-fog" => options.fog = false,
                "--json" => options.json = true,
                "--pictures" => options.pictures = Some(value()?.into()),
                "--frames" => options.frames = frames(&value()?)?,
                "--sizes" => {
                    options.sizes = value()?.split(',').map(size).collect::<Result<_, _>>()?
                }
                _ => {
                    return Err(format!(
                        "expected --sizes, --frames, --no-fog, --json or --pictures, got '{argument}'; try --help"
                    ));
                }
            }
        }
        Ok(Some(options))
    }
}

fn frames(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|n| (1..=10_000).contains(n));
    count.ok_or(format!("expected --frames of 1 to 10000, got '{text}'"))
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse().ok().filter(|n| (16..=8192).contains(n));
    let sides = text.split_once('x');
    let sides = sides.and_then(|(width, height)| Some([side(width)?, side(height)?]));
    sides.ok_or(format!(
        "expected --sizes such as 1280x720,1920x1080, with sides of 16 to 8192 pixels, got '{text}'"
    ))
}
