//! Filling of holes in depth maps from the known pixels around them.
//!
//! Stereo and depth cameras leave holes mostly where a near object hides a far one from one of two views: there the
//! farther neighbour is right. Along each row a hole therefore gets the farther of the nearest known values to its left
//! and right, unless the two are similar: then both lie on one surface, and the hole is interpolated linearly
//! in 1/z, as a plane appears. A median along the columns of the holes then removes the streaks that independently filled rows
//! would show. The work is proportional to the number of pixels.

use rayon::prelude::*;

/// Largest relative difference of two depths on one surface.
const ONE_SURFACE: f32 = 0.1;

/// Half width of the median, rows.
const REACH: usize = 4;

/// Fills NaN pixels; at least one pixel must be known.
pub(super) fn fill_holes(values: &mut [f32], width: usize) {
    let holes: Vec<bool> = values.iter().map(|v| v.is_nan()).collect();
    values.par_chunks_mut(width).for_each(fill_row);
    fill_rows(values, width);
    smooth(values, &holes, width);
}

/// Fills the holes of a row; a row without known pixels stays unchanged.
fn fill_row(row: &mut [f32]) {
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
            (Some(a), Some(b)) => fill_between(hole, a, b),
            (Some(v), None) | (None, Some(v)) => hole.fill(v),
            (None, None) => {}
        }
        start = end;
    }
}

fn fill_between(hole: &mut [f32], left: f32, right: f32) {
    let (near, far) = (left.min(right), left.max(right));
    if !(far.is_finite() && near > 0.0 && far - near <= ONE_SURFACE * far) {
        hole.fill(far);
        return;
    }
    let (a, b) = (1.0 / f64::from(left), 1.0 / f64::from(right));
    let step = (b - a) / (hole.len() + 1) as f64;
    for (i, value) in hole.iter_mut().enumerate() {
        *value = (1.0 / (a + step * (i + 1) as f64)) as f32;
    }
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

/// Replaces each hole by the median of the connected holes above and below it.
fn smooth(values: &mut [f32], holes: &[bool], width: usize) {
    let height = values.len() / width;
    let before = values.to_vec();
    values
        .par_chunks_mut(width)
        .enumerate()
        .for_each(|(y, row)| {
            for (x, value) in row.iter_mut().enumerate() {
                if !holes[y * width + x] {
                    continue;
                }
                let mut near = [0.0; 2 * REACH + 1];
                let mut count = 0;
                let mut take = |y: usize| {
                    let at = y * width + x;
                    if holes[at] {
                        near[count] = before[at];
                        count += 1;
                    }
                    holes[at]
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
