//! The colour of thick fog, estimated from a picture.

use crate::input::{DepthMap, Picture};
use airlight::spectrum::Spectrum;

/// How an estimate came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ambient {
    /// The mean of the lowest sky pixels of each column.
    Sky,
    /// The brightest thousandth of the dark channel.
    DarkChannel,
}

/// Half the side of the dark channel's patch: 15 x 15 pixels.
const HALF_PATCH: usize = 7;

/// The light that fog would be made of. Where at least 0.5 % of the pixels are sky (infinitely far): the mean of the
/// lowest eight of them in each column, as the fog ends in the sky near the horizon. Else, as Foggy Cityscapes and He et al.
/// (2011) do, the dark channel (the smallest of the three colours within 15 x 15 pixels); of the pixels where it is
/// brightest, one in a thousand, the mean colour.
pub fn estimate_ambient(picture: &Picture, depth: &DepthMap) -> (Spectrum<3>, Ambient) {
    let (width, height) = (
        picture.size.width() as usize,
        picture.size.height() as usize,
    );
    let count = width * height;
    let is_sky = |pixel: usize| depth.metres.get(pixel) == Some(&f32::INFINITY);
    let skies = (0..count).filter(|&pixel| is_sky(pixel)).count();
    if 200 * skies >= count {
        let lowest = (0..width).flat_map(|x| {
            let column = (0..height).rev().map(move |y| y * width + x);
            column.filter(|&pixel| is_sky(pixel)).take(8)
        });
        return (mean(picture, lowest), Ambient::Sky);
    }
    let dark = dark_channel(picture, width);
    let mut order: Vec<usize> = (0..count).collect();
    let brightest = count.div_ceil(1000);
    order.select_nth_unstable_by(brightest - 1, |&a, &b| dark[b].total_cmp(&dark[a]));
    let pixels = order[..brightest].iter().copied();
    (mean(picture, pixels), Ambient::DarkChannel)
}

fn mean(picture: &Picture, pixels: impl Iterator<Item = usize>) -> Spectrum<3> {
    let mut sum = [0.0f64; 3];
    let mut count = 0.0;
    for pixel in pixels {
        count += 1.0;
        for (sum, value) in sum.iter_mut().zip(&picture.rgb[3 * pixel..]) {
            *sum += f64::from(*value);
        }
    }
    Spectrum(sum.map(|s| (s / f64::max(count, 1.0)) as f32))
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
