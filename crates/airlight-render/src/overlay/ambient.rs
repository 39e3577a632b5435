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
    let dark = dark_channel(picture, width, height);
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

/// The smallest value in the patch round each pixel: rows first, then columns.
fn dark_channel(picture: &Picture, width: usize, height: usize) -> Vec<f32> {
    let smallest: Vec<f32> = picture
        .rgb
        .chunks_exact(3)
        .map(|rgb| rgb[0].min(rgb[1]).min(rgb[2]))
        .collect();
    let window =
        |at: usize, end: usize| at.saturating_sub(HALF_PATCH)..(at + HALF_PATCH + 1).min(end);
    let least = |values: &mut dyn Iterator<Item = f32>| values.fold(f32::INFINITY, f32::min);
    let rows: Vec<f32> = (0..width * height)
        .map(|pixel| {
            let (x, y) = (pixel % width, pixel / width);
            least(&mut window(x, width).map(|x| smallest[y * width + x]))
        })
        .collect();
    (0..width * height)
        .map(|pixel| {
            let (x, y) = (pixel % width, pixel / width);
            least(&mut window(y, height).map(|y| rows[y * width + x]))
        })
        .collect()
}
