//! Directions within pixels of a frame, angular size of pixels, and names of files beside a picture.

use airlight_image::Frame;
use glam::DVec3;
use std::path::{Path, PathBuf};

/// Number of samples across a pixel that an edge crosses; the pixel is their mean.
const SUBPIXELS: u32 = 4;
/// Number of samples of such a pixel.
pub const POINTS: u32 = SUBPIXELS * SUBPIXELS;

/// Extension of spectral EXR files.
const SPECTRAL_ENDING: &str = ".spectral.exr";

/// Directions at evenly spaced points of a pixel, row by row, without those outside the projection.
pub fn directions_within(frame: &Frame, (i, j): (u32, u32)) -> impl Iterator<Item = DVec3> {
    let at = |n: u32, k: u32| f64::from(n) + (f64::from(k) + 0.5) / f64::from(SUBPIXELS);
    (0..POINTS).filter_map(move |k| frame.direction(at(i, k % SUBPIXELS), at(j, k / SUBPIXELS)))
}

/// Upper bound of the angle from a pixel's centre to its corners, rad: 1.5 times the largest of 33 by 33 pixels.
pub fn pixel_reach(frame: &Frame) -> f64 {
    const STEPS: u32 = 32;
    let size = frame.size();
    if size.width() < 8 || size.height() < 8 {
        // Pixels of this size may extend beyond their corners.
        return std::f64::consts::PI;
    }
    let mut most = 0.0f64;
    for k in 0..=STEPS {
        for l in 0..=STEPS {
            let pick = |n: u32, k: u32| (u64::from(n - 1) * u64::from(k) / u64::from(STEPS)) as u32;
            let (i, j) = (
                f64::from(pick(size.width(), k)),
                f64::from(pick(size.height(), l)),
            );
            let Some(centre) = frame.direction(i + 0.5, j + 0.5) else {
                continue;
            };
            for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
                if let Some(corner) = frame.direction(i + dx, j + dy) {
                    most = most.max(corner.angle_between(centre));
                }
            }
        }
    }
    1.5 * most
}

/// Whether a path ends in `.spectral.exr`, ignoring case: a file with one channel for each wavelength.
pub fn is_spectral_path(path: &Path) -> bool {
    file_name(path)
        .to_ascii_lowercase()
        .ends_with(SPECTRAL_ENDING)
}

/// The path with a tag before its extension, such as `sky.sun.exr` for `sky.exr`.
pub fn tagged_path(path: &Path, tag: &str) -> PathBuf {
    let name = file_name(path);
    let ending = match is_spectral_path(path) {
        true => SPECTRAL_ENDING.len(),
        false => name.rfind('.').map_or(0, |at| name.len() - at),
    };
    let (stem, ending) = name.split_at(name.len() - ending);
    path.with_file_name(format!("{stem}.{tag}{ending}"))
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_are_inserted_before_the_extension() {
        for (path, tagged) in [
            ("a/sky.exr", "a/sky.sun.exr"),
            ("sky.0001.exr", "sky.0001.sun.exr"),
            ("x.spectral.exr", "x.sun.spectral.exr"),
            ("sky", "sky.sun"),
        ] {
            assert_eq!(tagged_path(Path::new(path), "sun"), Path::new(tagged));
        }
    }

    #[test]
    fn all_points_of_a_pixel_lie_within_its_reach() {
        let frame = Frame::equirectangular(32).unwrap();
        let reach = pixel_reach(&frame);
        for pixel in [(0, 0), (31, 15), (32, 16), (63, 31)] {
            let centre = frame.pixel_direction(pixel.0, pixel.1).unwrap();
            let directions: Vec<DVec3> = directions_within(&frame, pixel).collect();
            assert_eq!(directions.len(), POINTS as usize);
            assert!(directions.iter().all(|d| d.angle_between(centre) < reach));
        }
    }
}
