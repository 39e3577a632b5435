//! Drawing from outside the crate: fog over pictures, batches, sequences.

mod batch;
mod cancelled;
mod colours;
mod common;
mod display;
mod forms;
mod lights;
mod monte_carlo;
mod round_trips;
mod scenes;
mod shards;
mod sky;
