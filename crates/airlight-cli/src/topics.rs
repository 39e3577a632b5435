//! `airlight topics`: worked recipes.

use crate::error::CliError;
use crate::report;

/// Recipes for the usual tasks, of commands that work as they stand.
pub const TOPICS: &str = "\
Light a scene in Blender, Mitsuba, three.js, Unreal, Unity or Godot
  The sun is left out of the panorama and becomes a light; the report states its direction and its illuminance.
    airlight sky --sun-elevation 40 --sun-azimuth 120 --sun-disc out --orientation blender --size 4096x2048 -o world.exr
  Values are cd/m^2: set the strength of Blender's background to about 2e-4, or write the file with --scale 2e-4.

Photograph a place at a time
  Perspective pictures look towards the sun unless --camera-azimuth says otherwise.
    airlight sky --at 48.8584,2.2945 --when '2026-06-21 21:15 Europe/Paris' --projection perspective -o evening.png
  A day with a picture every ten minutes; a second run draws what is missing.
    airlight sky --at 48.8584,2.2945 --when 2026-06-21T04:00+02:00 --until +18h --every 10m --projection fisheye -o day.png

Choose the air
  Clear, average, hazy, Mars and others by name; haze by optical depth, by visibility or of a published type.
    airlight atmospheres
    airlight sky --sun-elevation 5 --aerosol urban --aod-550 0.4 --projection perspective -o city.png
  Fog is another layer: its visibility, and its top or scale height.
    airlight sky --sun-elevation 8 --visibility-m 200 --top-m 40 --altitude-m 60 --projection perspective -o valley.png

Add fog to pictures with depth
  One picture; depth in millimetres; visibility 200 m.
    airlight fog street.png --depth street_depth.png --depth-scale 0.001 --visibility-m 200 -o foggy.png
  A folder, with a visibility drawn for each picture; the same seed gives the same pictures.
    airlight fog rgb --depth depth --vary visibility=50..500 --seed 1 -o foggy

Measure and compare
  Radiance along directions and illuminances, as text, CSV or JSON.
    airlight probe --sun-elevation 30 --view 0,90 --view 90,2 --format json
  One sky by two solvers, with maps of the difference; the same sky with known noise.
    airlight compare orders hillaire2020 --sun-elevation 10 --size 480x240 -o compare.png
    airlight sky --sun-elevation 10 --solver monte-carlo --size 256x128 --noise-map -o truth.exr

--help after a command lists all its options. The book, docs/src, explains them.
";

/// Runs the command.
///
/// # Errors
/// [`CliError`] if standard output cannot be written.
pub fn run() -> Result<(), CliError> {
    report::print(TOPICS)
}
