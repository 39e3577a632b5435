//! Look-up tables shared by several published models: transmittance to space, and light scattered many times.

mod air;
mod multiple;
mod transmittance;

pub use air::AirLanes;
pub use multiple::{MultipleScatteringSettings, MultipleScatteringTable};
pub use transmittance::TransmittanceTable;

/// Where a coordinate in `[0, 1]` lies among `size` samples, the first at 0 and the last at 1: the sample below and the
/// part of the way to the next.
fn place(coordinate: f64, size: usize) -> (usize, f32) {
    let x = coordinate.clamp(0.0, 1.0) * (size - 1) as f64;
    let below = (x as usize).min(size - 2);
    (below, (x - below as f64) as f32)
}

/// The four samples about a place in a table of `columns` columns, with their weights.
fn corners((u, v): (f64, f64), [columns, rows]: [usize; 2]) -> [(usize, f32); 4] {
    let ((i, s), (j, t)) = (place(u, columns), place(v, rows));
    let first = j * columns + i;
    [
        (first, (1.0 - s) * (1.0 - t)),
        (first + 1, s * (1.0 - t)),
        (first + columns, (1.0 - s) * t),
        (first + columns + 1, s * t),
    ]
}
