//! Reports of checks as text, JSON and HTML with plots.

mod html;
mod json;
mod plot;
mod text;
mod words;

pub use html::html;
pub use json::json;
pub use text::text;

#[cfg(test)]
mod tests;
