//! What the page and its tests call.

use crate::sample;
use wasm_bindgen::prelude::wasm_bindgen;

/// [`sample::values`] as text, one name and value a line.
#[wasm_bindgen]
pub fn sample_values() -> String {
    sample::text(&sample::values())
}

/// Solves the sky of the viewer for all suns, which a test times.
#[wasm_bindgen]
pub fn solve_all_suns() -> f64 {
    sample::solve_all_suns()
}
