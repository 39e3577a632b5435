//! One lighting of sky, air, fog and ground.
//!
//! - [`AerialPerspective`]: what clear air does between the eye and things at any distance.
//! - [`FoggySky`]: a sky with fog in it: the light of the sky falls on the fog, air and fog lie along every line in their
//!   true order, and what is far away goes over into the drawn sky.
//! - [`IrradianceMap`]: what all of that sheds on surfaces.
//! - [`SceneLighting`]: what a solver must tell to light things and to show them through the air.
//!
//! [`channels`](Channels) says what the N lanes of both are.

mod aerial;
mod aerial_fill;
mod channels;
mod error;
mod foggy;
mod irradiance_map;
mod light;
mod lighting;
mod places;

pub use aerial::AerialPerspective;
pub use channels::Channels;
pub use error::SceneError;
pub use foggy::FoggySky;
pub use irradiance_map::IrradianceMap;
pub use lighting::SceneLighting;
