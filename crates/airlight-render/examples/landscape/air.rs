//! The air between the eye and the ground, tabulated over picture and distance.

use crate::light::rgb;
use airlight::sky::View;
use airlight_image::Frame;
use glam::DVec3;

/// Pixels between tabulated lines of sight.
const STEP: u32 = 16;
/// Distances tabulated along each.
const DISTANCES: usize = 20;

/// What the air does to light on its way to the eye, by place in the picture and distance.
pub struct Air {
    columns: usize,
    /// The farthest distance tabulated, metres; the others lie at squares of even steps.
    farthest: f64,
    /// `[row][column][distance]`: transmittance and luminance added, cd/m^2.
    nodes: Vec<[DVec3; 2]>,
}

impl Air {
    /// Tabulates lines of sight of up to `farthest` metres over the frame.
    pub fn new(view: &View, frame: &Frame, farthest: f64) -> Self {
        use rayon::prelude::*;
        let size = frame.size();
        let columns = size.width().div_ceil(STEP) as usize + 1;
        let rows = size.height().div_ceil(STEP) as usize + 1;
        let white = rgb(view, &view.solar_irradiance());
        let nodes = (0..columns * rows)
            .into_par_iter()
            .flat_map_iter(|i| {
                let within = |n: usize, size: u32| f64::from((n as u32 * STEP).min(size));
                let (x, y) = (
                    within(i % columns, size.width()),
                    within(i / columns, size.height()),
                );
                let direction = frame.direction(x, y).unwrap_or(DVec3::Y);
                (0..=DISTANCES).map(move |k| {
                    let part = k as f64 / DISTANCES as f64;
                    if k == 0 {
                        return [DVec3::ONE, DVec3::ZERO];
                    }
                    let line = view.along(direction, Some(farthest * part * part));
                    let dimmed: Vec<f32> = line
                        .transmittance
                        .iter()
                        .zip(view.solar_irradiance())
                        .map(|(t, e)| t * e)
                        .collect();
                    [rgb(view, &dimmed) / white, rgb(view, &line.path_radiance())]
                })
            })
            .collect();
        Self {
            columns,
            farthest,
            nodes,
        }
    }

    /// The light of something `distance` metres away at a place of the picture, as it arrives.
    pub fn through(&self, light: DVec3, x: f64, y: f64, distance: f64) -> DVec3 {
        let (u, v) = (x / f64::from(STEP), y / f64::from(STEP));
        let depth = (distance / self.farthest).clamp(0.0, 1.0).sqrt() * DISTANCES as f64;
        let first = (depth as usize).min(DISTANCES - 1);
        let mut sum = [DVec3::ZERO; 2];
        for (row, wy) in ends(v) {
            for (column, wx) in ends(u) {
                for (k, wd) in [
                    (first, 1.0 - (depth - first as f64)),
                    (first + 1, depth - first as f64),
                ] {
                    let cell = row * self.columns + column;
                    let node = self.nodes[cell * (DISTANCES + 1) + k];
                    for (sum, value) in sum.iter_mut().zip(node) {
                        *sum += wy * wx * wd * value;
                    }
                }
            }
        }
        light * sum[0] + sum[1]
    }
}

/// The nodes beside a coordinate and their weights.
fn ends(t: f64) -> [(usize, f64); 2] {
    let floor = t as usize;
    let part = t - floor as f64;
    // A coordinate on the last node takes it whole.
    [(floor, 1.0 - part), (floor + usize::from(part > 0.0), part)]
}
