//! Light scattered many times inside a fog.
//!
//! Sunlight and sky light enter at the top and are scattered until they leave, reach the ground or are absorbed. What a fog
//! sends along a line of sight is then mostly light that comes from everywhere. It is solved for once ([`ordinates`]: eight
//! polar angles, all azimuths; without the forward peak, [`crate::transfer::delta_m`]), kept as moments of the source function by height
//! ([`field`]), and integrated along each line with weights that are exact for a source linear in optical depth.

mod field;
mod heights;
mod legendre;
mod ordinates;

pub(super) use field::{DirectionWeights, Field, Reduced};
pub(super) use legendre::{STREAMS, in_direction, of_mode};
