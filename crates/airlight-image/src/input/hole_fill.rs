//! Filling of holes in depth maps from the known pixels around them.
//!
//! Stereo and depth cameras leave holes mostly where a near object hides a far one from one of two views: there the
//! farther neighbour is right. Along each row a hole therefore gets the farther of the nearest known values to its left
//! and right, unless the two are similar: then both lie on one surface, and the hole is interpolated linearly
//! in 1/z, as a plane appears. A median along the columns then removes the streaks that independently filled rows would show, of
//! holes between different surfaces: those on one surface are exact. The work is proportional to the number of pixels.

use rayon::prelude::*;

/// Largest relative difference of two depths on one surface.
const ONE_SURFACE: f32 = 0.1;

/// Half width of the median, rows.
const REACH: usize = 4;

/// Fills NaN pixels; at least one pixel must be known.
pub(super) fn fill_holes(values: &mut [f32], width: usize) {
    let mut uncertain: Vec<bool> = values.iter().map(|v| v.is_nan()).collect();
    values
        .par_chunks_mut(width)
        .zip(uncertain.par_chunks_mut(width))
        .for_each(|(row, uncertain)| fill_row(row, uncertain));
    fill_rows(values, width);
    smooth(values, &uncertain, width);
}

/// Fills the holes of a row; a row without known pixels stays unchanged. Holes on one surface are no longer `uncertain`.
fn fill_row(row: &mut [f32], uncertain: &mut [bool]) {
    let mut start = 0;
    while let Some(first) = row[start..].iter().position(|v| v.is_nan()) {
        let first = start + first;
        let end = row[first..]
            .iter()
            .position(|v| !v.is_nan())
            .map_or(row.len(), |n| first + n);
        let left = first.checked_sub(1).map(|i| row[i]);
        let right = row.get(end).copied();
        let hole = &mut row[first..end];
        match (left, right) {
            (Some(a), Some(b)) => {
                if fill_between(hole, a, b) {
                    uncertain[first..end].fill(false);
                }
            }
            (Some(v), None) | (None, Some(v)) => hole.fill(v),
            (None, None) => {}
        }
        start = end;
    }
}

/// Fills a hole between two known values; returns whether both lie on one surface.
fn fill_between(hole: &mut [f32], left: f32, right: f32) -> bool {
    let (near, far) = (left.min(right), left.max(right));
    if !(far.is_finite() && near > 0.0 && far - near <= ONE_SURFACE * far) {
        hole.fill(far);
        return left == right;
    }
    let (a, b) = (1.0 / f64::from(left), 1.0 / f64::from(right));
    let step = (b - a) / (hole.len() + 1) as f64;
    for (i, value) in hole.iter_mut().enumerate() {
        *value = (1.0 / (a + step * (i + 1) as f64)) as f32;
    }
    true
}

/// Fills rows without known pixels with the farther of the nearest rows above and below.
fn fill_rows(values: &mut [f32], width: usize) {
    let height = values.len() / width;
    let is_empty = |values: &[f32], y: usize| values[y * width].is_nan();
    let mut start = 0;
    while start < height {
        if !is_empty(values, start) {
            start += 1;
            continue;
        }
        let end = (start..height)
            .find(|&y| !is_empty(values, y))
            .unwrap_or(height);
        let (above, rest) = values.split_at_mut(start * width);
        let (hole, below) = rest.split_at_mut((end - start) * width);
        let above = above.rchunks_exact(width).next();
        let below = below.chunks_exact(width).next();
        for row in hole.chunks_exact_mut(width) {
            for (x, value) in row.iter_mut().enumerate() {
                let at = |row: Option<&[f32]>| row.map_or(0.0, |row| row[x]);
                *value = at(above).max(at(below));
            }
        }
        start = end;
    }
}

/// Replaces each uncertain hole by the median of those connected with it above and below.
fn smooth(values: &mut [f32], uncertain: &[bool], width: usize) {
    let height = values.len() / width;
    let before = values.to_vec();
    values
        .par_chunks_mut(width)
        .enumerate()
        .for_each(|(y, row)| {
            for (x, value) in row.iter_mut().enumerate() {
                if !uncertain[y * width + x] {
                    continue;
                }
                let mut near = [0.0; 2 * REACH + 1];
                let mut count = 0;
                let mut take = |y: usize| {
                    let at = y * width + x;
                    if uncertain[at] {
                        near[count] = before[at];
                        count += 1;
                    }
                    uncertain[at]
                };
                take(y);
                let up = (1..=REACH.min(y)).take_while(|&n| take(y - n)).count();
                let down = (1..=REACH.min(height - 1 - y))
                    .take_while(|&n| take(y + n))
                    .count();
                let near = &mut near[..1 + up + down];
                near.sort_unstable_by(f32::total_cmp);
                *value = near[near.len() / 2];
            }
        });
}

/// Treats the unknown pixels above the topmost known one of each column as sky.
pub(super) fn open_sky(values: &mut [f32], width: usize) {
    for x in 0..width {
        let known = values[x..].iter().step_by(width).position(|v| !v.is_nan());
        // A column without any known pixel is filled from its neighbours.
        for y in 0..known.unwrap_or(0) {
            values[y * width + x] = f32::INFINITY;
        }
    }
}
