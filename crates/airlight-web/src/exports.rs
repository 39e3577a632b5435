//! What the page, its worker and its tests call.

use crate::{figures, sample};
use airlight_viewer::{Answer, Computer, Options, Request, State, run_in_page};
use std::cell::RefCell;
use wasm_bindgen::prelude::wasm_bindgen;
use web_sys::HtmlCanvasElement;

/// Shows the viewer in a canvas, with the state of a fragment, or the first one without.
///
/// # Errors
/// Why it cannot be shown, as a sentence.
#[wasm_bindgen]
pub async fn start(canvas: HtmlCanvasElement, fragment: String) -> Result<(), String> {
    let state = match fragment.as_str() {
        "" => State::default(),
        fragment => State::from_fragment(fragment)?,
    };
    let options = Options {
        state,
        ..Options::default()
    };
    run_in_page(canvas, options).await
}

thread_local! {
    /// What the worker has solved.
    static COMPUTER: RefCell<Computer> = RefCell::default();
}

/// Answers a request of the page, in the worker.
#[wasm_bindgen]
pub fn answer(request: &[u8]) -> Vec<u8> {
    let answer = match Request::from_bytes(request) {
        Ok(request) => COMPUTER.with_borrow_mut(|computer| computer.compute(&request)),
        Err(sentence) => Answer {
            number: 0,
            result: Err(sentence),
        },
    };
    answer.to_bytes()
}

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

/// [`figures::phase_function`].
///
/// # Errors
/// As there.
#[wasm_bindgen]
pub fn phase_function(g: f64, alpha: f64, count: usize) -> Result<Vec<f64>, String> {
    figures::phase_function(g, alpha, count)
}

/// [`figures::height_fog`].
///
/// # Errors
/// As there.
#[wasm_bindgen]
pub fn height_fog(
    visibility_m: f64,
    scale_height_m: f64,
    sun_elevation_deg: f64,
    count: usize,
) -> Result<Vec<f64>, String> {
    figures::height_fog(visibility_m, scale_height_m, sun_elevation_deg, count)
}
