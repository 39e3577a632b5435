//! The viewer as a web page, the book's live figures, and values that the browser must compute as the processor does.

#[cfg(target_arch = "wasm32")]
mod exports;
pub mod figures;
pub mod sample;
