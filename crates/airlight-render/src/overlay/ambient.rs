//! The colour of thick fog, estimated from a picture.

use airlight_image::input::{DepthMap, Picture};

/// How an estimate came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ambient {
    /// The sky above its lower edge, in the columns of middling brightness.
    Sky,
    /// The brightest thousandth of the dark channel.
    DarkChannel,
}

/// Half the side of the dark channel's patch: 15 x 15 pixels.
const HALF_PATCH: usize = 7;
/// How far from the sky's edge pixels may be mixed with what stands before it, or blurred into it.
const MIXED: usize = 2;
/// The sky pixels of a column that count.
const COUNTED: usize = 8;

/// The light that fog would be made of: the mean colour of the sky's lowest pixels, as the fog ends in the sky near the
/// horizon. Where there are none, as Foggy Cityscapes and He et al. (2011) do, the dark channel (the smallest of the three
/// colours within 15 x 15 pixels); of the pixels where it is brightest, one in a thousand, the mean colour.
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

/// Pixels that show the sky's usual colour near the horizon; nothing where less than 0.5 % of the picture is sky
/// (infinitely far), or all of it near an edge.
///
/// Of each column, the lowest eight sky pixels that have sky two pixels below and to either side: nearer to the edge they
/// are mixed with what stands before them. Of the columns, the fifth in the middle by brightness: the sun's surroundings may
/// take up two fifths of the horizon, and so may dark clouds, without having a say.
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
    sum.map(|s| (s / f64::max(count, 1.0)) as f32)
}

/// The smallest value in the patch round each pixel: columns first, then rows.
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

/// The least of the 15 values `step` apart round each one, fewer at the ends.
fn least_around(values: Vec<f32>, step: usize) -> Vec<f32> {
    let beyond = vec![f32::INFINITY; HALF_PATCH * step];
    let mut least_of = [&beyond[..], &values, &beyond].concat();
    // The least of 2, of 4, of 8, of 8 and 8 that share one.
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

/// The smaller of two numbers, neither of them NaN: one instruction, where the library's takes several.
#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_around_is_that_of_the_patch() {
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
