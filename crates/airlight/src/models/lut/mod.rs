//! Look-up tables shared by published models: transmittance to space and multiple scattering.

mod air;
mod multiple;
mod transmittance;

pub use air::{AirLanes, Steps, add_scaled};
pub use multiple::{MultipleScatteringSettings, MultipleScatteringTable};
pub use transmittance::TransmittanceTable;
