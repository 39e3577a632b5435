//! Ambient light of fog, estimated from a picture.

use airlight_image::input::{DepthMap, Picture};

/// Method of an estimate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ambient {
    /// The sky above its lower edge, in columns of medium brightness.
    Sky,
    /// The brightest thousandth of the dark channel.
    DarkChannel,
}

/// Half the side of the dark channel's patch: 15 x 15 pixels.
const HALF_PATCH: usize = 7;
/// Distance from the edge of the sky within which pixels may be mixed with objects in front of it, pixels.
const MIXED: usize = 2;
/// Number of sky pixels used in each column.
const COUNTED: usize = 8;

/// Estimates the ambient light of fog: the mean colour of the sky's lowest pixels. Without any, as in Foggy Cityscapes and
/// He et al. (2011), the mean colour of the thousandth of all pixels with the brightest dark channel (the smallest of the
/// three colours within 15 x 15 pixels).
pub fn estimate_ambient(picture: &Picture, depth: &DepthMap) -> ([f32; 3], Ambient) {
    if let Some(pixels) = horizon_pixels(picture, depth) {
        return (mean(picture, pixels.into_iter()), Ambient::Sky);
    }
    let width = picture.size.width() as usize;
    let count = width * picture.size.height() as usize;
    let dark = dark_channel(picture, width);
    let mut order: Vec<usize> = (0..count).collect();
    let brightest = count.div_ceil(1000);
    order.select_nth_unstable_by(brightest - 1, |&a, &b| dark[b].total_cmp(&dark[a]));
    let pixels = order[..brightest].iter().copied();
    (mean(picture, pixels), Ambient::DarkChannel)
}

/// Pixels with the typical colour of the sky near the horizon; `None` if less than 0.5 % of the picture is sky (infinitely
/// far), or all sky is near an edge.
///
/// In each column, these are the lowest eight sky pixels that have sky two pixels below and on both sides: nearer to the edge,
/// pixels are mixed with objects. Of all columns, only the middle fifth by brightness is used, so that a bright aureole or dark
/// clouds may cover up to two fifths of the horizon each without effect.
pub fn horizon_pixels(picture: &Picture, depth: &DepthMap) -> Option<Vec<usize>> {
    let (width, height) = (
        picture.size.width() as usize,
        picture.size.height() as usize,
    );
    let is_sky = |x: usize, y: usize| depth.metres.get(y * width + x) == Some(&f32::INFINITY);
    let skies = depth.metres.iter().filter(|m| **m == f32::INFINITY).count();
    if 200 * skies < width * height {
        return None;
    }
    let is_pure = |x: usize, y: usize| {
        let below = y..(y + MIXED + 1).min(height);
        let beside = x.saturating_sub(MIXED)..(x + MIXED + 1).min(width);
        below.into_iter().all(|y| is_sky(x, y)) && beside.into_iter().all(|x| is_sky(x, y))
    };
    let mut columns: Vec<(f32, Vec<usize>)> = (0..width)
        .map(|x| {
            let pure = (0..height).rev().filter(|&y| is_pure(x, y));
            let pixels: Vec<usize> = pure.take(COUNTED).map(|y| y * width + x).collect();
            let colour = mean(picture, pixels.iter().copied());
            (colour[0] + colour[1] + colour[2], pixels)
        })
        .filter(|(_, pixels)| !pixels.is_empty())
        .collect();
    if columns.is_empty() {
        return None;
    }
    columns.sort_by(|a, b| a.0.total_cmp(&b.0));
    let middle = 2 * columns.len() / 5..(3 * columns.len()).div_ceil(5);
    let middle = columns.drain(middle).flat_map(|(_, pixels)| pixels);
    Some(middle.collect())
}

fn mean(picture: &Picture, pixels: impl Iterator<Item = usize>) -> [f32; 3] {
    let mut sum = [0.0f64; 3];
    let mut count = 0.0;
    for pixel in pixels {
        count += 1.0;
        for (sum, value) in sum.iter_mut().zip(&picture.rgb[3 * pixel..]) {
            *sum += f64::from(*value);
        }
    }
    // Colours outside the gamut have negative components, which no light has.
    sum.map(|s| (s / f64::max(count, 1.0)).max(0.0) as f32)
}

/// Smallest value in the patch around each pixel: columns first, then rows.
fn dark_channel(picture: &Picture, width: usize) -> Vec<f32> {
    let smallest = picture
        .rgb
        .chunks_exact(3)
        .map(|rgb| least(least(rgb[0], rgb[1]), rgb[2]))
        .collect();
    let columns = least_around(smallest, width);
    let rows = columns.chunks_exact(width);
    rows.flat_map(|row| least_around(row.to_vec(), 1)).collect()
}

/// Smallest of the 15 values, `step` apart, around each one; fewer at the ends.
fn least_around(values: Vec<f32>, step: usize) -> Vec<f32> {
    let beyond = vec![f32::INFINITY; HALF_PATCH * step];
    let mut least_of = [&beyond[..], &values, &beyond].concat();
    // Minimum of 2, of 4, of 8, and of two overlapping groups of 8.
    for by in [1, 2, 4, 7] {
        let ahead = &least_of[by * step..];
        least_of = least_of
            .iter()
            .zip(ahead)
            .map(|(&a, &b)| least(a, b))
            .collect();
    }
    least_of
}

/// The smaller of two numbers that are not NaN: a single instruction, unlike `f32::min`.
#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn least_around_is_the_minimum_of_the_patch() {
        for count in [1usize, 5, 14, 15, 16, 40] {
            let values: Vec<f32> = (0..count).map(|i| ((i * 37 + 11) % 29) as f32).collect();
            for step in [1, 3] {
                let made = least_around(values.clone(), step);
                assert_eq!(made.len(), count);
                for (i, &made) in made.iter().enumerate() {
                    let near = (0..count)
                        .filter(|j| j % step == i % step && i.abs_diff(*j) <= HALF_PATCH * step);
                    let expected = near.map(|j| values[j]).fold(f32::INFINITY, f32::min);
                    assert_eq!(made, expected, "{i} of {count}, {step}");
                }
            }
        }
    }
}
