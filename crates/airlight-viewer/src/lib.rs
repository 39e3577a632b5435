//! Viewer of skies, haze and fog: a window, or a page, with the picture of [`airlight_gpu`] and controls in physical units.
//!
//! [`run`] opens a window; [`screenshot`] draws the same without one. [`Viewer`] is the program itself, for [`eframe`] or for tests.
//!
//! [`State`] is all that the user has set: a [`Scene`](airlight::scene::Scene), from which everything on the screen follows.
//! [`compute()`] is the work that takes time, from plain data to plain data; the module `platform` runs it beside the window. The solver,
//! the drawing and the colours are those of the library; the viewer adds no physics.
//!
//! Modules, each importing only from those above it: [`state`], `terrain`, `lights`, `photograph`, `address`, `examples`, `options`, `command`,
//! [`compute`](mod@compute), `message`, `platform`, `page_files`, `timers`, `graphics`, `picture`, `time_lapse`, `truth`, `style`, `widgets`, `place`, `play`, `view`, `panel`, `reading`, `beside`, `app`, `headless`, `window`, `page`.

mod address;
mod app;
mod beside;
mod command;
pub mod compute;
mod examples;
#[cfg(not(target_arch = "wasm32"))]
mod graphics;
#[cfg(not(target_arch = "wasm32"))]
mod headless;
mod lights;
#[cfg(any(test, target_arch = "wasm32"))]
mod message;
mod options;
#[cfg(target_arch = "wasm32")]
mod page;
#[cfg(target_arch = "wasm32")]
mod page_files;
mod panel;
#[cfg(not(target_arch = "wasm32"))]
mod photograph;
mod picture;
mod place;
mod platform;
mod play;
mod reading;
pub mod state;
mod style;
mod terrain;
#[cfg(not(target_arch = "wasm32"))]
mod time_lapse;
mod timers;
mod truth;
mod view;
mod widgets;
#[cfg(not(target_arch = "wasm32"))]
mod window;

pub use app::{Viewer, ViewerError};
pub use command::command_line;
pub use compute::{Answer, Computer, Output, Request, Task, compute};
#[cfg(not(target_arch = "wasm32"))]
pub use headless::screenshot;
pub use options::Options;
#[cfg(target_arch = "wasm32")]
pub use page::run_in_page;
#[cfg(not(target_arch = "wasm32"))]
pub use photograph::FoggedPhotograph;
pub use state::State;
#[cfg(not(target_arch = "wasm32"))]
pub use window::run;
