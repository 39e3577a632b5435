//! Operations on blocks of pixels, component by component, without branches: the compiler makes vector code of them.

use super::srgb::luminance;

/// Red, green and blue of N pixels.
pub(super) type Planes<const N: usize> = [[f32; N]; 3];

/// The smaller of two numbers, neither of them NaN: one instruction, where the library's takes several.
#[inline(always)]
pub(super) fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The greater of two numbers, neither of them NaN.
#[inline(always)]
pub(super) fn greatest(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// `keep * c + share * (weighted mean of c)` for each component.
#[inline(always)]
pub(super) fn mix<const N: usize>(
    planes: &mut Planes<N>,
    weights: [f32; 3],
    keep: f32,
    share: f32,
) {
    let [r, g, b] = planes;
    for i in 0..N {
        let mean = share * (weights[0] * r[i] + weights[1] * g[i] + weights[2] * b[i]);
        r[i] = keep * r[i] + mean;
        g[i] = keep * g[i] + mean;
        b[i] = keep * b[i] + mean;
    }
}

/// Raises colours with negative components (outside the gamut) along the line to grey of their own luminance until none
/// is negative; black where the luminance is not positive.
#[inline(always)]
pub(super) fn without_negatives<const N: usize>(planes: &mut Planes<N>) {
    let [r, g, b] = planes;
    for i in 0..N {
        let bottom = least(least(r[i], g[i]), b[i]);
        let grey = luminance([r[i], g[i], b[i]]);
        let lit = if grey > 0.0 { grey } else { 0.0 };
        // Where nothing is negative, the whole colour stays: part 1.
        let part = if bottom < 0.0 {
            lit / (lit - bottom)
        } else {
            1.0
        };
        let raise = |v: f32| {
            let raised = greatest(lit + part * (v - lit), 0.0);
            if bottom < 0.0 { raised } else { v }
        };
        (r[i], g[i], b[i]) = (raise(r[i]), raise(g[i]), raise(b[i]));
    }
}

/// Brings colours into `[0, 1]` along the line to grey of their own luminance.
#[inline(always)]
pub(super) fn into_unit_cube<const N: usize>(planes: &mut Planes<N>) {
    without_negatives(planes);
    let [r, g, b] = planes;
    for i in 0..N {
        let top = greatest(greatest(r[i], g[i]), b[i]);
        let grey = least(luminance([r[i], g[i], b[i]]), 1.0);
        let part = if top > 1.0 {
            (1.0 - grey) / (top - grey)
        } else {
            1.0
        };
        let lower = |v: f32| {
            let lowered = least(grey + part * (v - grey), 1.0);
            if top > 1.0 { lowered } else { v }
        };
        (r[i], g[i], b[i]) = (lower(r[i]), lower(g[i]), lower(b[i]));
    }
}
