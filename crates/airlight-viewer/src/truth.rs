//! Differences between what is drawn and what models compute.

use crate::compute::{Light, SPACE};
use airlight::spectrum::difference::{D65_WHITE, ciede2000, xyz_to_lab};
use airlight_image::Frame;
use eframe::egui::Color32;
use glam::Vec3;

/// Differences at which the colours of maps end.
const ENDS: [f64; 7] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0];
/// Distance from the horizon, where radiance jumps within a pixel, up to which directions are left out of statistics, degrees.
const BESIDE_HORIZON_DEG: f64 = 0.3;

/// Directions of a grid over a picture, row by row: at the centres of its pixels where it is as large; zero outside the circle of a
/// fisheye.
pub fn directions(frame: &Frame, [across, down]: [u32; 2]) -> Vec<[f32; 3]> {
    let size = frame.size();
    let place =
        |k: u32, count: u32, side: u32| (f64::from(k) + 0.5) / f64::from(count) * f64::from(side);
    let points = (0..down).flat_map(|j| (0..across).map(move |i| (i, j)));
    points
        .map(|(i, j)| {
            let (x, y) = (
                place(i, across, size.width()),
                place(j, down, size.height()),
            );
            let direction = frame.direction(x, y).unwrap_or_default();
            direction.as_vec3().to_array()
        })
        .collect()
}

/// A difference in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Luminance of the picture over that of the model minus 1, percent.
    pub percent: f64,
    /// Difference of colour, where the brightest of the model is white.
    pub ciede2000: f64,
}

/// Root mean squares over directions, and largest differences.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Of luminance, percent.
    pub rms_percent: f64,
    /// Largest of luminance, percent.
    pub worst_percent: f64,
    /// Of colour, CIEDE2000.
    pub rms_ciede2000: f64,
}

/// Red, green and blue of what is drawn, cd/m^2; black in directions without length.
pub fn drawn(light: &Light, directions: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let directions = directions
        .iter()
        .map(|d| Vec3::from_array(*d).try_normalize());
    directions
        .map(|d| d.map_or([0.0; 3], |d| light.tables.rgb_radiance(d).to_array()))
        .collect()
}

/// Differences of colours from those that are taken as right; `None` where either is black.
pub fn differences(colours: &[[f32; 3]], right: &[[f32; 3]]) -> Vec<Option<Difference>> {
    let xyz = |rgb: &[f32; 3]| SPACE.to_xyz(rgb.map(f64::from));
    let white = right.iter().map(|rgb| xyz(rgb)[1]).fold(0.0, f64::max);
    let lab = |xyz: [f64; 3]| xyz_to_lab(xyz.map(|v| 100.0 * v / white), D65_WHITE);
    let pairs = colours.iter().zip(right);
    pairs
        .map(|(got, right)| {
            let [got, right] = [got, right].map(xyz);
            (got[1] > 0.0 && right[1] > 1e-4 * white).then(|| Difference {
                percent: 100.0 * (got[1] / right[1] - 1.0),
                ciede2000: ciede2000(lab(got), lab(right)),
            })
        })
        .collect()
}

/// The end of the colours of a map of differences with a root mean square.
pub fn end(rms: f64) -> f64 {
    let [.., last] = ENDS;
    let end = ENDS.into_iter().find(|end| *end >= 2.0 * rms);
    end.unwrap_or(last)
}

/// Statistics away from the horizon, and of the sky alone where there is any, as models of the sky are compared; `None` without light.
pub fn sky_statistics(
    light: &Light,
    directions: &[[f32; 3]],
    differences: &[Option<Difference>],
) -> Option<Statistics> {
    let horizon_sine = light.facts.horizon_deg.to_radians().sin() as f32;
    let pairs = directions.iter().zip(differences);
    let sky = pairs.map(|(d, difference)| difference.filter(|_| d[1] > horizon_sine));
    statistics(light, directions, &sky.collect::<Vec<_>>())
        .or_else(|| statistics(light, directions, differences))
}

/// Statistics away from the horizon; `None` without light.
pub fn statistics(
    light: &Light,
    directions: &[[f32; 3]],
    differences: &[Option<Difference>],
) -> Option<Statistics> {
    let horizon_deg = light.facts.horizon_deg;
    let pairs = directions.iter().zip(differences);
    let counted: Vec<Difference> = pairs
        .filter(|(d, _)| {
            let elevation_deg = f64::from(d[1].clamp(-1.0, 1.0)).asin().to_degrees();
            (elevation_deg - horizon_deg).abs() > BESIDE_HORIZON_DEG
        })
        .filter_map(|(_, difference)| *difference)
        .collect();
    let rms = |of: fn(&Difference) -> f64| {
        let squares: f64 = counted.iter().map(|d| of(d).powi(2)).sum();
        (squares / counted.len() as f64).sqrt()
    };
    let worst = |a: f64, d: &Difference| {
        if d.percent.abs() > a.abs() {
            d.percent
        } else {
            a
        }
    };
    (!counted.is_empty()).then(|| Statistics {
        rms_percent: rms(|d| d.percent),
        worst_percent: counted.iter().fold(0.0, worst),
        rms_ciede2000: rms(|d| d.ciede2000),
    })
}

/// Colour of a luminance difference: blue where the picture is darker, red where it is brighter.
pub fn percent_colour(percent: f64, end: f64) -> Color32 {
    let part = (percent / end).clamp(-1.0, 1.0) as f32;
    let fade = |v: f32| (255.0 * (1.0 - part.abs() * (1.0 - v))) as u8;
    match part < 0.0 {
        true => Color32::from_rgb(fade(0.1), fade(0.3), fade(0.75)),
        false => Color32::from_rgb(fade(0.75), fade(0.15), fade(0.1)),
    }
}

/// Colour of a CIEDE2000 difference: from black to yellow to white.
pub fn ciede2000_colour(difference: f64, end: f64) -> Color32 {
    let part = (difference / end).clamp(0.0, 1.0) as f32;
    let channel = |from: f32| (255.0 * ((part - from) * 3.0).clamp(0.0, 1.0)).round() as u8;
    Color32::from_rgb(channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use airlight_image::{Fisheye, Projection};

    #[test]
    fn maps_are_white_or_black_without_a_difference_and_end() {
        assert_eq!(percent_colour(0.0, 20.0), Color32::WHITE);
        assert_eq!(percent_colour(30.0, 20.0), percent_colour(20.0, 20.0));
        let [darker, brighter] = [-10.0, 10.0].map(|percent| percent_colour(percent, 20.0));
        assert!(darker.b() > darker.r() && brighter.r() > brighter.b());
        assert_eq!(ciede2000_colour(0.0, 10.0), Color32::BLACK);
        assert_eq!(ciede2000_colour(10.0, 10.0), Color32::WHITE);
        assert_eq!([0.0, 0.8, 3.0, 900.0].map(end), [1.0, 2.0, 10.0, 100.0]);
    }

    #[test]
    fn directions_are_those_of_the_picture() {
        let projection = Projection::AngularFisheye(Fisheye::ALL_SKY);
        let frame = Frame::new(projection, 9, 6).unwrap();
        for (k, direction) in (0..).zip(directions(&frame, [9, 6])) {
            let right = frame.pixel_direction(k % 9, k / 9).unwrap_or_default();
            let apart = Vec3::from_array(direction).distance(right.as_vec3());
            assert!(apart < 1e-6, "{k}");
        }
        // A grid of fewer points spans the same picture.
        let coarse = directions(&frame, [3, 2]);
        let right = frame.pixel_direction(4, 1).unwrap().as_vec3();
        assert!(Vec3::from_array(coarse[1]).distance(right) < 1e-6);
    }
}
