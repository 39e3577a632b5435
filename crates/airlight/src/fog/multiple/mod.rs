//! Multiple scattering in fog.
//!
//! The diffuse light is solved for once ([`ordinates`]: eight polar angles, all azimuths; without the forward peak,
//! [`crate::transfer::delta_m`]), stored as moments of the source function by height ([`field`]), and integrated along rays with
//! weights that are exact for sources linear in optical depth.

mod field;
mod heights;
mod legendre;
mod ordinates;
mod peak;

pub(super) use field::{DirectionWeights, Field, Reduced};
pub(super) use legendre::{DEGREES, azimuth_factors, in_direction, of_mode};
pub(super) use peak::{KEPT, KINDS, ORDERS, PeakScattering};
