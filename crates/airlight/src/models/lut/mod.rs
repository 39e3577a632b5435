//! Look-up tables shared by several published models: transmittance to space, and light scattered many times.

mod air;
mod multiple;
mod transmittance;

pub use air::AirLanes;
pub use multiple::{MultipleScatteringSettings, MultipleScatteringTable};
pub use transmittance::TransmittanceTable;
