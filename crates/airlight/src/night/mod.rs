//! Natural light of the night outside the lower air: moon, airglow, zodiacal light, starlight and bright stars.
//!
//! - [`CelestialFrame`]: the orientation of the celestial sphere over a place, and the moon's position.
//! - [`MoonState`]: position, phase and spectral irradiance of the moon.
//! - [`NightGlow`]: radiance of airglow, zodiacal light and integrated starlight outside the lower air.
//! - [`bright_stars`]: the stars up to magnitude 6.5.
//!
//! How the air dims and scatters this light is computed by the solvers of scenes ([`crate::scene`]). A moonless sky far from
//! cities has a luminance of about 2e-4 cd/m^2 at the zenith, 21.5 to 22 magnitudes per square arcsecond
//! ([`magnitude_per_square_arcsec`]). It varies by a factor of two with the activity of the sun, the season and the place
//! of the Milky Way.

mod airglow;
mod celestial;
#[cfg(feature = "ephemeris")]
mod ephemeris;
mod glow;
mod moon;
mod spectra;
mod starlight;
mod stars;
mod zodiacal;

pub use celestial::CelestialFrame;
pub(crate) use glow::MEAN_SOLAR_FLUX_SFU;
pub use glow::{GlowComponent, NightGlow};
pub use moon::{MoonError, MoonState};
pub(crate) use spectra::luminance_of_magnitude;
pub use spectra::{black_body, magnitude_per_square_arcsec};
pub use stars::{Star, bright_stars};

/// The lights of the night at one time: where the celestial sphere and the moon are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NightState {
    /// Orientation of the celestial sphere.
    pub frame: CelestialFrame,
    /// The moon, if it is to be seen.
    pub moon: Option<MoonState>,
}
